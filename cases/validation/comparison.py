"""The Sandia rotor's frequencies, simulated over the speeds and compared with the measured ones point by point.

Modes are told apart by what the rotor's symmetry gives: turned by half a turn about its axis, a mode is itself (S) or its
negative (A); and the blades move in their own plane (flatwise, F) or across it (edgewise, E). ``FA 2`` is the second
flatwise antisymmetric one, counted from the lowest.
"""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core import multibody as mb
from ..judge.measured import Validation
from ..judge.pairing import numbered
from . import sandia34
from .sandia34 import Variation

Array = NDArray[np.float64]

RPM = np.pi / 30.0
SPEEDS = (0.0, 10.0, 20.0, 30.0, 40.0)
"""rpm at which the model is solved; between them f² is a polynomial in Ω²."""

VARIED_AT = (0.0, 20.0, 40.0)
"""rpm at which the inputs are varied; u_input is linear between."""

COUNT = 12
"""Modes that are solved for, which hold all that were measured."""


@cache
def data() -> dict[str, Any]:
    """The numbers of ``sandia34_measured.toml``."""
    return tomllib.loads((files(str(__package__)) / "sandia34_measured.toml").read_text(encoding="utf-8"))


def named(found: mb.Solution) -> dict[str, float]:
    """Frequencies (Hz) by name."""
    state = found.linear.state.kinematics
    bodies = [b.name for b in found.linear.tree.mechanism.bodies]
    number = sum(name.startswith("right ") for name in bodies)
    sides = [np.array([bodies.index(f"{side} {k}") for k in range(1, number + 1)]) for side in ("right", "left")]
    kinds = []
    for shape in found.shapes:
        twist = state.B @ shape  # of every body, taken at the ground's origin
        right, left = (twist[s, :3] + np.cross(twist[s, 3:], state.poses[s, :3, 3]) for s in sides)
        turned = left * [-1.0, -1.0, 1.0]
        symmetric = np.linalg.norm(right + turned) > np.linalg.norm(right - turned)
        across = np.linalg.norm(right[:, 1])
        kinds.append(("E" if across > np.linalg.norm(right[:, [0, 2]]) else "F") + ("S" if symmetric else "A"))
    return dict(zip(numbered(kinds), (found.frequencies / (2.0 * np.pi)).tolist(), strict=True))


def solved(rpm: float, how: Variation) -> dict[str, float]:
    """The model's frequencies (Hz) by name at one speed."""
    return named(mb.solve(sandia34.mechanism(rpm * RPM, how), count=COUNT))


@dataclass(frozen=True)
class Simulated:
    """The model over the speeds.

    Attributes:
        base: frequencies (Hz) by name at each of ``SPEEDS``.
        inputs: u_input of each at each of ``VARIED_AT``, Hz.
        numerical: relative change of each at rest from halving every element.
    """

    base: tuple[dict[str, float], ...]
    inputs: tuple[dict[str, float], ...]
    numerical: dict[str, float]


def inputs(at: Sequence[dict[str, float]]) -> dict[str, float]:
    """u_input from the frequencies of all ``variations`` at one speed: root of the sum of the changes' squares."""
    plain, *others = at
    return {name: float(np.sqrt(sum((o.get(name, np.inf) - f) ** 2 for o in others))) for name, f in plain.items()}


def variations() -> tuple[Variation, ...]:
    """The model, and one change of each input that is uncertain: by a standard uncertainty, or to the other choice."""
    u = sandia34.data()["uncertainty"]
    return (
        Variation(),
        Variation(stiffness=1.0 + u["stiffness"]),
        Variation(mass=1.0 + u["mass"]),
        Variation(centre="across the chord"),
        Variation(centre="along the chord"),
        Variation(mirrored=True),
    )


def simulated() -> Simulated:
    """The model at all speeds, its inputs varied, and refined: 21 solutions of one to a few minutes' work in all."""
    base = tuple(solved(rpm, Variation()) for rpm in SPEEDS)
    varied = tuple(
        inputs([base[SPEEDS.index(rpm)], *(solved(rpm, how) for how in variations()[1:])]) for rpm in VARIED_AT
    )
    fine = solved(0.0, Variation(refine=2))
    return Simulated(base, varied, {name: abs(fine.get(name, np.inf) / f - 1.0) for name, f in base[0].items()})


def at_speed(values: Sequence[float], rpm: float) -> float:
    """A frequency (Hz) between ``SPEEDS``: f² as a polynomial in Ω² through them all."""
    x = (np.array(SPEEDS) / SPEEDS[-1]) ** 2
    through = np.polynomial.Polynomial.fit(x, np.square(values), len(x) - 1)
    return float(np.sqrt(through((rpm / SPEEDS[-1]) ** 2)))


@dataclass(frozen=True)
class Point:
    """One measured point beside what the model gives there, both in Hz."""

    line: str
    rpm: float
    validation: Validation


def points(model: Simulated) -> tuple[Point, ...]:
    """Every measured point that the model has a mode for, at every speed."""
    out = []
    for line in data()["lines"]:
        for rpm, measured in line["points"]:
            all_ = [at_speed([at[name] for at in model.base], rpm) for name in line["of"]]
            S = float(np.mean(all_))
            apart = 0.5 * (max(all_) - min(all_))  # which of a pair was measured is not known
            numerical = np.hypot(max(model.numerical[name] for name in line["of"]) * S, apart)
            u = max(np.interp(rpm, VARIED_AT, [at[name] for at in model.inputs]) for name in line["of"])
            out.append(
                Point(line["name"], rpm, Validation(S, measured, float(numerical), float(u), data()["uncertainty"]))
            )
    return tuple(out)
