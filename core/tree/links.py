"""The links of a tree and the velocity transformation over it: Y = B v outwards, Bᵀ inwards (Park et al. 2010, eq. 3, 5).

Link k leads from node ``parent[k]`` to node k + 1; parents come before their children, and node 0 does not move. A vector
holds (ρ, β) of one link after the other: the difference ρ = Ad ξ_b − ξ_a of the twists of its ends in the axes of its end a,
and its internal coordinates. With v = ρ, Y = B v is the recursion ``ξ_b = Ad⁻¹ (ρ + ξ_a)`` (D. S. Bae and E. J. Haug, Mech.
Struct. Mach. 15, 1987, 359), and its transpose sums the wrenches on all that lies beyond a link. B is never formed.

A matrix of the tree acts element by element on (ξ_a, ρ, β); its product with a vector x is Bᵀ (matrix) B x. Strains depend on
ρ, not on the twists: in these coordinates, the stiffness of short elements does not amplify rounding errors.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Links:
    """The links of a tree at a configuration.

    Attributes:
        parent: (n,) node at which each link begins.
        to_child: (n, 6, 6) Ad⁻¹ of the pose of each link's end b in the frame of its end a.
        clamped_directions: (n, 6, 6) projectors of ρ on the directions that joints clamp; (0, 6, 6) without joints.
    """

    parent: NDArray[np.int64]
    to_child: Array
    clamped_directions: Array

    @cached_property
    def arrays(self) -> kernels.Links:
        """The links for compiled kernels."""
        return kernels.Links(self.parent, self.to_child, self.clamped_directions)


def twists(links: Links, x: Array) -> Array:
    """B x: (k, n, d) ξ_b and β of vectors x (k, dn)."""
    n = len(links.parent)
    out = x.reshape(len(x), n, x.shape[1] // n).copy()
    kernels.twists(links.arrays, out)
    return out


def gathered(links: Links, f: Array, g: Array) -> Array:
    """Bᵀ of loads: (n, d) on (ρ, β) from those on (ξ_a, ρ, β) of the elements (n, d + 6) and on the nodes (n+1, 6)."""
    return kernels.gathered(links.arrays, f, g)


def allowed(links: Links, x: Array) -> Array:
    """Vectors x (k, dn) without the motions that joints clamp."""
    if not links.clamped_directions.size:
        return x
    out = x.reshape(len(x), len(links.parent), -1).copy()
    out[..., :6] -= (links.clamped_directions @ out[..., :6, None])[..., 0]
    return out.reshape(x.shape)


def product(matrix: Array, sign: float, links: Links, x: Array) -> Array:
    """Products Bᵀ (matrix) B x (k, dn) with the rows of x (k, dn) (Park et al. 2010, eq. 10).

    Args:
        matrix: (n, d + 6, d + 6) of the elements, d = 12, or 6 without internal coordinates.
        sign: 1 for a symmetric matrix, −1 for a skew one.
        links: the tree.
        x: the vectors.
    """
    return kernels.product(matrix, sign, links.arrays, np.ascontiguousarray(x))
