"""The distance that a mode must keep from n per revolution, as a user writes it: ``10%``, ``0.1`` or ``5Hz``."""

import re
from dataclasses import dataclass
from math import pi

from ..input.errors import CaseError

UNITS = {"Hz": 2.0 * pi, "rad/s": 1.0}
"""rad/s in a unit of distance."""


@dataclass(frozen=True)
class RequiredMargin:
    """Required distance between a natural frequency and n per revolution.

    Attributes:
        value: the distance, relative to n per revolution, or in rad/s.
        unit: unit in which an absolute distance was given; empty for a relative one.
    """

    value: float
    unit: str = ""

    def distance(self, excitation: float) -> float:
        """The required distance from an excitation frequency (rad/s), rad/s."""
        return self.value if self.unit else self.value * excitation

    def __str__(self) -> str:
        return f"{self.value / UNITS[self.unit]:.4g} {self.unit}" if self.unit else f"{100 * self.value:.3g} %"


TEN_PERCENT = RequiredMargin(0.1)
"""The margin of Park et al. (2010)."""


def required_margin(text: str | float, option: str = "margin") -> RequiredMargin:
    """Read a margin: ``10%``, ``10`` (1 and above is a percentage), ``0.1``, ``5Hz`` or ``30rad/s``.

    Raises:
        CaseError: another text, naming the ``option``.
    """
    read = re.fullmatch(r"\s*(\S+?)\s*(%|Hz|rad/s)?\s*", str(text))
    try:
        value = float(read[1]) if read else float("nan")
    except ValueError:
        read, value = None, float("nan")
    if not read:
        raise CaseError(
            f"{option}: {text!r} is neither a percentage, a fraction nor a frequency, as in 10%, 0.1 or 5Hz"
        ) from None
    unit = read[2] or ""
    if unit in UNITS:
        if not 0 <= value < 1e9:
            raise CaseError(f"{option}: {text!r}: needs a positive distance, as in 5Hz")
        return RequiredMargin(value * UNITS[unit], unit)
    value *= 0.01 if unit or value >= 1 else 1.0
    if not 0 <= value < 1:
        raise CaseError(f"{option}: {text!r}: needs 0 to 100 % of n per revolution, as in 10% or 0.1")
    return RequiredMargin(value)
