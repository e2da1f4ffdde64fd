"""Block-tridiagonal matrices of a chain of bodies.

A block contains the internal coordinates β of one element and then the six of the node at its end, so a block is coupled to
the next only through its last six rows.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import compiled, inlined, invert, product

Array = NDArray[np.float64]
Six = tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class Tridiagonal:
    """Blocks on the diagonal (n, d, d), above it (n−1, 6, d) and below it (n−1, d, 6), from the last six rows of each block."""

    diagonal: Array
    upper: Array
    lower: Array

    @property
    def size(self) -> int:
        """Number of scalar rows."""
        return len(self.diagonal) * self.block

    @property
    def block(self) -> int:
        """Rows of a block, 6 or 12."""
        return self.diagonal.shape[-1]


def from_elements(on_ends: Array, lever: Array, on_nodes: Array) -> Tridiagonal:
    """Sum element matrices (n, d+6, d+6), ordered a, b, β, and nodal ones (n+1, 6, 6); node 0 is clamped and dropped.

    ``lever`` (n, 6, 6) transforms twists of b from the axes of b to those of a, in which the element matrices are given.
    """
    n, d = len(on_ends), on_ends.shape[-1] - 6
    out = Tridiagonal(np.empty((n, d, d)), np.empty((n - 1, 6, d)), np.empty((n - 1, d, 6)))
    _gather(on_ends, lever, np.ascontiguousarray(on_nodes), out.diagonal, out.upper, out.lower)
    return out


@compiled
def _gather(on_ends: Array, lever: Array, on_nodes: Array, diagonal: Array, upper: Array, lower: Array) -> None:
    n, d = diagonal.shape[:2]
    inner = d - 6
    own = np.empty((d + 6, d + 6))
    for k in range(n):
        for i in range(d + 6):
            for j in range(d + 6):
                own[i, j] = on_ends[k, i, j]
        for i in range(d + 6):
            for j in range(6):
                own[i, 6 + j] = 0.0
            for m in range(6):
                for j in range(6):
                    own[i, 6 + j] += on_ends[k, i, 6 + m] * lever[k, m, j]
        for j in range(d + 6):
            b0, b1, b2, b3, b4, b5 = own[6, j], own[7, j], own[8, j], own[9, j], own[10, j], own[11, j]
            for i in range(6):
                low = lever[k, 0, i] * b0 + lever[k, 1, i] * b1 + lever[k, 2, i] * b2
                own[6 + i, j] = low + lever[k, 3, i] * b3 + lever[k, 4, i] * b4 + lever[k, 5, i] * b5
        for i in range(6):  # β first, then b
            for j in range(6):
                diagonal[k, inner + i, inner + j] = own[6 + i, 6 + j] + on_nodes[k + 1, i, j]
            for j in range(inner):
                diagonal[k, inner + i, j], diagonal[k, j, inner + i] = own[6 + i, 12 + j], own[12 + j, 6 + i]
        for i in range(inner):
            for j in range(inner):
                diagonal[k, i, j] = own[12 + i, 12 + j]
        if k > 0:
            for i in range(6):
                for j in range(6):
                    diagonal[k - 1, inner + i, inner + j] += own[i, j]
                    upper[k - 1, i, inner + j], lower[k - 1, inner + j, i] = own[i, 6 + j], own[6 + j, i]
                for j in range(inner):
                    upper[k - 1, i, j], lower[k - 1, j, i] = own[i, 12 + j], own[12 + j, i]


class Transposed(NamedTuple):
    """A matrix with every block transposed: (n, d, d) on the diagonal, (n−1, 6, d) below it and (n−1, d, 6) above it."""

    diagonal: Array
    lower: Array
    upper: Array


def transposed(t: Tridiagonal) -> Transposed:
    """The matrix with transposed blocks, for the compiled products."""
    out = Transposed(*(np.empty(np.swapaxes(part, -1, -2).shape) for part in (t.diagonal, t.lower, t.upper)))
    for part, there in zip((t.diagonal, t.lower, t.upper), out, strict=True):
        _transpose(part, there)
    return out


@compiled
def _transpose(part: Array, out: Array) -> None:
    for k in range(part.shape[0]):
        for i in range(part.shape[1]):
            for j in range(part.shape[2]):
                out[k, j, i] = part[k, i, j]


_ZERO = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def _more(
    transposed: Array, k: int, row: int, column: int, x: Array, v: int, w: int, at: int, count: int, a: Six, b: Six
) -> tuple[Six, Six]:
    """a and b plus the transpose of a part (count, 6) of block k times x[v, at …] and x[w, at …]."""
    a0, a1, a2, a3, a4, a5 = a
    b0, b1, b2, b3, b4, b5 = b
    for j in range(count):
        p, q = x[v, at + j], x[w, at + j]
        t0, t1, t2 = (
            transposed[k, row + j, column],
            transposed[k, row + j, column + 1],
            transposed[k, row + j, column + 2],
        )
        t3, t4, t5 = (
            transposed[k, row + j, column + 3],
            transposed[k, row + j, column + 4],
            transposed[k, row + j, column + 5],
        )
        a0, a1, a2, a3, a4, a5 = a0 + t0 * p, a1 + t1 * p, a2 + t2 * p, a3 + t3 * p, a4 + t4 * p, a5 + t5 * p
        b0, b1, b2, b3, b4, b5 = b0 + t0 * q, b1 + t1 * q, b2 + t2 * q, b3 + t3 * q, b4 + t4 * q, b5 + t5 * q
    return (a0, a1, a2, a3, a4, a5), (b0, b1, b2, b3, b4, b5)


@inlined
def _put(a: Six, out: Array, v: int, at: int) -> None:
    out[v, at], out[v, at + 1], out[v, at + 2], out[v, at + 3], out[v, at + 4], out[v, at + 5] = a


@compiled
def times(t: Transposed, x: Array, out: Array) -> None:
    """Multiply the matrix by vectors at the start of the rows of x (k, dn or more), into the start of the rows of ``out``."""
    n, d = t.diagonal.shape[:2]
    for i in range(n):
        at = d * i
        for v in range(0, len(x), 2):  # two at a time; an odd last one is paired with itself
            w = min(v + 1, len(x) - 1)
            for h in range(0, d, 6):
                a, b = _ZERO, _ZERO
                if i > 0:
                    a, b = _more(t.lower, i - 1, 0, h, x, v, w, at - 6, 6, a, b)
                a, b = _more(t.diagonal, i, 0, h, x, v, w, at, d, a, b)
                if i < n - 1 and h == d - 6:
                    a, b = _more(t.upper, i, 0, 0, x, v, w, at + d, d, a, b)
                _put(a, out, v, at + h)
                _put(b, out, w, at + h)


def dense(t: Tridiagonal) -> Array:
    """The full matrix."""
    out = np.empty((t.size, t.size))
    times(transposed(t), np.eye(t.size), out)
    return out.T


class Factor(NamedTuple):
    """Block LU factors, every block transposed.

    Attributes:
        pivots: (n, d, d) inverses of the diagonal blocks after elimination.
        lower, upper: (n−1, 6, d) and (n−1, d, 6) the blocks below and above.
        positive: whether all pivots are positive: a symmetric matrix then is positive definite.
    """

    pivots: Array
    lower: Array
    upper: Array
    positive: bool


def factor(t: Tridiagonal) -> Factor:
    """Factor a matrix that needs no pivoting: (nearly) symmetric positive definite.

    Raises:
        numpy.linalg.LinAlgError: if it is singular.
    """
    pivots, lower, upper = transposed(t)
    kind = _eliminate(pivots, lower, upper)
    if kind == 0:
        raise np.linalg.LinAlgError("singular")
    return Factor(pivots, lower, upper, kind == 2)


@compiled
def _eliminate(pivots: Array, lower: Array, upper: Array) -> int:
    """Block LU in place; returns the worst result of ``invert`` over all pivots."""
    n, d = pivots.shape[:2]
    between, less, kind = np.empty((6, 6)), np.empty((6, d)), 2
    for k in range(n):
        if k > 0:  # minus the block below times the last six of the pivot's inverse times the block above
            for i in range(6):
                for j in range(6):
                    between[i, j] = pivots[k - 1, d - 6 + i, d - 6 + j]
            product(between, lower[k - 1], less)
            for i in range(d):
                for m in range(6):
                    for j in range(d):
                        pivots[k, i, j] -= upper[k - 1, i, m] * less[m, j]
        kind = min(kind, invert(pivots[k]))
        if kind == 0:
            break
    return kind


@compiled
def solve(f: Factor, x: Array) -> None:
    """Replace right-hand sides (k, dn) by the solutions."""
    n, d = f.pivots.shape[:2]
    here = np.empty((2, d))
    for v in range(0, len(x), 2):  # as in ``times``
        w = min(v + 1, len(x) - 1)
        for k in range(n):
            at = d * k
            for h in range(0, d, 6):
                a, b = _ZERO, _ZERO
                if k > 0:
                    a, b = _more(f.lower, k - 1, 0, h, x, v, w, at - 6, 6, a, b)
                _put(a, here, 0, h)
                _put(b, here, 1, h)
            for r in range(d):
                here[0, r], here[1, r] = x[v, at + r] - here[0, r], x[w, at + r] - here[1, r]
            for h in range(0, d, 6):
                a, b = _more(f.pivots, k, 0, h, here, 0, 1, 0, d, _ZERO, _ZERO)
                _put(a, x, v, at + h)
                _put(b, x, w, at + h)
        for k in range(n - 2, -1, -1):
            at = d * k
            a, b = _more(f.upper, k, 0, 0, x, v, w, at + d, d, _ZERO, _ZERO)
            _put(a, here, 0, 0)
            _put(b, here, 1, 0)
            for r in range(d):
                p, q = x[v, at + r], x[w, at + r]
                for j in range(6):
                    p, q = p - f.pivots[k, d - 6 + j, r] * here[0, j], q - f.pivots[k, d - 6 + j, r] * here[1, j]
                x[v, at + r], x[w, at + r] = p, q


def solution(f: Factor, b: Array) -> Array:
    """The solution (dn,) for one right-hand side."""
    x = b[None].copy()
    solve(f, x)
    return x[0]
