"""Types of arguments, and access to the results of a run, for several commands."""

import os
import shlex
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter, Token
from cyclopts.validators import Number

from ...cases.input.errors import CaseError
from ...cases.input.writing import writable
from ...cases.judge.results import Run
from ...cases.run.cluster import SLURM
from ...cases.store import results_file, unfinished
from ...cases.store.results_file import RESULTS
from .errors import IncompleteError, UsageError


def _whole(_: type, tokens: Sequence[Token]) -> int:
    """Convert a whole number as typed (the conversion of Cyclopts rounds 1.5)."""
    try:
        return int(tokens[0].value)
    except ValueError:
        raise ValueError(f"{tokens[0].value[:40]!r} is not a whole number: give one, as in 10") from None


Whole = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=1_000_000))]
Count = Annotated[int, Parameter(converter=_whole, validator=Number(gte=0))]
NumberOfModes = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=1000))]
Workers = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=1024))]

Elements = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=20_000))]
"""Number of beam elements of a blade; more than the limit take gigabytes and minutes without a change of the result."""

Positive = Annotated[float, Parameter(validator=Number(gt=0, lte=86_400))]
"""A time in days or seconds, or memory in GiB."""

Accuracy = Annotated[float, Parameter(validator=Number(gte=1e-12, lte=0.1))]
"""A relative uncertainty."""

CONTINUE = "run the same `southwell verify` again, which continues where it was stopped"
"""The remedy for an incomplete run."""

Changes = Annotated[tuple[str, ...], Parameter(name="--set", consume_multiple=False)]
"""Changes of a blade's properties, each as ``NAME=*FACTOR``."""


@contextmanager
def writing(out: Path) -> Iterator[None]:
    """Create and lock the output folder ``out`` while a command writes in it.

    Raises:
        CaseError: if it cannot be created or written, or another process is writing in it.
    """
    with ExitStack() as stack:
        with writable(f"--out {out}"):
            out.mkdir(parents=True, exist_ok=True)
            stack.enter_context(unfinished.locked(out))
        yield


def finished(path: Path) -> Run:
    """Read the complete run in a report's folder, or in its results file.

    Raises:
        CaseError: if there is none.
        IncompleteError: if it is not complete.
    """
    run = run_in(path)
    if run.unfinished:
        raise IncompleteError(f"{path}: incomplete: {run.unfinished}: {CONTINUE}")
    return run


def run_in(path: Path) -> Run:
    """Read the run in a report's folder, or in its results file; from a folder the latest run, complete or not.

    Raises:
        CaseError: if there is none.
        IncompleteError: if it has no cell.
    """
    file = path
    if os.path.isdir(path):
        file = path / unfinished.NAME if (path / unfinished.NAME).exists() else path / RESULTS
    try:
        run = unfinished.read(file) if file.name == unfinished.NAME else results_file.read(file)
    except OSError as error:
        message = f"cannot be read ({error.strerror}): give a folder that `southwell verify --out` has written"
        raise CaseError(f"{file}: {message}") from error
    except ValueError as error:
        raise CaseError(str(error)) from error
    if not run.cells and run.unfinished:
        raise IncompleteError(f"{file}: incomplete: contains no results: {CONTINUE}")
    if not run.cells:
        raise CaseError(f"{file}: contains no results: run `southwell verify`")
    return run


def cluster_workers(workers: int | None, scheduler: str | None) -> int | None:
    """The number of workers to start; None if those of a running Dask scheduler are used.

    Raises:
        UsageError: if the number is given for a running scheduler, or missing for Slurm.
    """
    if scheduler is None:
        return workers or os.cpu_count() or 1
    if scheduler == SLURM and workers is None:
        raise UsageError(f"--scheduler {SLURM}: --workers: missing: give the number of workers, as in --workers 16")
    if scheduler != SLURM and workers is not None:
        raise UsageError(f"--workers {workers}: the workers of {scheduler} are used: leave it out")
    return workers


def typed() -> str:
    """The command as typed."""
    return shlex.join(["southwell", *sys.argv[1:]])
