"""Extrapolation of values given at a few abscissae to zero, by a polynomial of the degree that rounding errors allow."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def at_zero(x: Array, values: Array) -> Array:
    """Values (…) at x = 0 from ``values`` (k, …) at abscissae x (k,), the latest last.

    The polynomial is fitted by least squares: Σ p_j(0) Σ p_j(x_i) y_i over polynomials p_j orthonormal on the abscissae
    (Forsythe, J. SIAM 5, 1957, 74). It amplifies rounding errors less than one through all points.
    """
    basis = np.ones((len(x) + 1, 1))  # of each polynomial: its values on the abscissae, then at zero
    powers = np.append(x, 0.0) / np.abs(x).max()
    for _ in range(degree(x, values)):
        basis = np.column_stack([basis, powers * basis[:, -1]])
    q, r = np.linalg.qr(basis[:-1])
    at = np.linalg.solve(r.T, basis[-1])  # p_j(0), from the same combinations of powers
    return np.einsum("k,k...->...", q @ at, values)


def degree(x: Array, values: Array) -> int:
    """Degree of the polynomial.

    The terms of Newton's interpolation through the latest value, the two latest, and so on, decrease up to the degree at which
    rounding errors dominate. The polynomial ends before the smallest term.
    """
    differences, reach, terms = values, 1.0, []
    for order in range(1, len(x)):
        reach *= -x[len(x) - order]  # the product of 0 − x over the latest abscissae
        steps = x[order:] - x[:-order]
        differences = np.diff(differences, axis=0) / steps.reshape(-1, *[1] * (values.ndim - 1))
        terms.append(abs(reach) * np.abs(differences[-1]).max())
    return max(int(np.argmin(terms)), 1) if terms else 0
