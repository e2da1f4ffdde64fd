"""M* = Bᵀ M B and similar products without forming B: sums over the tree instead of products with repeated columns.

All rows of B that a coordinate moves contain its screw, hence ``(Bᵀ X B)_ij = J_iᵀ (Σ X_rs) J_j`` over the rows r that i
moves and the rows s that j moves. For X = M of bodies alone the sums are the inertias of composite bodies (Featherstone, *Rigid
Body Dynamics Algorithms*, 2008, sec. 6.2).

Where i moves every row that is coupled to those of j, the sum does not depend on i, and such entries together are a product of
matrices with six columns and six rows; likewise where j moves every row that is coupled to those of i. Few others remain.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .kinematics import Kinematics
from .topology import Tree

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def congruent(k: Kinematics, row: Index, column: Index, blocks: Array) -> tuple[Array, Array, Array]:
    """Bᵀ M B, Bᵀ (2 M Ḃ + C B) and Bᵀ (M B̈ + C Ḃ + K B), each (n, n), from blocks (p, 3, 6, 6) of M, C and K."""
    J, J1, J2 = k.J.T.copy(), k.J1.T, k.J2.T
    J[k.tree.inner[:, None] + np.arange(6)] = np.eye(6)  # internal coordinates are rows of B
    none = np.zeros_like(J)
    right = np.stack([np.hstack(x) for x in ((J, none, none), (2.0 * J1, J, none), (J2, J1, J))])  # (3, n, 18)
    M, C, K = _projected(places(k.tree, np.arange(len(k.q)), row, column), J, right, blocks)
    return M, C, K


def add_springs(k: Kinematics, ends: Index, stiffness: Array, out: Array) -> None:
    """Add to ``out`` (j, j) the stiffness of springs (s, 6, 6) between two bodies (s, 2), −1 the ground.

    ``B_b − B_a`` has columns only of coordinates that move one end and not the other.
    """
    j = k.tree.joints
    moves = np.append(k.tree.carries[:, :j], np.zeros((1, j), bool), axis=0)
    spring, at = np.nonzero(moves[ends[:, 1]] != moves[ends[:, 0]])
    number = np.bincount(spring, minlength=len(ends))
    column = np.arange(len(at)) - (np.cumsum(number) - number)[spring]
    most = int(number.max(initial=0))
    strains, J = np.full((len(ends), most), -1), np.zeros((len(ends), most, 6))
    strains[spring, column] = at
    J[spring, column] = np.where(moves[ends[spring, 1], at], 1.0, -1.0)[:, None] * k.J.T[at]
    one, other = np.broadcast_arrays(strains[:, :, None], strains[:, None])
    there = (one >= 0) & (other >= 0)
    np.add.at(out, (one[there], other[there]), (J @ stiffness @ np.swapaxes(J, 1, 2))[there])


@dataclass(frozen=True)
class Places:
    """Where blocks (p, 6, 6) act, and which sums of them the entries of Bᵀ X B (c, c) contain.

    Attributes:
        of: (c,) the group of each coordinate.
        rows, columns: (p, g) 1: a group moves the row or the column of a block; else 0.
        by_row, by_column: (c, c) whether the sum of an entry contains all columns, or all rows, that are coupled.
        pairs: (p, o) the blocks in the sums of pairs of groups for which neither is true.
        i, j: (o, k) the coordinates of these groups, padded with −1.
    """

    of: Index
    rows: Array
    columns: Array
    by_row: NDArray[np.bool_]
    by_column: NDArray[np.bool_]
    pairs: Array
    i: Index
    j: Index


def places(tree: Tree, at: Index, row: Index, column: Index) -> Places:
    """The places of blocks with these rows and columns (p,) of B, for coordinates ``at`` (c,)."""
    groups, of = tree.groups, tree.groups.of[at]
    last = int(of.max(initial=-1)) + 1
    moved = _moved(tree)[:, :last]
    rows, columns = moved[row], moved[column]
    coupled = rows.T @ columns
    by_column = coupled == columns.sum(0)
    by_row = (coupled == rows.sum(0)[:, None]) & ~by_column
    g, h = np.nonzero((coupled > 0) & ~by_column & ~by_row)
    place = np.full(len(tree.coordinates) + 1, -1)
    place[at] = np.arange(len(at))
    members = place[groups.members]
    by_row, by_column = (entries[of][:, of] for entries in (by_row, by_column))
    return Places(of, rows, columns, by_row, by_column, rows[:, g] * columns[:, h], members[g], members[h])


def _projected(p: Places, J: Array, right: Array, blocks: NDArray[Any]) -> NDArray[Any]:
    """Bᵀ Σ X_k B_k (w, c, c); arguments as for ``_upper``."""
    whole = _upper(p, J, right, blocks)
    left = (J[:, None] @ _wide(_summed(p.rows, blocks))[p.of])[:, 0]  # (c, 6x): J_iᵀ Σ X_rs over all s
    for out, screws in zip(whole, right, strict=True):
        np.copyto(out, left @ screws.T, where=p.by_row)
    return whole


def _upper(p: Places, J: Array, right: Array, blocks: NDArray[Any]) -> NDArray[Any]:
    """Bᵀ Σ X_k B_k (w, c, c): for each of w results, the sum over the matrices X_k; zero where ``by_row``.

    Args:
        p: the places of the blocks.
        J: (c, 6) columns of B.
        right: (w, c, 6x) columns of the x matrices B_k of each result, side by side.
        blocks: (p, x, 6, 6) of the matrices X_k.
    """
    whole = np.zeros((len(right), len(J), len(J)), blocks.dtype)
    of_column = _wide(_summed(p.columns, blocks))[p.of]
    for out, screws in zip(whole, right, strict=True):
        forces = (of_column @ screws[:, :, None])[:, :, 0]  # (c, 6): Σ X_rs J_j over all r
        np.matmul(J, forces.T, out=out)
        out *= p.by_column
    _pairs(whole, J, right, _summed(p.pairs, blocks), p.i, p.j)
    return whole


def _moved(tree: Tree) -> Array:
    """(b + m, g) 1: a group of coordinates moves a row of B; else 0."""
    groups = tree.groups
    out = np.zeros((len(groups.row), len(groups.before)))
    out[: len(tree.bodies)] = tree.carries[:, groups.members[:, 0]]
    out[np.arange(len(tree.bodies), len(out)), groups.of[tree.inner]] = 1.0
    return out


def _summed(some: Array, blocks: NDArray[Any]) -> NDArray[Any]:
    """Sums (k, x, 6, 6) of some of the blocks (p, x, 6, 6), chosen by ones among zeros (p, k)."""
    flat = np.ascontiguousarray(blocks).reshape(len(blocks), -1)
    return (some.T @ flat.view(np.float64)).view(blocks.dtype).reshape(-1, *blocks.shape[1:])


def _pairs(whole: NDArray[Any], J: Array, right: Array, sums: NDArray[Any], i: Index, j: Index) -> None:
    """Entries of pairs of groups with coordinates i and j (o, k), padded with −1, from their sums (o, x, 6, 6)."""
    there = (i[:, :, None] >= 0) & (j[:, None, :] >= 0)
    row, column = (np.broadcast_to(x, there.shape)[there] for x in (i[:, :, None], j[:, None, :]))
    left = _padded(J)[i] @ _wide(sums)  # (o, k, 6x)
    for out, screws in zip(whole, right, strict=True):
        out[row, column] = (left @ np.swapaxes(_padded(screws)[j], 1, 2))[there]


def _wide(sums: NDArray[Any]) -> NDArray[Any]:
    """Blocks (m, x, 6, 6) side by side, (m, 6, 6x)."""
    return sums.transpose(0, 2, 1, 3).reshape(len(sums), 6, 6 * sums.shape[1])


def _padded(a: Array) -> Array:
    """With a row of zeros, which index −1 finds."""
    return np.concatenate([a, np.zeros((1, *a.shape[1:]))])
