"""ElastoDyn's assumed mode shapes in a blade or tower file.

They are polynomials Σ c_k x^k, k = 2 … 6, of the distance from the root, 0 to 1. Source: J. Jonkman, M. Buhl, *FAST User's
Guide*, NREL/EL-500-38230, 2005.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import CaseError
from ..text import Text, keys, number_or, value

Array = NDArray[np.float64]


class Names(NamedTuple):
    """Names in a file of one shape's coefficients without the power, damping, and tuner if the format has one."""

    shape: str
    damping: str
    tuner: str | None = None

    @property
    def coefficients(self) -> list[str]:
        """Of x² … x⁶."""
        return [f"{self.shape}{power}" for power in range(2, 7)]


BLADE = {
    "flapwise 1": Names("BldFl1Sh", "BldFlDmp1", "FlStTunr1"),
    "flapwise 2": Names("BldFl2Sh", "BldFlDmp2", "FlStTunr2"),
    "edgewise 1": Names("BldEdgSh", "BldEdDmp1"),
}
"""Shapes in a blade file by motion."""

TOWER = {
    "tower fore-aft 1": Names("TwFAM1Sh", "TwrFADmp1", "FAStTunr1"),
    "tower fore-aft 2": Names("TwFAM2Sh", "TwrFADmp2", "FAStTunr2"),
    "tower side-side 1": Names("TwSSM1Sh", "TwrSSDmp1", "SSStTunr1"),
    "tower side-side 2": Names("TwSSM2Sh", "TwrSSDmp2", "SSStTunr2"),
}
"""Shapes in a tower file by motion."""


@dataclass(frozen=True)
class Shape:
    """An assumed mode shape.

    Attributes:
        coefficients: (5,) of x² … x⁶.
        damping: ratio of critical damping.
        tuner: factor on the modal stiffness.
    """

    coefficients: Array
    damping: float
    tuner: float

    def at(self, x: Array, derivative: int = 0) -> Array:
        """The polynomial or its derivative at x, 0 to 1."""
        powers = np.polynomial.Polynomial([0.0, 0.0, *self.coefficients])
        return np.asarray(powers.deriv(derivative)(x) if derivative else powers(x))


def read(text: Text, motions: dict[str, Names]) -> dict[str, Shape]:
    """The shapes in a blade or tower file (``BLADE``, ``TOWER``) by motion; those that it does not have are left out."""
    entries = keys(text)
    out: dict[str, Shape] = {}
    for motion, names in motions.items():
        if not all(name.lower() in entries for name in names.coefficients):
            continue
        coefficients = np.array([value(text, entries, name) for name in names.coefficients])
        if abs(coefficients.sum()) < 1e-6:
            raise CaseError(
                f"{text.path}: {names.shape}: the coefficients sum to 0, but a shape is 1 at its end: correct one"
            )
        damping = 0.01 * number_or(text, names.damping, 0.0)
        out[motion] = Shape(coefficients, damping, number_or(text, names.tuner, 1.0) if names.tuner else 1.0)
    return out
