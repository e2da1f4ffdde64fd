"""Results without an adapter as columns of the matrix: results of a program are judged, measured ones are not.

A measured frequency D is compared with core's frequency S: the comparison error is E = S − D, and its uncertainty u_val
follows from the numerical solution, the inputs and the data (ASME V&V 20-2009). Results are rarely given at the speeds of a
case, so core is also solved at theirs.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from math import inf
from pathlib import Path

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS
from ...core.participation import MIXED
from ...references.protocol.process import Failure
from ..input.schema import Compare, Variant
from ..judge.cells import Head, Rows, empty, join
from ..judge.measured import Datum, measured
from ..judge.printed import printed
from ..judge.reference import Reference
from ..judge.results import Cell
from ..judge.uncertainty import Estimate
from ..solve.copies import GIVEN_BACK, given_back
from ..solve.reference import references
from ..solve.works import References
from .column import Column
from .user_results import UserFrequency, UserResults, at


def columns(variant: Variant, user_results: Sequence[UserResults], compare: Compare) -> list[Column]:
    """A column for each file with results for a blade."""
    out = []
    for results in user_results:
        rows = [row for row in results.rows if row.blade in ("", variant.name)]
        if not rows:
            continue
        file = Path(results.path).name
        if results.measured:
            head = Head(variant.name, results.name, f"measured, in {file}", "measured", compare.target)
            work = partial(_rows, _of_a_rig, head, variant.blade, compare, rows)
        else:
            head = Head(variant.name, results.name, f"from {file}", "code", compare.target, "nothing")
            work = partial(_rows_of_a_program, head, variant.blade, compare, rows)
        out.append(Column(results.name, ALL_EFFECTS, head, work, due="somewhere"))
    return out


Judge = Callable[[Head, float, int, Reference, UserFrequency], Cell]
"""The cell of a row whose mode is compared: head, speed in rad/s, index of the mode, reference, row."""


def _rows(
    judge: Judge, head: Head, blade: Blade, compare: Compare, frequencies: Sequence[UserFrequency], core: References
) -> Rows:
    """A cell for every frequency, at the case's speed if the row's speed rounds to it, else at the row's."""
    cells = []
    for row, omega, reference in _at_their_speeds(blade, compare, frequencies, core):
        if isinstance(reference, Failure):
            cells.append(
                empty(head, omega, "not applicable", f"line {row.line}: Southwell's own solver: {reference.reason}")
            )
        elif (k := _place(row, reference)) is None:
            cells.append(_without_partner(head, omega, row, reference))
        else:
            cells.append(judge(head, omega, k, reference, row))
    return cells, []


def _rows_of_a_program(
    head: Head, blade: Blade, compare: Compare, frequencies: Sequence[UserFrequency], core: References
) -> Rows:
    """The cells of a program; Southwell's own output, given back, is no program that shares nothing with it."""
    cells, levels = _rows(_of_a_program, head, blade, compare, frequencies, core)
    if given_back(blade, [(row.omega, row.value.value, row.value.uncertainty or 0.0) for row in frequencies]):
        why = f"equals what southwell modes prints to {GIVEN_BACK:.0e}: Southwell's own output, not independent"
        cells = [replace(cell, shares="everything", reason=join(why, cell.reason)) for cell in cells]
    return cells, levels


def _of_a_program(head: Head, omega: float, k: int, reference: Reference, row: UserFrequency) -> Cell:
    estimate = Estimate(row.value.value, _uncertainty(row, omega))
    return _unless_misnamed(printed(head, omega, k, reference, estimate, ""), row, k, reference)


def _of_a_rig(head: Head, omega: float, k: int, reference: Reference, row: UserFrequency) -> Cell:
    return measured(head, omega, k, reference, Datum(row.value.value, _uncertainty(row, omega), row.inputs))


def _uncertainty(row: UserFrequency, omega: float) -> float:
    """Relative uncertainty of a row's frequency, with the error due to its speed."""
    return (row.value.uncertainty or 0.0) + _off(row, omega)


def _at_their_speeds(
    blade: Blade, compare: Compare, frequencies: Sequence[UserFrequency], core: References
) -> Iterator[tuple[UserFrequency, float, Reference | Failure]]:
    """Each row with its speed and core's solution there; speeds that the case does not have are solved, each once."""
    solved: dict[float, Reference | Failure] = dict(core)
    for row in frequencies:
        omega = next((omega for omega, _ in core if at(row, omega)), row.omega)
        if omega not in solved:
            (solved[omega],) = references(blade, [omega], compare, {ALL_EFFECTS})[ALL_EFFECTS]
        yield row, omega, solved[omega]


def _unless_misnamed(cell: Cell, row: UserFrequency, k: int, reference: Reference) -> Cell:
    """The cell, but inconclusive if its frequency is that of another mode and core has a mixed mode up to there.

    A program that names such a mode by its largest motion counts it in a family, and core does not.
    """
    f, core = cell.value, reference.core
    off = [abs(f / m.estimate.value - 1.0) if m.estimate and f else inf for m in core.modes]
    best = off.index(min(off))
    mixed = any(name.startswith(MIXED) for name in core.spectrum.labels[: core.indices[max(k, best)] + 1])
    if cell.verdict != "fail" or not row.family or off[best] > cell.target or not mixed:
        return cell
    reason = (
        f"line {row.line}: the frequency is not that of {core.names[k]} but of {core.names[best]}; Southwell's own solver has "
        "a mixed mode, whose name is a convention: give the mode's number among all modes"
    )
    return replace(cell, verdict="inconclusive", reason=reason)


def _off(row: UserFrequency, omega: float) -> float:
    """Relative error of a frequency due to the difference of the row's speed from ``omega``.

    By f² = f₀² + K Ω² the relative change is at most that of the speed (Southwell 1921; K not negative).
    """
    return abs(row.omega / omega - 1.0) if omega else 0.0


def _without_partner(head: Head, omega: float, row: UserFrequency, reference: Reference) -> Cell:
    """The cell of a row for a mode that the case does not compare."""
    label, compared = f"{row.family} {row.mode}".strip(), ", ".join(reference.core.names)
    reason = f"line {row.line}: the case does not compare mode {label} at this speed; it compares {compared}"
    return empty(head, omega, "not applicable", reason)


def _place(row: UserFrequency, reference: Reference) -> int | None:
    """Index of a row's mode among the modes that the case compares; None if it is not compared."""
    labels: tuple[object, ...] = reference.core.names if row.family else reference.core.indices
    label = f"{row.family} {row.mode}" if row.family else row.mode - 1
    return labels.index(label) if label in labels else None
