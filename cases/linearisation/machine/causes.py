"""Which alteration of the deck explains what the models leave of a difference: causes, ranked as in ``cases.diagnosis``.

Each hypothesis alters the deck, and the last structural model predicts the frequencies. A cause is named only if it explains
more than chance (``diagnosis.ranking``). With aerodynamics nothing is sought: the rest then contains its stiffness.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....core.blade import Blade
from ...diagnosis.ranking import CHANCE, UNEXPLAINED, UNFITTED, VISIBLE, chance, remaining_square
from ...input.readers.openfast.mode_shapes import Shape
from .deck import Deck

Array = NDArray[np.float64]
Alteration = Callable[[Deck, float], Deck]

STEP, FITTED, REFINED = 1.02, 4, 2
"""Factor for the derivative of a fitted hypothesis, number of hypotheses whose factor is fitted, and of refinements."""


@dataclass(frozen=True)
class Hypothesis:
    """An alteration of the deck; if ``fitted``, its factor is fitted."""

    name: str
    alter: Alteration
    fitted: bool = False


@dataclass(frozen=True)
class Cause:
    """A hypothesis that explains a difference.

    Attributes:
        name: what differs, in words.
        factor: fitted; 1 without one.
        explained: part of the sum of squares that it explains.
        remains: largest relative difference that remains.
        chance: bound of the probability that it explains as much by chance.
    """

    name: str
    factor: float
    explained: float
    remains: float
    chance: float
    fitted: bool

    @property
    def named(self) -> bool:
        """Whether it explains enough, and more than chance."""
        limit = UNFITTED if self.fitted else UNEXPLAINED
        return self.chance <= CHANCE and self.explained >= 1.0 - limit**2

    def __str__(self) -> str:
        alteration = f"{self.factor:.4g} × {self.name}" if self.fitted else self.name
        return f"{alteration} (explains {100 * self.explained:.3g} %, leaves {100 * self.remains:.2g} %)"


def ranked(deck: Deck, difference: Array, uncertainty: float, predict: Callable[[Deck], Array]) -> tuple[Cause, ...]:
    """The causes of a difference, the most probable first.

    Args:
        deck: the deck that was given.
        difference: (m,) logarithms of the ratios of the linearisation's frequencies to the model's.
        uncertainty: relative.
        predict: (m,) the logarithms of the model's frequencies with another deck; nan where it has no such mode.
    """
    base = predict(deck)
    out: list[Cause] = []
    fixed = [hypothesis for hypothesis in HYPOTHESES if not hypothesis.fitted]
    factors = [hypothesis for hypothesis in HYPOTHESES if hypothesis.fitted]
    for hypothesis in fixed:
        change = predict(hypothesis.alter(deck, 1.0)) - base
        if _visible(change, uncertainty):
            out.append(_cause(hypothesis, 1.0, difference, change, uncertainty, len(fixed)))
    slopes = {hypothesis: (predict(hypothesis.alter(deck, STEP)) - base) / np.log(STEP) for hypothesis in factors}
    slopes = {hypothesis: slope for hypothesis, slope in slopes.items() if _visible(0.1 * slope, uncertainty)}
    remainders = {hypothesis: remaining_square(difference, slope) for hypothesis, slope in slopes.items()}
    for hypothesis in sorted(slopes, key=remainders.__getitem__)[:FITTED]:
        slope = slopes[hypothesis]
        power = float(difference @ slope / (slope @ slope))
        for _ in range(REFINED):  # the secant through the last factor
            if not 1e-6 < abs(power) < np.log(10.0):
                break
            change = predict(hypothesis.alter(deck, float(np.exp(power)))) - base
            if not _visible(change, 0.0):
                break
            out.append(_cause(hypothesis, float(np.exp(power)), difference, change, uncertainty, len(factors)))
            slope = change / power
            power = float(difference @ slope / (slope @ slope))
    best: dict[str, Cause] = {}
    for cause in sorted(out, key=lambda cause: (cause.chance, -cause.explained)):
        best.setdefault(cause.name, cause)
    return tuple(best.values())


def _visible(change: Array, uncertainty: float) -> bool:
    return bool(np.isfinite(change).all() and np.abs(change).max(initial=0.0) > max(VISIBLE * uncertainty, 1e-9))


def _cause(hypothesis: Hypothesis, factor: float, D: Array, change: Array, uncertainty: float, kinds: int) -> Cause:
    rest, size = D - change, float(D @ D)
    share = float(max(rest @ rest, len(D) * uncertainty**2)) / size
    return Cause(
        hypothesis.name,
        factor,
        1.0 - float(rest @ rest) / size,
        float(np.abs(rest).max()),
        chance(share, len(D), kinds, 1 if hypothesis.fitted else 0),
        hypothesis.fitted,
    )


def _part(name: str, alter: Callable[[Any, float], Any]) -> Alteration:
    """A part of the turbine is altered: a beam, an inertia or a number."""

    def altered(deck: Deck, x: float) -> Deck:
        part = alter(getattr(deck.turbine, name), x)
        return replace(deck, turbine=replace(deck.turbine, **{name: part}))

    return altered


def _times(value: Any, x: float) -> Any:
    return x * value


def _stiffer(*entries: int) -> Callable[[Blade, float], Blade]:
    def alter(beam: Blade, x: float) -> Blade:
        stiffness = beam.stiffness.copy()
        for k in entries:
            stiffness[:, k, k] *= x
        return replace(beam, stiffness=stiffness)

    return alter


def _heavier(beam: Blade, x: float) -> Blade:
    return replace(beam, mass=x * beam.mass)


def _untuned(shapes: dict[str, Shape]) -> dict[str, Shape]:
    return {name: replace(shape, tuner=1.0) for name, shape in shapes.items()}


def _generator(deck: Deck, inertia: float) -> Deck:
    drive = replace(deck.turbine.drivetrain, generator=inertia)
    return replace(deck, turbine=replace(deck.turbine, drivetrain=drive))


HYPOTHESES: Sequence[Hypothesis] = (
    Hypothesis("no gravity", _part("gravity", lambda *_: 0.0)),
    Hypothesis("no precone", _part("blade", lambda blade, _: replace(blade, precone=0.0))),
    Hypothesis("no hub radius", _part("blade", lambda blade, _: replace(blade, hub_radius=0.0))),
    Hypothesis("no tip mass", _part("blade", lambda blade, _: replace(blade, tip_mass=np.zeros((6, 6))))),
    Hypothesis("no pitch", _part("blade", lambda blade, _: replace(blade, pitch=0.0))),
    Hypothesis("no twist", _part("blade", lambda blade, _: replace(blade, twist=np.zeros_like(blade.twist)))),
    Hypothesis(
        "no tuners",
        lambda d, _: replace(d, blade_shapes=_untuned(d.blade_shapes), tower_shapes=_untuned(d.tower_shapes)),
    ),
    Hypothesis(
        "many nodes",
        lambda deck, _: replace(deck, blade_nodes=20 * deck.blade_nodes, tower_nodes=20 * deck.tower_nodes),
    ),
    Hypothesis("no generator", lambda deck, _: _generator(deck, 0.0)),
    Hypothesis(
        "the generator's inertia without the square of the gear ratio",
        lambda deck, _: _generator(deck, deck.turbine.drivetrain.generator / deck.turbine.drivetrain.gear_ratio**2),
    ),
    Hypothesis("the blades' mass", _part("blade", _heavier), True),
    Hypothesis("the blades' flapwise stiffness", _part("blade", _stiffer(4)), True),
    Hypothesis("the blades' edgewise stiffness", _part("blade", _stiffer(5)), True),
    Hypothesis("the blades' bending stiffness", _part("blade", _stiffer(4, 5)), True),
    Hypothesis(
        "the hub radius", _part("blade", lambda blade, x: replace(blade, hub_radius=x * blade.hub_radius)), True
    ),
    Hypothesis("the tower's mass", _part("tower", _heavier), True),
    Hypothesis("the tower's stiffness", _part("tower", _stiffer(4, 5)), True),
    Hypothesis("the nacelle's mass", _part("nacelle", _times), True),
    Hypothesis("the hub's mass", _part("hub", _times), True),
    Hypothesis(
        "the generator's inertia", lambda deck, x: _generator(deck, x * deck.turbine.drivetrain.generator), True
    ),
    Hypothesis("the shaft's stiffness", lambda deck, x: replace(deck, shaft_stiffness=x * deck.shaft_stiffness), True),
    Hypothesis("the yaw spring", _part("yaw", _times), True),
)
"""Alterations of a deck that occur."""
