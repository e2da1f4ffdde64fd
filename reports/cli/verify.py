"""``southwell verify``: solves cases with every code, compares and judges the results, and writes a report."""

import os
import shlex
import shutil
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from ...cases.faults import table
from ...cases.input import atomic
from ...cases.input.changes import parse
from ...cases.input.library import is_blade_file
from ...cases.input.readers import Mount
from ...cases.input.schema import Case
from ...cases.judge.results import Run, Setting
from ...cases.run.executors import executor
from ...cases.run.software import Software
from ...cases.store.unfinished import Unfinished
from ...cases.verify import matrix, user_results
from ...cases.verify import names as names_of
from ...cases.verify.settings import NOT_USED, settings
from ...references.protocol import launch, registry, store
from ...references.protocol.description import describe
from ...references.protocol.process import Limits
from ...references.protocol.store import Store
from ..ci import junit as xml
from ..shared import summary
from ..shared.statuses import INCOMPLETE
from ..shared.writing import writable
from . import campbell_options, measured
from .arguments import CONTINUE, Changes, Count, Positive, Workers, cluster_workers, writing
from .errors import UsageError
from .mounting import Mounting
from .report import show
from .verify_cases import Decks, case_of, changed, everything
from .verify_run import SCRATCH, Stopped, said, solve

SHARES = 8
"""Largest number of tasks for the seeded faults on a cluster, whose number of workers may change."""


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
    kept_before = _store(fresh)
    with ExitStack() as early:
        if kept_before:
            early.callback(kept_before.close)
        launch.prepare()  # for ``describe``, while the cases are read
        decks = Decks(campbell_options.speeds(rpm, omega), (mounting or Mounting()).mount())
        given = [parse(text) for text in changes]
        wanted = [case_of(name, decks) for name in dict.fromkeys(case)] if case else everything()
        chosen = [changed(one, given) for one in wanted]
        if not any(is_blade_file(name) for name in case) and (decks.speeds or decks.mount != Mount()):
            raise UsageError(
                "--rpm, --omega, --length and the like are for blade files: a case defines its speeds and mounting"
            )
        names = list(dict.fromkeys(codes.split(","))) if codes is not None else list(registry.names())
        blades = [v for c in chosen if isinstance(c, Case) for v in c.variants]
        known = describe(names, [v.blade for v in blades])
        defaults = measured.defaults(data_uncertainty, input_uncertainty)
        files = [measured.user_results(text, defaults) for text in add]
        measured.check(files, data_uncertainty, input_uncertainty)
        names_of.unique(chosen, known, files)
        user_results.check(files, blades, [c.name for c in known])
        options = [*(["--codes", codes] if codes else []), *(word for text in add for word in ("--add", text))]
        options += [*(["--data-uncertainty", data_uncertainty] if data_uncertainty else [])]
        options += [*(["--input-uncertainty", input_uncertainty] if input_uncertainty else [])]
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
        limits = {"seconds": time_limit, "memory": int(memory_limit * 2**30), "reuse": kept_before is not None}
        software = Software(
            tuple(sorted({c.distribution for c in known} - {""})), tuple(c.asked for c in known if not c.failure)
        )
        with writing(out), ExitStack() as started:
            started.callback(shutil.rmtree, out / SCRATCH, ignore_errors=True)  # after the processes have ended
            pool = started.enter_context(executor(count, scheduler, (out / SCRATCH).resolve(), software, _report))
            with writable(f"--out {out}"):
                opened = Unfinished(out)
            with opened as kept:
                run, stopped = solve(
                    chosen, known, files, about, kept, out, pool, started.close, seeded, limits, kept_before
                )
                try:
                    if run.cells:
                        show(run, out, None if stopped or scheduler else pool)
                        if junit:
                            with writable(f"--junit {junit}", "file"):
                                atomic.write(junit, xml.render(run))
                except OSError as error:
                    stopped = stopped or Stopped(said(error), INCOMPLETE)
                if not stopped:
                    kept.remove()
                    return summary.status(run)
    what = f"{len(run.cells)} cells are kept" if run.cells else "no cell was finished"
    print(f"southwell: {stopped.what}: {what}; {CONTINUE}", file=sys.stderr)
    return stopped.status


def _required(setting: Setting, witnesses: int | None, whole: bool) -> Setting:
    """The setting with the required number of groups: as given, or as in the case if all codes take part."""
    if witnesses is None and whole:
        return setting
    return replace(setting, groups=witnesses or 0, lacking="")


def _store(fresh: bool) -> Store | None:
    """Open the store of answers; None if it is not wanted, which the processes of codes learn too, or cannot be used."""
    if fresh:
        os.environ[store.FRESH] = "1"
    if os.environ.get(store.FRESH):
        return None
    try:
        return store.users()
    except OSError as error:
        print(f"southwell: the store of answers is not used: {said(error)}", file=sys.stderr)
        return None


def _shared_out(names: Sequence[str], parts: int) -> list[Sequence[str]]:
    """Distribute faults over tasks; neighbours stay together, because they are tried on the same case."""
    size = -(-len(names) // parts)
    return [names[k : k + size] for k in range(0, len(names), size)] if names else []


def _report(line: str) -> None:
    print(f"southwell: {line}", file=sys.stderr)
