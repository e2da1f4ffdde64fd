"""A solver given as a function: the only column of its blade, in a run in this thread.

For tests of a user's solver, which needs neither an adapter nor a separate process.
"""

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...core.modes import STATIONS, Modes
from ...references.protocol.description import Description
from ...references.protocol.process import Failure, Limits
from ...references.protocol.worker import Run as CodeRun
from ..input.schema import Case, Compare, Variant
from ..judge.cells import Head, Rows, joined
from ..judge.refined import refined
from ..judge.results import Cell, Run
from ..judge.spectrum import Answer, of_blade
from ..judge.verdict import judge, percent, unsigned
from ..plan.blade import BladeSubject
from ..plan.column import Column, ColumnError, declined
from ..plan.request import Execution, Request
from ..plan.subject import PropertyChecks
from ..plan.user_results import UserResults
from ..solve import published_tables
from ..solve.reference import references, relevant_effects
from ..solve.refinement import Refining
from ..solve.works import References, refinements
from .fault_effects import SAME_MODE, FaultEffect
from .pipeline import verify


@dataclass(frozen=True)
class UserSolver:
    """A solver to be judged.

    Attributes:
        solve: ``(blade, omega, elements, count)`` or ``(blade, omega)`` → frequencies and shapes. ``omega`` and the (m,)
            frequencies in rad/s; shapes (m, 21, 4) at ``core.modes.STATIONS``, as in ``Modes``, or (m, 21, 3) without the
            rotation about the blade's axis; any scale, real or complex, in any order of frequency.
        name: name of its column.
        lacks: effects it omits, see ``Effects``: core is compared without them.
        levels: refinements, coarse to fine; ignored for a function without ``elements``.
        order: order of convergence of its frequencies.
        unsupported: returns why it cannot solve a blade; None if it can.
        cases: names of cases, or ``case/blade``; all by default.
        target: largest relative difference; by default that of each case.
        known: known differences: pattern of a test's name → cause, and the largest difference it explains (relative).
    """

    solve: Callable[..., tuple[Any, Any]]
    name: str = "user-solver"
    lacks: tuple[str, ...] = ()
    levels: tuple[int, ...] = (10, 20, 40)
    order: int = 4
    unsupported: Callable[[Blade], str | None] = lambda blade: None
    cases: tuple[str, ...] = ()
    target: float | None = None
    known: dict[str, tuple[str, float]] = field(default_factory=dict)

    @property
    def effects(self) -> Effects:
        """The effects it keeps."""
        return replace(ALL_EFFECTS, **dict.fromkeys(self.lacks, False))

    @property
    def refines(self) -> bool:
        """Whether its function takes ``elements`` and ``count``."""
        return len(inspect.signature(self.solve).parameters) != 2


@dataclass(frozen=True)
class SolverSubject(BladeSubject):
    """A blade with one column, that of a solver given as a function; see ``Subject``."""

    solver: UserSolver

    def columns(
        self, codes: Sequence[Description], limits: Limits, user_results: Sequence[UserResults]
    ) -> list[Column]:
        """See ``Subject``."""
        return [_column(self.solver, self.variant, self.case.text.compare)]

    def property_checks(self, codes: Sequence[Description], limits: Limits) -> PropertyChecks:
        """A function is not asked which model it solves."""
        return PropertyChecks()

    def error_budget(self) -> None:
        """See ``Subject``."""
        return None


def run(solver: UserSolver, case: Case, variant: Variant) -> Run:
    """The run of a solver for one blade of a case at all its speeds: against core and against printed numbers.

    Raises:
        ColumnError: the solver raised an exception, which is its cause.
    """
    subject = SolverSubject(case, variant, solver)
    return verify(Request((subject,), codes=(), faults="none", execution=Execution(workers=0)))


def _column(solver: UserSolver, variant: Variant, compare: Compare) -> Column:
    head = Head(variant.name, solver.name, "", "code", solver.target or compare.target, "nothing")
    effects = relevant_effects(solver.effects, variant.blade)
    if why := solver.unsupported(variant.blade):
        return declined(head, effects, why)
    return Column(solver.name, effects, head, partial(_rows, head, solver, variant, compare), bundled=False)


def _rows(head: Head, solver: UserSolver, variant: Variant, compare: Compare, core: References) -> Rows:
    """Cells of a solver at the speeds of core's references, with those against the printed numbers that core passes."""
    finest = 4 * solver.levels[-1]
    refining = Refining(solver.levels, solver.order, finest) if solver.refines else Refining((1,), 0, 1, bracket=True)
    answers = refinements(partial(_answers, solver, variant.blade), refining, core)
    cells, levels = joined(refined(head, omega, r, s, refining.order, refining.bracket) for omega, r, s in answers)
    return cells + _printed(cells, solver, variant, compare, core), levels


def _answers(solver: UserSolver, blade: Blade, runs: Sequence[CodeRun]) -> list[Answer]:
    """Answers of the solver; an invalid return value is a failure.

    Raises:
        ColumnError: the solver raised an exception, which its user must see.
    """
    out: list[Answer] = []
    for omega, elements, count in runs:
        try:
            answer = solver.solve(blade, omega, elements, count) if solver.refines else solver.solve(blade, omega)
        except Exception as error:
            raise ColumnError(solver.name) from error
        try:
            out.append(of_blade(_modes(omega, elements, *answer, exact=not solver.refines)))
        except (TypeError, ValueError) as error:
            out.append(Failure("nonsense", f"not (frequencies, shapes): {error}"))
    return out


def _modes(omega: float, elements: int, frequencies: Any, shapes: Any, exact: bool) -> Modes:
    values, shape = np.asarray(frequencies, dtype=float), np.asarray(shapes).astype(np.complex128)
    if shape.ndim == 3 and shape.shape[1:] == (len(STATIONS), 3):
        shape = np.pad(shape, ((0, 0), (0, 0), (0, 1)))
    if shape.shape != (len(values), len(STATIONS), 4):
        raise ValueError(f"shapes: {shape.shape}, expected {(len(values), len(STATIONS), 4)}, or 3 instead of 4")
    if not shape.any(axis=(1, 2)).all() or not len(values):
        raise ValueError(
            "no modes, or a mode whose shape is zero"
        )  # neither could be distinguished from an unsupported blade
    order = np.argsort(values)
    uncertainty = np.zeros(len(values)) if exact else np.zeros(0)
    return Modes(omega, values[order], shape[order], elements, uncertainty=uncertainty)


def _printed(
    cells: Sequence[Cell], solver: UserSolver, variant: Variant, compare: Compare, core: References
) -> list[Cell]:
    """The solver's frequencies against the printed numbers that core passes with the table's and with the solver's effects."""
    speeds = [omega for omega, _ in core]
    cores = {relevant_effects(solver.effects, variant.blade): core}
    out = []
    for table in published_tables.about(variant.blade, compare.tables):
        effects = relevant_effects(table.series.effects, variant.blade)
        if effects not in cores:
            answers = zip(speeds, references(variant.blade, speeds, compare, [effects])[effects], strict=True)
            cores[effects] = [(omega, r) for omega, r in answers if not isinstance(r, Failure)]
        head = Head(variant.name, table.name, "", "table", compare.target, "nothing")
        rows, _ = published_tables.rows(head, table, variant.blade, None, cores[effects])
        agreed = {(c.omega, c.mode): c for c in rows if c.verdict == "pass"}
        for cell in cells:
            number = agreed.get((cell.omega, cell.mode))
            if number and cell.family == number.family and _agrees(cell.reference, number):
                out.append(_compared(cell, number, number.value or 0.0))
    return out


def _agrees(reference: float | None, number: Cell) -> bool:
    """Whether core without the effects that the solver lacks also passes a printed number; otherwise it is not used."""
    if reference is None or not number.value:
        return False
    return judge(reference / number.value - 1.0, number.uncertainty, number.target)[0] == "pass"


def _compared(cell: Cell, number: Cell, reference: float) -> Cell:
    """One frequency against one printed number; a known difference of the frequency remains known."""
    difference = (cell.value or 0.0) / reference - 1.0
    uncertainty = None if cell.uncertainty is None else cell.uncertainty + (number.uncertainty or 0.0)
    verdict, reason = judge(difference, uncertainty, max(cell.target, number.target))
    if verdict != "pass" and cell.verdict == "known difference":
        verdict, reason = cell.verdict, cell.reason
    name = f"{cell.code}, {number.code}"
    return replace(
        cell, code=name, role="table", reference=reference, difference=difference, uncertainty=uncertainty,
        target=max(cell.target, number.target), verdict=verdict, reason=reason,
    )  # fmt: skip


def alike(cell: Cell, effects: Sequence[FaultEffect]) -> str:
    """The fault in core that reproduces a wrong frequency; empty if none does.

    It must explain at least nine tenths of the difference.
    """
    if cell.value is None or cell.reference is None or cell.difference is None:
        return ""
    candidates: list[tuple[float, str]] = []
    for fault_effect in effects:
        for m in fault_effect.modes:
            same_mode = m.name.split()[0] == cell.family and abs(m.correct / cell.reference - 1.0) < SAME_MODE
            if fault_effect.omega == cell.omega and same_mode and m.change is not None:
                remainder = cell.value / (cell.reference * (1.0 + m.change)) - 1.0
                if abs(remainder) <= 0.1 * abs(cell.difference):
                    size = f"({percent(m.change)}; {unsigned(remainder)} from it)"
                    similarity = f"agrees with Southwell's own solver with this fault: {fault_effect.fault} {size}"
                    candidates.append((abs(remainder), similarity))
    return min(candidates)[1] if candidates else ""
