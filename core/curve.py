"""The reference curve of a blade: a cubic spline of arc length through its points, one for each piece between two kinks.

At a kink the tangent jumps and the pieces on either side are independent; a piece of two points is straight.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[Any]
Kinks = tuple[float, ...]

KINK_TOLERANCE = 1e-12
"""Fraction of the length: arc lengths closer than this to a kink count as the kink."""


def at(stations: Array, values: Array, kinks: Kinks, s: Array, *, root_side: bool = False) -> tuple[Array, Array]:
    """Values (k, …) and their derivatives with respect to arc length (k, …) at arc lengths ``s`` (k,), m.

    Args:
        stations: (n,) arc length of the points, m.
        values: (n, …) at the stations: the curve (n, 3), m, or any quantity that is smooth between kinks.
        kinks: stations where the derivative jumps, ascending, m.
        s: (k,) arc lengths, m.
        root_side: evaluate at a kink from its root side instead of its tip side.
    """
    s = on_kinks(s, kinks, KINK_TOLERANCE * stations[-1])
    piece = np.searchsorted(np.array(kinks), s, side="left" if root_side else "right")
    ends = np.array([stations[0], *kinks, stations[-1]])
    out, rate = (np.empty((len(s), *values.shape[1:]), dtype=values.dtype) for _ in range(2))
    for k in np.unique(piece):
        points, in_piece = (stations >= ends[k]) & (stations <= ends[k + 1]), piece == k
        spline = CubicSpline(stations[points], values[points])
        out[in_piece], rate[in_piece] = spline(s[in_piece]), spline(s[in_piece], 1)
    return out, rate


def on_kinks(s: Array, kinks: Kinks, within: float) -> Array:
    """The arc lengths ``s`` (k,), m, with those ``within`` (m) of a kink moved onto it."""
    s = np.array(s, dtype=float)
    for kink in kinks:
        s[np.abs(s - kink) <= within] = kink
    return s
