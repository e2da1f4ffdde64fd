"""Block-tridiagonal matrices: what a chain of bodies gives.

A block holds the internal coordinates β of one element and then the six of the node beyond it, so a block is coupled to the
next only through its last six rows.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compiled import compiled, inlined, invert, product

Array = NDArray[np.float64]


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

    ``lever`` (n, 6, 6) takes twists of b from its own axes to those of a, in which the element matrices are.
    """
    n, d = len(on_ends), on_ends.shape[-1] - 6
    out = Tridiagonal(np.empty((n, d, d)), np.empty((n - 1, 6, d)), np.empty((n - 1, d, 6)))
    _gather(on_ends, lever, np.ascontiguousarray(on_nodes), out.diagonal, out.upper, out.lower)
    return out


@compiled
def _gather(on_ends: Array, lever: Array, on_nodes: Array, diagonal: Array, upper: Array, lower: Array) -> None:
    n, d = diagonal.shape[:2]
    right, own = np.empty((d + 6, d + 6)), np.empty((d + 6, d + 6))
    place = np.empty(d, dtype=np.intp)  # β, then b
    for i in range(d):
        place[i] = 12 + i if i < d - 6 else i + 12 - d
    for k in range(n):
        for i in range(d + 6):
            for j in range(d + 6):
                right[i, j] = on_ends[k, i, j] if j < 6 or j >= 12 else 0.0
            for m in range(6):
                for j in range(6):
                    right[i, 6 + j] += on_ends[k, i, 6 + m] * lever[k, m, j]
        for i in range(d + 6):
            for j in range(d + 6):
                own[i, j] = right[i, j] if i < 6 or i >= 12 else 0.0
        for m in range(6):
            for i in range(6):
                for j in range(d + 6):
                    own[6 + i, j] += lever[k, m, i] * right[6 + m, j]
        for i in range(d):
            for j in range(d):
                diagonal[k, i, j] = own[place[i], place[j]]
        for i in range(6):
            for j in range(6):
                diagonal[k, d - 6 + i, d - 6 + j] += on_nodes[k + 1, i, j]
                if k > 0:
                    diagonal[k - 1, d - 6 + i, d - 6 + j] += own[i, j]
            if k > 0:
                for j in range(d):
                    upper[k - 1, i, j] = own[i, place[j]]
                    lower[k - 1, j, i] = own[place[j], i]


def columns(*matrices: Tridiagonal) -> Array:
    """(n, 6 + 2d, rows) the rows of each block, of all matrices below each other, transposed, for ``times``.

    They go over the last six of the block before, the block itself, and the next.
    """
    n, d = len(matrices[0].diagonal), matrices[0].block
    out = np.zeros((n, 6 + 2 * d, d * len(matrices)))
    for k, t in enumerate(matrices):
        _put_columns(t.diagonal, t.upper, t.lower, d * k, out)
    return out


@compiled
def _put_columns(diagonal: Array, upper: Array, lower: Array, first: int, out: Array) -> None:
    n, d = diagonal.shape[:2]
    for k in range(n):
        for r in range(d):
            for j in range(d):
                out[k, 6 + j, first + r] = diagonal[k, r, j]
            for j in range(6 if k > 0 else 0):
                out[k, j, first + r] = lower[k - 1, r, j]
        for r in range(6 if k < n - 1 else 0):
            for j in range(d):
                out[k, 6 + d + j, first + d - 6 + r] = upper[k, r, j]


@compiled
def times(columns: Array, x: Array, out: Array) -> None:
    """The matrices, as of ``columns``, times vectors x (k, dn): block after block, all matrices' rows in each (k, rows n)."""
    n, width, rows = columns.shape
    d, size = (width - 6) // 2, x.shape[1]
    spare = np.empty(out.shape[1])
    for v in range(0, len(x), 2):  # two at a time
        p, q = x[v], x[min(v + 1, len(x) - 1)]
        p_out, q_out = out[v], out[v + 1] if v + 1 < len(x) else spare
        for i in range(n):
            first = rows * i
            for r in range(rows):
                p_out[first + r], q_out[first + r] = 0.0, 0.0
            for j in range(0, width, 6):
                at = d * i - 6 + j
                if 0 <= at < size:
                    p0, p1, p2, p3, p4, p5 = p[at], p[at + 1], p[at + 2], p[at + 3], p[at + 4], p[at + 5]
                    q0, q1, q2, q3, q4, q5 = q[at], q[at + 1], q[at + 2], q[at + 3], q[at + 4], q[at + 5]
                    for r in range(rows):
                        c0, c1, c2 = columns[i, j, r], columns[i, j + 1, r], columns[i, j + 2, r]
                        c3, c4, c5 = columns[i, j + 3, r], columns[i, j + 4, r], columns[i, j + 5, r]
                        p_out[first + r] += c0 * p0 + c1 * p1 + c2 * p2 + c3 * p3 + c4 * p4 + c5 * p5
                        q_out[first + r] += c0 * q0 + c1 * q1 + c2 * q2 + c3 * q3 + c4 * q4 + c5 * q5


def dense(t: Tridiagonal) -> Array:
    """The full matrix."""
    out = np.empty((t.size, t.size))
    times(columns(t), np.eye(t.size), out)
    return out.T


class Factor(NamedTuple):
    """Block LU factors: (n, d, d) inverses of the pivots and the blocks below (n−1, 6, d) and above (n−1, d, 6), all transposed."""

    pivots: Array
    lower: Array
    upper: Array


def factor(t: Tridiagonal, positive: bool = False) -> Factor:
    """Factor a matrix that needs no pivoting: one that is, or is nearly, symmetric positive definite.

    Raises:
        numpy.linalg.LinAlgError: if it is singular, or not ``positive`` definite though it has to be.
    """
    turned = (np.ascontiguousarray(np.swapaxes(part, -1, -2)) for part in (t.diagonal, t.lower, t.upper))
    f = Factor(*turned)
    if not _eliminate(f, positive):
        raise np.linalg.LinAlgError("singular" if not positive else "not positive definite")
    return f


@compiled
def _eliminate(f: Factor, positive: bool) -> bool:
    n, d = f.pivots.shape[:2]
    between, less = np.empty((6, 6)), np.empty((6, 12))
    for k in range(n):
        if k > 0:  # less the block below times the last six of the pivot's inverse times the block above
            for i in range(6):
                for j in range(6):
                    between[i, j] = f.pivots[k - 1, d - 6 + i, d - 6 + j]
            product(between, f.lower[k - 1], less)
            for i in range(d):
                for m in range(6):
                    for j in range(d):
                        f.pivots[k, i, j] -= f.upper[k - 1, i, m] * less[m, j]
        if not invert(f.pivots[k], positive):
            return False
    return True


@compiled
def solve(f: Factor, x: Array) -> None:
    """Replace right-hand sides (k, dn) by the solutions."""
    n, d = f.pivots.shape[:2]
    here = np.empty(d)
    for v in range(len(x)):
        p = x[v]
        for k in range(n):
            at = d * k
            for r in range(d):
                here[r], p[at + r] = p[at + r], 0.0
            if k > 0:
                _add(f.lower, k - 1, 0, -1.0, p, at - 6, here, 0)
            for j in range(0, d, 6):
                _add(f.pivots, k, j, 1.0, here, j, p, at)
        for k in range(n - 2, -1, -1):
            at = d * k
            for r in range(6):
                here[r] = 0.0
            for j in range(0, d, 6):
                _add(f.upper, k, j, -1.0, p, at + d + j, here, 0)
            _add(f.pivots, k, d - 6, 1.0, here, 0, p, at)


@inlined
def _add(turned: Array, k: int, j: int, sign: float, x: Array, first: int, out: Array, at: int) -> None:
    """Add ± the transpose of rows j … j + 5 of block k times x[first …] to out[at …]."""
    x0, x1, x2 = sign * x[first], sign * x[first + 1], sign * x[first + 2]
    x3, x4, x5 = sign * x[first + 3], sign * x[first + 4], sign * x[first + 5]
    for r in range(turned.shape[2]):
        out[at + r] += (
            turned[k, j, r] * x0
            + turned[k, j + 1, r] * x1
            + turned[k, j + 2, r] * x2
            + turned[k, j + 3, r] * x3
            + turned[k, j + 4, r] * x4
            + turned[k, j + 5, r] * x5
        )


def symmetric(t: Tridiagonal) -> Tridiagonal:
    """The symmetric part."""
    turned = np.swapaxes(t.diagonal, -1, -2)
    off = 0.5 * (t.upper + np.swapaxes(t.lower, -1, -2))
    return Tridiagonal(0.5 * (t.diagonal + turned), off, np.swapaxes(off, -1, -2))


def asymmetry(t: Tridiagonal, sign: int = 1) -> float:
    """Largest entry of t − sign·tᵀ relative to t's largest: 0 for a symmetric (+1) or skew (−1) matrix."""
    scale = max(np.abs(t.diagonal).max(), 1e-300)
    a = np.abs(t.diagonal - sign * np.swapaxes(t.diagonal, -1, -2)).max()
    b = np.abs(t.upper - sign * np.swapaxes(t.lower, -1, -2)).max(initial=0.0)
    return float(max(a, b) / scale)
