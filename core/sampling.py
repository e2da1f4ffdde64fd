"""A blade's sections between its stations, as core's elements have them: matrices linear in the arc length.

The adapters of foreign codes have a sampling of their own, ``references.sampling``.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .blade import Blade

Array = NDArray[np.float64]


def stiffness_at(blade: Blade, s: ArrayLike) -> Array:
    """Section stiffness (k, 6, 6) at arc lengths ``s``; rigid strains stay ``inf``."""
    rigid = np.isinf(blade.stiffness).any(0)
    finite = np.where(np.isinf(blade.stiffness), 0.0, blade.stiffness)
    out = _interpolate(blade.stations, finite, s)
    out[:, rigid] = np.inf
    return out


def mass_at(blade: Blade, s: ArrayLike) -> Array:
    """Section mass per length (k, 6, 6) at arc lengths ``s``."""
    return _interpolate(blade.stations, blade.mass, s)


def twist_at(blade: Blade, s: ArrayLike) -> Array:
    """Structural twist (k,) at arc lengths ``s``, rad."""
    return np.interp(np.atleast_1d(s), blade.stations, blade.twist)


def _interpolate(stations: Array, values: Array, s: ArrayLike) -> Array:
    s = np.atleast_1d(np.asarray(s, float))
    k = np.clip(np.searchsorted(stations, s, side="right") - 1, 0, len(stations) - 2)
    t = ((s - stations[k]) / (stations[k + 1] - stations[k]))[:, None, None]
    return (1 - t) * values[k] + t * values[k + 1]
