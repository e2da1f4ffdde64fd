"""The first release of a code that moves a frequency, found by bisection on one question: one blade, at one speed.

The releases between the two of a run are halved until two neighbours remain; each step installs one release and asks it
the one question. This assumes that the frequency does not move back and forth. A release that cannot be installed or
does not answer is skipped and named.
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
from ...references.protocol.registry import at_release
from ..input.schema import Case
from ..judge.releases import Bisection, Change, change, comparisons, smallest
from ..judge.results import Cell, Run
from . import mechanism_columns
from .columns import Column, columns
from .matrix import dated
from .mechanism_case import MechanismCase
from .reference import references

Tell = Callable[[str], None]


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
    tell: Tell,
) -> tuple[Bisection, ...]:
    """One bisection for each code that another release of the run moves, on its fastest question.

    Args:
        run: the results, with the columns of other releases.
        cases, codes: those of the run.
        executor: where questions are answered.
        limits: of one solution, by case.
        tell: called with one line before and after each release that is tried.
    """
    known = {code.name: code for code in codes}
    out = []
    for found in comparisons(run):
        if moved := found.moved:
            worst = smallest(moved)
            case = _narrowed(cases, worst)
            question = Question(case, known[found.code], limits(case), worst.before.mode)
            out.append(_bisect(worst, question, executor, tell))
    return tuple(out)


def _bisect(moved: Change, question: Question, executor: Executor, tell: Tell) -> Bisection:
    old, new = sorted((moved.before, moved.after), key=lambda cell: Version(cell.version))
    first, before, last = new.version, old.version, change(old, new)
    todo, tried, skipped = _between(question.code.distribution, before, first, tell), 0, dict[str, str]()
    ask = _Asker(question, executor)
    while todo:
        middle = len(todo) // 2
        release = todo[middle]
        what = f"{question.code.name}, {question.code.distribution} {release}"
        tell(f"bisection: {what}: {question.name}, {question.omega:g} rad/s; {len(todo)} releases left")
        cell = ask(release)
        if isinstance(cell, str):
            tell(f"bisection: {what}: skipped: {cell}")
            skipped[release] = cell
            del todo[middle]
            continue
        tried += 1
        here = change(old, cell)
        tell(f"bisection: {what}: {'moved' if here.moved else 'not moved'} ({here.relative:+.1e}, relative)")
        if here.moved:
            first, last, todo = release, here, todo[:middle]
        else:
            before, todo = release, todo[middle + 1 :]
    return Bisection(
        code=question.code.name,
        other=moved.after.code,
        distribution=question.code.distribution,
        case=question.name,
        omega=question.omega,
        mode=question.mode,
        first=first,
        before=before,
        older=old.version,
        change=last.relative,
        uncertainty=last.uncertainty or 0.0,
        tried=tried,
        skipped={k: why for k, why in skipped.items() if Version(before) < Version(k) < Version(first)},
    )


def _between(distribution: str, older: str, newer: str, tell: Tell) -> list[str]:
    """Releases strictly between two, oldest first; none if they cannot be listed."""
    try:
        return [v for v in overlay.releases(distribution) if Version(older) < Version(v) < Version(newer)]
    except ReleaseError as error:
        tell(f"bisection: {error}: only the two releases of the run are known")
        return []


def _narrowed(cases: Sequence[Case | MechanismCase], worst: Change) -> Case | MechanismCase:
    """The case with the blade and the speed of one change only."""
    name, speed = worst.before.case, np.array([worst.before.omega])
    for case in cases:
        for variant in case.variants:
            if variant.name == name:
                return replace(case, variants=(replace(variant, speeds=speed),))  # type: ignore[arg-type]
    raise ValueError(f"{name}: not a case of the run")


class _Asker:
    """Asks releases one question; core's reference is computed once."""

    def __init__(self, question: Question, executor: Executor) -> None:
        self.question, self.executor = question, executor
        self.core: dict[Effects, Any] = {}

    def __call__(self, release: str) -> Cell | str:
        """The cell of the mode with a release, or why there is none."""
        q = self.question
        try:
            overlay.install(q.code.distribution, release)
        except ReleaseError as error:
            return str(error)
        asked = at_release(q.code.asked, q.code.distribution, release)
        blades = [v.blade for v in q.case.variants] if isinstance(q.case, Case) else []
        (code,) = describe([asked], blades)
        if code.failure:
            return code.failure.reason
        if not overlay.same(code.version, release):
            return f"reports version {code.version}"
        column = _column(q, code)
        if column.model not in self.core:
            self.core |= self.executor.submit(_reference(q.case, column)).result()
        cells = self.executor.submit(_cells, column, [q.omega], self.core[column.model]).result()
        mine = next((cell for cell in cells if cell.mode == q.mode and cell.frequency is not None), None)
        return mine or next((cell.reason for cell in cells if cell.reason), "no answer")


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
    return partial(references, variant.blade, variant.speeds.tolist(), case.text.compare, [column.model])


def _cells(column: Column, speeds: Sequence[float], core: Sequence[Any]) -> list[Cell]:
    """The cells of a column: not the rows of a run, so that they do not appear among its results."""
    return column(speeds, core)[0]
