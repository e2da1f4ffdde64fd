"""Exact bending frequencies of a uniform cantilever with shear and rotary inertia (Timoshenko beam), not rotating.

T. C. Huang, J. Appl. Mech. 28 (1961) 579–584: the frequency equation of the clamped–free beam.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]


def cantilever(count: int, *, EI: float, GA: float, mass: float, rotary: float, length: float) -> Array:
    """The ``count`` lowest frequencies (rad/s) in one plane, below the cut-off frequency √(GA/rotary).

    Args:
        count: number of frequencies.
        EI: bending stiffness, N m².
        GA: shear stiffness with its correction factor, N.
        mass: mass per length, kg/m.
        rotary: moment of inertia per length about the bending axis, kg m.
        length: from the clamp to the free end, m.

    Returns:
        (count,), ascending; fewer if there are fewer below the cut-off.
    """
    r2, s2 = rotary / mass / length**2, EI / GA / length**2

    def characteristic(omega: float) -> float:
        b2 = mass * length**4 * omega**2 / EI
        b, root = np.sqrt(b2), np.sqrt((r2 - s2) ** 2 + 4 / b2)
        alpha, beta = (b * np.sqrt((sign * (r2 + s2) + root) / 2) for sign in (-1, 1))
        sum_of_terms = (b2 * (r2 - s2) ** 2 + 2) * np.cos(beta) + 2 / np.cosh(alpha)
        return float(sum_of_terms - b * (r2 + s2) / np.sqrt(1 - b2 * r2 * s2) * np.tanh(alpha) * np.sin(beta))

    unit = np.sqrt(EI / mass) / length**2
    grid = unit * np.arange(0.05, 12.0 * count**2, 0.1)
    grid = grid[grid < np.sqrt(GA / rotary)]  # the cut-off, where b² r² s² = 1
    signs = np.sign([characteristic(w) for w in grid])
    cross = np.flatnonzero(signs[1:] != signs[:-1])[:count]
    return np.array([brentq(characteristic, grid[k], grid[k + 1], xtol=1e-12) for k in cross])
