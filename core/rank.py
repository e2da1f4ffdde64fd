"""The rank criterion of the mechanism solver: independent constraints, and directions without stiffness."""

from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.linalg import lapack

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_LAPACK: Any = lapack

TOLERANCE = 1e-9
"""Singular values below this fraction of the largest count as zero."""


@dataclass(frozen=True)
class Ranked:
    """A matrix (m, n) with its numerical rank r and the parts of its singular value decomposition.

    Attributes:
        range: (m, r) orthonormal basis of the columns' span.
        sizes: (r,) singular values above ``TOLERANCE``.
        rows: (r, n) orthonormal basis of the rows' span.
        null: (n, n − r) orthonormal basis of the null space.
        left_null: (m, m − r) orthonormal basis of the null space of the transpose.
    """

    range: Array
    sizes: Array
    rows: Array
    null: Array
    left_null: Array

    @property
    def rank(self) -> int:
        """The number of singular values above ``TOLERANCE``."""
        return len(self.sizes)

    def solve(self, b: Array, damping: float = 0.0) -> Array:
        """The least-norm x (n,) or (n, k) that minimises |A x − b|, or |A x − b|² + damping |x|²."""
        scaled = (self.range.T @ b).T * self.sizes / (self.sizes**2 + damping)
        return self.rows.T @ scaled.T


def ranked(A: Array) -> Ranked:
    """Decompose a matrix (m, n); any size may be 0.

    Raises:
        ValueError: an entry is not finite.
    """
    m, n = A.shape
    if not A.size:
        return Ranked(np.zeros((m, 0)), np.zeros(0), np.zeros((0, n)), np.eye(n), np.eye(m))
    try:
        u, s, vt = scipy.linalg.svd(A)
    except np.linalg.LinAlgError:  # divide and conquer, six times as fast, may fail to converge
        u, s, vt = scipy.linalg.svd(A, lapack_driver="gesvd")
    r = int((s > TOLERANCE * s[0]).sum())
    return Ranked(u[:, :r], s[:r], vt[:r], vt[r:].T, u[:, r:])


@dataclass(frozen=True)
class Regular:
    """LU factors of a matrix (n, n) of full rank, as returned by ``scipy.linalg.lu_factor``."""

    factors: tuple[Array, Index]

    @property
    def null(self) -> Array:
        """Its null space (n, 0)."""
        return np.zeros((len(self.factors[0]), 0))

    left_null = null

    def solve(self, b: Array) -> Array:
        """A⁻¹ b for b (n,) or (n, k)."""
        return scipy.linalg.lu_solve(self.factors, b, check_finite=False)


def factored(A: Array) -> Regular | Ranked:
    """Factor a matrix (n, n): by LU if its condition number proves full rank, else as ``ranked``.

    Since κ₁ ≥ κ₂/n, and LAPACK's estimate of κ₁ is hardly ever below a third of it (Higham, *Accuracy and Stability of
    Numerical Algorithms*, 2002, sec. 15.3), ``10 n κ₁ < 1/TOLERANCE`` implies full rank by the criterion above.

    Raises:
        ValueError: an entry is not finite.
    """
    if not np.isfinite(A).all():
        raise ValueError("array must not contain infs or NaNs")
    if len(A):
        lu, pivot, info = _LAPACK.dgetrf(A)
        if info == 0 and _LAPACK.dgecon(lu, float(np.abs(A).sum(0).max()))[0] > 10.0 * len(A) * TOLERANCE:
            return Regular((lu, pivot))
    return ranked(A)


def pivots(A: Array) -> tuple[Index, Index]:
    """Indices of columns of A that span its range, chosen by QR with column pivoting, and of the other columns."""
    if not len(A):
        return np.zeros(0, np.intp), np.arange(A.shape[1])
    r = ranked(A).rank
    if r == 0:
        return np.zeros(0, np.intp), np.arange(A.shape[1])
    order = cast(tuple[Array, Index], scipy.linalg.qr(A, mode="r", pivoting=True))[1].astype(np.intp)
    return np.sort(order[:r]), np.sort(order[r:])
