"""``southwell study``: sampled properties of blades, solved at many speeds on one machine or a cluster."""

import sys
from concurrent.futures import BrokenExecutor
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter
from msgspec import UNSET

from ....cases.input.writing import writable
from ....cases.run.executors import executor
from ....cases.study import parquet
from ....cases.study.journal import JournalError, StudyJournal, read
from ....cases.study.plan import Header, header
from ....cases.study.run import run
from ....cases.study.schema import Study
from ....cases.study.schema import read as read_study
from ....cases.study.statistics import Outcome, outcome, spreads
from ...shared import not_used
from ...shared.console import Counter, output
from ...shared.sheets import Sheet, terminal
from ...shared.statuses import FAILED, INCOMPLETE, INTERRUPTED, PASSED
from ...shared.units import RAD_S, RPM
from ..arguments import Workers, cluster_workers
from ..errors import UsageError

SUFFIX = ".jsonl"

ROUNDING = 1e-12
"""Relative standard deviation that is rounding: no sampled property acts on the mode."""


def command(
    study: Path,
    /,
    *,
    out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("study.jsonl"),
    workers: Workers | None = None,
    scheduler: str | None = None,
    summary: bool = False,
) -> int:
    """Solve sampled variants of blades at many speeds.

    One row per blade, sample, speed and mode is written to a JSON Lines file as soon as the sample is solved. A study that was
    interrupted (status 130) or killed (status 3) continues with the same command. The status is 1 if a sample has no frequency
    at a speed; its row has the reason.

    Parameters
    ----------
    study
        Study file (TOML): blades, speeds, modes, samples, seed, and the distribution of each sampled property.
    out
        Output file: `.jsonl`, or `.parquet`, which is written from the `.jsonl` file of the same name when the study is
        complete.
    workers
        Number of worker processes, or of Slurm workers. Default: one per processor.
    scheduler
        Address of a Dask scheduler, for example `tcp://host:8786`, or `slurm` with `--workers`. Default: processes of this
        machine.
    summary
        Print mean, standard deviation and percentiles of every frequency over the samples.
    """
    if out.suffix not in (SUFFIX, parquet.SUFFIX):
        raise UsageError(f"--out {out}: neither JSON Lines nor Parquet: end it with .jsonl or .parquet")
    count = cluster_workers(workers, scheduler)
    if out.suffix == parquet.SUFFIX:
        parquet.library(out)  # before the first answer
    request, unused = read_study(study)
    not_used.show(unused, output())
    head, path = header(request), out.with_suffix(SUFFIX)
    with writable(f"--out {path}", "file"):
        opened_journal = StudyJournal(path, head)
    with opened_journal as journal:
        stopped = _run(request, journal, count, scheduler)
        if stopped:
            progress = f"{sum(journal.done)} of {head.tasks} samples are in {path}"
            print(f"southwell: {stopped[0]}: {progress}; the same command continues", file=sys.stderr)
            return stopped[1]
        if out != path:
            parquet.write(out, path, head)
        result = outcome(read(path))
        if summary:
            console = output()
            console.print(terminal(_sheet(path, request), console.width))
    output().print(f"{out}: {_said(result, head)}", markup=False, soft_wrap=True)
    return FAILED if result.missing else PASSED


def _run(study: Study, journal: StudyJournal, workers: int | None, scheduler: str | None) -> tuple[str, int] | None:
    """Run a study; return why it stopped before its end and the exit status, or None."""
    if all(journal.done):
        return None
    counter = Counter("samples", journal.header.tasks)
    try:
        with counter, executor(workers, scheduler, report=counter.report) as pool:
            run(study, pool, journal, counter.show)
    except KeyboardInterrupt:
        return "interrupted", INTERRUPTED
    except BrokenExecutor as error:
        return f"workers are lost ({error})", INCOMPLETE
    except JournalError as error:
        return f"{error.filename}: {error.strerror}", INCOMPLETE
    return None


def _said(result: Outcome, head: Header) -> str:
    message = f"{result.frequencies} frequencies of {head.tasks} samples at {len(head.speeds_rad_s)} speeds"
    if result.missing:
        message += f"; {result.missing} speeds of samples without one (first: {result.reason})"
    if result.internal:
        message += f"; {result.internal} of these are internal errors: please report them"
    return message


def _sheet(path: Path, study: Study) -> Sheet:
    units = RAD_S if study.text.speeds.rpm is UNSET else RPM
    head = ("blade", "speed", "mode", "name", "samples", f"mean, {units.frequency}", "std. deviation", "5 %", "95 %")
    rows = []
    for blade, omega, mode, name, samples, *numbers in spreads(read(path)).itertuples(index=False):
        mean, deviation, *limits = (value * units.frequencies for value in numbers)
        deviation_text = f"{deviation:.3g}" if deviation > ROUNDING * mean else "0"
        rows.append(
            (
                blade,
                units.at(omega),
                str(mode),
                name,
                str(samples),
                f"{mean:.6g}",
                deviation_text,
                *(f"{f:.6g}" for f in limits),
            )
        )
    note = "A mode is a number in the order of each sample; its name is the most frequent one."
    return Sheet("Frequencies over the samples", head, tuple(rows), note, keys=4)
