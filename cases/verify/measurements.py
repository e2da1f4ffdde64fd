"""``--add`` and the uncertainties of its data, for the commands that take measurements."""

import re
from collections.abc import Sequence
from pathlib import Path

from ..input.errors import CaseError
from ..plan import linearised
from ..plan.user_results import Defaults, UserResults, read


def defaults(data: str | None, inputs: str | None) -> Defaults:
    """Convert ``--data-uncertainty`` and ``--input-uncertainty``."""
    return Defaults(
        data=_percent("--data-uncertainty", data) if data is not None else None,
        inputs=_percent("--input-uncertainty", inputs) if inputs is not None else 0.0,
    )


def _percent(option: str, text: str) -> float:
    try:
        value = float(text.removesuffix("%")) / 100.0
    except ValueError:
        raise CaseError(f"{option}: {text!r} is not a percentage: give one standard uncertainty, as in 1%") from None
    if not 0.0 < value <= 1.0:
        raise CaseError(
            f"{option}: {text!r}: needs more than 0 and at most 100 %: give one standard uncertainty, as in 1%"
        )
    return value


def user_results(text: str, u: Defaults) -> UserResults:
    """Read the file of one ``--add``.

    Raises:
        CaseError: if it does not have the form NAME=FILE.csv, or the file cannot be used.
    """
    name, equals, path = text.partition("=")
    if not (equals and path and re.fullmatch(r"\w[\w .+-]{0,99}", name)):
        raise CaseError(f"--add {text}: give a name and a file, as in --add rig=results.csv")
    return linearised.read(name, path) if linearised.matches(path) else read(name, Path(path), u)


def check(files: Sequence[UserResults], data: str | None, inputs: str | None) -> None:
    """Reject an uncertainty option that applies to no file.

    Raises:
        CaseError: if an uncertainty is given and no file has measurements.
    """
    for option, uncertainty in (("--data-uncertainty", data), ("--input-uncertainty", inputs)):
        if uncertainty is not None and not any(results.measured for results in files):
            raise CaseError(
                f"{option}: {uncertainty}: no file of --add has measured frequencies: name their column 'measured [Hz]'"
            )
