"""Matrices of a tree, element by element, and their products with vectors.

An element's matrix acts on (ξ_a, ρ, β) (see ``links``); the product with a vector x of all (ρ, β) is Bᵀ (matrix) B x. Strains
depend on ρ, not on the twists: in these coordinates, the stiffness of short elements does not amplify rounding errors.
"""

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from .links import Links

Array = NDArray[np.float64]


def product(matrix: Array, sign: float, links: Links, x: Array) -> Array:
    """Products (k, dn) of a matrix with the rows of x (k, dn).

    Args:
        matrix: (n, d + 6, d + 6) of the elements, d = 12, or 6 without internal coordinates.
        sign: 1 for a symmetric matrix, −1 for a skew one.
        links: the tree.
        x: the vectors.
    """
    return kernels.product(matrix, sign, links.arrays, np.ascontiguousarray(x))
