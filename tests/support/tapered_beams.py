"""Beams of rectangular section that taper linearly in height and breadth: exact frequencies, and the same as a blade."""

import numpy as np
from numpy.polynomial import Legendre, Polynomial
from scipy.linalg import eigh

from southwell.core.blade import Blade, section_mass, section_stiffness

ALONG = Polynomial([0.0, 1.0])


def exact(height: float, breadth: float, omega: float, hub: float = 0.0, terms: int = 16) -> np.ndarray:
    """(terms,) flapwise frequencies of an inextensible Euler-Bernoulli beam, length, root's mass and stiffness 1.

    Rayleigh and Ritz with x² times Legendre polynomials, to 1e-7 for the first three; every integrand but that of the tension
    is a polynomial, and Gauss' 40 points integrate all of them exactly.
    """
    mass = (1 - breadth * ALONG) * (1 - height * ALONG)
    stiffness = (1 - breadth * ALONG) * (1 - height * ALONG) ** 3
    points, weights = np.polynomial.legendre.leggauss(40)
    x, weights = (points + 1) / 2, weights / 2
    pull = (mass * (ALONG + hub)).integ()
    tension = omega**2 * (pull(1.0) - pull(x))
    shapes = [ALONG**2 * Legendre.basis(k, domain=[0, 1]).convert(kind=Polynomial) for k in range(terms)]
    w, slope, bend = (np.array([s.deriv(d)(x) if d else s(x) for s in shapes]) for d in range(3))
    K = (bend * stiffness(x) * weights) @ bend.T + (slope * tension * weights) @ slope.T
    return np.sqrt(eigh(K, (w * mass(x) * weights) @ w.T, eigvals_only=True))


def blade(height: float, breadth: float, hub: float = 0.0, stations: int = 1601) -> Blade:
    """The same, slender (1000), as alike in both planes; linear between so many stations."""
    x = np.linspace(0.0, 1.0, stations)
    b, h = 1 - breadth * x, 1 - height * x
    bending = b * h**3
    return Blade(
        name="tapered",
        stations=x,
        stiffness=section_stiffness(1e6 * b * h, bending, bending, bending),
        mass=section_mass(b * h),
        twist=np.zeros(stations),
        hub_radius=hub,
    )
