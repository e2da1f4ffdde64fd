"""``southwell verify``: solves cases with every code, compares and judges the results, and writes a report."""

import os
import shlex
import shutil
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from msgspec.structs import replace as replaced

from ...cases.faults import table
from ...cases.input import atomic, library, mechanisms
from ...cases.input import changes as blade_changes
from ...cases.input.changes import Change, parse
from ...cases.input.default_case import default_case
from ...cases.input.library import is_blade_file
from ...cases.input.readers import Mount
from ...cases.input.schema import Case
from ...cases.judge import results
from ...cases.judge.results import Control, Level, Planned, Run, Setting
from ...cases.verify import bisection, journal, lumping, matrix, mechanism_case, user_results
from ...cases.verify import names as names_of
from ...cases.verify.cached import Cached
from ...cases.verify.executors import executor
from ...cases.verify.journal import Journal, Remembering
from ...cases.verify.mechanism_case import MechanismCase
from ...cases.verify.settings import NOT_USED, settings
from ...cases.verify.software import Software
from ...cases.verify.user_results import UserResults
from ...references.protocol import registry, store
from ...references.protocol.description import Description, describe
from ...references.protocol.process import Limits
from ...references.protocol.store import Store
from ..ci import junit as xml
from ..shared import console, summary
from ..shared.statuses import INCOMPLETE, INTERRUPTED
from ..shared.units import RPM, Units
from . import campbell_options, measured, versions
from .arguments import CONTINUE, RESULTS, Changes, Count, Positive, Workers, cluster_workers, writing
from .errors import UsageError
from .mounting import Mounting
from .report import show
from .subjects import subjects

SHARES = 8
"""Largest number of tasks for the seeded faults on a cluster, whose number of workers may change."""

SCRATCH = "results.partial.tmp"
"""Folder in ``--out`` for temporary files of this run and of the codes it runs."""


def command(
    *case: str,
    codes: str | None = None,
    out: Path = Path("southwell-report"),
    workers: Workers | None = None,
    scheduler: str | None = None,
    add: tuple[str, ...] = (),
    data_uncertainty: str | None = None,
    input_uncertainty: str | None = None,
    junit: Path | None = None,
    faults: str = "fast",
    witnesses: Count | None = None,
    against_version: tuple[str, ...] = (),
    time_limit: Positive | None = None,
    memory_limit: Positive = Limits.memory / 2**30,
    rpm: str | None = None,
    omega: str | None = None,
    changes: Changes = (),
    fresh: bool = False,
    mounting: Mounting | None = None,
) -> int:
    """Solve blades with every code, compare the results and write a report.

    Writes results.jsonl (one row per cell), report.md and figures. Status 1 if a cell fails or is inconclusive, if nothing was
    compared, if fewer independent groups confirm a blade than its case requires, or if a seeded fault is not detected.

    Answers are stored as they are computed. After an interruption (status 130), or if the run was killed or the disk is full
    (status 3), the same command continues. Earlier results are replaced when the new ones are complete.

    Parameters
    ----------
    case
        Blade files (ElastoDyn, BeamDyn, BModes, HAWC2, windIO), cases by name (`southwell cases`), one blade of a case as
        `case/blade`, or case files (TOML). Default: all cases. Of a blade file, the lowest six modes are compared.
    codes
        Names separated by commas (`southwell codes`), or import paths `module:attribute`. Default: all codes.
    out
        Output folder; only one run at a time may write in it.
    workers
        Worker processes (default: one per processor), or workers of Slurm.
    scheduler
        Address of a Dask scheduler, as `tcp://host:8786`, or `slurm` with `--workers`. Default: processes of this machine.
    add
        `NAME=FILE.csv`: results of another program as one more column; may be repeated. Columns of the file: `speed [rpm]` (or
        rad/s, gamma), `frequency [Hz]` (or rad/s, gamma), `mode` (flapwise 1, or a number). Measurements have `measured [Hz]`
        instead of `frequency [Hz]`, and `uncertainty [%]`: they show how far the model is from the data, and decide nothing.
    data_uncertainty
        Standard uncertainty of measured frequencies without one in the file: `1%`.
    input_uncertainty
        Standard uncertainty of the computed frequencies due to the blade's properties, for measured rows without one: `2%`.
    junit
        Output file for JUnit XML, one test case per cell.
    faults
        Seeded faults to run: `fast` (seven), `all`, `none`, or names separated by commas.
    witnesses
        Number of independent groups that must confirm each blade. Default: as the case says; none with `--codes`.
    against_version
        `NAME==VERSION`: another release of a package, such as `exudyn==1.11.0` or `exudyn==newest`, is run next to the
        installed one, as one more column for each code that uses it; may be repeated. The release is installed in the cache.
        The report compares both. If a frequency moves beyond its uncertainty, or only one release answers, bisection finds
        the first release that differs. This does not change the status; a failing cell of either release does.
    time_limit
        Seconds for one solution by another code. Default: as the case says, otherwise 300.
    memory_limit
        Memory in GiB for one solution by another code, including the processes that it starts.
    rpm
        Rotor speeds of a blade file in rpm: a range `first:last:step` or a list `0,5,10`.
    omega
        Rotor speeds of a blade file in rad/s, in the same form.
    changes
        Change a property of every blade: `EI_flap=*1.1`, also EI_edge, GJ, EA, mass, tip_mass, twist, hub_radius, precone,
        pitch. May be repeated.
    fresh
        Compute every answer again instead of taking those of earlier runs from the store (`southwell cache`).
    """
    count = cluster_workers(workers, scheduler)
    if scheduler and against_version:
        raise UsageError(
            f"--against-version {against_version[0]}: with --scheduler: workers have one release: leave it out"
        )
    decks = _Decks(campbell_options.speeds(rpm, omega), (mounting or Mounting()).mount())
    given = [parse(text) for text in changes]
    chosen = [_changed(_chosen(name, decks), given) for name in dict.fromkeys(case or everything())]
    if not any(is_blade_file(name) for name in case) and (decks.speeds or decks.mount != Mount()):
        raise UsageError(
            "--rpm, --omega, --length and the like are for blade files: a case defines its speeds and mounting"
        )
    names = list(dict.fromkeys(codes.split(","))) if codes is not None else list(registry.names())
    blades = [v for c in chosen if isinstance(c, Case) for v in c.variants]
    known = describe(names, [v.blade for v in blades])
    pins = versions.pinned(against_version, known)
    known += versions.described(pins, known, [v.blade for v in blades])
    defaults = measured.defaults(data_uncertainty, input_uncertainty)
    files = [measured.user_results(text, defaults) for text in add]
    measured.check(files, data_uncertainty, input_uncertainty)
    names_of.unique(chosen, known, files)
    user_results.check(files, blades, [c.name for c in known])
    options = [*(["--codes", codes] if codes else []), *(word for text in add for word in ("--add", text))]
    options += [*(["--data-uncertainty", data_uncertainty] if data_uncertainty else [])]
    options += [*(["--input-uncertainty", input_uncertainty] if input_uncertainty else [])]
    options += [word for name, release in pins for word in ("--against-version", f"{name}=={release}")]
    plain = not (rpm or omega or changes or decks.mount != Mount())
    line = ["southwell", "verify", *case, *options] if plain else ["southwell", *sys.argv[1:]]
    about = Run(
        cells=(),
        versions=matrix.versions(known, files),
        command=shlex.join(line),
        settings=tuple(_required(s, witnesses, codes is None) for c in chosen for s in settings(c)),
    )
    seeded = _shared_out(table.chosen(faults), count or SHARES)
    for setting in about.settings:
        if NOT_USED in setting.facts:
            print(f"southwell: {setting.case}: {NOT_USED}: {setting.facts[NOT_USED]}", file=sys.stderr)
    kept_before = _store(fresh)
    limits = {"seconds": time_limit, "memory": int(memory_limit * 2**30), "reuse": kept_before is not None}
    software = Software(
        tuple(sorted({c.distribution for c in known} - {""})), tuple(c.asked for c in known if not c.failure)
    )
    with writing(out), ExitStack() as started:
        pool = started.enter_context(executor(count, scheduler, (out / SCRATCH).resolve(), software, _tell))
        with _journal(out) as kept:
            run, stopped = _solve(
                chosen, known, files, about, kept, out, pool, started.close, seeded, limits, kept_before
            )
            try:
                if run.cells:
                    show(run, out)
                    if junit:
                        _junit(run, junit)
            except OSError as error:
                stopped = stopped or Stopped(_said(error), INCOMPLETE)
            if not stopped:
                kept.remove()
                return summary.status(run)
    what = f"{len(run.cells)} cells are kept" if run.cells else "no cell was finished"
    print(f"southwell: {stopped.what}: {what}; {CONTINUE}", file=sys.stderr)
    return stopped.status


@dataclass(frozen=True)
class Stopped:
    """Why a run stopped before its end, and the exit status."""

    what: str
    status: int


def _required(setting: Setting, witnesses: int | None, whole: bool) -> Setting:
    """The setting with the required number of groups: as given, or as in the case if all codes take part."""
    if witnesses is None and whole:
        return setting
    return replace(setting, groups=witnesses or 0, lacking="")


def _solve(
    chosen: Sequence[Case | MechanismCase],
    codes: Sequence[Description],
    files: Sequence[UserResults],
    about: Run,
    kept: Journal,
    out: Path,
    pool: Executor,
    stop: Callable[[], None],
    seeded: Sequence[Sequence[str]],
    limits: Mapping[str, Any],
    kept_before: Store | None,
) -> tuple[Run, Stopped | None]:
    """The complete run, written to ``out``; or the part that was computed, and why it stopped.

    Answers go to the journal at once. Seeded faults are executed in every run, because they show that this run would
    detect a fault; only what codes answered to the same questions is reused. ``stop`` ends the workers of ``pool``;
    ``seeded`` are the faults of each task.
    """
    scratch = out / SCRATCH
    shutil.rmtree(scratch, ignore_errors=True)  # left by a killed run
    watch = console.Watch()
    fresh = Remembering(pool, kept)
    cached = Cached(pool, kept_before) if kept_before else None
    executor = Remembering(cached, kept) if cached else fresh
    lumped: list[Future[tuple[Level, ...]]] = []
    tried: list[Future[list[Control]]] = []

    def begin(plan: tuple[Planned, ...]) -> None:
        kept.begin(replace(about, plan=plan))
        blades = [v for c in chosen if isinstance(c, Case) for v in c.variants]
        lumped.extend(executor.submit(lumping.lumping, v.blade) for v in blades if v.name == lumping.CASE)
        tried.extend(fresh.submit(table.run, part, kept_before is not None) for part in seeded)

    try:
        scratch.mkdir()
        with watch:
            done = matrix.run(chosen, codes, executor, watch.show, user_results=files, on_plan=begin, **limits)
            moved = bisection.bisections(
                done, chosen, codes, fresh, lambda case: matrix.limits(case, **limits), watch.tell
            )
            levels = done.levels + tuple(level for future in lumped for level in future.result())
            found = {control.control: control for future in tried for control in future.result()}
        controls = tuple(found[name] for part in seeded for name in part)
        run = replace(done, levels=levels, controls=controls, bisections=moved)
        run = replace(run, versions=about.versions, command=about.command, settings=about.settings)
        if missing := results.gaps(run):
            return replace(run, unfinished=missing), Stopped(missing, INCOMPLETE)
        results.write(out / RESULTS, run)
        if cached and cached.taken:
            print(f"southwell: {_taken(cached)}", file=sys.stderr)
        return run, None
    except KeyboardInterrupt:
        stopped = Stopped("interrupted", INTERRUPTED)
    except BrokenProcessPool:
        why = "a worker process was killed, probably out of memory: use fewer --workers or fewer cases at once"
        stopped = Stopped(why, INCOMPLETE)
    except BrokenExecutor as error:
        stopped = Stopped(str(error), INCOMPLETE)
    except OSError as error:
        stopped = Stopped(_said(error), INCOMPLETE)
    finally:
        stop()
        if kept_before:
            kept_before.close()
        shutil.rmtree(scratch, ignore_errors=True)
    return replace(journal.read(kept.path), unfinished=stopped.what), stopped


def _store(fresh: bool) -> Store | None:
    """Open the store of answers; None if it is not wanted or cannot be used."""
    if fresh or os.environ.get(store.FRESH):
        return None
    try:
        return Store(store.path())
    except OSError as error:
        print(f"southwell: the store of answers is not used: {_said(error)}", file=sys.stderr)
        return None


def _taken(cached: Cached) -> str:
    first, last = (time.strftime("%Y-%m-%d %H:%M", time.localtime(when(cached.taken))) for when in (min, max))
    return (
        f"{len(cached.taken)} of {cached.asked} answers are from the store, computed between {first} and {last}; "
        "--fresh computes them again"
    )


def _said(error: OSError) -> str:
    return f"{error.filename}: {error.strerror}" if error.filename else str(error)


def _shared_out(names: Sequence[str], parts: int) -> list[Sequence[str]]:
    """Distribute faults over tasks; neighbours stay together, because they are tried on the same case."""
    size = -(-len(names) // parts)
    return [names[k : k + size] for k in range(0, len(names), size)] if names else []


def _tell(line: str) -> None:
    print(f"southwell: {line}", file=sys.stderr)


@dataclass(frozen=True)
class _Decks:
    """What the command line gives for blade files: rotor speeds and their unit, and how they are mounted."""

    speeds: tuple[tuple[float, ...], Units] | None
    mount: Mount


def _chosen(name: str, decks: _Decks) -> Case | MechanismCase:
    """A case of blades or of a mechanism, by name or file; or the default case of a blade file."""
    if is_blade_file(name):
        (subject,) = subjects(name, decks.mount)
        speeds, units = decks.speeds or (subject.speeds, subject.units)
        if not speeds:
            raise UsageError(f"--rpm: missing: {name} does not define rotor speeds: give them, as in 0,6.9,12.1")
        return default_case(
            subject.blade, speeds, rpm=units is RPM, source="; ".join(subject.about), unused=subject.unused
        )
    if name in library.mechanisms() or (name.endswith(".toml") and mechanisms.is_one(Path(name))):
        return mechanism_case.case(library.mechanism(name))
    return library.select(name)


def _changed(case: Case | MechanismCase, given: Sequence[Change]) -> Case | MechanismCase:
    """The case with changed blade properties and without printed tables, which no longer apply."""
    if not given:
        return case
    if not isinstance(case, Case):
        raise UsageError(f"--set {given[0]}: {case.name} is a mechanism, not a blade: leave it out")
    what = "changed: " + ", ".join(str(change) for change in given)
    text = replaced(
        case.text,
        title=f"{case.text.title}; {what}",
        compare=replaced(case.text.compare, tables=()),
        discretisation=None,
    )
    variants = tuple(replace(v, blade=blade_changes.apply(v.blade, given)) for v in case.variants)
    return replace(case, text=text, variants=variants)


def everything() -> tuple[str, ...]:
    """Every case and mechanism whose files are present; the others are reported as not run."""
    absent = library.absent()
    for name, why in absent.items():
        print(f"southwell: {name}: not run: {why}", file=sys.stderr)
    return (*(name for name in library.names() if name not in absent), *library.mechanisms())


def _journal(out: Path) -> Journal:
    try:
        return Journal(out)
    except OSError as error:
        raise UsageError(f"--out {out}: cannot be written ({error.strerror}): give another folder") from error


def _junit(run: Run, path: Path) -> None:
    try:
        atomic.write(path, xml.render(run))
    except OSError as error:
        raise UsageError(f"--junit {path}: cannot be written ({error.strerror}): give another file") from error
