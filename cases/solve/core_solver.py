"""Core as a solver: answers in the same form as a foreign code's, refined until they can serve as reference."""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...core.element.discretize import Mass
from ...core.element.measures import Measure
from ...core.modes import Modes
from ...core.participation import FAMILIES, families, numbered, participation
from ...core.solve import mesh_sweep, rigid_strain_bias
from ...references.protocol.process import Failure
from ...references.protocol.worker import Answer, Run
from ..input.errors import NO_STATE
from ..input.schema import Compare, Discretisation
from ..judge import spectrum
from ..judge.convergence import Compared, RefinedMode, follow
from ..judge.pairing import Array, aligned, weights
from ..judge.reference import MARGIN, Converged
from ..judge.spectrum import Spectrum
from ..judge.uncertainty import widened
from .refinement import Refining, solve

MAX_UNCERTAINTY = 5e-5
"""Core is refined until its relative uncertainty is at most this: a quarter of the limit for a code."""

COARSEST, LARGEST_START, FINEST = 15, 100, 960
"""Elements of core's reference: the coarsest, the most to start with for many stations, and the finest."""

JUMP = 1e-4
"""Intervals shorter than this fraction of the blade's length are steps of the properties."""

DEEPER = 3
"""Factor on the number of modes for the one retry when too few modes qualify."""


def answers(
    blade: Blade,
    runs: Sequence[Run],
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
) -> list[Answer]:
    """Core's answers to ``runs``; a speed without a stable steady state gives a failure."""
    out: list[Answer] = []
    for (elements, count), group in groupby(runs, key=lambda run: run[1:]):
        speeds = [omega for omega, _, _ in group]
        first = 0
        while first < len(speeds):
            swept = mesh_sweep(blade, speeds[first:], elements, count, mass=mass, stiffness=stiffness, effects=effects)
            try:
                for modes in swept:
                    out.append(modes)
                    first += 1
            except NO_STATE as error:
                out.append(Failure("refused", str(error)))
                first += 1
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
    return Refining((start, 2 * start, 3 * start), order=4, cap=FINEST, max_uncertainty=MAX_UNCERTAINTY, least=2.0)


def as_given(source: Discretisation) -> Refining:
    """Refinement of the discretisation of a source: its number of elements first, then finer ones of the same kind."""
    n = source.elements
    return Refining((n, 2 * n, 4 * n), order=2, cap=8 * n, least=2.0)


def converged(blade: Blade, speeds: Sequence[float], compare: Compare, effects: Effects) -> list[Converged | Failure]:
    """Core's converged modes at each speed (rad/s), with the given effects; a failure where too few modes qualify."""
    count, weight = 2 * compare.modes + MARGIN, weights(blade)
    by_speed = _converged(blade, speeds, compare, effects, weight, count)
    if insufficient := [omega for omega, answer in by_speed.items() if isinstance(answer, int)]:
        count *= DEEPER
        by_speed |= _converged(blade, insufficient, compare, effects, weight, count)
    return [_enough(omega, by_speed[omega], compare.modes, count) for omega in speeds]


def _enough(omega: float, answer: Converged | Failure | int, compared: int, count: int) -> Converged | Failure:
    if not isinstance(answer, int):
        return answer
    reason = f"at {omega:g} rad/s only {answer} of the lowest {count} modes qualify; reduce it"
    return Failure("no reference", f"compare.modes: {compared}: {reason}")


def _converged(
    blade: Blade, speeds: Sequence[float], compare: Compare, effects: Effects, weight: Array, count: int
) -> dict[float, Converged | Failure | int]:
    """As ``converged``, by speed, from ``count`` modes; if too few of them qualify, their number."""
    raw: dict[tuple[float, int], Modes] = {}
    compared_at: dict[tuple[float, int], tuple[Compared, Array]] = {}

    def ask(runs: Sequence[Run]) -> list[spectrum.Answer]:
        answered = answers(blade, runs, effects=effects)
        raw.update({(modes.omega, modes.elements): modes for modes in answered if isinstance(modes, Modes)})
        return spectrum.of_blades(answered)

    def compared(omega: float, spectra: Sequence[Spectrum]) -> tuple[Compared, Array]:
        """The modes to compare, and the energy fractions of all, by the finest answer."""
        elements = spectra[-1].elements
        if (omega, elements) not in compared_at:
            finest = aligned(raw[omega, elements], weight)
            energies = participation(finest, blade)
            labelled = replace(spectrum.of_blade(finest, weight), labels=numbered(families(energies)))
            compared_at[omega, elements] = Compared(labelled, qualifying(energies, compare)), energies
        return compared_at[omega, elements]

    plan = refining(blade)
    refined = solve(ask, speeds, plan, count, lambda omega, solved: compared(omega, solved)[0])
    out: dict[float, Converged | Failure | int] = {}
    sufficient: dict[float, tuple[Spectrum, ...]] = {}
    for omega, refinements in zip(speeds, refined, strict=True):
        if not refinements.answers:
            out[omega] = refinements.failure or Failure("refused", "no answer")
        elif (qualified := len(compared(omega, refinements.answers)[0].indices)) < compare.modes:
            out[omega] = qualified
        else:
            sufficient[omega] = refinements.answers
    meshes = [(omega, (solved[-2:][0].elements, solved[-1].elements)) for omega, solved in sufficient.items()]
    biases = rigid_strain_bias(blade, meshes, count, effects)
    for (omega, solved), (factor, unsure) in zip(sufficient.items(), biases, strict=True):
        target, energies = compared(omega, solved)
        modes = tuple(
            _corrected(mode, float(factor[k]), float(unsure[k]))
            for k, mode in zip(target.indices, follow(solved, target, plan.order), strict=True)
        )
        motions = tuple(FAMILIES[k] for k in energies[list(target.indices)].argmax(1))
        out[omega] = Converged(target.spectrum, target.indices, modes, motions)
    return out


def _corrected(mode: RefinedMode, factor: float, unsure: float) -> RefinedMode:
    """Remove the bias of rigid strains."""
    if mode.estimate is None:
        return mode
    estimate = widened(mode.estimate, unsure)
    return replace(mode, estimate=replace(estimate, value=factor * estimate.value))


def qualifying(energies: Array, compare: Compare) -> tuple[int, ...]:
    """Indices of the lowest ``compare.modes`` modes with at least half their energy in ``compare.motions``.

    ``energies`` are the fractions (m, 4) of ``participation``.
    """
    share = energies[:, [FAMILIES.index(m) for m in compare.motions]].sum(1)
    return tuple(np.flatnonzero(share >= 0.5)[: compare.modes].tolist())
