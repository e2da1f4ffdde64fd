"""Formats numbers with the digits that their uncertainty allows, and remarks on the accuracy of frequencies."""

import math
from collections.abc import Sequence

from ...cases.campbell.sweep import NamedMode
from ...core.element.measures import LARGE_STRAIN
from .units import Units

NUMERICAL = (
    "± relative is the numerical uncertainty (mesh and rounding). The interpretation of a blade file (axes, interpolation, "
    "missing data) can change frequencies by orders of magnitude more."
)
"""The meaning of the uncertainty of a frequency, for a blade from a file."""

DIGITS = 7
"""Largest number of digits of a frequency."""


def certain(value: float, uncertainty: float, digits: int = DIGITS) -> str:
    """A number with the digits that a relative uncertainty allows, at most ``digits``; ``?`` if no digit is certain."""
    if not uncertainty < 0.5:
        return "?"
    if value == 0.0:
        return "0"
    size = abs(value)
    last = math.floor(math.log10(size)) - digits + 1
    if uncertainty > 0:
        last = max(last, math.ceil(math.log10(size * uncertainty)))
    return f"{round(value, -last):.{max(-last, 0)}f}".replace("-", "−")


def relative(uncertainty: float) -> str:
    """A relative uncertainty as text, such as ``3e-07``."""
    return f"{uncertainty:.0e}" if math.isfinite(uncertainty) else "unknown"


def remarks(rows: Sequence[NamedMode], accuracy: float | None, units: Units) -> list[str]:
    """Remarks on large steady strains, and on an ``accuracy`` (relative) that was not reached."""
    out = []
    strained = {r.omega: r.strain for r in rows if r.strain > LARGE_STRAIN}
    if strained:
        omega, strain = max(strained.items(), key=lambda item: item[1])
        out.append(
            f"steady strain up to {strain:.1%} at {units.at(omega)}: above {LARGE_STRAIN:.0%}, check that linear elastic "
            "sections describe the blade"
        )
    worst = max(rows, key=lambda r: r.uncertainty, default=None)
    if worst and accuracy is not None and worst.uncertainty > accuracy:
        out.append(
            f"accuracy {accuracy:g} not reached: {worst.name} at {units.at(worst.omega)} is known to {worst.uncertainty:.0e}"
        )
    return out
