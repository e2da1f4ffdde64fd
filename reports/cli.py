"""The command line: bad input is one line on standard error and status 2, never a traceback."""

import os
import re
import shlex
import sys
from collections.abc import Sequence
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import msgspec
import numpy as np
from cyclopts import App, CycloptsError, Parameter, Token, UnusedCliTokensError
from cyclopts.validators import Number
from rich import box
from rich.table import Table
from threadpoolctl import threadpool_limits

from ..cases import added, library, lumping, matrix, mechanism_case, mechanisms, results
from ..cases.added import Added
from ..cases.errors import CaseError, nearest
from ..cases.mechanism_case import MechanismCase
from ..cases.pool import Pool
from ..cases.results import Run
from ..cases.schema import Case, speed_range
from ..cases.settings import settings
from ..cases.sweep import Named, sweep
from ..references import codes as registry
from ..references import elsewhere
from ..references.codes import UnknownCodeError
from ..references.elsewhere import ENVIRONMENTS
from . import junit as xml
from . import mechanisms as answer
from . import summary, terminal
from .mounting import Mounting
from .units import RAD_S, RPM, Units

PASSED, BAD_INPUT, INTERRUPTED = 0, 2, 130

RESULTS = "results.jsonl"

app = App(
    name="southwell",
    help="""Are these natural frequencies of a rotating blade right?

    One blade through many independent codes, every difference with its uncertainty and its cause.

    Exit status: 0 all within target or explained, 1 something fails or is inconclusive, 2 bad input, 130 interrupted.
    """,
    version=lambda: version("southwell"),
    suppress_keyboard_interrupt=False,
)


def _whole(_: type, tokens: Sequence[Token]) -> int:
    """A whole number as typed (Cyclopts' own conversion rounds 1.5)."""
    try:
        return int(tokens[0].value)
    except ValueError:
        raise ValueError(f"{tokens[0].value!r} is not a whole number: give one, as in 10") from None


Whole = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1))]
Elements = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=20_000))]
"""Of one blade; more than the most are gigabytes and minutes, and change nothing."""

Flag = Annotated[bool, Parameter(negative=())]


class UsageError(ValueError):
    """An argument that cannot be used: names it, its value, the likely cause, the remedy."""


@app.command
def verify(
    *case: str,
    codes: str | None = None,
    out: Path = Path("southwell-report"),
    workers: Whole | None = None,
    add: tuple[str, ...] = (),
    junit: Path | None = None,
) -> int:
    """Solve cases with every code, compare, judge, and write a report.

    Writes results.jsonl (a row a cell), report.md and figures. Status 1 if any cell fails or is inconclusive, or if
    core made wrong on purpose (every run tries) is not caught; interrupted, it keeps and reports what is there, status 130.

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
    """
    chosen = [_chosen(name) for name in dict.fromkeys(case or _all())]
    names = list(dict.fromkeys(codes.split(","))) if codes is not None else list(registry.names())
    known = [registry.code(name) for name in names]
    files = [_added(text) for text in add]
    added.check(files, [v for c in chosen if isinstance(c, Case) for v in c.variants], [c.name for c in known])
    options = [*(["--codes", codes] if codes else []), *(word for text in add for word in ("--add", text))]
    about = Run(
        cells=(),
        versions=matrix.versions({c.name: c.version() for c in known}, files),
        command=shlex.join(["southwell", "verify", *case, *options]),
        settings=tuple(s for c in chosen for s in settings(c)),
    )
    path = _fresh(out)
    results.append(path, run=about)
    run, complete = _solve(chosen, names, files, about, path, workers or os.cpu_count() or 1)
    if run.cells:
        _show(run, out)
        if junit:
            _junit(run, junit)
    if not complete:
        kept = (
            f"the report has the {len(run.cells)} cells that were finished" if run.cells else "nothing was finished yet"
        )
        print(f"southwell: interrupted: {kept}", file=sys.stderr)
        return INTERRUPTED
    return summary.status(run)


def _added(text: str) -> Added:
    name, equals, path = text.partition("=")
    if not (equals and path and re.fullmatch(r"\w[\w .+-]*", name)):
        raise UsageError(f"--add {text}: give a name and a file, as in --add rig=results.csv")
    return added.read(name, Path(path))


def _solve(
    chosen: Sequence[Case | MechanismCase],
    names: Sequence[str],
    files: Sequence[Added],
    about: Run,
    path: Path,
    workers: int,
) -> tuple[Run, bool]:
    """The run, and whether it is complete; rows go to ``path`` as they come, and in order once all are there."""
    pool, watch = Pool(workers), terminal.Watch()

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
            done = matrix.run(chosen, names, pool, keep, added=files)
            levels = done.levels + tuple(level for future in lumped for level in future.result())
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
    run = replace(about, cells=done.cells, levels=levels, controls=done.controls, shares=done.shares)
    ordered = path.with_suffix(".part")
    ordered.unlink(missing_ok=True)
    results.append(ordered, run.cells, run.levels, run)
    ordered.replace(path)
    return run, True


@app.command
def modes(
    case: str,
    /,
    *,
    omega: str | None = None,
    rpm: str | None = None,
    elements: Elements = 50,
    modes: Whole = 10,
    json: Annotated[bool, Parameter(negative=())] = False,
    mounting: Mounting | None = None,
) -> int:
    """Natural frequencies by the in-house solver, with their families.

    Parameters
    ----------
    case
        A case by name (`southwell cases`), one of its blades as `case/blade`, or its TOML file; or a blade's file: ElastoDyn,
        BeamDyn, BModes, HAWC2, windIO, or Southwell's own TOML and CSV.
    omega
        Rotor speed in rad/s, or a range `first:last:step` with both ends; the case's own speeds by default.
    rpm
        The same in revolutions per minute.
    elements
        Beam elements along the blade.
    modes
        How many, from the lowest.
    json
        Print rows as JSON: case, omega_rad_s, mode, name, frequency_rad_s, frequency_hz.
    """
    from . import campbell_subjects  # which itself selects cases by this module

    speeds, units = _speeds(omega, rpm)
    rows: list[dict[str, object]] = []
    for subject in campbell_subjects.subjects(case, (mounting or Mounting()).mount()):
        if speeds is None and not subject.speeds:
            raise UsageError(f"--rpm: missing: {case} says no speeds: give them, as in 0:15:5")
        blade = subject.blade
        found = sweep(blade, subject.speeds if speeds is None else speeds, elements, modes)
        rows += [_tidy(blade.name, row) for row in found]
        if not json:
            title = f"{blade.name}: {len(blade.stations)} stations, {elements} elements"
            terminal.output().print(terminal.frequencies(found, title, units or subject.units))
    if json:
        print(msgspec.json.format(msgspec.json.encode(rows)).decode())
    return PASSED


@app.command
def mechanism(
    name: str,
    /,
    *,
    modes: Whole = 10,
    time: float = 0.0,
    json: Annotated[bool, Parameter(negative=())] = False,
) -> int:
    """Steady state and modes of any mechanism: frequencies, damping ratios, what was chosen, what was redundant.

    Parameters
    ----------
    name
        A mechanism by name (`southwell cases`), or a TOML file of bodies and joints.
    modes
        How many, from the lowest.
    time
        The instant looked at, in seconds, where motions are functions of time.
    json
        Print everything as JSON.
    """
    described = library.mechanism(name)
    found = described.solve(modes, time)
    if json:
        plain = msgspec.json.encode(answer.plain(described.text.name, found))
        print(msgspec.json.format(plain).decode())
        return PASSED
    console = terminal.output()
    console.print(answer.modes(found, described.text.title or described.text.name))
    console.print(answer.state(found))
    console.print(answer.redundant(found), markup=False, soft_wrap=True)
    return PASSED


def _tidy(case: str, row: Named) -> dict[str, object]:
    return {
        "case": case,
        "omega_rad_s": row.omega,
        "mode": row.mode,
        "name": row.name,
        "frequency_rad_s": row.frequency,
        "frequency_hz": row.frequency / (2 * np.pi),
    }


def _speeds(omega: str | None, rpm: str | None) -> tuple[Sequence[float] | None, Units | None]:
    if omega is not None and rpm is not None:
        raise UsageError(f"--omega {omega} and --rpm {rpm}: the speed is given twice: give one of them")
    if omega is None and rpm is None:
        return None, None
    option, text, units = ("--omega", omega, RAD_S) if omega is not None else ("--rpm", rpm, RPM)
    try:
        return (speed_range(text or "") / units.speeds).tolist(), units
    except ValueError as error:
        raise UsageError(f"{option}: {error}") from error


@app.command
def report(folder: Path, /, *, html: Flag = False, pdf: Flag = False) -> int:
    """Write report.md and figures anew from the results.jsonl in a folder.

    Parameters
    ----------
    folder
        What `southwell verify --out` was given.
    html
        Also report.html, one file with the figures inside it.
    pdf
        Also report.pdf; needs the extra `pdf` (WeasyPrint).
    """
    written = _show(_results(folder), folder)
    if html or pdf:
        from . import html as page

        if html:
            print(page.write(written))
        if pdf:
            try:
                print(page.pdf(written))
            except page.PdfError as error:
                raise UsageError(str(error)) from error
    return PASSED


def _results(folder: Path) -> Run:
    """The results in a report's folder."""
    path = folder / RESULTS
    try:
        run = results.read(path)
    except FileNotFoundError:
        raise UsageError(f"{path}: no such file: give a folder that `southwell verify --out` has written") from None
    except OSError as error:
        remedy = "give a folder that `southwell verify --out` has written"
        raise UsageError(f"{path}: cannot be read ({error.strerror}): {remedy}") from error
    except ValueError as error:
        raise UsageError(str(error)) from error
    if not run.cells:
        raise UsageError(f"{path}: no results in it: the run was cut short before its first; run `southwell verify`")
    return run


@app.command
def cases() -> int:
    """List the cases that come with the package."""
    table = Table(box=box.SIMPLE_HEAD)
    for head in ("case", "what", "blades", "speeds"):
        table.add_column(head, overflow="fold")
    absent = library.absent()
    for name in library.names():
        if name in absent:
            table.add_row(name, absent[name], "", "")
            continue
        known = library.load(name)
        first, *_ = settings(known)
        blades = ", ".join(v.name.partition("/")[2] for v in known.variants) if len(known.variants) > 1 else "1"
        table.add_row(name, known.text.title, blades, first.facts["speeds"])
    for name in library.mechanisms():
        told = mechanism_case.setting(mechanism_case.case(library.mechanism(name)))
        table.add_row(name, told.title, "mechanism", told.facts["speeds"])
    terminal.output().print(table)
    return PASSED


listing = App(name="codes", result_action="return_value")
app.command(listing)


@listing.default
def codes(*, pages: Path | None = None) -> int:
    """List the codes: found or not, version, what each shares with core, how to install it.

    Parameters
    ----------
    pages
        Folder of a report (`southwell verify --out`): write a page for each code into it instead, with its worst
        difference on every blade and its known defects, shown by running them.
    """
    if pages:
        from . import code_pages

        print(code_pages.write(_results(pages), pages))
        return PASSED
    table = Table(box=box.SIMPLE_HEAD)
    for head in ("code", "title", "version", "shares with core", "leaves out"):
        table.add_column(head, overflow="fold")
    for name in registry.names():
        known = registry.code(name)
        found = known.version()
        table.add_row(
            known.name,
            known.title,
            f"✔ {found}" if found else f"○ not found; {known.hint}",
            known.shares,
            ", ".join(known.model.lacks()) or "nothing",
        )
    terminal.output().print(table)
    return PASSED


@listing.command
def install(code: str, /) -> int:
    """Make a pinned environment in the cache for a code whose dependencies conflict with ours; status 1 if it cannot be made.

    Parameters
    ----------
    code
        Its name; `southwell codes` says which need this.
    """
    if code not in ENVIRONMENTS:
        raise UsageError(f"code: {code!r}: no environment of its own: {nearest(code, list(ENVIRONMENTS))}")
    try:
        folder = elsewhere.install(ENVIRONMENTS[code])
    except elsewhere.EnvironmentMissingError as error:
        print(f"southwell: {error}", file=sys.stderr)
        return 1
    print(f"{code} {ENVIRONMENTS[code].version()} in {folder}")
    return PASSED


app.command(f"{__package__}.campbell_command:command", name="campbell")
app.command(f"{__package__}.bench:command", name="bench")
app.command(f"{__package__}.condense:command", name="condense")
app.command(f"{__package__}.closed_forms_page:command", name="closed-forms")
app.command(f"{__package__}.conform:command", name="conform")
app.command(f"{__package__}.show:command", name="show")
app.command(f"{__package__}.convert:command", name="convert")
app.command(f"{__package__}.history_command:app", name="history")
app.command(f"{__package__}.gate_command:command", name="gate")
app.command(f"{__package__}.dashboard_command:command", name="dashboard")


def _chosen(name: str) -> Case | MechanismCase:
    """A case of blades or of a mechanism, by name or file."""
    if name in library.mechanisms() or (name.endswith(".toml") and mechanisms.is_one(Path(name))):
        return mechanism_case.case(library.mechanism(name))
    return select(name)


def _all() -> tuple[str, ...]:
    """Every case and mechanism whose files are there; what is not is said."""
    absent = library.absent()
    for name, why in absent.items():
        print(f"southwell: {name}: not run: {why}", file=sys.stderr)
    return (*(name for name in library.names() if name not in absent), *library.mechanisms())


def select(name: str) -> Case:
    """A case by name or file, or with only one of its blades: ``park-blade/surrogate``.

    Raises:
        CaseError: if there is no such case or blade.
    """
    stem, _, blade = name.partition("/")
    if name.endswith(".toml") or not blade:
        return library.load(name)
    case = library.load(stem)
    kept = tuple(v for v in case.variants if v.name == name)
    if not kept:
        raise CaseError(f"case: {name!r}: no such blade: {nearest(name, [v.name for v in case.variants])}")
    return replace(case, variants=kept)


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


def _show(run: Run, folder: Path) -> Path:
    """Write the report, print what it says first; the report's path."""
    from . import markdown  # with its figures half of a command's time to start, and of every worker's

    report = markdown.write(run, folder)
    console = terminal.output()
    for line in markdown.headline(run):
        console.print(line.replace("**", ""), markup=False)
    for table in terminal.matrix(run, console.width):
        console.print(table)
    console.print(terminal.legend(), style="dim", markup=False)
    if run.controls:
        console.print(terminal.controls(run))
    console.print(f"{report}, {folder / RESULTS}", markup=False, soft_wrap=True)
    return report


def main(arguments: Sequence[str] | None = None) -> None:
    """The entry point; ends the process with the command's status."""
    if "" not in sys.path:
        sys.path.append("")  # a code named by its import path may lie in the current folder, as python -m finds it
    try:
        with threadpool_limits(1):  # matrices are small: threads would wait for each other
            status = app(arguments, exit_on_error=False, print_error=False, result_action="return_value") or PASSED
        sys.stdout.flush()
    except UnusedCliTokensError as error:
        words = " ".join(error.unused_tokens or ())
        print(
            f"southwell: {words}: not understood here: more words than the command takes; see --help", file=sys.stderr
        )
        status = BAD_INPUT
    except (CycloptsError, CaseError, UnknownCodeError, UsageError) as error:
        print(f"southwell: {' '.join(str(error).split())}", file=sys.stderr)
        status = BAD_INPUT
    except KeyboardInterrupt:
        print("southwell: interrupted", file=sys.stderr)
        status = INTERRUPTED
    except BrokenPipeError:  # the reader of a pipe has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = PASSED
    sys.exit(status)
