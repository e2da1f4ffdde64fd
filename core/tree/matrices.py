"""Matrices of a chain, element by element, and their products with vectors.

A vector holds (ρ, β) of one element after the other: the difference ρ = Ad ξ_b − ξ_a of the twists of its ends in the axes of
its end a, and its internal coordinates. An element's matrix acts on (ξ_a, ρ, β), where ξ_b = Ad⁻¹ (ρ + ξ_a) and node 0 does not
move. A load on (ρ, β) is that on the element and, at its end b, on all that lies beyond. Strains depend on ρ, not on the
twists: in these coordinates, the stiffness of short elements does not amplify rounding errors.
"""

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels

Array = NDArray[np.float64]


def product(matrix: Array, sign: float, back: Array, x: Array) -> Array:
    """Products (k, dn) of a matrix with the rows of x (k, dn).

    Args:
        matrix: (n, d + 6, d + 6) of the elements, d = 12, or 6 without internal coordinates.
        sign: 1 for a symmetric matrix, −1 for a skew one.
        back: (n, 6, 6) Ad⁻¹, see ``chain.pencil.ChainPencil``.
        x: the vectors.
    """
    return kernels.product(matrix, sign, back, np.ascontiguousarray(x))


def twists(back: Array, x: Array) -> Array:
    """(k, n, d) ξ_b and β of vectors x (k, dn)."""
    out = x.reshape(len(x), len(back), -1).copy()
    kernels.twists(back, out)
    return out
