"""The rank criterion of the mechanism solver: independent constraints, and directions without stiffness."""

from dataclasses import dataclass
from typing import cast

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]

TOLERANCE = 1e-9
"""Singular values below this fraction of the largest count as zero, unless the errors of the matrix are known."""

_TIE = (
    1e-8  # relative difference of columns' lengths, above rounding, by which pivots choose the later of equal columns
)


class NotFiniteError(ValueError):
    """A matrix with an entry that is not finite."""


@dataclass(frozen=True)
class Ranked:
    """A matrix A (m, n) with its numerical rank r, from the singular values of ``U_e⁻¹ A U_x``.

    U_e and U_x contain the units of the equations A x = b and of the unknowns x. In these units, norms are of like quantities.

    Attributes:
        left_vectors: (m, r) left singular vectors, divided by the equations' units.
        singular_values: (r,) singular values that are not zero.
        right_vectors: (r, n) right singular vectors, times the unknowns' units.
        null: (n, n − r) basis of the null space, orthonormal in these units.
        left_null: (m, m − r) basis of the null space of the transpose, likewise.
    """

    left_vectors: Array
    singular_values: Array
    right_vectors: Array
    null: Array
    left_null: Array

    @property
    def rank(self) -> int:
        """The number of singular values that are not zero."""
        return len(self.singular_values)

    def solve(self, b: Array, damping: float = 0.0) -> Array:
        """The x (n,) or (n, k) of least norm that minimises |A x − b|, or |A x − b|² + damping |x|²; norms in the units."""
        scaled = (self.left_vectors.T @ b).T * self.singular_values / (self.singular_values**2 + damping)
        return self.right_vectors.T @ scaled.T


def ranked(
    A: Array, equations: Array | float = 1.0, unknowns: Array | float = 1.0, error: Array | None = None
) -> Ranked:
    """Decompose a matrix (m, n); any size may be 0.

    Args:
        A: the matrix.
        equations: (m,) units of its rows.
        unknowns: (n,) units of the unknowns that it multiplies.
        error: (n,) e: entry ij of A in these units, which is square, is exact to e_i e_j. If given, a small singular value
            counts as zero only if these errors can explain it: long chains of soft elements have smaller ones.

    Raises:
        NotFiniteError: an entry is not finite.
    """
    m, n = A.shape
    row, column = np.broadcast_to(equations, m)[:, None], np.broadcast_to(unknowns, n)[:, None]
    if not A.size:
        return Ranked(np.zeros((m, 0)), np.zeros(0), np.zeros((0, n)), np.eye(n) * column, np.eye(m) / row)
    scaled = A * column.T / row
    check_finite(scaled)
    try:
        u, s, vt = scipy.linalg.svd(scaled)
    except np.linalg.LinAlgError:  # divide and conquer, six times as fast, may fail to converge
        u, s, vt = scipy.linalg.svd(scaled, lapack_driver="gesvd")
    significant = np.zeros(max(m, n), bool)
    significant[: len(s)] = s > TOLERANCE * s[0]
    if error is not None:
        significant |= s > np.maximum((np.abs(u.T) @ error) * (np.abs(vt) @ error), n * np.finfo(float).eps * s[0])
    u, v = u / row, vt.T * column
    of_u, of_v = significant[:m], significant[:n]
    return Ranked(u[:, of_u], s[significant[: len(s)]], v[:, of_v].T, v[:, ~of_v], u[:, ~of_u])


def check_finite(A: Array) -> None:
    """Raise ``NotFiniteError`` if an entry is not finite."""
    if not np.isfinite(A).all():
        raise NotFiniteError(
            "the forces, stiffnesses or constraints are not finite: a value is out of range; check units"
        )


def pivots(A: Array) -> tuple[Index, Index]:
    """Indices of columns of A that span its range, chosen by QR with column pivoting, and of the other columns.

    Among columns of equal length, the last is chosen.
    """
    if not len(A):
        return np.zeros(0, np.intp), np.arange(A.shape[1])
    r = ranked(A).rank
    if r == 0:
        return np.zeros(0, np.intp), np.arange(A.shape[1])
    preference = 1.0 + _TIE * np.arange(A.shape[1])
    order = cast(tuple[Array, Index], scipy.linalg.qr(A * preference, mode="r", pivoting=True))[1].astype(np.intp)
    return np.sort(order[:r]), np.sort(order[r:])
