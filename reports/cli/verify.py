"""``southwell verify``: cases through every code, compared, judged, reported."""

import os
import re
import shlex
import sys
from collections.abc import Sequence
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, replace
from pathlib import Path

from msgspec.structs import replace as replaced

from ...cases.faults import table
from ...cases.input import changes as blade_changes
from ...cases.input import library, mechanisms
from ...cases.input.changes import Change, parse
from ...cases.input.default_case import default_case
from ...cases.input.readers import Mount
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
from ..shared.units import RPM, Units
from . import campbell_options
from .arguments import RESULTS, Changes, Count, Whole
from .exit_status import INTERRUPTED, UsageError
from .mounting import Mounting
from .report import show
from .subjects import is_blade_file, subjects


def command(
    *case: str,
    codes: str | None = None,
    out: Path = Path("southwell-report"),
    workers: Whole | None = None,
    add: tuple[str, ...] = (),
    junit: Path | None = None,
    faults: str = "fast",
    witnesses: Count | None = None,
    rpm: str | None = None,
    omega: str | None = None,
    changes: Changes = (),
    mounting: Mounting | None = None,
) -> int:
    """Solve blades with every code, compare the results and write a report.

    Writes results.jsonl (one row per cell), report.md and figures. Status 1 if a cell fails or is inconclusive, if nothing was
    compared, if fewer independent groups confirm a blade than its case requires, or if a seeded fault is not detected. An
    interrupted run keeps and reports what is finished; status 130.

    Parameters
    ----------
    case
        Blade files (ElastoDyn, BeamDyn, BModes, HAWC2, windIO), cases by name (`southwell cases`), one blade of a case as
        `case/blade`, or case files (TOML). Default: all cases. Of a blade file, the lowest six modes are compared.
    codes
        Names separated by commas (`southwell codes`), or import paths `module:attribute`. Default: all codes.
    out
        Output folder; results of an earlier run in it are replaced.
    workers
        Worker processes (default: one per processor).
    add
        `NAME=FILE.csv`: results of another program or of a test rig as one more column; may be repeated. Columns of the file:
        `speed [rpm]` (or rad/s, gamma), `frequency [Hz]` (or rad/s, gamma), `mode` (flapwise 1, or a number).
    junit
        Output file for JUnit XML, one test case per cell.
    faults
        Seeded faults to run: `fast` (seven), `all`, `none`, or names separated by commas.
    witnesses
        Number of independent groups that must confirm each blade. Default: as the case says; none with `--codes`.
    rpm
        Rotor speeds of a blade file in rpm: a range `first:last:step` or a list `0,5,10`.
    omega
        Rotor speeds of a blade file in rad/s, in the same form.
    changes
        Change a property of every blade: `EI_flap=*1.1`, also EI_edge, GJ, EA, mass, tip_mass, twist, hub_radius, precone,
        pitch. May be repeated.
    """
    decks = _Decks(campbell_options.speeds(rpm, omega), (mounting or Mounting()).mount())
    given = [parse(text) for text in changes]
    chosen = [_changed(_chosen(name, decks), given) for name in dict.fromkeys(case or everything())]
    if not any(is_blade_file(name) for name in case) and (decks.speeds or decks.mount != Mount()):
        raise UsageError(
            "--rpm, --omega, --length and the like are for blade files: a case says its own speeds and mounting"
        )
    names = list(dict.fromkeys(codes.split(","))) if codes is not None else list(registry.names())
    known = [registry.code(name) for name in names]
    files = [_added(text) for text in add]
    user_results.check(files, [v for c in chosen if isinstance(c, Case) for v in c.variants], [c.name for c in known])
    options = [*(["--codes", codes] if codes else []), *(word for text in add for word in ("--add", text))]
    plain = not (rpm or omega or changes or decks.mount != Mount())
    line = ["southwell", "verify", *case, *options] if plain else ["southwell", *sys.argv[1:]]
    about = Run(
        cells=(),
        versions=matrix.versions(known, files),
        command=shlex.join(line),
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
    if not (equals and path and re.fullmatch(r"\w[\w .+-]*", name)):
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
        lost = "a worker process was killed, probably out of memory: use fewer --workers or fewer cases at once"
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


@dataclass(frozen=True)
class _Decks:
    """What is said of blade files beside their names: rotor speeds and their unit, and how they are mounted."""

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
    """The case with properties of its blades changed, which its printed tables are not about."""
    if not given:
        return case
    if not isinstance(case, Case):
        raise UsageError(f"--set {given[0]}: {case.name} is a mechanism, not a blade: leave it out")
    told = "changed: " + ", ".join(str(change) for change in given)
    text = replaced(
        case.text,
        title=f"{case.text.title}; {told}",
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
