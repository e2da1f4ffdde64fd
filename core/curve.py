"""The reference curve of a blade: a cubic spline of arc length through its points, one for each piece between two kinks.

At a kink the tangent jumps, so neither piece knows of the other; a piece of two points is straight.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[Any]
Kinks = tuple[float, ...]

SAME = 1e-12
"""Of the length: arc lengths closer than this to a kink are the kink's."""


def at(stations: Array, values: Array, kinks: Kinks, s: Array, *, before: bool = False) -> tuple[Array, Array]:
    """Values (k, …) and their derivatives by arc length (k, …) at arc lengths ``s`` (k,), m.

    Args:
        stations: (n,) arc length of the points, m.
        values: (n, …) there: of the curve, (n, 3) m; or of what else is continuous, and smooth but for the kinks.
        kinks: those of the stations where the derivative jumps, ascending, m.
        s: (k,) where, m.
        before: which side of a kink its own arc length belongs to: the one before it, or the one beyond it.
    """
    s = on_kinks(s, kinks, SAME * stations[-1])
    piece = np.searchsorted(np.array(kinks), s, side="left" if before else "right")
    ends = np.array([stations[0], *kinks, stations[-1]])
    found, rate = (np.empty((len(s), *values.shape[1:]), dtype=values.dtype) for _ in range(2))
    for k in np.unique(piece):
        own, here = (stations >= ends[k]) & (stations <= ends[k + 1]), piece == k
        spline = CubicSpline(stations[own], values[own])
        found[here], rate[here] = spline(s[here]), spline(s[here], 1)
    return found, rate


def on_kinks(s: Array, kinks: Kinks, within: float) -> Array:
    """The arc lengths ``s`` (k,), those ``within`` a kink's put on it."""
    s = np.array(s, dtype=float)
    for kink in kinks:
        s[np.abs(s - kink) <= within] = kink
    return s
