"""Block-tridiagonal matrices: what a chain of bodies gives.

A block holds the internal coordinates β of one element and then the six of the node beyond it, so a block is coupled to the
next only through its last six rows.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky_banded, get_lapack_funcs, solve_banded

Array = NDArray[np.float64]
Numbers = NDArray[Any]

(_pbtrs,) = get_lapack_funcs(("pbtrs",), dtype=np.float64)


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


def from_elements(on_ends: Array, on_nodes: Array) -> Tridiagonal:
    """Sum element matrices (n, d+6, d+6), ordered a, b, β, and nodal ones (n+1, 6, 6); node 0 is clamped and dropped."""
    own = np.r_[12 : on_ends.shape[-1], 6:12]  # β, then b
    diagonal = on_ends[:, own[:, None], own]
    diagonal[:, -6:, -6:] += on_nodes[1:]
    diagonal[:-1, -6:, -6:] += on_ends[1:, :6, :6]
    return Tridiagonal(diagonal, on_ends[1:, :6][:, :, own], on_ends[1:, own, :6])


def rows(t: Tridiagonal) -> Array:
    """(n, d, 6 + 2d) each block's rows: over the last six of the block before, the block itself, and the next."""
    n, d = len(t.diagonal), t.block
    out = np.zeros((n, d, 6 + 2 * d))
    out[1:, :, :6], out[:, :, 6 : 6 + d], out[:-1, -6:, 6 + d :] = t.lower, t.diagonal, t.upper
    return out


def times(rows: Array, x: Numbers) -> Numbers:
    """(n, r, k) product of rows (n, r, 6 + 2d) as of ``rows``, one or several matrices' above each other, with x (dn, k)."""
    n, d = len(rows), (rows.shape[-1] - 6) // 2
    padded = np.zeros((6 + len(x) + d, x.shape[1]), x.dtype)
    padded[6 : 6 + len(x)] = x
    return rows @ padded.take(_windows(n, d), axis=0)


@lru_cache
def _windows(n: int, d: int) -> NDArray[np.intp]:
    """(n, 6 + 2d) where each block's window lies."""
    return d * np.arange(n)[:, None] + np.arange(6 + 2 * d)


def dense(t: Tridiagonal) -> Array:
    """The full matrix."""
    return times(rows(t), np.eye(t.size)).reshape(t.size, t.size)


def solve(t: Tridiagonal, b: Array) -> Array:
    """Solve t x = b by a banded LU factorisation. Raises ``numpy.linalg.LinAlgError`` if t is singular."""
    width = t.block + 5
    return solve_banded((width, width), _banded(t, lower=True), b, overwrite_ab=True, check_finite=False)


@dataclass(frozen=True)
class Factor:
    """Banded Cholesky factor of a symmetric positive definite matrix."""

    band: Array

    def solve(self, b: Array) -> Array:
        """Solve for right-hand sides (n, k)."""
        return _pbtrs(self.band, b)[0]


def cholesky(t: Tridiagonal) -> Factor:
    """Factor a symmetric matrix (the upper half is read).

    Raises:
        numpy.linalg.LinAlgError: if it is not positive definite.
    """
    return Factor(cholesky_banded(_banded(t, lower=False), overwrite_ab=True, check_finite=False))


def _banded(t: Tridiagonal, lower: bool) -> Array:
    n, d = t.size, t.block
    width = d + 5
    band = np.zeros((2 * width + 1 if lower else width + 1, n))
    i, j = np.indices((d, d))
    start = d * np.arange(len(t.diagonal))[:, None, None]
    on = np.ones((d, d), bool) if lower else i <= j
    band[(width + i - j)[on], (start + j)[:, on]] = t.diagonal[:, on]
    i, j = np.indices((6, d))  # the last six rows of a block against the next block
    band[width + i - 6 - j, start[1:] + j] = t.upper
    if lower:
        i, j = np.indices((d, 6))
        band[width + i - j + 6, start[1:] - 6 + j] = t.lower
    return band


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
