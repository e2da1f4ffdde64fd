"""M* = Bᵀ M B and similar products without forming B: sums over the tree instead of products with repeated columns.

All rows of B that a coordinate moves contain its screw, hence ``(Bᵀ X B)_ij = J_iᵀ (Σ X_rs) J_j`` over the rows r that i
moves and the rows s that j moves. The sums of 6×6 blocks are accumulated from the outermost bodies inwards. For X = M of
bodies alone this is the composite rigid body algorithm (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, sec. 6.2).
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .kinematics import Kinematics

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def congruent(k: Kinematics, row: Index, column: Index, blocks: Array) -> tuple[Array, Array, Array]:
    """Bᵀ M B, Bᵀ (2 M Ḃ + C B) and Bᵀ (M B̈ + C Ḃ + K B), each (n, n), from blocks (p, 3, 6, 6) of M, C and K."""
    groups = k.tree.groups
    g, size = groups.members.shape
    if not size:
        return np.zeros((0, 0)), np.zeros((0, 0)), np.zeros((0, 0))
    sums = _composite(groups.before, groups.row[row], groups.row[column], blocks)
    J, J1, J2 = (_screws(k, part) for part in (k.J, k.J1, k.J2))
    J[np.searchsorted(_first(k), k.tree.inner)] = np.eye(
        6, size
    )  # internal coordinates, last in the tree, are rows of B
    none = np.zeros_like(J)
    right = np.block([[J, 2.0 * J1, J2], [none, J, J1], [none, none, J]])  # (g, 18, 3 k)
    left = sums.transpose(1, 0, 3, 2, 4).reshape(g, 6 * g, 18)  # by the group of the column
    half = (left @ right).reshape(g, g, 6, 3 * size).transpose(1, 2, 0, 3).reshape(g, 6, g * 3 * size)
    whole = (np.swapaxes(J, 1, 2) @ half).reshape(g * size, g, 3, size).transpose(2, 0, 1, 3).reshape(3, g * size, -1)
    at = groups.place
    M, C, K = whole if np.array_equal(at, np.arange(g * size)) else whole[:, at[:, None], at]
    return M, C, K


def stretched(k: Kinematics, ends: Index, stiffness: Array) -> Iterator[tuple[Index, Array]]:
    """For each spring between two bodies (s, 2), −1 the ground: the c coordinates that strain it, and its (c, c) on them.

    ``B_b − B_a`` has columns only of coordinates that move one end and not the other.
    """
    moves = np.append(k.tree.carries, np.zeros((1, len(k.q)), bool), axis=0)
    apart = moves[ends[:, 1]].astype(float) - moves[ends[:, 0]]
    for sign, spring in zip(apart, stiffness, strict=True):
        at = np.flatnonzero(sign)
        J = k.J[:, at] * sign[at]
        yield at, J.T @ spring @ J


def _composite(before: Index, row: Index, column: Index, blocks: Array) -> Array:
    """(g, g, 3, 6, 6) sums of blocks over all rows and columns that two groups of coordinates move."""
    g = len(before)
    out = np.zeros((g, g, 3, 6, 6))
    both = (row >= 0) & (column >= 0)
    np.add.at(out, (row[both], column[both]), blocks[both])
    for j in range(g - 1, -1, -1):
        if before[j] >= 0:
            out[before[j]] += out[j]
    for j in range(g - 1, -1, -1):
        if before[j] >= 0:
            out[:, before[j]] += out[:, j]
    return out


def _screws(k: Kinematics, J: Array) -> Array:
    """Screws (g, 6, k) of each group, padded with zeros."""
    members = k.tree.groups.members
    return np.append(J, np.zeros((6, 1)), axis=1)[:, members].transpose(1, 0, 2)


def _first(k: Kinematics) -> Index:
    """(g,) the first coordinate of each group, ascending."""
    return k.tree.groups.members[:, 0]
