"""``southwell verify``: cases through every code, compared, judged, reported."""

import os
import re
import shlex
import shutil
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...cases.faults import table
from ...cases.input import atomic, library, mechanisms
from ...cases.input.schema import Case
from ...cases.judge import results
from ...cases.judge.results import Control, Level, Planned, Run, Setting
from ...cases.verify import journal, lumping, matrix, mechanism_case, user_results
from ...cases.verify import names as names_of
from ...cases.verify.journal import Journal, Remembering
from ...cases.verify.mechanism_case import MechanismCase
from ...cases.verify.pool import Pool
from ...cases.verify.settings import NOT_USED, settings
from ...cases.verify.user_results import Added
from ...references.protocol import registry as registry
from ...references.protocol.description import Description, describe
from ...references.protocol.process import Limits
from ..ci import junit as xml
from ..shared import console, summary
from ..shared.statuses import INCOMPLETE, INTERRUPTED
from .arguments import CONTINUE, RESULTS, Count, Positive, UsageError, Workers, writing
from .report import show

SCRATCH = "results.partial.tmp"
"""Folder in ``--out`` for temporary files of this run and of the codes it runs."""


def command(
    *case: str,
    codes: str | None = None,
    out: Path = Path("southwell-report"),
    workers: Workers | None = None,
    add: tuple[str, ...] = (),
    junit: Path | None = None,
    faults: str = "fast",
    witnesses: Count | None = None,
    time_limit: Positive | None = None,
    memory_limit: Positive = Limits.memory / 2**30,
) -> int:
    """Solve cases with every code, compare, judge, and write a report.

    Writes results.jsonl (a row a cell), report.md and figures. Status 1 if any cell fails or is inconclusive, if nothing was
    compared, if a blade is confirmed by fewer independent groups than its case requires, or if a seeded fault is not detected.

    Answers are kept as they come: interrupted (status 130), killed or short of disk space (status 3), the same command
    continues. Earlier results are replaced once the new ones are complete.

    Parameters
    ----------
    case
        A case by name (`southwell cases`), one of its blades as `case/blade`, or a TOML file; all cases by default.
    codes
        Names separated by commas (`southwell codes`), or import paths `module:attribute`; all codes by default.
    out
        Folder for the report; only one run at a time may write in it.
    workers
        Processes to use; one a processor by default.
    add
        `NAME=FILE.csv`, as often as wanted: results of any other program or of a test rig, as one more column. The file's
        columns: `speed [rpm]` (or rad/s, gamma), `frequency [Hz]` (or rad/s, gamma), `mode` (flapwise 1, or a number).
    junit
        File for the same as JUnit's XML: a test case a cell, for a CI that shows it.
    faults
        Seeded faults to run through the whole pipeline: `fast` (seven), `all`, `none`, or names separated by commas.
    witnesses
        How many independent groups must confirm each blade. By default what its case says, where all codes take part; a run
        with `--codes` requires none.
    time_limit
        Seconds that one solution by another code may take; by default what each case says, 300 if it says nothing.
    memory_limit
        Memory that one solution by another code may take, in GiB, with all the processes that it starts.
    """
    chosen = [_chosen(name) for name in dict.fromkeys(case or everything())]
    names = list(dict.fromkeys(codes.split(","))) if codes is not None else list(registry.names())
    blades = [v for c in chosen if isinstance(c, Case) for v in c.variants]
    known = describe(names, [v.blade for v in blades])
    files = [_added(text) for text in add]
    user_results.check(files, blades, [c.name for c in known])
    options = [*(["--codes", codes] if codes else []), *(word for text in add for word in ("--add", text))]
    about = Run(
        cells=(),
        versions=matrix.versions(known, files),
        command=shlex.join(["southwell", "verify", *case, *options]),
        settings=tuple(_required(s, witnesses, codes is None) for c in chosen for s in settings(c)),
    )
    seeded = table.chosen(faults)
    for setting in about.settings:
        if NOT_USED in setting.facts:
            print(f"southwell: {setting.case}: {NOT_USED}: {setting.facts[NOT_USED]}", file=sys.stderr)
    names_of.unique(chosen, known, files)
    limits = {"seconds": time_limit, "memory": int(memory_limit * 2**30)}
    with writing(out), _journal(out) as kept:
        run, stopped = _solve(chosen, known, files, about, kept, out, workers or os.cpu_count() or 1, seeded, limits)
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
    told = f"{len(run.cells)} cells are kept" if run.cells else "nothing was finished yet"
    print(f"southwell: {stopped.what}: {told}; {CONTINUE}", file=sys.stderr)
    return stopped.status


@dataclass(frozen=True)
class Stopped:
    """Why a run came to no end, in words, and the status that says so."""

    what: str
    status: int


def _required(setting: Setting, witnesses: int | None, whole: bool) -> Setting:
    """How many groups a run requires of a blade: as told, or as the case says if all codes take part."""
    if witnesses is None and whole:
        return setting
    return replace(setting, groups=witnesses or 0, lacking="")


def _added(text: str) -> Added:
    name, equals, path = text.partition("=")
    if not (equals and path and re.fullmatch(r"\w[\w .+-]{0,99}", name)):
        raise UsageError(f"--add {text}: give a name and a file, as in --add rig=results.csv")
    return user_results.read(name, Path(path))


def _solve(
    chosen: Sequence[Case | MechanismCase],
    codes: Sequence[Description],
    files: Sequence[Added],
    about: Run,
    kept: Journal,
    out: Path,
    workers: int,
    seeded: Sequence[str],
    limits: Mapping[str, Any],
) -> tuple[Run, Stopped | None]:
    """The complete run, written to ``out``; or what there is of it, and what stopped it. Answers go to the journal at once."""
    scratch = out / SCRATCH
    shutil.rmtree(scratch, ignore_errors=True)  # a killed run's
    pool, watch = Pool(workers, scratch.resolve()), console.Watch()
    executor = Remembering(pool, kept)
    lumped: list[Future[tuple[Level, ...]]] = []
    tried: list[Future[list[Control]]] = []

    def begin(plan: tuple[Planned, ...]) -> None:
        kept.begin(replace(about, plan=plan))
        blades = [v for c in chosen if isinstance(c, Case) for v in c.variants]
        lumped.extend(executor.submit(lumping.lumping, v.blade) for v in blades if v.name == lumping.CASE)
        tried.extend(executor.submit(table.run, part) for part in _shared_out(seeded, workers))

    try:
        scratch.mkdir()
        with watch:
            done = matrix.run(chosen, codes, executor, watch.show, added=files, on_plan=begin, **limits)
            levels = done.levels + tuple(level for future in lumped for level in future.result())
            found = {control.control: control for future in tried for control in future.result()}
        controls = tuple(found[name] for name in seeded)
        run = replace(done, levels=levels, controls=controls)
        run = replace(run, versions=about.versions, command=about.command, settings=about.settings)
        if missing := results.gaps(run):
            return replace(run, unfinished=missing), Stopped(missing, INCOMPLETE)
        results.write(out / RESULTS, run)
        return run, None
    except KeyboardInterrupt:
        stopped = Stopped("interrupted", INTERRUPTED)
    except BrokenProcessPool:
        stopped = Stopped("a worker process was killed, probably out of memory (try fewer --workers)", INCOMPLETE)
    except OSError as error:
        stopped = Stopped(_said(error), INCOMPLETE)
    finally:
        pool.stop()
        shutil.rmtree(scratch, ignore_errors=True)
    return replace(journal.read(kept.path), unfinished=stopped.what), stopped


def _said(error: OSError) -> str:
    return f"{error.filename}: {error.strerror}" if error.filename else str(error)


def _shared_out(names: Sequence[str], workers: int) -> list[Sequence[str]]:
    """Faults for each worker: neighbours together, as their trials are the same case."""
    size = -(-len(names) // workers)
    return [names[k : k + size] for k in range(0, len(names), size)] if names else []


def _chosen(name: str) -> Case | MechanismCase:
    """A case of blades or of a mechanism, by name or file."""
    if name in library.mechanisms() or (name.endswith(".toml") and mechanisms.is_one(Path(name))):
        return mechanism_case.case(library.mechanism(name))
    return library.select(name)


def everything() -> tuple[str, ...]:
    """Every case and mechanism whose files are there; what is not is said."""
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
