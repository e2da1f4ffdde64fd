"""The one error of bad input."""

from collections.abc import Iterable
from difflib import get_close_matches

import numpy as np

from ...core.chain.completeness import MissedModesError
from ...core.chain.lanczos import EigensolverError
from ...core.chain.steady import LargeStrainError, SteadyStateError
from ...core.eigen import UnstableError

NO_STATE = (SteadyStateError, UnstableError, np.linalg.LinAlgError, EigensolverError, MissedModesError)
"""What the solver raises where there is no steady state to vibrate about, or its eigensolver fails."""


class CaseError(ValueError):
    """Input that cannot be used. One line: the file, the field, the value, the likely cause, the remedy."""


class FilesMissingError(CaseError):
    """A case whose blade is in files that do not come with the package."""


def nearest(word: str, known: Iterable[str]) -> str:
    """Advice on a word that is not known: the nearest that is, else all of them."""
    known = tuple(known)
    near = get_close_matches(word, known, 1, cutoff=0.5)
    return f"did you mean {near[0]}?" if near else f"known: {', '.join(known)}"


def unsteady(blade: str, omega: float, error: Exception) -> CaseError:
    """What to raise where the solver finds no stable steady state of a blade at ``omega`` rad/s."""
    if isinstance(error, np.linalg.LinAlgError):
        return CaseError(
            f"{blade}: speed: {omega:g} rad/s: stiffness and mass are out of all proportion: check their units"
        )
    what = str(error).removeprefix(f"omega: {omega:.6g} rad/s: ").removeprefix("omega: ")
    if isinstance(error, (EigensolverError, MissedModesError, LargeStrainError)):
        remedy = " (--allow-large-strain)" if isinstance(error, LargeStrainError) else ""
        return CaseError(f"{blade}: speed: {omega:g} rad/s: {what}{remedy}")
    if not omega:
        cause = "does nothing hold a hinge at rest? give speeds above 0; are values too far apart? check units"
        return CaseError(f"{blade}: at rest: the stiffness is not positive definite: {cause}")
    remedy = "hold the hinge, or give lower speeds" if "hinge" in what else "give lower speeds"
    return CaseError(f"{blade}: speed: {omega:g} rad/s: {what}: {remedy}")
