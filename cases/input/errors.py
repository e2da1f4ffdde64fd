"""The error raised for invalid input."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches

import numpy as np

from ...core.blade_checks import BladeError
from ...core.spectrum.completeness import MissedModesError
from ...core.spectrum.eigen import UnstableError
from ...core.spectrum.lanczos import EigensolverError
from ...core.steady.blade_state import LargeStrainError, SteadyStateError

NO_STATE = (SteadyStateError, UnstableError, np.linalg.LinAlgError, EigensolverError, MissedModesError)
"""Errors of the solver if there is no stable steady state or the eigensolver fails."""


MAX_LINE = 1000
"""Maximum number of characters of a message."""


def brief(message: str) -> str:
    """A message on one line; the middle of a long message is omitted."""
    line = " ".join(message.split())
    return line if len(line) <= MAX_LINE else f"{line[: MAX_LINE * 2 // 3]} … {line[-MAX_LINE // 4 :]}"


class CaseError(ValueError):
    """Input that cannot be used. One line: the file, the field, the value, the likely cause, the remedy."""

    def __init__(self, message: str) -> None:
        super().__init__(brief(message))


class FilesMissingError(CaseError):
    """A case whose blade is in files that are not part of the package."""


@contextmanager
def located(where: str, kind: type[ValueError] = BladeError) -> Iterator[None]:
    """Turn an error of core about its input into the error that begins with the place of the input.

    Raises:
        CaseError: in place of an error of this ``kind``.
    """
    try:
        yield
    except kind as error:
        raise CaseError(f"{where}{error}") from error


def nearest(word: str, names: Iterable[str]) -> str:
    """Suggestion for an unknown word: the nearest known word, else all of them."""
    names = tuple(names)
    matches = get_close_matches(word, names, 1, cutoff=0.5)
    return f"did you mean {matches[0]}?" if matches else f"give one of {', '.join(names)}"


def rad_s(omega: float) -> str:
    """Format a rotor speed in rad/s."""
    return f"{omega:g} rad/s"


def unsteady(blade: str, omega: float, error: Exception, at: Callable[[float], str] = rad_s) -> CaseError:
    """The error to raise if the solver finds no stable steady state of a blade at ``omega`` rad/s.

    ``at`` formats a speed in the unit in which it was given.
    """
    if isinstance(error, np.linalg.LinAlgError):
        return CaseError(
            f"{blade}: speed: {at(omega)}: implausible stiffness-to-mass ratio: use more elements if the blade is a cable, "
            "else check units"
        )
    reason = str(error).removeprefix(f"omega: {omega:.6g} rad/s: ").removeprefix("omega: ")
    reason = reason.replace(f"{omega:.6g} rad/s", at(omega))
    if isinstance(error, (EigensolverError, MissedModesError, LargeStrainError)):
        remedy = " (--allow-large-strain)" if isinstance(error, LargeStrainError) else ""
        return CaseError(f"{blade}: speed: {at(omega)}: {reason}{remedy}")
    return CaseError(f"{blade}: speed: {at(omega)}: {reason}")
