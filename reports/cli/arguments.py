"""Types of arguments, and the finished run that several commands read."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter, Token
from cyclopts.validators import Number

from ...cases.input.errors import CaseError
from ...cases.judge import results
from ...cases.judge.results import Run

RESULTS = "results.jsonl"


def _whole(_: type, tokens: Sequence[Token]) -> int:
    """A whole number as typed (Cyclopts' own conversion rounds 1.5)."""
    try:
        return int(tokens[0].value)
    except ValueError:
        raise ValueError(f"{tokens[0].value!r} is not a whole number: give one, as in 10") from None


Whole = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1))]
Count = Annotated[int, Parameter(converter=_whole, validator=Number(gte=0))]
Elements = Annotated[int, Parameter(converter=_whole, validator=Number(gte=1, lte=20_000))]
"""Of one blade; more than the most are gigabytes and minutes, and change nothing."""

Accuracy = Annotated[float, Parameter(validator=Number(gte=1e-12, lte=0.1))]
"""A relative uncertainty."""

Flag = Annotated[bool, Parameter(negative=())]

Changes = Annotated[tuple[str, ...], Parameter(name="--set", negative=(), show_default=False, consume_multiple=False)]
"""Changes of a blade's properties, each as ``NAME=*FACTOR``."""


def finished(path: Path) -> Run:
    """The run in a report's folder, or in its results file.

    Raises:
        CaseError: if there is none.
    """
    file = path / RESULTS if path.is_dir() else path
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
