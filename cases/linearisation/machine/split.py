"""Modes of a linearisation beside core's turbine: paired by shape, the difference split into its parts.

From one model of ``models`` to the next, a mode is paired by shape; the change of its frequency is a part of the difference.
What remains is divided by what no structure has: M being the structure's mass, the remainder of C has a symmetric part beyond
the deck's damping, that of K a skew one, and other modules' states act on the structure. These are *aerodynamics*; symmetric
stiffness and skew damping, which a structure can have, are the *rest*.
"""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ....core.rotor.periodic import PeriodicError
from ...input.errors import NO_STATE, CaseError, rad_s
from ..judged import JudgedSet
from ..modes import Mode, components
from ..multiblade import fixed_frame
from ..sets import AzimuthSet, first_azimuths
from . import fields, models
from .causes import Cause, ranked
from .deck import Deck
from .elastodyn import Matrices, Structure
from .fields import Shapes
from .models import Models

Array = NDArray[np.float64]

SHAPES, NODES, GRAVITY, DEFLECTION, AERODYNAMICS, REST = (
    "mode shapes",
    "nodes",
    "gravity",
    "deflection",
    "aerodynamics",
    "rest",
)
"""Names of the parts, in their order."""


RATE_OF = "rate of "

CLEAR, FEW_DIGITS = 0.9, 0.01
"""Least MAC and largest relative uncertainty of the modes by which causes are sought."""

AZIMUTHS = 2
"""Number of azimuths at which hypotheses are solved."""

SOUGHT = 1e-3
"""Relative differences up to this need no cause."""


@dataclass(frozen=True)
class Comparison:
    """The structural modes of a set beside core's turbine.

    Attributes:
        modes: by frequency; those without a partner are left out.
        causes: alterations of the deck that explain the rest, the most probable first; empty if none was sought.
        remark: why none was sought, or what was found, in one line.
    """

    modes: tuple["ModeComparison", ...]
    causes: tuple[Cause, ...]
    remark: str


@dataclass(frozen=True)
class ModeComparison:
    """A mode of a linearisation beside the mode of core's turbine with its shape.

    Attributes:
        mode: of the linearisation.
        frequency: of core's turbine, Hz.
        mac: agreement of the shapes, 0 to 1.
        parts: of the difference, by name, relative to core's frequency; they add up to ``difference``.
        origin: the largest term of A beyond the structure, in words; empty if there is none.
    """

    mode: Mode
    frequency: float
    mac: float
    parts: dict[str, float]
    origin: str

    @property
    def difference(self) -> float:
        """Of the linearisation's frequency from core's, relative."""
        return self.mode.frequency / self.frequency - 1


def compare(judged_set: JudgedSet, deck: Deck, causes: bool = True) -> Comparison:
    """The structural modes of a set beside those of the deck's turbine.

    Args:
        judged_set: the set.
        deck: of its turbine.
        causes: whether causes of the rest are sought.

    Raises:
        CaseError: the deck is not of this set, or the turbine has no steady state at its speed.
    """
    azimuth_set = judged_set.azimuth_set
    deck_models = Models(deck, azimuth_set, models.degrees(deck, azimuth_set), fields.points(deck))
    field = fields.of_states(deck, deck_models.at, azimuth_set)
    own = Shapes(
        np.array([mode.eigenvalue for mode in judged_set.modes]),
        np.array([mode.shape for mode in judged_set.modes]).reshape(-1, len(azimuth_set.states)) @ field,
    )
    try:
        chain = structural(deck_models)
        non_structural = np.zeros(azimuth_set.A.shape[1:])
        last = chain[-1][1]
        if _has_equations(deck_models):
            structure = deck_models.structure()
            deflected = models.matrices(structure, azimuth_set, True, True)
            model = np.array([structure.state_matrix(part, azimuth_set) for part in deflected])
            chain.append(
                (
                    AERODYNAMICS,
                    models.of_states(deck_models, _with_non_structural(structure, deflected, model, azimuth_set)),
                )
            )
            non_structural = (fixed_frame(azimuth_set, azimuth_set.A) - fixed_frame(azimuth_set, model)).mean(axis=0)
        pairs = _comparisons([*chain, (REST, own)], judged_set, non_structural)
        sought, remark = _causes(deck_models, last, own, judged_set, pairs) if causes else ((), "")
    except (PeriodicError, *NO_STATE) as error:
        raise CaseError(f"--fst: at {rad_s(azimuth_set.omega)}: {error}") from error
    return Comparison(pairs, sought, remark)


def structural(deck_models: Models) -> list[tuple[str, Shapes]]:
    """The modes of each structural model, with the name of what it adds to the one before; the first is core's."""
    chain = [("core", deck_models.core(False))]
    if deck_models.free.blade or deck_models.free.tower or deck_models.free.order:
        chain.append((SHAPES, deck_models.core(True)))
    if _has_equations(deck_models):
        structure = deck_models.structure()
        for name, gravity, deflected in ((NODES, False, False), (GRAVITY, True, False), (DEFLECTION, True, True)):
            matrices = models.matrices(structure, deck_models.azimuth_set, gravity, deflected)
            chain.append((name, _modes(deck_models, structure, matrices)))
    return chain


def _last(deck_models: Models) -> Shapes:
    """The modes of the last structural model alone."""
    if not _has_equations(deck_models):
        return deck_models.core(bool(deck_models.free.blade or deck_models.free.tower or deck_models.free.order))
    structure = deck_models.structure()
    return _modes(deck_models, structure, models.matrices(structure, deck_models.azimuth_set, True, True))


def _comparisons(
    chain: list[tuple[str, Shapes]], judged_set: JudgedSet, non_structural: Array
) -> tuple[ModeComparison, ...]:
    names = [name for name, _ in chain[1:]]
    out = []
    for track, mac in _tracks([shapes for _, shapes in chain]):
        mode = judged_set.modes[track[-1]]
        values = [abs(shapes.values[k]) for (_, shapes), k in zip(chain, track, strict=True)]
        parts = {name: float((b - a) / values[0]) for name, a, b in zip(names, values[:-1], values[1:], strict=True)}
        out.append(
            ModeComparison(
                mode, float(values[0] / (2 * np.pi)), mac, parts, _origin(judged_set.azimuth_set, mode, non_structural)
            )
        )
    return tuple(sorted(out, key=lambda pair: pair.mode.frequency))


def _causes(
    deck_models: Models, last: Shapes, own: Shapes, judged_set: JudgedSet, pairs: Sequence[ModeComparison]
) -> tuple[tuple[Cause, ...], str]:
    """The causes of what remains after the last structural model, and a remark."""
    if _lacks_yaw(deck_models):
        return (), (
            "the deck states no yaw spring (YawSpr in ServoDyn's file, which may be missing): the bearing is locked here, and "
            "no cause of the rest is sought"
        )
    if any("AeroDyn" in name for file in deck_models.azimuth_set.files for name in file.modules):
        return (), "aerodynamic stiffness is part of the rest: no other cause is sought"
    partner, _ = fields.paired(own, last)
    clear = {id(pair.mode) for pair in pairs if pair.mac >= CLEAR and pair.mode.relative_uncertainty < FEW_DIGITS}
    index = [k for k, mode in enumerate(judged_set.modes) if id(mode) in clear and partner[k] >= 0]
    if len(index) < 2:
        return (), "the printed digits determine too few frequencies to seek a cause of the rest"
    observed = np.log(np.abs(own.values[index]))
    difference = observed - np.log(np.abs(last.values[partner[index]]))
    uncertainty = max(float(np.median([judged_set.modes[k].relative_uncertainty for k in index])), 1e-5)
    largest = float(np.abs(difference).max())
    if largest <= max(SOUGHT, 3.0 * uncertainty):
        return (), f"the deck explains all differences; {100 * largest:.2g} % remain"
    selection = fields.chosen(own, index)
    subset = first_azimuths(deck_models.azimuth_set, AZIMUTHS)  # a hypothesis changes all azimuths alike

    def predict(deck: Deck) -> Array:
        try:
            altered = _last(replace(deck_models, deck=deck, azimuth_set=subset))
        except (PeriodicError, *NO_STATE):
            return np.full(len(index), np.nan)
        partners, _ = fields.paired(selection, altered)
        return np.where(partners >= 0, np.log(np.abs(altered.values[partners])), np.nan)

    causes = ranked(deck_models.deck, difference, uncertainty, predict)
    known_causes = [cause for cause in causes if cause.named]
    return causes, f"as the deck with {known_causes[0]}" if known_causes else f"no known cause of {100 * largest:.2g} %"


def _has_equations(deck_models: Models) -> bool:
    """Whether all motions are ElastoDyn's and in the deck, so that its equations are known."""
    rate_of = dict(deck_models.azimuth_set.pairs)
    own = all(state.module == "ED" for k, state in enumerate(deck_models.azimuth_set.states) if k in rate_of)
    return own and deck_models.deck.blade_nodes > 0 and not _lacks_yaw(deck_models)


def _lacks_yaw(deck_models: Models) -> bool:
    """Whether the set has a yaw bearing of which the deck does not state the spring."""
    return "yaw" in deck_models.free.hub and bool(np.isinf(deck_models.deck.turbine.yaw))


def _modes(deck_models: Models, structure: Structure, matrices: list[Matrices]) -> Shapes:
    return models.of_states(
        deck_models, np.array([structure.state_matrix(part, deck_models.azimuth_set) for part in matrices])
    )


def _tracks(chain: list[Shapes]) -> list[tuple[list[int], float]]:
    """Indices of each of the last model's modes in all models, and the MAC of the last with the first."""
    backwards = [fields.paired(after, before) for before, after in pairwise(chain)]
    out = []
    for k in range(len(chain[-1].values)):
        track = [k]
        for partner, _ in reversed(backwards):
            track.append(int(partner[track[-1]]) if track[-1] >= 0 else -1)
        if min(track) >= 0:
            track.reverse()
            x, y = chain[0].fields[track[0]], chain[-1].fields[k]
            mac = abs(np.vdot(x, y)) ** 2 / (np.vdot(x, x) * np.vdot(y, y)).real
            if mac >= fields.MIN_MAC:
                out.append((track, float(mac)))
    return out


def _with_non_structural(
    structure: Structure, deflected: list[Matrices], model: Array, azimuth_set: AzimuthSet
) -> Array:
    """The files' A, in which the structure's block is that of the model and what no structure adds."""
    out = azimuth_set.A.copy()
    q, v = structure.coordinates, structure.rates
    for k, (M, C, K) in enumerate(deflected):
        stiffness = -M @ azimuth_set.A[k][np.ix_(v, q)] - K
        damping = -M @ azimuth_set.A[k][np.ix_(v, v)] - C
        K_free, C_free = K + 0.5 * (stiffness - stiffness.T), C + 0.5 * (damping + damping.T)
        out[k][np.ix_(q, q)], out[k][np.ix_(q, v)] = model[k][np.ix_(q, q)], model[k][np.ix_(q, v)]
        out[k][np.ix_(v, q)] = -np.linalg.solve(M, K_free)
        out[k][np.ix_(v, v)] = -np.linalg.solve(M, C_free)
    return out


def _origin(azimuth_set: AzimuthSet, mode: Mode, non_structural: Array) -> str:
    """The terms of A beyond the structure that change the mode's frequency most, to the first order."""
    change = np.outer(mode.adjoint, mode.shape) * non_structural * np.conj(mode.eigenvalue) / abs(mode.eigenvalue) ** 2
    component = components(azimuth_set)
    names = [_named(azimuth_set, k, component) for k in range(len(azimuth_set.states))]
    total: dict[tuple[str, str], float] = defaultdict(float)
    for i, j in zip(*np.nonzero(change), strict=True):
        total[names[i], names[j]] += float(change[i, j].real)
    if not total:
        return ""
    (row, column), value = max(total.items(), key=lambda item: abs(item[1]))
    block = "damping" if column.startswith(RATE_OF) else "stiffness"
    row, column = row.removeprefix(RATE_OF), column.removeprefix(RATE_OF)
    on = "itself" if row == column else row
    return f"{100 * value:+.2g} %: {block}, {column} on {on}".replace("-", "−")


def _named(azimuth_set: AzimuthSet, k: int, component: dict[int, int]) -> str:
    state = azimuth_set.states[k]
    part = "" if k not in component else " collective" if component[k] == 0 else " whirl"
    family = (RATE_OF if state.rate else "") + state.family + part
    return family + (f" of blade {state.blade}" if state.blade and k not in component else "")
