"""From a solver's study and core's reference to rows: the difference, how sure it is, and what it means."""

from dataclasses import dataclass, replace

from ...core.modes import Modes
from ...references.protocol.worker import Answer, Failure
from ..judge.pairing import LEAST_MAC, MOTIONS, Pair, pair, shares
from ..judge.results import Cell, Level, Verdict
from ..judge.uncertainty import ROUNDING, Estimate
from ..judge.verdict import Judgement, bracketed, discretised, judge, known, percent
from .reference import Reference
from .refinement import Settled, Study, settle

FAILED: dict[str, Verdict] = {
    "not installed": "not run",
    "timed out": "inconclusive",
    "refused": "fail",
    "nonsense": "fail",
    "crashed": "fail",
}
"""What a code's failure means for its cell: whoever takes part and gives no answer has failed."""


Rows = tuple[list[Cell], list[Level]]


@dataclass(frozen=True)
class Head:
    """What all cells of one column have in common; see ``results.Cell``."""

    case: str
    code: str
    version: str
    role: str
    target: float
    shares: str = ""


def empty(head: Head, omega: float, verdict: Verdict, reason: str) -> Cell:
    """The cell of a code that has no answer at a speed."""
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


def refined(head: Head, omega: float, reference: Reference, study: Study, order: int) -> Rows:
    """A code's cells at one speed, one for each mode the case compares, and every refinement's frequencies."""
    if not study.answers:
        return [_failed(head, omega, study.failure)], []
    settled = settle(study.answers, reference.core.wanted, order)
    late = f"finer: {study.failure.reason}" if study.failure else ""
    cells = []
    for i, mine in enumerate(settled):
        cell = _row(head, omega, i, reference, study.answers[-1], mine.partner)
        if still := _still(reference, i, study.answers[-1]):
            cell = replace(cell, verdict="not applicable", reason=still)
        elif mine.estimate:
            cell = _judged(cell, reference, i, mine, late)
        cells.append(cell)
    levels = [
        Level(head.case, omega, i + 1, head.code, n, f) for i, mine in enumerate(settled) for n, f in mine.history
    ]
    return cells, levels


def same(head: Head, omega: float, reference: Reference, theirs: Answer, mine: Answer) -> Rows:
    """Cells of a code that shares core's discretisation, against core's modes ``mine`` with as many elements."""
    if isinstance(theirs, Failure):
        return [_failed(head, omega, theirs)], []
    if isinstance(mine, Failure):
        return [empty(head, omega, "inconclusive", f"core with the same discretisation: {mine.reason}")], []
    wanted = reference.core.wanted
    cells, levels = [], []
    for i, base in enumerate(pair(wanted.reference, mine, wanted.indices, wanted.weight)):
        (partner,) = pair(mine, theirs, [base.mode], wanted.weight) if base.mode is not None else (base,)
        cell = _row(head, omega, i, reference, theirs, partner)
        if base.mode is not None and partner.mode is not None:
            f, f0 = float(theirs.frequencies[partner.mode]), float(mine.frequencies[base.mode])
            verdict, reason = judge(f / f0 - 1.0, ROUNDING, head.target)
            cell = replace(cell, frequency=f, reference=f0, difference=f / f0 - 1.0, uncertainty=ROUNDING)
            cell = replace(cell, verdict=verdict, reason=_join(reason, partner.note))
        cells.append(cell)
    return cells, levels


def printed(head: Head, omega: float, i: int, reference: Reference, value: Estimate, note: str) -> Cell:
    """The cell of a printed number for the ``i``-th mode the case compares."""
    settled = Settled(value, Pair(i, 1.0, note), ())
    return _judged(_row(head, omega, i, reference, None, settled.partner), reference, i, settled, "")


def excused(cell: Cell, value: Estimate, discretised: float | None, what: str) -> Cell:
    """The cell of a printed number whose author's discretisation is known and core's answer with it is ``discretised``.

    Where the number is not within the target of the converged answer but agrees with that one, the rest is known.
    """
    if cell.verdict == "pass" or discretised is None or cell.reference is None:
        return cell
    verdict, _ = judge(value.value / discretised - 1.0, value.uncertainty, cell.target)
    if verdict != "pass":
        return cell
    error = percent(discretised / cell.reference - 1.0)
    reason = (
        f"discretisation error of {what}: {error} (core so discretised, and converged); so discretised, core agrees"
    )
    return replace(cell, verdict="known difference", reason=reason)


def given(head: Head, omega: float, reference: Reference, study: Study, order: int, what: str) -> Rows:
    """Cells of one given discretisation of core's: its coarsest answer, explained by what refining it does.

    Args:
        what: names the discretisation, for the reason.
        study: core's, the discretisation in question first, then ever finer ones of its kind.
    """
    if not study.answers:
        return [_failed(head, omega, study.failure)], []
    first = replace(study, answers=study.answers[:1])
    coarse, levels = refined(head, omega, reference, first, order)
    fine, _ = refined(head, omega, reference, study, order)
    cells = []
    for i, (cell, limit) in enumerate(zip(coarse, fine, strict=True)):
        base, difference = reference.core.settled[i].estimate, cell.difference
        if difference is not None and base is not None:
            cell = replace(cell, uncertainty=base.uncertainty)
            verdict, reason = discretised(difference, base.uncertainty, head.target, limit.difference, what)
            if verdict != "fail":
                lacking, why = _known(reference, i, head.target)
                verdict, reason = verdict if lacking == "pass" else lacking, _join(reason, why)
            cell = replace(cell, verdict=verdict, reason=reason)
        cells.append(cell)
    return cells, levels


def _failed(head: Head, omega: float, failure: Failure | None) -> Cell:
    """The cell of a code that gave no answer."""
    failure = failure or Failure("nonsense", "no answer and no reason")
    return empty(head, omega, FAILED[failure.kind], failure.reason)


def _row(head: Head, omega: float, i: int, reference: Reference, finest: Modes | None, partner: Pair) -> Cell:
    """A cell with everything but numbers; as it is, that of a mode without a partner."""
    return replace(
        empty(head, omega, "fail", partner.note),
        mode=i + 1,
        family=reference.core.names[i],
        full=reference.full[i],
        elements=finest.elements if finest else None,
        seconds=finest.seconds if finest else None,
        mac=partner.mac if finest else None,
    )


def _known(reference: Reference, i: int, target: float) -> Judgement:
    """What the effects that the reference lacks do to its ``i``-th mode."""
    full, base = reference.full[i], reference.core.settled[i].estimate
    shift = base.value / full - 1.0 if full and base else None
    verdict, reason = known(shift, target, reference.effects[i])
    if full and reference.likeness[i] < LEAST_MAC:
        reason = _join(reason, f"shapes with and without are alike to MAC {reference.likeness[i]:.2f} only")
    return verdict, reason


def _still(reference: Reference, i: int, modes: Modes) -> str:
    """Why a code cannot have a mode: none of its shapes moves at all where this one moves most."""
    wanted = reference.core.wanted
    share = shares(wanted.reference, wanted.weight)[wanted.indices[i]]
    motion = int(share.argmax())
    return "" if modes.shapes[:, :, motion].any() else f"no mode of this code has any {MOTIONS[motion]} motion"


def _judged(cell: Cell, reference: Reference, i: int, mine: Settled, late: str) -> Cell:
    base, best = reference.core.settled[i].estimate, mine.estimate
    if base is None or best is None:
        return cell
    difference = best.value / base.value - 1.0
    unsure = best.uncertainty is None or base.uncertainty is None
    uncertainty = None if unsure else (best.uncertainty or 0.0) + (base.uncertainty or 0.0)
    verdict, reason = judge(difference, uncertainty, cell.target)
    if mine.bracketed:
        verdict, reason = bracketed(difference, best.uncertainty, (verdict, reason))
    if verdict == "pass":
        verdict, reason = _known(reference, i, cell.target)
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


def _join(*parts: str) -> str:
    return "; ".join(part for part in parts if part)
