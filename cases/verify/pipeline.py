"""One run, from what is asked to its results: for the command line, notebooks and tests."""

import os
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path

from ...references.protocol import launch, registry, store
from ...references.protocol.description import Description, describe
from ...references.protocol.store import Store
from ..faults import own, own_reading, own_turbine, own_uncertainty, table
from ..input.writing import writable
from ..judge.results import Control, Planned, Run, Setting
from ..plan import linearised, names, user_results
from ..plan.blade import BladeSubject
from ..plan.request import Execution, Request, command_line
from ..plan.settings import NOT_USED
from ..plan.subject import Subject, asked_about, speeds_of_blades
from ..plan.subjects import subjects
from ..plan.turbine import TurbineSubject
from ..plan.user_results import UserResults
from ..run.executors import Serial, executor
from ..run.software import Software
from ..store import results_file, unfinished
from ..store.results_file import RESULTS
from ..store.stored import Stored
from ..store.unfinished import Unfinished
from . import matrix, measurements
from .matrix import Progress

SCRATCH = "results.partial.tmp"
"""Folder in the output folder for temporary files of this run and of the codes it runs."""

INTERRUPTED = "interrupted"
"""``Run.unfinished`` after an interruption from the keyboard."""

SHARES = 8
"""Largest number of tasks for the seeded faults on a cluster, whose number of workers may change."""


class Observer:
    """Told what a run does; this one ignores it."""

    def note(self, line: str) -> None:
        """Called with one line on something that is left out, taken from the store, or lost."""

    def watching(self) -> AbstractContextManager[Callable[[Progress], None]]:
        """The progress of the run: entered before its first task, exited after the last."""
        return nullcontext(lambda progress: None)

    def finished(self, run: Run, pool: Executor | None) -> None:
        """Called with a run that has cells, complete or not, before the answers in its folder are removed.

        ``pool`` executes more tasks of a complete run; None if there is none. An ``OSError`` leaves the run unfinished.
        """


@dataclass(frozen=True)
class Plan:
    """What a request stands for.

    Attributes:
        subjects: what is verified.
        codes: descriptions of the codes, which have been asked about every blade.
        user_results: results of other programs and measurements.
        empty_run: the run without rows.
        faults: names of the seeded faults.
    """

    subjects: tuple[Subject, ...]
    codes: tuple[Description, ...]
    user_results: tuple[UserResults, ...]
    empty_run: Run
    faults: tuple[str, ...]


def verify(request: Request, observer: Observer | None = None) -> Run:
    """Solve every subject with every code, judge the results, and run seeded faults through the same steps.

    With an output folder, answers are kept there as they are computed, and a run that is stopped returns what it has with the
    reason in ``unfinished``; the same request continues it. Otherwise the exception that stops a run is raised.

    Raises:
        CaseError: if the request cannot be met: a subject, an option or the output folder is wrong.
        UnknownCodeError: if a code is unknown.
    """
    observer, execution = observer or Observer(), request.execution
    with _store(execution.fresh, observer) as users, ExitStack() as stack:
        if request.codes != ():
            launch.warm_up()  # for the descriptions of codes, while the cases are read
        plan = planned(request, observer)
        if execution.out is None:
            with _pool(execution, plan, None, observer) as pool:
                run = _solved(request, plan, pool, users, None, observer)
                observer.finished(run, None)
            return run
        out = execution.out
        with writable(f"--out {out}"):
            out.mkdir(parents=True, exist_ok=True)
            stack.enter_context(unfinished.locked(out))
        return _kept(request, plan, out, users, observer)


def planned(request: Request, observer: Observer) -> Plan:
    """Read the subjects, describe the codes, and check that they belong together.

    Raises:
        CaseError, UnknownCodeError: as ``verify``.
    """
    selection = subjects(request, observer.note)
    requested = list(dict.fromkeys(request.codes)) if request.codes is not None else list(registry.names())
    codes = describe(requested, asked_about(selection))
    defaults = measurements.defaults(request.data_uncertainty, request.input_uncertainty)
    added_results = [measurements.user_results(text, defaults) for text in request.add]
    measurements.check(added_results, request.data_uncertainty, request.input_uncertainty)
    names.unique(selection, codes, added_results)
    user_results.check(added_results, speeds_of_blades(selection))
    linearised.check(added_results, [subject.name for subject in selection if isinstance(subject, TurbineSubject)])
    empty_run = Run(
        cells=(),
        versions=matrix.versions(codes, added_results),
        command=command_line(request),
        settings=tuple(_required(subject.setting(), request) for subject in selection),
    )
    for setting in empty_run.settings:
        if NOT_USED in setting.facts:
            observer.note(f"{setting.case}: {NOT_USED}: {setting.facts[NOT_USED]}")
    return Plan(tuple(selection), tuple(codes), tuple(added_results), empty_run, table.chosen(request.faults))


def _required(setting: Setting, request: Request) -> Setting:
    """The setting with the required number of groups: as asked, or as in the case if all codes take part."""
    if request.witnesses is None and request.codes is None:
        return setting
    return replace(setting, groups=request.witnesses or 0, lacking="")


def _kept(request: Request, plan: Plan, out: Path, users: Store | None, observer: Observer) -> Run:
    """The run with an output folder, where answers are kept until results and reports are written."""
    execution, scratch = request.execution, out / SCRATCH
    with ExitStack() as stack:
        stack.callback(shutil.rmtree, scratch, ignore_errors=True)  # after the processes have ended
        pool = stack.enter_context(_pool(execution, plan, scratch.resolve(), observer))
        with writable(f"--out {out}"):
            store = Unfinished(out)
        with store as answers:
            shutil.rmtree(scratch, ignore_errors=True)  # left by a killed run
            try:
                scratch.mkdir()
                run = _solved(request, plan, pool, users, answers, observer)
                if missing := results_file.gaps(run):
                    run = replace(run, unfinished=missing)
                else:
                    results_file.write(out / RESULTS, run)
            except (KeyboardInterrupt, BrokenExecutor, OSError) as error:
                stack.close()
                run = replace(unfinished.read(answers.path), unfinished=_reason(error))
            except BaseException:
                stack.close()
                raise
            try:
                if run.cells:
                    observer.finished(run, None if run.unfinished or execution.scheduler else pool)
            except OSError as error:
                run = replace(run, unfinished=run.unfinished or _reason(error))
            if not run.unfinished:
                answers.remove()
    return run


def _solved(
    request: Request, plan: Plan, pool: Executor, users: Store | None, answers: Unfinished | None, observer: Observer
) -> Run:
    """The complete run. That a fault is detected is taken from the store only if no version of a code has changed."""
    state = tuple(f"{name} {version}" for name, version in sorted(plan.empty_run.versions.items()))
    serial = request.execution.threads or request.execution.workers == 0
    tasks, trials = Stored(pool, users, answers), Stored(Serial() if serial else pool, users, answers, state)
    users_blades = [subject for subject in plan.subjects if isinstance(subject, BladeSubject) and subject.users]
    on_blades = own.chosen(plan.faults) if users_blades else ()
    turbines = [subject for subject in plan.subjects if isinstance(subject, TurbineSubject) and subject.users]
    on_turbines = own.chosen(plan.faults, own_turbine.NAMES) if turbines else ()
    # faults of a blade say nothing of a run on turbines alone
    covered_faults = {
        *on_blades,
        *on_turbines,
        *(table.FAST if turbines and len(turbines) == len(plan.subjects) else ()),
    }
    elsewhere = tuple(name for name in plan.faults if name not in covered_faults)
    shares = _shares(elsewhere, request.execution.workers or SHARES)
    trial_futures: list[Future[list[Control]]] = []

    def try_faults() -> None:
        trial_futures.extend(trials.submit(table.run, share, users is not None) for share in shares)

    def begin(columns: tuple[Planned, ...]) -> None:
        if answers:
            answers.begin(replace(plan.empty_run, plan=columns))
        if not serial:
            try_faults()

    with observer.watching() as progress:
        run = matrix.run(
            plan.subjects,
            plan.codes,
            tasks,
            progress,
            request.time_limit,
            int(request.memory_limit * 2**30),
            users is not None,
            plan.user_results,
            on_plan=begin,
        )
        if serial:  # a fault alters modules, which no other thread may use at that time
            try_faults()
        on_own = [
            trials.submit(own.run, subject, own.witnesses(run.cells, subject, plan.codes), on_blades, users is not None)
            for subject in (users_blades if on_blades else [])
        ]
        on_own += [
            trials.submit(
                own_turbine.run, subject, own.witnesses(run.cells, subject, plan.codes), on_turbines, users is not None
            )
            for subject in (turbines if on_turbines else [])
        ]
        if on_turbines == own_turbine.NAMES:
            on_own += [trials.submit(own_reading.run, subject) for subject in turbines]
        for run_own in (own_reading.run, own_uncertainty.run) if on_blades == own.NAMES else ():
            on_own += [trials.submit(run_own, subject) for subject in users_blades]
        controls = {control.control: control for future in trial_futures for control in future.result()}
    empty_run = plan.empty_run
    ordered = (*(c for future in on_own for c in future.result()), *(controls[name] for name in elsewhere))
    if times := [*tasks.taken, *trials.taken]:
        observer.note(_taken(times, tasks.asked + trials.asked))
    return replace(
        run, controls=ordered, versions=empty_run.versions, command=empty_run.command, settings=empty_run.settings
    )


@contextmanager
def _pool(execution: Execution, plan: Plan, scratch: Path | None, observer: Observer) -> Iterator[Executor]:
    if execution.workers == 0:
        yield Serial()
        return
    if execution.threads:
        with ThreadPoolExecutor(execution.workers) as pool:
            yield pool
        return
    distributions = tuple(sorted({c.distribution for c in plan.codes} - {""}))
    software = Software(distributions, tuple(c.asked for c in plan.codes if not c.failure))
    with executor(execution.workers, execution.scheduler, scratch, software, observer.note) as pool:
        yield pool


@contextmanager
def _store(fresh: bool, observer: Observer) -> Iterator[Store | None]:
    """Open the store of answers; None if it is not wanted, which the processes of codes learn too, or cannot be used."""
    previous = os.environ.get(store.FRESH)
    if fresh:
        os.environ[store.FRESH] = "1"
    users = None
    try:
        if not os.environ.get(store.FRESH):
            try:
                users = store.users()
            except OSError as error:
                observer.note(f"the store of answers is not used: {_reason(error)}")
        yield users
    finally:
        if users:
            users.close()
        if fresh and previous is None:
            del os.environ[store.FRESH]


def _shares(faults: Sequence[str], parts: int) -> list[Sequence[str]]:
    """Distribute faults over tasks; neighbours stay together, because they are tried on the same case."""
    size = -(-len(faults) // parts)
    return [faults[k : k + size] for k in range(0, len(faults), size)] if faults else []


def _taken(times: Sequence[float], requested: int) -> str:
    first, last = (time.strftime("%Y-%m-%d %H:%M", time.localtime(when(times))) for when in (min, max))
    computed = f"computed between {first} and {last}; --fresh computes them again"
    return f"{len(times)} of {requested} answers are from the store, {computed}"


def _reason(error: BaseException) -> str:
    """Why a run stopped, in one line."""
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED
    if isinstance(error, BrokenProcessPool):
        return "a worker process was killed, probably out of memory: use fewer --workers or fewer cases at once"
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    return str(error)
