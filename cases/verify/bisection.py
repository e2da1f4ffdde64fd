"""The first release of a code that moves a frequency or loses an answer, by bisection on one blade at one speed.

The releases between the two of a run are halved until two neighbours remain; each step installs one release and asks it
the one question. This assumes that the frequency does not move back and forth. A release that cannot be installed is
skipped and named. If only one of the two releases answers, the first release that does, or does not, is sought;
otherwise a release that does not answer is skipped, too.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from packaging.version import Version

from ...core.effects import Effects
from ...references.protocol import overlay
from ...references.protocol.description import Description, describe
from ...references.protocol.overlay import ReleaseError
from ...references.protocol.process import Limits
from ...references.protocol.registry import at_release, release_of
from ..input.schema import Case
from ..judge.releases import Bisection, change, comparisons
from ..judge.results import Cell, Run
from . import mechanism_columns
from .columns import Column, columns
from .matrix import dated
from .mechanism_case import MechanismCase
from .reference import references

Report = Callable[[str], None]


@dataclass(frozen=True)
class Question:
    """The question of a bisection: a case with one blade and one speed, a code with its limits, and a mode."""

    case: Case | MechanismCase
    code: Description
    limits: Limits
    mode: int

    @property
    def name(self) -> str:
        """Name of the blade, as in ``results.Cell``."""
        return self.case.variants[0].name

    @property
    def omega(self) -> float:
        """Rotor speed, rad/s."""
        return float(self.case.variants[0].speeds[0])


def bisections(
    run: Run,
    cases: Sequence[Case | MechanismCase],
    codes: Sequence[Description],
    executor: Executor,
    limits: Callable[[Case | MechanismCase], Limits],
    report: Report,
) -> tuple[Bisection, ...]:
    """One bisection for each column of another release that moves a frequency, or gives or lacks an answer.

    Each uses one question: that of the largest change, or else one with an answer missing.

    Args:
        run: the results, with the columns of other releases.
        cases, codes: those of the run.
        executor: where questions are answered.
        limits: of one solution, by case.
        report: called with one line before and after each release that is tried.
    """
    known = {code.name: code for code in codes}
    out = []
    for found in comparisons(run):
        code, differing = known[found.code], found.moved or found.lost + found.gained
        if code.version and differing:  # without an installed release there is nothing to bisect
            one = max(differing, key=lambda change: abs(change.relative or 0.0))
            case = _narrowed(cases, one.cell)
            question = Question(case, code, limits(case), one.cell.mode)
            release = release_of(known[found.other].asked)  # its code may not say, if it cannot be imported
            ends = [End(code.version, one.before, _why(run, found.code, one.cell))]
            ends.append(End(release, one.after, _why(run, found.other, one.cell)))
            out.append(_bisect(found.other, question, ends, executor, report))
    return tuple(out)


def _why(run: Run, code: str, cell: Cell) -> str:
    """Why a column has no frequency at the speed of a cell."""
    there = (c for c in run.cells if (c.case, c.omega, c.code) == (cell.case, cell.omega, code))
    return next((c.reason for c in there if c.frequency is None), "no answer")


@dataclass(frozen=True)
class End:
    """The answer of a release: its cell, or why there is none; ``skip``: it could not be asked."""

    release: str
    cell: Cell | None = None
    why: str = ""
    skip: bool = False


def _bisect(other: str, question: Question, ends: Sequence[End], executor: Executor, report: Report) -> Bisection:
    before, first = old, _ = sorted(ends, key=lambda end: Version(end.release))
    both = all(end.cell for end in ends)
    code, ask, tried = question.code, _Asker(question, executor), 0
    todo, skipped = _between(code.distribution, before.release, first.release, report), dict[str, str]()
    while todo:
        middle = len(todo) // 2
        what = f"bisection: {code.name}, {code.distribution} {todo[middle]}"
        report(f"{what}: {question.name}, {question.omega:g} rad/s; releases left: {len(todo)}")
        here = ask(todo[middle])
        if here.skip or (both and not here.cell):
            report(f"{what}: skipped: {here.why}")
            skipped[todo.pop(middle)] = here.why
            continue
        tried += 1
        report(f"{what}: {_difference(old, here)}")
        if _differs(old, here):
            first, todo = here, todo[:middle]
        else:
            before, todo = here, todo[middle + 1 :]
    last = change(old.cell, first.cell)
    limits = [Version(end.release) for end in (before, first)]
    return Bisection(
        code=code.name,
        other=other,
        distribution=code.distribution,
        case=question.name,
        omega=question.omega,
        mode=question.mode,
        first=first.release,
        before=before.release,
        older=old.release,
        change=last.relative,
        uncertainty=last.uncertainty,
        answers=first.cell is not None,
        reason="" if both else before.why if first.cell else first.why,
        tried=tried,
        skipped={release: why for release, why in skipped.items() if limits[0] < Version(release) < limits[1]},
    )


def _differs(old: End, new: End) -> bool:
    return bool(old.cell or new.cell) and change(old.cell, new.cell).differs


def _difference(old: End, new: End) -> str:
    if not new.cell:
        return f"no answer: {new.why}"
    here = change(old.cell, new.cell)
    if here.relative is None:
        return "answers"
    return f"{'moved' if here.moved else 'not moved'}, {here.relative:+.1e} from {old.release}"


def _between(distribution: str, older: str, newer: str, report: Report) -> list[str]:
    """Releases strictly between two, oldest first; none if they cannot be listed."""
    try:
        return [v for v in overlay.releases(distribution) if Version(older) < Version(v) < Version(newer)]
    except ReleaseError as error:
        report(f"bisection: {error}: only the two releases of the run are known")
        return []


def _narrowed(cases: Sequence[Case | MechanismCase], cell: Cell) -> Case | MechanismCase:
    """The case with the blade and the speed of one cell only."""
    for case in cases:
        for variant in case.variants:
            if variant.name == cell.case:
                return replace(case, variants=(replace(variant, speeds=np.array([cell.omega])),))  # type: ignore[arg-type]
    raise ValueError(f"{cell.case}: not a case of the run")


class _Asker:
    """Asks releases one question; core's reference is computed once."""

    def __init__(self, question: Question, executor: Executor) -> None:
        self.question, self.executor = question, executor
        self.core: dict[Effects, Any] = {}

    def __call__(self, release: str) -> End:
        q = self.question
        try:
            overlay.install(q.code.distribution, release)
        except ReleaseError as error:
            return End(release, why=str(error), skip=True)
        asked = at_release(q.code.asked, q.code.distribution, release)
        (code,) = describe([asked], [v.blade for v in q.case.variants] if isinstance(q.case, Case) else [])
        if code.failure:
            return End(release, why=code.failure.reason)
        if not overlay.same(code.version, release):
            return End(release, why=f"reports version {code.version}", skip=True)
        column = _column(q, code)
        if column.effects not in self.core:
            self.core |= self.executor.submit(_reference(q.case, column)).result()
        cells = self.executor.submit(_cells, column, [q.omega], self.core[column.effects]).result()
        mine = next((cell for cell in cells if cell.mode == q.mode and cell.frequency), None)
        return End(release, mine, "" if mine else next((c.reason for c in cells if c.frequency is None), "no answer"))


def _column(question: Question, code: Description) -> Column:
    """The column of a code for the one blade or mechanism."""
    if isinstance(question.case, Case):
        made = columns(question.case, question.case.variants[0], [code], question.limits)
    else:
        made = mechanism_columns.columns(question.case, [code], question.limits)
    (column,) = (column for column in dated(made, [code]) if column.head.code == code.name)
    return column


def _reference(case: Case | MechanismCase, column: Column) -> Callable[[], dict[Effects, list[Any]]]:
    if isinstance(case, MechanismCase):
        return partial(mechanism_columns.references, case.variants[0])
    (variant,) = case.variants
    return partial(references, variant.blade, variant.speeds.tolist(), case.text.compare, [column.effects])


def _cells(column: Column, speeds: Sequence[float], core: Sequence[Any]) -> list[Cell]:
    """The cells of a column: not the rows of a run, so that they do not appear among its results."""
    return column(speeds, core)[0]
