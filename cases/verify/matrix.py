"""The run: every blade of every case through every code, on any executor, rows delivered as they come.

For each blade core's references come first, then each column. A task is a pure function of picklable arguments.
"""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import asdict, dataclass, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from platform import python_version
from typing import Any

from ...references.protocol.registry import code, version_of
from ..input.schema import Case, Variant
from ..judge.results import Cell, Level, Origin, Run, Share
from . import error_budget, mechanism_columns
from .columns import Column, Rows, columns
from .mechanism_case import MechanismCase, Turning
from .reference import references
from .settings import settings
from .user_results import Added, check
from .user_results import columns as added_columns

TIMEOUT = 300.0
"""Seconds a worker has for what it is asked at once: all speeds of one blade."""


@dataclass(frozen=True)
class Progress:
    """How far a run is, and what it just delivered.

    Attributes:
        done: tasks finished.
        total: tasks in all; known from the start.
        running: what is being solved now: ``park-cantilever × pinocchio``.
        cells: rows just delivered.
        levels: refinements' answers just delivered.
    """

    done: int
    total: int
    running: tuple[str, ...]
    cells: tuple[Cell, ...] = ()
    levels: tuple[Level, ...] = ()


@dataclass(frozen=True)
class _Task:
    """One thing to solve of one blade: core's references (no column), or a column; and what differences are made of."""

    variant: Variant | Turning
    columns: tuple[Column, ...]
    core: Callable[[], dict[Any, list[Any]]]
    column: Column | None = None
    shares: Callable[[], list[Share]] | None = None

    @property
    def label(self) -> str:
        return f"{self.variant.name} × {self.column.name if self.column else 'core'}"


def run(
    cases: Sequence[Case | MechanismCase],
    codes: Sequence[str],
    executor: Executor,
    on_progress: Callable[[Progress], None] = lambda _: None,
    timeout: float = TIMEOUT,
    added: Sequence[Added] = (),
    parts: bool = True,
) -> Run:
    """Every blade of ``cases`` through every one of ``codes``, judged.

    Args:
        cases: as read.
        codes: names or import paths, see ``references.codes``.
        executor: where tasks run: threads, processes, another machine's.
        on_progress: told when the run starts and whenever a task ends; an exception from it stops the run.
        timeout: seconds for one worker.
        added: results without a code, each a column more.
        parts: whether to say what core's differences are made of.

    Raises:
        CaseError: if core itself cannot solve a case, or results are added that are not of these cases.
        UnknownCodeError: if a code is not known.
    """
    known = {name: code(name) for name in codes}
    blades = [v for case in cases if isinstance(case, Case) for v in case.variants]
    check(added, blades, [c.name for c in known.values()])
    plans = [task for case in cases for task in _tasks(case, known, timeout, added)]
    total = sum(1 + len(task.columns) for task in plans)
    rows: dict[tuple[str, str], Rows] = {}
    pending: dict[Future[Any], _Task] = {}
    split: list[tuple[_Task, Future[list[Share]]]] = []
    try:
        for task in plans:
            pending[executor.submit(task.core)] = task
        split = [(task, executor.submit(task.shares)) for task in plans if task.shares and parts]
        on_progress(Progress(0, total, _running(pending)))
        while pending:
            for future in wait(pending, return_when=FIRST_COMPLETED).done:
                task, new = pending.pop(future), ([], [])
                if task.column:
                    rows[task.variant.name, task.column.name] = new = future.result()
                else:
                    for column in task.columns:
                        answer = executor.submit(column, task.variant.speeds.tolist(), future.result()[column.model])
                        pending[answer] = replace(task, column=column)
                done = total - sum(1 if t.column else 1 + len(t.columns) for t in pending.values())
                on_progress(Progress(done, total, _running(pending), tuple(new[0]), tuple(new[1])))
        made_of = [row for task, future in split for row in _parts(task, future.result(), rows)]
    finally:
        for future in [*pending, *(future for _, future in split)]:
            future.cancel()
    ordered = [rows[task.variant.name, column.name] for task in plans for column in task.columns]
    return Run(
        cells=tuple(cell for cells, _ in ordered for cell in cells),
        levels=tuple(level for _, levels in ordered for level in levels),
        versions=versions(known.values(), added),
        settings=tuple(setting for case in cases for setting in settings(case)),
        shares=tuple(made_of),
        origins=tuple(
            Origin(task.variant.name, column.head.code, **asdict(column.origin))
            for task in plans
            for column in task.columns
            if column.origin
        ),
    )


def _tasks(case: Case | MechanismCase, codes: dict[str, Any], timeout: float, added: Sequence[Added]) -> list[_Task]:
    """One for each blade of a case, or for its mechanism."""
    if isinstance(case, MechanismCase):
        (turning,) = case.variants
        made = tuple(mechanism_columns.columns(case, codes, timeout))
        return [_Task(turning, made, partial(mechanism_columns.references, turning))]
    out = []
    for v in case.variants:
        made = (*columns(case, v, codes, timeout), *added_columns(v, added, case.text.compare.target))
        models = [column.model for column in made]
        question = partial(references, v.blade, v.speeds.tolist(), case.text.compare, models)
        out.append(_Task(v, made, question, shares=partial(error_budget.solve, case, v)))
    return out


def _parts(task: _Task, parts: list[Share], rows: dict[tuple[str, str], Rows]) -> list[Share]:
    """What core's differences are made of, and how sure the numbers are that they are seen in."""
    return parts + error_budget.uncertain(task.variant.name, parts, _cells(task, rows))


def _cells(task: _Task, rows: dict[tuple[str, str], Rows]) -> list[Cell]:
    return [cell for column in task.columns for cell in rows[task.variant.name, column.name][0]]


def versions(codes: Iterable[Any], added: Sequence[Added] = ()) -> dict[str, str]:
    """What the numbers were made with: Python, the packages core needs, each code, and files of results."""
    ours = {name: version(name) for name in ("southwell", "numpy", "scipy")}
    files = {one.name: f"results in {Path(one.path).name}" for one in added}
    told = {c.name: version_of(c) for c in codes}
    theirs = {name: version or ("unknown" if raised else "not installed") for name, (version, raised) in told.items()}
    return {"python": python_version(), **ours, **theirs, **files}


def _running(pending: dict[Future[Any], _Task]) -> tuple[str, ...]:
    return tuple(task.label for future, task in pending.items() if future.running())
