"""ElastoDyn's assumed mode shapes in a blade or tower file.

They are polynomials Σ c_k x^k, k = 2 … 6, of the distance from the root, 0 to 1. Source: J. Jonkman, M. Buhl, *FAST User's
Guide*, NREL/EL-500-38230, 2005.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import CaseError
from ..text import Text, keys, number, value

Array = NDArray[np.float64]

_BLADE = {"flapwise 1": "BldFl1Sh", "flapwise 2": "BldFl2Sh", "edgewise 1": "BldEdgSh"}
"""Motions of a blade and the names of their coefficients."""

_TOWER = {
    "tower fore-aft 1": "TwFAM1Sh",
    "tower fore-aft 2": "TwFAM2Sh",
    "tower side-side 1": "TwSSM1Sh",
    "tower side-side 2": "TwSSM2Sh",
}
"""Motions of the tower and the names of their coefficients."""

_BLADE_DAMPING = {"flapwise 1": "BldFlDmp1", "flapwise 2": "BldFlDmp2", "edgewise 1": "BldEdDmp1"}
_BLADE_TUNERS = {"flapwise 1": "FlStTunr1", "flapwise 2": "FlStTunr2"}
_TOWER_DAMPING = {
    "tower fore-aft 1": "TwrFADmp1",
    "tower fore-aft 2": "TwrFADmp2",
    "tower side-side 1": "TwrSSDmp1",
    "tower side-side 2": "TwrSSDmp2",
}
_TOWER_TUNERS = {
    "tower fore-aft 1": "FAStTunr1",
    "tower fore-aft 2": "FAStTunr2",
    "tower side-side 1": "SSStTunr1",
    "tower side-side 2": "SSStTunr2",
}


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


def of_blade(text: Text) -> dict[str, Shape]:
    """The shapes in a blade file by motion; those that it does not have are left out."""
    return _shapes(text, _BLADE, _BLADE_DAMPING, _BLADE_TUNERS)


def of_tower(text: Text) -> dict[str, Shape]:
    """The shapes in a tower file by motion; those that it does not have are left out."""
    return _shapes(text, _TOWER, _TOWER_DAMPING, _TOWER_TUNERS)


def _shapes(text: Text, names: dict[str, str], damping: dict[str, str], tuners: dict[str, str]) -> dict[str, Shape]:
    entries = keys(text)
    out: dict[str, Shape] = {}
    for motion, name in names.items():
        numbered = [f"{name}{k}" for k in range(2, 7)]
        if not all(key.lower() in entries for key in numbered):
            continue
        coefficients = np.array([value(text, entries, key) for key in numbered])
        if abs(coefficients.sum()) < 1e-6:
            raise CaseError(f"{text.path}: {name}: the coefficients sum to 0, but a shape is 1 at its end: correct one")
        out[motion] = Shape(
            coefficients,
            0.01 * number_or(text, damping[motion], 0.0),
            number_or(text, tuners[motion], 1.0) if motion in tuners else 1.0,
        )
    return out


def number_or(text: Text, name: str, otherwise: float) -> float:
    """A finite number by its name in a file, or ``otherwise`` if there is none."""
    entry = keys(text).get(name.lower())
    out = number(entry[1]) if entry else None
    return out if out is not None and np.isfinite(out) else otherwise
