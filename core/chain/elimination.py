"""Elimination of a chain's elements from the tip inwards, in the coordinates (ρ, β) of each: factors of K and solutions.

Let P be the stiffness that the part of the chain beyond an element presents to its end b. With ξ_b = Ad⁻¹ (ρ + ξ_a), the
element and that part have the stiffness

    [[X, Y], [W, Z]] on ξ_a and (ρ, β),

the element's matrix plus Ad⁻ᵀ P Ad⁻¹ on ξ_a + ρ, and present P = X − Y Z⁻¹ W to end a. This is the recursion of Featherstone's
articulated bodies (*Rigid Body Dynamics Algorithms*, 2008, sec. 7.2) for a stiffness instead of an inertia. The large stiffness
of a short element appears in Z only, not as a difference. The rounding error grows with the number of elements, and not
with its fourth power as the condition number of the stiffness on the nodes' twists.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import clear, compiled, congruence, inner, invert
from .matrices import add_six, inwards, outwards, six

Array = NDArray[np.float64]


class Factor(NamedTuple):
    """Factors of K, which an inward and an outward sweep apply.

    A load q on (ρ, β) acts as R q on end a, in addition to its rigid transport; then (ρ, β) = G q + V ξ_a.

    Attributes:
        flexibility: (n, d, d) Gᵀ.
        ride: (n, 6, d) Vᵀ.
        reaction: (n, d, 6) Rᵀ.
        back: (n, 6, 6) Ad⁻¹.
        positive: whether K is positive definite.
    """

    flexibility: Array
    ride: Array
    reaction: Array
    back: Array
    positive: bool


def factor(K: Array, back: Array, clamped: Array) -> Factor:
    """Factor K.

    Args:
        K: (n, d + 6, d + 6) of the elements, see ``matrices``; not symmetric out of balance.
        back, clamped: as in ``ChainPencil``.

    Raises:
        numpy.linalg.LinAlgError: if K is singular.
    """
    n, d = len(K), K.shape[1] - 6
    out = np.empty((n, d, d)), np.empty((n, 6, d)), np.empty((n, d, 6))
    kind = _eliminate(K, back, clamped, *out)
    if kind == 0:
        raise np.linalg.LinAlgError("singular")
    if clamped.size:
        out[0][0, :6, :6] = back[0] @ out[0][0, :6, :6] @ back[0]
    return Factor(*out, back, kind == 2)


@inner
def add_beyond(beyond: Array, H: Array) -> None:
    """Add a stiffness (6, 6) on ξ_a + ρ to H."""
    for i in range(6):
        for j in range(6):
            H[i, j] += beyond[i, j]
            H[i, 6 + j] += beyond[i, j]
            H[6 + i, j] += beyond[i, j]
            H[6 + i, 6 + j] += beyond[i, j]


@compiled
def _eliminate(K: Array, back: Array, clamped: Array, flexibility: Array, ride: Array, reaction: Array) -> int:
    """Fill the parts of ``Factor``; returns the worst result of ``invert`` over all elements."""
    n, size = K.shape[:2]
    d, kind = size - 6, 2
    H, P, work, beyond = np.empty((size, size)), np.zeros((6, 6)), np.empty((6, 6)), np.empty((6, 6))
    for k in range(n - 1, -1, -1):
        congruence(back[k], P, work, beyond)
        for i in range(size):
            for j in range(size):
                H[i, j] = K[k, i, j]
        add_beyond(beyond, H)
        if k == 0 and len(clamped):
            for i in range(6):
                for j in range(6):
                    H[6 + i, 6 + j] += clamped[i, j]  # any stiffness: these directions do not move
        kind = min(kind, invert(H, 6))
        if kind == 0:
            break
        for i in range(6):
            for j in range(6):
                P[i, j] = H[i, j]
            for j in range(d):
                ride[k, i, j], reaction[k, j, i] = -H[6 + j, i], H[i, 6 + j]
        for i in range(d):
            for j in range(d):
                flexibility[k, i, j] = H[6 + j, 6 + i]
    return kind


@compiled
def solve(f: Factor, x: Array) -> None:
    """Replace loads (k, dn) by the displacements. Loads on clamped directions have no effect."""
    n, d = f.flexibility.shape[:2]
    p, xi, here = np.empty((2, 6)), np.empty((2, 6)), np.empty((2, d))
    for v in range(0, len(x), 2):  # as in ``matrices.times``
        w = min(v + 1, len(x) - 1)
        for i in range(6):
            p[0, i] = p[1, i] = xi[0, i] = xi[1, i] = 0.0
        for k in range(n - 1, -1, -1):
            at = d * k
            inwards(f.back, k, p, 0)
            inwards(f.back, k, p, 1)
            for i in range(6):
                first, second = x[v, at + i] + p[0, i], x[w, at + i] + p[1, i]
                x[v, at + i], x[w, at + i] = first, second
            for i in range(d):
                q, r = x[v, at + i], x[w, at + i]
                for j in range(6):
                    p[0, j] += f.reaction[k, i, j] * q
                    p[1, j] += f.reaction[k, i, j] * r
        for k in range(n):
            at = d * k
            clear(here)
            for j in range(0, d, 6):
                add_six(f.flexibility, k, j, six(x, v, at + j), six(x, w, at + j), here)
            add_six(f.ride, k, 0, six(xi, 0, 0), six(xi, 1, 0), here)
            for i in range(d):
                x[v, at + i], x[w, at + i] = here[0, i], here[1, i]
            outwards(f.back, k, x, v, at, xi, 0)
            outwards(f.back, k, x, w, at, xi, 1)


def solution(f: Factor, b: Array) -> Array:
    """The solution (dn,) for one right-hand side."""
    x = b[None].copy()
    solve(f, x)
    return x[0]
