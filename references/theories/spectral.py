"""Polynomials for a cantilever: spectral between the stations, where its properties are smooth.

Each interval has the linear or cubic functions of its end values, and Legendre polynomials integrated once (for stretch
and torsion, continuous) or twice (for bending, with continuous slope), whose derivatives are orthogonal. This is the
p-version of the finite element method (B. Szabó and I. Babuška, *Finite Element Analysis*, 1991, §3.1). Properties
that are linear between stations have kinks there, but none within an interval, so frequencies converge exponentially
with the number of terms for every blade. A uniform blade is one interval.
"""

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ...core.blade import Blade
from ..sampling import points

Array = NDArray[np.float64]

CUBIC = ([2, -3, 0, 1], [1, -1, -1, 1], [2, 3, 0, -1], [-1, -1, 1, 1])
"""Four times Hermite's cubics on [−1, 1], ascending powers: value and slope at −1, value and slope at +1."""


def intervals(blade: Blade) -> Array:
    """Arc lengths (k+1,) between which the blade's properties are linear: its stations, except those without a kink."""
    s = blade.stations
    rigid = np.where(np.isinf(blade.stiffness), 0.0, blade.stiffness)
    table = np.column_stack([blade.twist, rigid.reshape(len(s), -1), blade.mass.reshape(len(s), -1)])
    t = ((s[1:-1] - s[:-2]) / (s[2:] - s[:-2]))[:, None]
    kink = np.abs((1 - t) * table[:-2] + t * table[2:] - table[1:-1]) > 1e-12 * np.abs(table).max(0)
    return s[np.concatenate([[True], kink.any(1), [True]])]


def gauss(ends: Array, count: int) -> tuple[Array, Array]:
    """Gauss points and weights (k·count,) with ``count`` in each of the intervals between ``ends`` (k+1,)."""
    s, weight = points(ends, count)
    return s.ravel(), weight.ravel()


def clamped_functions(ends: Array, terms: int, s: Array) -> Array:
    """Functions for bending: value and slope are zero at the root and continuous.

    Args:
        ends: (k+1,) of the intervals, from the root's.
        terms: number in each interval, at least 2; their degree is ``terms + 1``.
        s: (q,) arc lengths at which to evaluate them, m.

    Returns:
        (3, q, k·terms): the functions, their slopes and their second derivatives with respect to ``s``.
    """
    cubics = [legendre.poly2leg(c) / 4 for c in CUBIC]
    bubbles = legendre.legint(np.eye(terms)[2:].T, m=2, lbnd=-1, axis=0)
    local = np.zeros((terms + 2, terms + 2))
    local[:4, :4] = np.transpose(cubics)
    local[: len(bubbles), 4:] = bubbles
    return _assembled(ends, s, local, shared=2)


def pinned_functions(ends: Array, terms: int, s: Array) -> Array:
    """Functions for stretch, torsion and cables: zero at the root and continuous, of degree ``terms``.

    Arguments and returned arrays are those of ``clamped_functions``.
    """
    local = np.zeros((terms + 1, terms + 1))
    local[:2, :2] = [[0.5, 0.5], [-0.5, 0.5]]
    bubbles = legendre.legint(np.eye(terms)[1:].T, lbnd=-1, axis=0)
    local[: len(bubbles), 2:] = bubbles
    return _assembled(ends, s, local, shared=1)


def _assembled(ends: Array, s: Array, local: Array, shared: int) -> Array:
    """Global functions from the columns of Legendre coefficients ``local``: ``shared`` at each end, then the bubbles.

    In each interval the bubbles come first, then the functions shared with the next interval at its outer end.
    """
    width = local.shape[1]
    new = width - shared
    k = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, len(ends) - 2)
    half = np.diff(ends)[k, None] / 2
    t = (s - ends[k]) / half[:, 0] - 1
    column = np.empty((len(s), width), dtype=np.intp)
    column[:, :shared] = k[:, None] * new - shared + np.arange(shared)
    column[:, shared : 2 * shared] = column[:, :shared] + new
    column[:, 2 * shared :] = k[:, None] * new + np.arange(new - shared)
    out = np.zeros((3, len(s), shared + new * (len(ends) - 1)))
    for order in range(3):
        values = legendre.legval(t, legendre.legder(local, order, axis=0)).T / half**order
        if shared == 2:
            values[:, [1, 3]] *= half  # a unit slope with respect to s, not to t
        np.put_along_axis(out[order], column + shared, values, axis=1)
    return out[:, :, shared:]
