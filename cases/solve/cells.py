"""Rows from a solver's refinements and core's reference: the difference, its uncertainty and the verdict."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from ...core.modes import Modes
from ...references.protocol.process import Failure
from ...references.protocol.worker import Answer
from ..judge.measured import Validation, explained
from ..judge.pairing import LEAST_MAC, MOTIONS, Array, Pair, pair
from ..judge.results import Cell, Level, Verdict
from ..judge.uncertainty import ROUNDING, WARY, Estimate
from ..judge.verdict import AGREES, Judgement, bracketed, discretised, judge, known
from .reference import Reference
from .refinement import RefinedMode, Refinements, follow

FAILED: dict[str, Verdict] = {
    "not installed": "not run",
    "unsupported": "not applicable",
    "timed out": "inconclusive",
    "refused": "fail",
    "nonsense": "fail",
    "crashed": "fail",
    "unknown": "fail",
    "internal": "fail",
    "no reference": "fail",
}
"""Verdict of a cell by the kind of failure: a code that takes part and gives no answer has failed."""

DAMPED = 1e-6
"""Largest damping ratio of a blade's mode that counts as rounding."""

Rows = tuple[list[Cell], list[Level]]


@dataclass(frozen=True)
class Head:
    """Fields common to all cells of one column; see ``results.Cell``."""

    case: str
    code: str
    version: str
    role: str
    target: float
    shares: str = ""
    motions: tuple[str, ...] = MOTIONS
    """Motions that the code declares its shapes contain."""


def empty(head: Head, omega: float, verdict: Verdict, reason: str) -> Cell:
    """The cell of a code without an answer at one speed."""
    return Cell(
        case=head.case,
        omega=omega,
        mode=0,
        family="",
        code=head.code,
        version=head.version,
        role=head.role,
        frequency=None,
        reference=None,
        difference=None,
        uncertainty=None,
        target=head.target,
        verdict=verdict,
        reason=reason,
        shares=head.shares,
    )


def refined(
    head: Head, omega: float, reference: Reference, refinements: Refinements, order: int, bracket: bool = False
) -> Rows:
    """Cells of a code at one speed, one for each compared mode, and the frequencies of every refinement."""
    if not refinements.answers or (refinements.failure and refinements.failure.kind == "nonsense"):
        return [failed(head, omega, refinements.failure)], []
    refined_modes = follow(refinements.answers, reference.core.wanted, order, bracket)
    late = f"finer: {refinements.failure.reason}" if refinements.failure else ""
    doubt = (
        _extra(reference, refinements.answers[-1], refined_modes)
        or _damped(refinements.answers[-1])
        or (_unrefined(refinements.answers) if order and not bracket else "")
    )
    cells = []
    for i, mine in enumerate(refined_modes):
        cell = _row(head, omega, i, reference, refinements.answers[-1], mine.partner)
        if still := _still(reference, i, head.motions):
            cell = replace(cell, verdict="not applicable", reason=still)
        elif mine.estimate:
            cell = _judged(cell, reference, i, mine, late, order)
        if doubt and cell.verdict in (*AGREES, "known difference"):
            cell = replace(cell, verdict="inconclusive", reason=_join(doubt, cell.reason))
        cells.append(cell)
    levels = [
        Level(head.case, omega, i + 1, head.code, n, f) for i, mine in enumerate(refined_modes) for n, f in mine.history
    ]
    return cells, levels


def _extra(reference: Reference, answer: Modes, refined_modes: Sequence[RefinedMode]) -> str:
    """The modes of an answer below the highest compared one that are none of core's; empty if there are none."""
    wanted = reference.core.wanted
    every = range(len(wanted.reference.frequencies))
    paired = {one.mode for one in pair(wanted.reference, answer, every, wanted.weight)}
    top = max((answer.frequencies[m.partner.mode] for m in refined_modes if m.partner.mode is not None), default=0.0)
    extra = [f"{f:.6g}" for k, f in enumerate(answer.frequencies) if k not in paired and f < top]
    return (
        f"modes at {', '.join(extra)} rad/s do not match any core mode: spurious, or missed by core?" if extra else ""
    )


def _unrefined(answers: Sequence[Modes]) -> str:
    """Two refinements with the same digits in every mode: their spread says nothing about the discretisation error."""
    for coarse, fine in pairwise(answers):
        if np.array_equal(coarse.frequencies, fine.frequencies):
            return f"the answers for {coarse.elements} and {fine.elements} elements are identical: not refined"
    return ""


def _damped(answer: Modes) -> str:
    """The largest damping ratio of an answer, which a blade, undamped and stable, does not have; empty if it is rounding."""
    largest = max(answer.damping, key=abs, default=0.0)
    return f"damping ratio {largest:.2g}: the blade has no damping" if abs(largest) > DAMPED else ""


def rounding(mine: Answer, again: Sequence[Answer]) -> Array:
    """Relative uncertainty (m,) of core's frequencies ``mine`` due to rounding.

    It is estimated from core's answers ``again`` to the same equations scaled by common factors, which differ only by
    rounding. The largest change of any mode is used for all modes, as rounding in the steady state affects them
    together. The uncertainty that core reports is used if it is larger.
    """
    found = [other for other in (mine, *again) if not isinstance(other, Failure)]
    if isinstance(mine, Failure) or len(found) <= len(again) or len({len(m.frequencies) for m in found}) > 1:
        return np.zeros(0)
    change = max(float(np.abs(other.frequencies / mine.frequencies - 1.0).max()) for other in found)
    rounding_of_core = np.full(len(mine.frequencies), max(ROUNDING, WARY * change))
    return np.maximum(rounding_of_core, mine.rounding) if len(mine.rounding) else rounding_of_core


def same(
    head: Head, omega: float, reference: Reference, theirs: Answer, mine: Answer, rounding_of_core: Array | None = None
) -> Rows:
    """Cells of a code that shares core's discretisation, against core's modes ``mine`` with as many elements.

    ``rounding_of_core``: (m,) relative uncertainty of core's frequencies due to rounding. The other code's equations
    are equally sensitive, so it is assumed to have the same uncertainty, or the one that it reports.
    """
    if isinstance(theirs, Failure):
        return [failed(head, omega, theirs)], []
    if isinstance(mine, Failure):
        return [empty(head, omega, "inconclusive", f"core with the same discretisation: {mine.reason}")], []
    wanted = reference.core.wanted
    cells, levels = [], []
    for i, base in enumerate(pair(wanted.reference, mine, wanted.indices, wanted.weight)):
        (partner,) = pair(mine, theirs, [base.mode], wanted.weight) if base.mode is not None else (base,)
        cell = _row(head, omega, i, reference, theirs, partner)
        if base.mode is not None and partner.mode is not None:
            f, f0 = float(theirs.frequencies[partner.mode]), float(mine.frequencies[base.mode])
            core = (
                float(rounding_of_core[base.mode])
                if rounding_of_core is not None and len(rounding_of_core)
                else ROUNDING
            )
            own = float(theirs.rounding[partner.mode]) if len(theirs.rounding) else core
            sure = core + max(own, core)
            verdict, reason = _unless_ambiguous(judge(f / f0 - 1.0, sure, head.target), partner)
            cell = replace(cell, frequency=f, reference=f0, difference=f / f0 - 1.0, uncertainty=sure)
            cell = replace(cell, verdict=verdict, reason=_join(reason, partner.note))
        cells.append(cell)
    return cells, levels


def printed(head: Head, omega: float, i: int, reference: Reference, value: Estimate, note: str) -> Cell:
    """The cell of a printed number for the ``i``-th mode that the case compares."""
    refined_modes = RefinedMode(value, Pair(i, 1.0, note), ())
    return _judged(_row(head, omega, i, reference, None, refined_modes.partner), reference, i, refined_modes, "")


@dataclass(frozen=True)
class Datum:
    """A measured frequency.

    Attributes:
        value: D, rad/s.
        data, inputs: relative standard uncertainties of the datum, and of the simulation due to its inputs.
    """

    value: float
    data: float
    inputs: float


def measured(head: Head, omega: float, i: int, reference: Reference, datum: Datum) -> Cell:
    """The cell of a measured frequency of the ``i``-th mode that the case compares; never evidence.

    The numerical uncertainty of core's answer is a bound and is used as the standard uncertainty. If it is unknown, no
    statement is made.
    """
    cell = replace(
        empty(head, omega, "measured", ""),
        frequency=datum.value,
        **_mode(reference, i),
    )
    base = reference.core.modes[i].estimate
    if base is None:
        return replace(cell, verdict="not applicable", reason="core has no frequency to compare with")
    found = Validation(
        base.value,
        datum.value,
        (base.uncertainty or 0.0) * base.value,
        datum.inputs * base.value,
        datum.data * datum.value,
    )
    difference, uncertainty = found.relative
    cell = replace(cell, reference=base.value, difference=difference)
    if base.uncertainty is None:
        return replace(cell, reason=f"not judged: u_num is unknown ({base.note})")
    return replace(cell, uncertainty=uncertainty, reason=explained(found))


@dataclass(frozen=True)
class Coarse:
    """Core's answer for one mode with an author's discretisation, and the limit of its refinements; both rad/s."""

    frequency: float
    limit: float


def excused(cell: Cell, coarse: Coarse | None, what: str) -> Cell:
    """The cell of a printed number whose author's discretisation, named ``what``, is known.

    If the number is not within the target of the converged answer, its difference is known if core with that
    discretisation agrees with it and the refinements of that discretisation lead to the converged answer.
    """
    if cell.verdict in AGREES or not coarse or not cell.frequency or not cell.reference or cell.difference is None:
        return cell
    remainder, limit, size = (
        value - 1.0
        for value in (
            cell.frequency / coarse.frequency,
            coarse.limit / cell.reference,
            coarse.frequency / cell.reference,
        )
    )
    verdict, reason = discretised(cell.difference, cell.uncertainty, cell.target, remainder, limit, what, size)
    if verdict == cell.verdict and verdict != "fail":
        return cell
    return replace(cell, verdict=verdict, reason=reason)


def given(head: Head, omega: float, reference: Reference, refinements: Refinements, order: int, what: str) -> Rows:
    """Cells of core with a given discretisation: its coarsest answer, explained by its refinements.

    Args:
        what: name of the discretisation, for the reason.
        refinements: core's answers: the given discretisation first, then finer ones of the same kind.
    """
    if not refinements.answers:
        return [failed(head, omega, refinements.failure)], []
    first = replace(refinements, answers=refinements.answers[:1])
    coarse, levels = refined(head, omega, reference, first, order)
    fine, _ = refined(head, omega, reference, refinements, order)
    cells = []
    for i, (cell, limit) in enumerate(zip(coarse, fine, strict=True)):
        base, difference = reference.core.modes[i].estimate, cell.difference
        if difference is not None and base is not None:
            cell = replace(cell, uncertainty=base.uncertainty)
            verdict, reason = discretised(difference, base.uncertainty, head.target, 0.0, limit.difference, what)
            if verdict != "fail":
                lacking, why = _known(reference, i, head.target)
                verdict, reason = verdict if lacking in AGREES else lacking, _join(reason, why)
            cell = replace(cell, verdict=verdict, reason=reason)
        cells.append(cell)
    return cells, levels


def failed(head: Head, omega: float, failure: Failure | None) -> Cell:
    """The cell of a code that failed."""
    failure = failure or Failure("nonsense", "no answer and no reason")
    return empty(head, omega, FAILED[failure.kind], failure.reason)


def _row(head: Head, omega: float, i: int, reference: Reference, finest: Modes | None, partner: Pair) -> Cell:
    """A cell without numbers, valid as the cell of a mode without a partner."""
    return replace(
        empty(head, omega, "fail", partner.note),
        **_mode(reference, i),
        elements=finest.elements if finest else None,
        mac=partner.mac if finest else None,
    )


def _mode(reference: Reference, i: int) -> dict[str, Any]:
    """Fields of a cell that follow from core's ``i``-th compared mode."""
    family, _, ordinal = reference.core.names[i].rpartition(" ")
    return {"mode": i + 1, "family": family, "ordinal": int(ordinal), "full": reference.full[i]}


def _known(reference: Reference, i: int, target: float) -> Judgement:
    """The verdict on the change of the ``i``-th mode due to the effects that the reference lacks."""
    full, base = reference.full[i], reference.core.modes[i].estimate
    shift = base.value / full - 1.0 if full and base else None
    verdict, reason = known(shift, target, reference.effects[i])
    if full and reference.likeness[i] < LEAST_MAC:
        reason = _join(reason, f"the shapes with and without have a MAC of only {reference.likeness[i]:.2f}")
    return verdict, reason


def _still(reference: Reference, i: int, motions: Collection[str]) -> str:
    """Why a code cannot have a mode: the dominant motion of the mode is not among the declared ``motions``.

    The shapes themselves are not inspected: a column that is empty because of an adapter fault looks the same.
    """
    motion = reference.core.motions[i]
    return "" if motion in motions else f"this code declares that its modes have no {motion} motion"


def _judged(
    cell: Cell, reference: Reference, i: int, mine: RefinedMode, late: str, declared_order: float = 0.0
) -> Cell:
    """The cell with numbers and verdict; a pass states an order of convergence below the declared one."""
    base, best = reference.core.modes[i].estimate, mine.estimate
    if base is None or best is None:
        return cell
    difference = best.value / base.value - 1.0
    unsure = best.uncertainty is None or base.uncertainty is None
    uncertainty = None if unsure else (best.uncertainty or 0.0) + (base.uncertainty or 0.0)
    if mine.bracketed:
        verdict, reason = bracketed(difference, uncertainty, cell.target)
    else:
        verdict, reason = judge(difference, uncertainty, cell.target)
    if verdict in AGREES:
        verdict, reason = _unless_ambiguous(_known(reference, i, cell.target), mine.partner)
        reason = _join(reason, best.note if best.order is not None and best.order < declared_order else "", late)
    else:
        reason = _join(reason, best.note, base.note and f"core: {base.note}", late)
    return replace(
        cell,
        frequency=best.value,
        reference=base.value,
        difference=difference,
        uncertainty=uncertainty,
        verdict=verdict,
        reason=_join(reason, mine.partner.note),
        order=best.order,
    )


def _unless_ambiguous(judged: Judgement, partner: Pair) -> Judgement:
    """No agreement if the code has another mode of nearly the same shape at a different frequency."""
    return ("inconclusive", "") if partner.ambiguous and judged[0] in (*AGREES, "known difference") else judged


def _join(*parts: str) -> str:
    return "; ".join(part for part in parts if part)
