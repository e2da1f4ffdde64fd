"""The run: every blade of every case solved by every code, on any executor; rows are delivered as they are computed.

For each blade core's references come first, then each column. A task is a pure function of picklable arguments.
"""

from collections.abc import Callable, Collection, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from pathlib import Path
from platform import python_version
from typing import Any

from ...references.protocol import sources
from ...references.protocol.description import Description
from ...references.protocol.process import Failure, Limits, raised
from ...references.protocol.store import StoreError
from ..diagnosis import columns as diagnosis
from ..input.errors import CaseError
from ..judge.cells import Rows, failing
from ..judge.results import BudgetEntry, Cell, Diagnosed, Level, Origin, Planned, PropertyCheck, Run
from ..plan.column import Column, ColumnError
from ..plan.subject import PropertyChecks, Subject
from ..plan.user_results import UserResults
from ..solve import error_budget


@dataclass(frozen=True)
class Progress:
    """Progress of a run and its latest rows.

    Attributes:
        done: tasks finished.
        total: total number of tasks, known from the start.
        running: tasks in progress: ``park-cantilever × pinocchio``.
        cells: rows just delivered.
        levels: answers of refinements just delivered.
    """

    done: int
    total: int
    running: tuple[str, ...]
    cells: tuple[Cell, ...] = ()
    levels: tuple[Level, ...] = ()


@dataclass(frozen=True)
class _Task:
    """One task for one subject: core's references (no column), or a column."""

    subject: Subject
    columns: tuple[Column, ...]
    core: Callable[[], dict[Any, list[Any]]]
    properties: PropertyChecks
    column: Column | None = None

    @property
    def label(self) -> str:
        return f"{self.subject.name} × {self.column.name if self.column else 'Southwell'}"


def run(
    subjects: Sequence[Subject],
    codes: Sequence[Description],
    executor: Executor,
    on_progress: Callable[[Progress], None] = lambda _: None,
    seconds: float | None = None,
    memory: int = Limits.memory,
    reuse: bool = False,
    user_results: Sequence[UserResults] = (),
    parts: bool = True,
    on_plan: Callable[[tuple[Planned, ...]], None] = lambda _: None,
) -> Run:
    """Solve every one of ``subjects`` with every one of ``codes`` and judge the results.

    Args:
        subjects: what is verified.
        codes: descriptions of the codes, which have been asked about every blade.
        executor: where tasks run: threads, processes, another machine's.
        on_progress: called when the run starts and whenever a task ends; an exception from it stops the run.
        seconds: time limit for one solution by a foreign code, s; by default the limit of each case.
        memory: memory limit for one solution, bytes.
        reuse: whether codes' earlier answers may be taken from the store.
        user_results: results without a code; each adds a column.
        parts: whether to read files again, weigh the codes' models, and compute the error budget of core and the diagnoses
            of columns that fail.
        on_plan: called with every column before the first task starts.
    """
    plans = _tasks(subjects, codes, lambda s: Limits(seconds or s.time_limit, memory, reuse), user_results, parts)
    plan = tuple(_planned(task, column) for task in plans for column in task.columns)
    on_plan(plan)
    total = sum(1 + len(task.columns) for task in plans)
    rows: dict[tuple[str, str], Rows] = {}
    pending: dict[Future[Any], _Task] = {}
    split: list[tuple[_Task, Future[list[BudgetEntry]]]] = []
    weighed: list[Future[list[PropertyCheck]]] = []
    try:
        for task in plans:
            pending[executor.submit(task.core)] = task
        on_progress(Progress(0, total, _running(pending)))
        while pending:
            for future in wait(pending, return_when=FIRST_COMPLETED).done:
                task, new = pending.pop(future), ([], [])
                points, answer = task.subject.points, _answer(future)
                if isinstance(answer, Failure):
                    for column in [task.column] if task.column else task.columns:
                        lost_cells, _ = rows[task.subject.name, column.name] = failing(column.head, answer, points)
                        new = (new[0] + lost_cells, [])
                elif task.column:
                    rows[task.subject.name, task.column.name] = new = answer
                else:
                    for column in task.columns:
                        pending[executor.submit(column, points, answer[column.effects])] = replace(task, column=column)
                if parts and not split and all(t.column for t in pending.values()):
                    # after all columns: they are short, so that no worker is idle at the end
                    budgets = [(task, task.subject.error_budget()) for task in plans]
                    split = [(task, executor.submit(budget)) for task, budget in budgets if budget]
                    weighed = [executor.submit(weigh) for task in plans for weigh in task.properties.tasks]
                finished = total - sum(1 if t.column else 1 + len(t.columns) for t in pending.values())
                on_progress(Progress(finished, total, _running(pending), tuple(new[0]), tuple(new[1])))
        reasons = _diagnosed(plans, rows, executor, {results.name for results in user_results}) if parts else ()
        made_of = [row for task, future in split for row in _parts(task, future.result(), rows)]
        checks = [row for task in plans for row in task.properties.rows]
        checks += [row for future in weighed for row in future.result()]
    finally:
        for future in [*pending, *weighed, *(future for _, future in split)]:
            future.cancel()
    ordered = [rows[task.subject.name, column.name] for task in plans for column in task.columns]
    return Run(
        cells=tuple(cell for cells, _ in ordered for cell in cells),
        levels=tuple(level for _, levels in ordered for level in levels),
        versions=versions(codes, user_results),
        settings=tuple(subject.setting() for subject in subjects),
        error_budget=tuple(made_of),
        origins=tuple(
            Origin(task.subject.name, column.head.code, **asdict(column.origin))
            for task in plans
            for column in task.columns
            if column.origin
        ),
        diagnoses=reasons,
        plan=plan,
        property_checks=tuple(checks),
    )


def _diagnosed(
    plans: Sequence[_Task], rows: dict[tuple[str, str], Rows], executor: Executor, user_names: Collection[str]
) -> tuple[Diagnosed, ...]:
    """Why columns that fail, and files of other programs, differ from core; one that cannot be solved is left out."""
    futures: list[Future[Diagnosed]] = []
    for task in plans:
        for column in task.columns:
            cells, _ = rows[task.subject.name, column.name]
            if task.subject.blade is not None and diagnosis.is_due(cells, column.name in user_names):
                futures.append(executor.submit(diagnosis.diagnosed, task.subject.blade, cells, task.subject.file))
    return tuple(answer for answer in map(_answer, futures) if isinstance(answer, Diagnosed))


def _planned(task: _Task, column: Column) -> Planned:
    points = {"everywhere": len(task.subject.points), "highest speed": 1, "somewhere": 0}[column.due]
    return Planned(task.subject.name, column.head.code, points, task.subject.cells if points else 0)


def _answer(future: Future[Any]) -> Any:
    """The result of a task, or a failure if this package raised an error; only the cells of that task are lost."""
    try:
        return future.result()
    except (BrokenExecutor, ColumnError, StoreError):
        raise
    except CaseError as error:
        return Failure("no reference", str(error))
    except Exception as error:
        return Failure("internal", f"internal error of southwell, not of the code: {raised(error)}")


def _tasks(
    subjects: Sequence[Subject],
    codes: Sequence[Description],
    limits: Callable[[Subject], Limits],
    user_results: Sequence[UserResults],
    parts: bool,
) -> list[_Task]:
    """The task of each subject, with its columns. A code's answers on whether it accepts a blade are divided among them."""
    out, blades = [], 0
    for subject in subjects:
        descriptions = [replace(code, refused=code.refused[blades : blades + 1]) for code in codes]
        blades += subject.blade is not None
        columns = dated(subject.columns(descriptions, limits(subject), user_results), codes)
        checks = subject.property_checks(descriptions, limits(subject)) if parts else PropertyChecks()
        out.append(_Task(subject, columns, subject.references(columns), checks))
    return out


def dated(columns: Sequence[Column], codes: Sequence[Description]) -> tuple[Column, ...]:
    """The columns with the digests of the sources of their codes."""
    origins = {c.name: (sources.adapter(c.asked), sources.bundled(c.asked)) for c in codes if not c.failure}
    of_columns = [(column, *origins.get(column.head.code, ("", True))) for column in columns]
    return tuple(replace(column, adapter=digest, bundled=bundled) for column, digest, bundled in of_columns)


def _parts(task: _Task, parts: list[BudgetEntry], rows: dict[tuple[str, str], Rows]) -> list[BudgetEntry]:
    """The error budget of core, with the uncertainties of the compared numbers."""
    name = task.subject.name
    cells = [cell for column in task.columns for cell in rows[name, column.name][0]]
    return parts + error_budget.uncertain(name, parts, cells)


def versions(codes: Iterable[Description], user_results: Sequence[UserResults] = ()) -> dict[str, str]:
    """Versions of Python, the packages core needs, each code, and files of results."""
    own_versions = {name: version(name) for name in ("southwell", "numpy", "scipy")}
    files = {
        results.name: f"{'measured,' if results.measured else 'results'} in {Path(results.path).name}"
        for results in user_results
    }
    code_versions = {c.name: c.version or ("unknown" if c.failure else "not installed") for c in codes}
    return {"python": python_version(), **own_versions, **code_versions, **files}


def _running(pending: dict[Future[Any], _Task]) -> tuple[str, ...]:
    return tuple(task.label for future, task in pending.items() if future.running())
