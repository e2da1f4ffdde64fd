"""Exact frequencies of a Timoshenko beam of square section, clamped at one end: what a solid cantilever has to show.

T. C. Huang, J. Appl. Mech. 28 (1961) 579–584, with the shear coefficient of G. R. Cowper (J. Appl. Mech. 33 (1966) 335), who
defines displacement and rotation as a section's averages.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from .mesh import Material

Array = NDArray[np.float64]


def shear_stiffness(material: Material, side: float) -> float:
    """κ G A (N) with Cowper's κ of a rectangle, 10 (1 + ν)/(12 + 11 ν)."""
    nu = material.poisson
    return 10 * (1 + nu) / (12 + 11 * nu) * material.lame[1] * side**2


def cantilever(count: int, material: Material, side: float, length: float) -> Array:
    """The ``count`` lowest frequencies (rad/s) in one plane.

    Args:
        count: how many.
        material: what it is made of.
        side: of the square section, m.
        length: from the clamp to the free end, m.
    """
    EI, mass = material.young * side**4 / 12, material.density * side**2
    r2, s2 = side**2 / 12 / length**2, EI / shear_stiffness(material, side) / length**2

    def characteristic(omega: float) -> float:
        b2 = mass * length**4 * omega**2 / EI
        b, root = np.sqrt(b2), np.sqrt((r2 - s2) ** 2 + 4 / b2)
        alpha, beta = (b * np.sqrt((sign * (r2 + s2) + root) / 2) for sign in (-1, 1))
        both = (b2 * (r2 - s2) ** 2 + 2) * np.cos(beta) + 2 / np.cosh(alpha)
        return float(both - b * (r2 + s2) / np.sqrt(1 - b2 * r2 * s2) * np.tanh(alpha) * np.sin(beta))

    unit = np.sqrt(EI / mass) / length**2
    grid = unit * np.arange(0.05, 12.0 * count**2, 0.1)
    signs = np.sign([characteristic(w) for w in grid])
    cross = np.flatnonzero(signs[1:] != signs[:-1])[:count]
    return np.array([brentq(characteristic, grid[k], grid[k + 1], xtol=1e-12) for k in cross])
