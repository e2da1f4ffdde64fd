"""What the commands take and give back: whole numbers, flags, a case by name or file, how bad input is told."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter, Token
from cyclopts.validators import Number

from ...cases.input.errors import CaseError
from ...cases.judge import results
from ...cases.judge.results import Run

PASSED, BAD_INPUT, INTERRUPTED = 0, 2, 130

RESULTS = "results.jsonl"


def _whole(_: type, tokens: Sequence[Token]) -> int:
    """A whole number as typed (Cyclopts' own conversion rounds 1.5)."""
    try:
        return int(tokens[0].value)
    except ValueError:
        raise ValueError(f"{tokens[0].value[:40]!r} is not a whole number: give one, as in 10") from None


Whole = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=1_000_000))]
Count = Annotated[int, Parameter(converter=_whole, validator=Number(gte=0))]
Workers = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=1024))]

Elements = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=20_000))]
"""Of one blade; more than the most are gigabytes and minutes, and change nothing."""

Accuracy = Annotated[float, Parameter(validator=Number(gte=1e-12, lte=0.1))]
"""A relative uncertainty."""

Flag = Annotated[bool, Parameter(negative=())]


class UsageError(ValueError):
    """An argument that cannot be used: names it, its value, the likely cause, the remedy."""


def finished(path: Path) -> Run:
    """The run in a report's folder, or in its results file.

    Raises:
        CaseError: if there is none.
    """
    file = path / RESULTS if os.path.isdir(path) else path
    try:
        run = results.read(file)
    except OSError as error:
        told = f"cannot be read ({error.strerror}): give a folder that `southwell verify --out` has written"
        raise CaseError(f"{file}: {told}") from error
    except ValueError as error:
        raise CaseError(str(error)) from error
    if not run.cells:
        raise CaseError(f"{file}: no results in it: the run was cut short before its first; run `southwell verify`")
    return run
