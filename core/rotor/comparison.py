"""Exponents of a periodic system by Floquet's and by Hill's method, always compared."""

from dataclasses import dataclass

import numpy as np

from .exponents import Exponents
from .floquet import distance, floquet
from .hill import hill
from .periodic import Periodic, PeriodicError

LARGEST_DIFFERENCE = 1e-8
"""Difference of the exponents of both methods, as a fraction of Ω, above which neither is returned."""


@dataclass(frozen=True)
class Compared:
    """Exponents by both methods.

    Attributes:
        floquet: from the monodromy matrix.
        hill: from the harmonics.
        difference: largest difference between both, 1/s, up to multiples of iΩ.
    """

    floquet: Exponents
    hill: Exponents
    difference: float


def compared(system: Periodic) -> Compared:
    """The exponents of a periodic system by both methods.

    Raises:
        PeriodicError: a method does not accept the system or does not converge, or they differ by more than their errors and
            ``LARGEST_DIFFERENCE``.
    """
    by_integration, by_harmonics = floquet(system), hill(system)
    omega = abs(system.omega)
    distances = distance(by_integration.multipliers, by_harmonics.multipliers) * omega / (2.0 * np.pi)
    difference = float(distances.max(initial=0.0))
    allowed = max(
        LARGEST_DIFFERENCE * omega,
        10.0 * float(by_integration.error.max(initial=0.0) + by_harmonics.error.max(initial=0.0)),
    )
    if difference > allowed:
        raise PeriodicError(
            f"exponents: Floquet's and Hill's method differ by {difference:.1e} 1/s, more than their errors: solutions that "
            "decay strongly over a revolution are lost by integration; reduce the system to its slower motions"
        )
    return Compared(by_integration, by_harmonics, difference)
