"""Rows of a refined code: the difference from core's reference, its uncertainty and the verdict, mode by mode."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from .cells import Head, Rows, failed, join, row, unless_ambiguous
from .convergence import RefinedMode, Refinements, follow
from .pairing import LEAST_MAC, pair
from .reference import Reference
from .results import Cell, Level
from .spectrum import Spectrum
from .verdict import AGREES, Judgement, bracketed, judge, known_difference

DAMPED = 1e-6
"""Largest damping ratio of a blade's mode that counts as rounding."""


def refined(
    head: Head, omega: float, reference: Reference, refinements: Refinements, order: int, bracket: bool = False
) -> Rows:
    """Cells of a code at one speed, one for each compared mode, and the frequencies of every refinement."""
    if not refinements.answers or (refinements.failure and refinements.failure.kind == "nonsense"):
        return [failed(head, omega, refinements.failure)], []
    refined_modes = follow(refinements.answers, reference.core, order, bracket)
    note = f"finer: {refinements.failure.reason}" if refinements.failure else ""
    doubt = (
        _extra(reference, refinements.answers[-1], refined_modes)
        or _damped(refinements.answers[-1])
        or (_unrefined(refinements.answers) if order and not bracket else "")
    )
    cells = []
    for i, mode in enumerate(refined_modes):
        cell = row(head, omega, i, reference, refinements.answers[-1], mode.partner)
        if reason := _missing_motion(reference, i, head.motions):
            cell = replace(cell, verdict="not applicable", reason=reason)
        elif mode.estimate:
            cell = judged(cell, reference, i, mode, note, order)
        if doubt and cell.verdict in (*AGREES, "known difference"):
            cell = replace(cell, verdict="inconclusive", reason=join(doubt, cell.reason))
        cells.append(cell)
    levels = [
        Level(head.case, omega, i + 1, head.code, n, f) for i, mode in enumerate(refined_modes) for n, f in mode.history
    ]
    return cells, levels


def _extra(reference: Reference, answer: Spectrum, refined_modes: Sequence[RefinedMode]) -> str:
    """The modes of an answer below the highest compared one that are none of core's; empty if there are none."""
    core = reference.core.spectrum
    partners = {partner.mode for partner in pair(core, answer, range(len(core.values)))}
    top = max((answer.frequencies[m.partner.mode] for m in refined_modes if m.partner.mode is not None), default=0.0)
    extra = [f"{f:.6g}" for k, f in enumerate(answer.frequencies) if k not in partners and f < top]
    return (
        f"modes at {', '.join(extra)} rad/s do not match any mode of Southwell's own solver: they are spurious, or it "
        "missed them"
        if extra
        else ""
    )


def _unrefined(answers: Sequence[Spectrum]) -> str:
    """Two refinements with the same digits in every mode: their spread says nothing about the discretisation error."""
    for coarse, fine in pairwise(answers):
        if np.array_equal(coarse.frequencies, fine.frequencies):
            return f"the answers for {coarse.elements} and {fine.elements} elements are identical: not refined"
    return ""


def _damped(answer: Spectrum) -> str:
    """The largest damping ratio of an answer, which a blade, undamped and stable, does not have; empty if it is rounding."""
    largest = max(answer.damping, key=abs, default=0.0)
    return f"damping ratio {largest:.2g}: the blade has no damping" if abs(largest) > DAMPED else ""


def known_effects(reference: Reference, i: int, target: float) -> Judgement:
    """The verdict on the change of the ``i``-th mode due to the effects that the reference lacks."""
    full, base = reference.full[i], reference.core.modes[i].estimate
    shift = base.value / full - 1.0 if full and base else None
    verdict, reason = known_difference(shift, target, reference.effects[i])
    if full and reference.likeness[i] < LEAST_MAC:
        reason = join(reason, f"the shapes with and without have a MAC of only {reference.likeness[i]:.2f}")
    return verdict, reason


def _missing_motion(reference: Reference, i: int, motions: Collection[str]) -> str:
    """Why a code cannot have a mode: the dominant motion of the mode is not among the declared ``motions``.

    The shapes themselves are not inspected: a column that is empty because of an adapter fault looks the same.
    """
    motion = reference.core.motions[i]
    return "" if motion in motions else f"this code declares that its modes have no {motion} motion"


def judged(cell: Cell, reference: Reference, i: int, mode: RefinedMode, note: str, declared_order: float = 0.0) -> Cell:
    """The cell with numbers and verdict; a pass states scatter, and an order of convergence below the declared one."""
    base, best = reference.core.modes[i].estimate, mode.estimate
    if base is None or best is None:
        return cell
    difference = best.value / base.value - 1.0
    unsure = best.uncertainty is None or base.uncertainty is None
    uncertainty = None if unsure else (best.uncertainty or 0.0) + (base.uncertainty or 0.0)
    if mode.bracketed:
        verdict, reason = bracketed(difference, uncertainty, cell.target)
    else:
        verdict, reason = judge(difference, uncertainty, cell.target)
    if verdict in AGREES:
        verdict, reason = unless_ambiguous(known_effects(reference, i, cell.target), mode.partner)
        reason = join(reason, best.note if best.order is None or best.order < declared_order else "", note)
    else:
        reason = join(reason, best.note, base.note and f"Southwell's own solver: {base.note}", note)
    return replace(
        cell,
        value=best.value,
        reference=base.value,
        difference=difference,
        uncertainty=uncertainty,
        verdict=verdict,
        reason=join(reason, mode.partner.note),
        order=best.order,
    )
