"""Block-tridiagonal matrices with 6×6 blocks: what a chain of bodies gives."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse
from numpy.typing import NDArray
from scipy.linalg import cho_solve_banded, cholesky_banded, solve_banded

Array = NDArray[np.float64]

_WIDTH = 11  # sub-diagonals of two neighbouring 6×6 blocks


@dataclass(frozen=True)
class Tridiagonal:
    """Blocks on the diagonal (n, 6, 6), above it (n−1, 6, 6) and below it (n−1, 6, 6)."""

    diagonal: Array
    upper: Array
    lower: Array

    @property
    def size(self) -> int:
        """Number of scalar rows."""
        return 6 * len(self.diagonal)


def from_elements(on_ends: Array, on_nodes: Array) -> Tridiagonal:
    """Sum element matrices (n, 12, 12) and nodal ones (n+1, 6, 6); node 0 is clamped and dropped."""
    diagonal = on_nodes[1:] + on_ends[:, 6:, 6:]
    diagonal[:-1] += on_ends[1:, :6, :6]
    return Tridiagonal(diagonal, on_ends[1:, :6, 6:], on_ends[1:, 6:, :6])


def sparse(t: Tridiagonal) -> scipy.sparse.bsr_array:
    """Block compressed sparse rows, for products."""
    n = len(t.diagonal)
    column = np.arange(n)[:, None] + np.array([-1, 0, 1])
    data = np.zeros((n, 3, 6, 6))
    data[1:, 0], data[:, 1], data[:-1, 2] = t.lower, t.diagonal, t.upper
    inside = ((column >= 0) & (column < n)).ravel()
    pointer = np.concatenate([[0], np.cumsum(inside.reshape(n, 3).sum(1))])
    return scipy.sparse.bsr_array(
        (data.reshape(-1, 6, 6)[inside], column.ravel()[inside], pointer), shape=(6 * n, 6 * n)
    )


def dense(t: Tridiagonal) -> Array:
    """The full matrix."""
    return sparse(t).toarray()


def solve(t: Tridiagonal, b: Array) -> Array:
    """Solve t x = b by a banded LU factorisation. Raises ``numpy.linalg.LinAlgError`` if t is singular."""
    return solve_banded((_WIDTH, _WIDTH), _banded(t, lower=True), b, overwrite_ab=True, check_finite=False)


@dataclass(frozen=True)
class Factor:
    """Banded Cholesky factor of a symmetric positive definite matrix."""

    band: Array

    def solve(self, b: Array) -> Array:
        """Solve for one or many right-hand sides (n,) or (n, k)."""
        return cho_solve_banded((self.band, False), b, check_finite=False)


def cholesky(t: Tridiagonal) -> Factor:
    """Factor a symmetric matrix (the upper half is read).

    Raises:
        numpy.linalg.LinAlgError: if it is not positive definite.
    """
    return Factor(cholesky_banded(_banded(t, lower=False), overwrite_ab=True, check_finite=False))


def _banded(t: Tridiagonal, lower: bool) -> Array:
    n = t.size
    band = np.zeros((2 * _WIDTH + 1 if lower else _WIDTH + 1, n))
    i, j = np.indices((6, 6))
    start = 6 * np.arange(len(t.diagonal))[:, None, None]
    on = np.ones((6, 6), bool) if lower else i <= j
    band[(_WIDTH + i - j)[on], (start + j)[:, on]] = t.diagonal[:, on]
    band[_WIDTH + i - j - 6, start[1:] + j] = t.upper
    if lower:
        band[_WIDTH + i - j + 6, start[:-1] + j] = t.lower
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
