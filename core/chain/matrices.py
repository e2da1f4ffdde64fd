"""Matrices of a chain, element by element, and their products with vectors.

A vector holds (ρ, β) of one element after the other: the difference ρ = Ad ξ_b − ξ_a of the twists of its ends in the axes of
its end a, and its internal coordinates. An element's matrix acts on (ξ_a, ρ, β), where ξ_b = Ad⁻¹ (ρ + ξ_a) and node 0 does not
move. A load on (ρ, β) is that on the element and, at its end b, on all that lies beyond. Strains depend on ρ, not on the
twists: in these coordinates, the stiffness of short elements does not amplify rounding errors.
"""

import numpy as np
from numpy.typing import NDArray

from ..compiled import clear, compiled, inlined

Array = NDArray[np.float64]
Six = tuple[float, float, float, float, float, float]


@inlined
def six(x: Array, v: int, at: int) -> Six:
    """x[v, at …]."""
    return x[v, at], x[v, at + 1], x[v, at + 2], x[v, at + 3], x[v, at + 4], x[v, at + 5]


@inlined
def add_six(matrix: Array, k: int, row: int, p: Six, q: Six, out: Array) -> None:
    """Add the transpose of six rows of matrix k times p to out[0], and times q to out[1]."""
    p0, p1, p2, p3, p4, p5 = p
    q0, q1, q2, q3, q4, q5 = q
    for i in range(matrix.shape[2]):
        e0, e1, e2 = matrix[k, row, i], matrix[k, row + 1, i], matrix[k, row + 2, i]
        e3, e4, e5 = matrix[k, row + 3, i], matrix[k, row + 4, i], matrix[k, row + 5, i]
        out[0, i] += e0 * p0 + e1 * p1 + e2 * p2 + e3 * p3 + e4 * p4 + e5 * p5
        out[1, i] += e0 * q0 + e1 * q1 + e2 * q2 + e3 * q3 + e4 * q4 + e5 * q5


@inlined
def outwards(back: Array, k: int, x: Array, v: int, at: int, xi: Array, m: int) -> None:
    """xi[m, 0 … 5] = Ad⁻¹ (ρ + ξ_a) of element k, for ρ = x[v, at …] and ξ_a in the same place."""
    s0, s1, s2 = x[v, at] + xi[m, 0], x[v, at + 1] + xi[m, 1], x[v, at + 2] + xi[m, 2]
    s3, s4, s5 = x[v, at + 3] + xi[m, 3], x[v, at + 4] + xi[m, 4], x[v, at + 5] + xi[m, 5]
    for i in range(6):
        low = back[k, i, 0] * s0 + back[k, i, 1] * s1 + back[k, i, 2] * s2
        xi[m, i] = low + back[k, i, 3] * s3 + back[k, i, 4] * s4 + back[k, i, 5] * s5


@inlined
def inwards(back: Array, k: int, p: Array, m: int) -> None:
    """p[m] = Ad⁻ᵀ p[m] of element k."""
    p0, p1, p2, p3, p4, p5 = p[m, 0], p[m, 1], p[m, 2], p[m, 3], p[m, 4], p[m, 5]
    for i in range(6):
        low = back[k, 0, i] * p0 + back[k, 1, i] * p1 + back[k, 2, i] * p2
        p[m, i] = low + back[k, 3, i] * p3 + back[k, 4, i] * p4 + back[k, 5, i] * p5


@compiled
def times(matrix: Array, sign: float, back: Array, x: Array, out: Array) -> None:
    """Multiply a matrix by vectors at the start of the rows of x (k, dn or more), into the start of the rows of ``out``.

    Args:
        matrix: (n, d + 6, d + 6) of the elements, d = 12, or 6 without internal coordinates.
        sign: 1 for a symmetric matrix, −1 for a skew one.
        back: (n, 6, 6) Ad⁻¹, see ``chain.pencil.ChainPencil``.
        x: the vectors.
        out: the products.
    """
    n, d = len(matrix), matrix.shape[1] - 6
    u, f, p, on_a = np.empty((2, d + 6)), np.empty((2, d + 6)), np.empty((2, 6)), np.empty((n, 2, 6))
    for v in range(0, len(x), 2):  # two at a time; an odd last one is paired with itself
        w = min(v + 1, len(x) - 1)
        for i in range(6):
            u[0, i] = u[1, i] = p[0, i] = p[1, i] = 0.0
        for k in range(n):
            at = d * k
            for i in range(d):
                u[0, 6 + i], u[1, 6 + i] = x[v, at + i], x[w, at + i]
            clear(f)
            for j in range(0, d + 6, 6):
                add_six(matrix, k, j, six(u, 0, j), six(u, 1, j), f)
            for i in range(6):
                on_a[k, 0, i], on_a[k, 1, i] = sign * f[0, i], sign * f[1, i]
            for i in range(d):
                out[v, at + i], out[w, at + i] = sign * f[0, 6 + i], sign * f[1, 6 + i]
            outwards(back, k, x, v, at, u, 0)
            outwards(back, k, x, w, at, u, 1)
        for k in range(n - 1, -1, -1):
            at = d * k
            inwards(back, k, p, 0)
            inwards(back, k, p, 1)
            for i in range(6):
                first_end, second_end = out[v, at + i] + p[0, i], out[w, at + i] + p[1, i]
                out[v, at + i], out[w, at + i] = first_end, second_end
                p[0, i], p[1, i] = p[0, i] + on_a[k, 0, i], p[1, i] + on_a[k, 1, i]


def product(matrix: Array, sign: float, back: Array, x: Array) -> Array:
    """The products (k, dn) with the rows of x (k, dn); see ``times``."""
    out = np.empty_like(x)
    times(matrix, sign, back, np.ascontiguousarray(x), out)
    return out


def twists(back: Array, x: Array) -> Array:
    """(k, n, d) ξ_b and β of vectors x (k, dn)."""
    out = x.reshape(len(x), len(back), -1).copy()
    _twists(back, out)
    return out


@compiled
def _twists(back: Array, x: Array) -> None:
    xi = np.empty((1, 6))
    for v in range(len(x)):
        for i in range(6):
            xi[0, i] = 0.0
        for k in range(len(back)):
            outwards(back, k, x[v], k, 0, xi, 0)
            for i in range(6):
                x[v, k, i] = xi[0, i]
