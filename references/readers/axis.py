"""A reference curve through points: arc length, and the angle between two conventions for section axes."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

GAUSS = np.polynomial.legendre.leggauss(24)


@dataclass(frozen=True)
class Curve:
    """A curve and the twist along a parameter.

    Attributes:
        values: value (k, 3) and, with the second argument 1, derivative of the curve in axes of ``core.blade``, m.
        knots: (n,) parameter at the ends of the smooth pieces.
    """

    values: Callable[..., Array]
    knots: Array

    def lengths(self) -> Array:
        """Arc length (n,) at the knots, from the first."""
        return np.concatenate([[0.0], np.cumsum([self._piece(a, b) for a, b in pairwise(self.knots)])])

    def parameter(self, s: Array) -> Array:
        """The parameter at arc lengths ``s`` (k,), by bisection in each piece."""
        at = self.lengths()
        out = np.empty(len(s))
        for i, value in enumerate(s):
            k = int(np.clip(np.searchsorted(at, value, side="right") - 1, 0, len(at) - 2))
            low, high = self.knots[k], self.knots[k + 1]
            for _ in range(60):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if at[k] + self._piece(self.knots[k], middle) < value else (low, middle)
            out[i] = 0.5 * (low + high)
        return out

    def _piece(self, a: float, b: float) -> float:
        x, w = GAUSS
        slope = self.values(0.5 * (a + b) + 0.5 * (b - a) * x, 1)
        return float(0.5 * (b - a) * w @ np.linalg.norm(slope, axis=1))


def tangents(curve: Curve, at: Array) -> Array:
    """Unit tangents (k, 3)."""
    slope = curve.values(at, 1)
    return slope / np.linalg.norm(slope, axis=1, keepdims=True)


def beamdyn_roll(t: Array) -> Array:
    """Angle (n,) about the tangents ``t`` from axes rotated by the smallest angle to BeamDyn's, before its twist.

    BeamDyn's downwind section axis has no component along the blade's edgewise axis (``BD_ComputeIniNodalCrv``).
    """
    axes = np.cross([1.0, 0.0, 0.0], t)
    sine = np.linalg.norm(axes, axis=1, keepdims=True)
    angle = np.arctan2(sine[:, 0], t[:, 0])
    smallest = Rotation.from_rotvec(np.divide(axes, sine, out=np.zeros_like(axes), where=sine > 0) * angle[:, None])
    y, z = smallest.apply([0.0, 1.0, 0.0]), smallest.apply([0.0, 0.0, 1.0])
    downwind = np.stack([-t[:, 2], np.zeros(len(t)), t[:, 0]], axis=1)
    return np.arctan2(-(downwind * y).sum(1), (downwind * z).sum(1))
