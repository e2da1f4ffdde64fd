"""A solver given as a function: its cells, judged in this process like those of any code.

For tests of a user's solver, which needs neither an adapter nor a separate process.
"""

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...core.modes import STATIONS, Modes
from ...references.protocol.process import Failure
from ...references.protocol.worker import Run as Asked
from ..input.schema import Compare, Variant
from ..judge.cells import Head, Rows, empty, without_reference
from ..judge.refined import refined
from ..judge.results import Cell
from ..judge.spectrum import Answer, of_blade
from ..judge.verdict import judge, percent, unsigned
from ..solve import published_tables
from ..solve.reference import References, felt, references
from ..solve.refinement import Refining, solve
from .controls import SAME_MODE, Wrong


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


def rows(solver: UserSolver, variant: Variant, compare: Compare) -> Rows:
    """Cells of a solver for one blade at all speeds of the case: against core and against printed numbers.

    Only printed numbers that core agrees with are used, with the effects of the table and with those of the solver.
    """
    target = solver.target or compare.target
    head = Head(variant.name, solver.name, "", "code", target, "nothing")
    speeds = variant.speeds.tolist()
    if why := solver.unsupported(variant.blade):
        return [empty(head, omega, "not applicable", why) for omega in speeds], []
    effects = felt(solver.effects, variant.blade)
    solved = references(variant.blade, speeds, compare, [effects])
    pairs = list(zip(speeds, solved[effects], strict=True))
    without = [without_reference(head, omega, r) for omega, r in pairs if isinstance(r, Failure)]
    core = [(omega, r) for omega, r in pairs if not isinstance(r, Failure)]
    if not core:
        return without, []
    finest = 4 * solver.levels[-1]
    refining = Refining(solver.levels, solver.order, finest) if solver.refines else Refining((1,), 0, 1, bracket=True)
    count = max(r.core.count for _, r in core)
    by_speed = {omega: r.core.compared for omega, r in core}
    refinements = solve(
        lambda runs: _answers(solver, variant.blade, runs), list(by_speed), refining, count, lambda w, _: by_speed[w]
    )
    cells, levels = without, []
    for (omega, reference), refinements_at in zip(core, refinements, strict=True):
        new = refined(head, omega, reference, refinements_at, refining.order, refining.bracket)
        cells += new[0]
        levels += new[1]
    return cells + _printed(cells, variant, compare, solved), levels


def _answers(solver: UserSolver, blade: Blade, runs: Sequence[Asked]) -> list[Answer]:
    """Answers of the solver; an invalid return value becomes a failure, an exception propagates to the user."""
    out: list[Answer] = []
    for omega, elements, count in runs:
        answer = solver.solve(blade, omega, elements, count) if solver.refines else solver.solve(blade, omega)
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
    sure = np.zeros(len(values)) if exact else np.zeros(0)
    return Modes(omega, values[order], shape[order], elements, uncertainty=sure)


def _printed(cells: Sequence[Cell], variant: Variant, compare: Compare, solved: References) -> list[Cell]:
    """The solver's frequencies against the printed numbers that core, with the effects of the table, passes."""
    out = []
    for table in published_tables.about(variant.blade, compare.tables):
        effects = felt(table.series.effects, variant.blade)
        if effects not in solved:
            solved |= references(variant.blade, variant.speeds.tolist(), compare, [effects])
        core = [
            (w, r) for w, r in zip(variant.speeds.tolist(), solved[effects], strict=True) if not isinstance(r, Failure)
        ]
        head = Head(variant.name, table.name, "", "table", compare.target, "nothing")
        printed, _ = published_tables.rows(head, table, variant.blade, None, core)
        agreed = {(c.omega, c.mode): c for c in printed if c.verdict == "pass"}
        for ours in cells:
            number = agreed.get((ours.omega, ours.mode))
            if number and ours.family == number.family and _agrees(ours.reference, number):
                out.append(_compared(ours, number, number.value or 0.0))
    return out


def _agrees(reference: float | None, number: Cell) -> bool:
    """Whether core without the effects that the solver lacks also passes a printed number; otherwise it is not used."""
    if reference is None or not number.value:
        return False
    return judge(reference / number.value - 1.0, number.uncertainty, number.target)[0] == "pass"


def _compared(ours: Cell, number: Cell, printed: float) -> Cell:
    """One frequency against one printed number; a known difference of the frequency remains known."""
    difference = (ours.value or 0.0) / printed - 1.0
    unsure = None if ours.uncertainty is None else ours.uncertainty + (number.uncertainty or 0.0)
    verdict, reason = judge(difference, unsure, max(ours.target, number.target))
    if verdict != "pass" and ours.verdict == "known difference":
        verdict, reason = ours.verdict, ours.reason
    name = f"{ours.code}, {number.code}"
    return replace(
        ours, code=name, role="table", reference=printed, difference=difference, uncertainty=unsure,
        target=max(ours.target, number.target), verdict=verdict, reason=reason,
    )  # fmt: skip


def alike(cell: Cell, wrongs: Sequence[Wrong]) -> str:
    """The fault in core that reproduces a wrong frequency; empty if none does.

    It must explain at least nine tenths of the difference.
    """
    if cell.value is None or cell.reference is None or cell.difference is None:
        return ""
    candidates: list[tuple[float, str]] = []
    for wrong in wrongs:
        for m in wrong.modes:
            same = m.name.split()[0] == cell.family and abs(m.right / cell.reference - 1.0) < SAME_MODE
            if wrong.omega == cell.omega and same and m.change is not None:
                rest = cell.value / (cell.reference * (1.0 + m.change)) - 1.0
                if abs(rest) <= 0.1 * abs(cell.difference):
                    likeness = f"as core with this fault: {wrong.fault} ({percent(m.change)}; {unsigned(rest)} from it)"
                    candidates.append((abs(rest), likeness))
    return min(candidates)[1] if candidates else ""
