"""``southwell verify``: cases through every code, compared, judged, reported."""

import os
import re
import shlex
import sys
from collections.abc import Sequence
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path

from ...cases.faults import table
from ...cases.input import library, mechanisms
from ...cases.input.schema import Case
from ...cases.judge import results
from ...cases.judge.results import Run, Setting
from ...cases.verify import lumping, matrix, mechanism_case, user_results
from ...cases.verify.mechanism_case import MechanismCase
from ...cases.verify.pool import Pool
from ...cases.verify.settings import NOT_USED, settings
from ...cases.verify.user_results import Added
from ...references.protocol import registry as registry
from ..ci import junit as xml
from ..shared import console, summary
from .arguments import INTERRUPTED, RESULTS, Count, UsageError, Workers
from .report import show


def command(
    *case: str,
    codes: str | None = None,
    out: Path = Path("southwell-report"),
    workers: Workers | None = None,
    add: tuple[str, ...] = (),
    junit: Path | None = None,
    faults: str = "fast",
    witnesses: Count | None = None,
) -> int:
    """Solve cases with every code, compare, judge, and write a report.

    Writes results.jsonl (a row a cell), report.md and figures. Status 1 if any cell fails or is inconclusive, if nothing was
    compared, if a blade is confirmed by fewer independent groups than its case requires, or if a seeded fault is not detected;
    interrupted, it keeps and reports what is there, status 130.

    Parameters
    ----------
    case
        A case by name (`southwell cases`), one of its blades as `case/blade`, or a TOML file; all cases by default.
    codes
        Names separated by commas (`southwell codes`), or import paths `module:attribute`; all codes by default.
    out
        Folder for the report; results of an earlier run in it are replaced.
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
    """
    chosen = [_chosen(name) for name in dict.fromkeys(case or everything())]
    names = list(dict.fromkeys(codes.split(","))) if codes is not None else list(registry.names())
    known = [registry.code(name) for name in names]
    files = [_added(text) for text in add]
    user_results.check(files, [v for c in chosen if isinstance(c, Case) for v in c.variants], [c.name for c in known])
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
    path = _fresh(out)
    results.append(path, run=about)
    run, complete = _solve(chosen, names, files, about, path, workers or os.cpu_count() or 1, seeded)
    if run.cells:
        show(run, out)
        if junit:
            _junit(run, junit)
    if not complete:
        kept = (
            f"the report has the {len(run.cells)} cells that were finished" if run.cells else "nothing was finished yet"
        )
        print(f"southwell: interrupted: {kept}", file=sys.stderr)
        return INTERRUPTED
    return summary.status(run)


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
    names: Sequence[str],
    files: Sequence[Added],
    about: Run,
    path: Path,
    workers: int,
    seeded: Sequence[str],
) -> tuple[Run, bool]:
    """The run, and whether it is complete; rows go to ``path`` as they come, and in order once all are there."""
    pool, watch = Pool(workers), console.Watch()

    def keep(step: matrix.Progress) -> None:
        results.append(path, step.cells, step.levels)
        watch.show(step)

    try:
        with watch:
            lumped = [
                pool.submit(lumping.lumping, v.blade)
                for c in chosen
                if isinstance(c, Case)
                for v in c.variants
                if v.name == lumping.CASE
            ]
            tried = [pool.submit(table.run, part) for part in _shared_out(seeded, workers)]
            done = matrix.run(chosen, names, pool, keep, added=files)
            levels = done.levels + tuple(level for future in lumped for level in future.result())
            found = {control.control: control for future in tried for control in future.result()}
    except KeyboardInterrupt:
        return results.read(path), False
    except BrokenProcessPool:
        lost = (
            "a worker process was killed, most likely for want of memory: try fewer --workers, or fewer cases at once"
        )
        print(f"southwell: {lost}", file=sys.stderr)
        return results.read(path), False
    finally:
        pool.stop()
    controls = tuple(found[name] for name in seeded)
    run = replace(about, cells=done.cells, levels=levels, controls=controls, shares=done.shares, origins=done.origins)
    ordered = path.with_suffix(".part")
    ordered.unlink(missing_ok=True)
    results.append(ordered, run.cells, run.levels, run)
    ordered.replace(path)
    return run, True


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


def _fresh(out: Path) -> Path:
    try:
        out.mkdir(parents=True, exist_ok=True)
        path = out / RESULTS
        path.write_bytes(b"")
    except OSError as error:
        raise UsageError(f"--out {out}: cannot be written ({error.strerror}): give another folder") from error
    return path


def _junit(run: Run, path: Path) -> None:
    try:
        path.write_bytes(xml.render(run))
    except OSError as error:
        raise UsageError(f"--junit {path}: cannot be written ({error.strerror}): give another file") from error
