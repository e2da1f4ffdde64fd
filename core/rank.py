"""The rank criterion of the mechanism solver: independent constraints, and directions without stiffness."""

from dataclasses import dataclass
from typing import cast

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

TOLERANCE = 1e-9
"""Singular values below this fraction of the largest count as zero."""


@dataclass(frozen=True)
class Ranked:
    """A matrix (m, n) with its numerical rank r and the parts of its singular value decomposition.

    Attributes:
        range: (m, r) orthonormal basis of the columns' span.
        sizes: (r,) singular values that count.
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
        """The number of singular values that count."""
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


def pivots(A: Array) -> tuple[Index, Index]:
    """Columns of A that span its range, as QR with column pivoting picks them, and the columns that depend on them."""
    r = ranked(A).rank
    if r == 0:
        return np.zeros(0, np.intp), np.arange(A.shape[1])
    order = cast(tuple[Array, Index], scipy.linalg.qr(A, mode="r", pivoting=True))[1].astype(np.intp)
    return np.sort(order[:r]), np.sort(order[r:])
