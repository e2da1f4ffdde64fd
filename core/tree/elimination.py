"""Elimination of a tree's elements from the tips inwards, in the coordinates (ρ, β) of each: factors of K and solutions.

Let P be the stiffness that all that lies beyond an element presents to its end b. With ξ_b = Ad⁻¹ (ρ + ξ_a), the
element and that part have the stiffness

    [[X, Y], [W, Z]] on ξ_a and (ρ, β),

the element's matrix plus Ad⁻ᵀ P Ad⁻¹ on ξ_a + ρ, and present X − Y Z⁻¹ W to end a, where the elements that begin there add
up. This is the recursion of Featherstone's
articulated bodies (*Rigid Body Dynamics Algorithms*, 2008, sec. 7.2) for a stiffness instead of an inertia. The large stiffness
of a short element appears in Z only, not as a difference. The rounding error grows with the number of elements, and not
with its fourth power as the condition number of the stiffness on the nodes' twists.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from .links import Links

Array = NDArray[np.float64]


class Factor(NamedTuple):
    """Factors of K, which an inward and an outward sweep apply.

    A load q on (ρ, β) acts as R q on end a, in addition to its rigid transport; then (ρ, β) = G q + V ξ_a.

    Attributes:
        flexibility: (n, d, d) Gᵀ.
        transfer: (n, 6, d) Vᵀ.
        reaction: (n, d, 6) Rᵀ.
        links: the tree.
        positive: whether K is positive definite.
    """

    flexibility: Array
    transfer: Array
    reaction: Array
    links: Links
    positive: bool


def factor(K: Array, links: Links) -> Factor:
    """Factor K.

    Args:
        K: (n, d + 6, d + 6) of the elements, see ``links``; not symmetric out of balance.
        links: the tree.

    Raises:
        numpy.linalg.LinAlgError: if K is singular.
    """
    worst_pivot, flexibility, transfer, reaction = kernels.factor(K, links.arrays)
    if worst_pivot == 0:
        raise np.linalg.LinAlgError("singular")
    return Factor(flexibility, transfer, reaction, links, worst_pivot == 2)


def solve(f: Factor, x: Array) -> None:
    """Replace loads (k, dn) by the displacements. Loads on clamped directions have no effect."""
    kernels.solve(f.flexibility, f.transfer, f.reaction, f.links.arrays, x)


def solution(f: Factor, b: Array) -> Array:
    """The solution (dn,) for one right-hand side."""
    x = b[None].copy()
    solve(f, x)
    return x[0]
