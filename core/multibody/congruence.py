"""M* = Bᵀ M B and similar products without forming B: sums over the tree instead of products with repeated columns.

All rows of B that a coordinate moves contain its screw, hence ``(Bᵀ X B)_ij = J_iᵀ (Σ X_rs) J_j`` over the rows r that i
moves and the rows s that j moves. The sums of 6×6 blocks are accumulated from the outermost bodies inwards. For X = M of
bodies alone this is the composite rigid body algorithm (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, sec. 6.2).

Where i moves every row that is coupled to those of j, the sum does not depend on i, and such entries together are a product of
matrices with six columns and six rows; likewise where j moves every row that is coupled to those of i. Few others remain.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .kinematics import Kinematics

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def congruent(k: Kinematics, row: Index, column: Index, blocks: Array) -> tuple[Array, Array, Array]:
    """Bᵀ M B, Bᵀ (2 M Ḃ + C B) and Bᵀ (M B̈ + C Ḃ + K B), each (n, n), from blocks (p, 3, 6, 6) of M, C and K."""
    groups, n = k.tree.groups, len(k.q)
    whole = np.empty((3, n, n))
    if n:
        carry = np.ones(len(groups.before), bool)
        carry[groups.of[k.tree.inner]] = False
        sums, coupled = _composite(groups.before, carry, groups.row[row], groups.row[column], blocks)
        by_column = (coupled[:-1, :-1] == coupled[-1, :-1]) & carry[:, None]
        by_row = (coupled[:-1, :-1] == coupled[:-1, -1:]) & carry & ~by_column
        J, J1, J2 = k.J.T.copy(), k.J1.T, k.J2.T
        J[k.tree.inner[:, None] + np.arange(6)] = np.eye(6)  # internal coordinates are rows of B
        none = np.zeros_like(J)
        right = np.stack([np.hstack(x) for x in ((J, none, none), (2.0 * J1, J, none), (J2, J1, J))])  # (3, n, 18)
        _products(whole, J, right, sums, groups.of, by_column, by_row)
        others = np.nonzero((coupled[:-1, :-1] > 0) & ~by_column & ~by_row)
        _pairs(whole, J, right, sums[others], *(groups.members[some] for some in others))
    M, C, K = whole
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


def _composite(
    before: Index, carry: NDArray[np.bool_], row: Index, column: Index, blocks: Array
) -> tuple[Array, Index]:
    """Sums (g + 1, g + 1, 3, 6, 6) of blocks over the rows and columns that two groups move, and how many they are.

    The last group moves the rows of all bodies, as the ground does; ``carry`` (g,): whether a group moves bodies.
    """
    g = len(before)
    out, number = np.zeros((g + 1, g + 1, 3, 6, 6)), np.zeros((g + 1, g + 1), np.intp)
    both = (row >= 0) & (column >= 0)
    np.add.at(out, (row[both], column[both]), blocks[both])
    np.add.at(number, (row[both], column[both]), 1)
    inwards = np.flatnonzero(carry)[::-1]
    for j in inwards:
        out[before[j]] += out[j]
        number[before[j]] += number[j]
    for j in inwards:
        out[:, before[j]] += out[:, j]
        number[:, before[j]] += number[:, j]
    return out, number


def _products(whole: Array, J: Array, right: Array, sums: Array, of: Index, by_column: Array, by_row: Array) -> None:
    """Entries (n, n) whose sums depend on one group only: that of the column, or that of the row."""
    by_column, by_row = by_column[of][:, of], by_row[of][:, of]
    left = (J[:, None] @ _wide(sums[:-1, -1])[of])[:, 0]  # (n, 18): J_iᵀ Σ X_rs over all s
    for out, screws in zip(whole, right, strict=True):
        forces = (_wide(sums[-1, :-1])[of] @ screws[:, :, None])[:, :, 0]  # (n, 6): Σ X_rs J_j over all r
        np.matmul(J, forces.T, out=out)
        out *= by_column
        np.copyto(out, left @ screws.T, where=by_row)


def _pairs(whole: Array, J: Array, right: Array, sums: Array, i: Index, j: Index) -> None:
    """Entries of pairs of groups with coordinates i and j (o, k), padded with −1, from their sums (o, 3, 6, 6)."""
    there = (i[:, :, None] >= 0) & (j[:, None, :] >= 0)
    row, column = (np.broadcast_to(x, there.shape)[there] for x in (i[:, :, None], j[:, None, :]))
    left = _padded(J)[i] @ _wide(sums)  # (o, k, 18)
    for out, screws in zip(whole, right, strict=True):
        out[row, column] = (left @ np.swapaxes(_padded(screws)[j], 1, 2))[there]


def _wide(sums: Array) -> Array:
    """Blocks (m, 3, 6, 6) side by side, (m, 6, 18)."""
    return sums.transpose(0, 2, 1, 3).reshape(len(sums), 6, 18)


def _padded(a: Array) -> Array:
    """With a row of zeros, which index −1 finds."""
    return np.concatenate([a, np.zeros((1, *a.shape[1:]))])
