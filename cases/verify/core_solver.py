"""Core as a solver: answers in the same form as a foreign code's, refined until they can serve as reference."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...core.element.discretize import Mass
from ...core.element.measures import Measure
from ...core.modes import Modes
from ...core.participation import FAMILIES, families, numbered, participation
from ...core.solve import mesh_modes, rigid_strain_bias
from ...references.protocol.process import Failure
from ...references.protocol.worker import Answer, Run
from ..input.errors import NO_STATE, CaseError
from ..input.schema import Compare, Discretisation
from ..judge.pairing import Array, aligned, weights
from ..judge.uncertainty import widened
from .refinement import RefinedMode, Refining, Wanted, follow, solve

SURE = 5e-5
"""Core is refined until its relative uncertainty is at most this: a quarter of the limit for a code."""

COARSEST, LARGEST_START, FINEST = 15, 100, 960
"""Elements of core's reference: the coarsest, the most to start with for many stations, and the finest."""

JUMP = 1e-4
"""Intervals shorter than this fraction of the blade's length are steps of the properties."""

MARGIN = 4
"""Number of modes solved above the highest one wanted, so that each can find its partner."""

DEEPER = 3
"""Factor on the number of modes for the one retry when too few modes qualify."""


Solver = Callable[..., Modes]
"""A method of core: ``solve.modes`` or ``velocity_transformation.modes``."""


@dataclass(frozen=True)
class Converged:
    """Core's modes at one speed, with the compared modes, their estimates and dominant motions in the same order.

    ``every`` has the names of all modes, such as ``flapwise 2``, also of those that are not compared.
    """

    wanted: Wanted
    modes: tuple[RefinedMode, ...]
    every: tuple[str, ...]
    motions: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the compared modes."""
        return tuple(self.every[k] for k in self.wanted.indices)

    @property
    def count(self) -> int:
        """Number of modes to request from another solver."""
        return max(self.wanted.indices) + 1 + MARGIN


def answers(
    blade: Blade,
    runs: Sequence[Run],
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    by: Solver | None = None,
) -> list[Answer]:
    """Core's answers to ``runs`` by one of its methods; a speed without a stable steady state gives a failure."""
    out: list[Answer] = []
    for omega, elements, count in runs:
        try:
            out.append(
                (by or mesh_modes)(blade, omega, elements, count, mass=mass, stiffness=stiffness, effects=effects)
            )
        except NO_STATE as error:
            out.append(Failure("refused", str(error)))
    return out


def rescaled(blade: Blade, factor: float) -> Blade:
    """The blade with masses and stiffnesses multiplied by ``factor``: same frequencies, different rounding."""
    return replace(
        blade,
        mass=factor * blade.mass,
        stiffness=factor * blade.stiffness,
        tip_mass=factor * blade.tip_mass,
        root=factor * blade.root,
    )


def refining(blade: Blade) -> Refining:
    """Refinement of core, starting from elements no longer than the shortest interval between stations.

    Properties have kinks at stations. Intervals that represent a step of the properties do not count: elements
    integrate across them.
    """
    intervals = np.diff(blade.stations) / blade.length
    shortest = float(intervals[intervals > JUMP].min(initial=1.0))
    start = min(max(COARSEST, math.ceil(1.0 / shortest - 1e-9)), LARGEST_START)
    return Refining((start, 2 * start, 3 * start), order=4, cap=FINEST, sure=SURE)


def as_given(source: Discretisation) -> Refining:
    """Refinement of the discretisation of a source: its number of elements first, then finer ones of the same kind."""
    n = source.elements
    return Refining((n, 2 * n, 4 * n), order=2, cap=8 * n)


def converged(blade: Blade, omega: float, compare: Compare, effects: Effects) -> Converged | Failure:
    """Core's converged modes at one speed, with the given effects.

    Raises:
        CaseError: if the blade has fewer modes than the case compares.
    """
    return _converged(blade, omega, compare, effects, weights(blade), 2 * compare.modes + MARGIN)


def _converged(
    blade: Blade, omega: float, compare: Compare, effects: Effects, weight: Array, count: int
) -> Converged | Failure:
    def ask(runs: Sequence[Run]) -> list[Answer]:
        return answers(blade, runs, effects=effects)

    def wanted(_: float, solved: Sequence[Modes]) -> Wanted:
        finest = aligned(solved[-1], weight)
        return Wanted(finest, qualifying(finest, blade, compare), weight)

    plan = refining(blade)
    (refinements,) = solve(ask, [omega], plan, count, wanted)
    if not refinements.answers:
        return refinements.failure or Failure("refused", "no answer")
    target = wanted(omega, refinements.answers)
    if len(target.indices) < compare.modes:
        if count > 2 * compare.modes + MARGIN:
            raise CaseError(
                f"{blade.name}: compare.modes: {compare.modes}: at {omega:g} rad/s only {len(target.indices)} of the lowest "
                f"{len(refinements.answers[-1].frequencies)} modes qualify; reduce it"
            )
        return _converged(blade, omega, compare, effects, weight, DEEPER * count)
    energies = participation(target.reference, blade)
    meshes = [answer.elements for answer in refinements.answers]
    factor, unsure = rigid_strain_bias(blade, omega, (meshes[-2:][0], meshes[-1]), count, effects)
    refined_modes = tuple(
        _corrected(one, float(factor[k]), float(unsure[k]))
        for k, one in zip(target.indices, follow(refinements.answers, target, plan.order), strict=True)
    )
    motions = tuple(FAMILIES[k] for k in energies[list(target.indices)].argmax(1))
    return Converged(target, refined_modes, numbered(families(energies)), motions)


def _corrected(one: RefinedMode, factor: float, unsure: float) -> RefinedMode:
    """Remove the bias of rigid strains."""
    if one.estimate is None:
        return one
    known = widened(one.estimate, unsure)
    return replace(one, estimate=replace(known, value=factor * known.value))


def qualifying(modes: Modes, blade: Blade, compare: Compare) -> tuple[int, ...]:
    """Indices of the lowest ``compare.modes`` modes with at least half their kinetic energy in ``compare.motions``."""
    share = participation(modes, blade)[:, [FAMILIES.index(m) for m in compare.motions]].sum(1)
    return tuple(np.flatnonzero(share >= 0.5)[: compare.modes].tolist())
