"""Coordinate partitioning of a tree closed by cut joints (Park et al. 2010, eq. 12–22).

A weld joins a body to its copy, ``Φ = log(X_copy⁻¹ X_body) = 0``. In the ground's frame its Jacobian is ``B_body − B_copy``,
so its rates are differences of Ḃ and B̈. A pivoted QR factorisation chooses the dependent coordinates.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..rank import pivots, ranked
from ..space import spatial as sp
from .kinematics import Kinematics
from .scales import coordinate_units, length_at, weld_units
from .topology import Tree

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def misfit(tree: Tree, poses: Array) -> Array:
    """Φ (6w,) of all welds at the ground's origin, in its axes: the complete error of the poses, up to half a turn."""
    if not tree.welds:
        return np.zeros(0)
    body, copy = np.array(tree.welds).T
    x = np.concatenate([poses, np.eye(4)[None]])  # the ground, so that index −1 finds it
    gap = sp.log(sp.inverse(x[copy]) @ x[body])
    return (sp.adjoint(x[copy]) @ gap[..., None]).ravel()


def jacobian(tree: Tree, B: Array) -> Array:
    """Φ_q (6w, n) from B, or its rates from Ḃ and B̈ (b, 6, n)."""
    # Φᶜ_q = Φᶜ_Z B (eq. 6), since a weld's Φᶜ_Z is 1 for the body and −1 for the copy
    rows = [(0.0 if body < 0 else B[body]) - B[copy] for body, copy in tree.welds]
    return np.concatenate(rows) if rows else np.zeros((0, B.shape[-1]))


@dataclass(frozen=True)
class Partition:
    """δq = R δq_I over the free coordinates, and the rates of R along the motion.

    Attributes:
        free: (f,) indices of coordinates whose motion is not prescribed.
        independent: (i,) indices of q_I.
        dependent: indices of q_D.
        R, R1, R2: (f, i) and its first and second rates; rows as ``free``.
        redundant: redundant constraint equations, as ``joint: component``.
    """

    free: Index
    independent: Index
    dependent: Index
    R: Array
    R1: Array
    R2: Array
    redundant: tuple[str, ...]

    def among_free(self, a: Array) -> Array:
        """Rows and columns (f, f) of the free coordinates of a matrix (n, n); a view if they are contiguous."""
        first, f = (int(self.free[0]), len(self.free)) if len(self.free) else (0, 0)
        at = slice(first, first + f)
        return a[at, at] if f and self.free[-1] == first + f - 1 else a[np.ix_(self.free, self.free)]

    def onto(self, forces: Array) -> Array:
        """Rᵀ f (i,) or (i, k) of forces on the free coordinates."""
        return self.R.T @ forces if len(self.dependent) else forces

    def spread(self, steps: NDArray[Any]) -> NDArray[Any]:
        """R δq_I (f,) or (f, k)."""
        return self.R @ steps if len(self.dependent) else steps


def prescribed(tree: Tree) -> Index:
    """Indices of the coordinates whose motion is prescribed."""
    return np.array(
        sorted(tree.coordinate(m.coordinate) for m in tree.mechanism.motions if m.prescribed), dtype=np.intp
    )


def free_coordinates(tree: Tree) -> Index:
    """(f,) indices of the coordinates whose motion is not prescribed."""
    free = np.ones(len(tree.coordinates), bool)
    free[prescribed(tree)] = False
    return np.flatnonzero(free)


def partition(tree: Tree, k: Kinematics, independent: tuple[str, ...] | None = None) -> Partition:
    """Split the free coordinates (eq. 12) and express the dependent ones by the independent (eq. 14–16, 18).

    Args:
        tree: the mechanism.
        k: its kinematics at an assembled configuration.
        independent: names to use as q_I; chosen numerically if not given.

    Raises:
        MechanismError: names that cannot serve as independent coordinates.
    """
    free = free_coordinates(tree)
    J = jacobian(tree, k.B)[:, free] if tree.welds else np.zeros((0, len(free)))
    length = length_at(tree, k.poses)
    equations, units = weld_units(tree, length), coordinate_units(tree, length)[free]
    scaled = J * units / equations[:, None]
    dependent, independent_columns = pivots(scaled)
    rank = len(dependent)
    if independent is not None:
        independent_columns = np.flatnonzero(np.isin(free, [tree.coordinate(name) for name in independent]))
        dependent = np.setdiff1d(np.arange(len(free)), independent_columns)
    pinv = ranked(J[:, dependent], equations, units[dependent])
    if independent is not None and (len(independent_columns) != len(free) - rank or pinv.rank < rank):
        raise MechanismError(
            f"independent: {', '.join(independent)} do not determine the others: give {len(free) - rank} that are free "
            "and not tied to each other by a loop, or leave the choice to the solver"
        )
    R = np.zeros((len(free), len(independent_columns)))
    R[independent_columns, np.arange(len(independent_columns))] = 1.0
    R1, R2 = np.zeros_like(R), np.zeros_like(R)
    if rank:
        J1, J2 = (jacobian(tree, b)[:, free] for b in (k.B1, k.B2))
        # δΦ = Φ_qD δq_D + Φ_qI δq_I = 0 (eq. 13), so δq_D = −Φ_qD⁻¹ Φ_qI δq_I (eq. 14), and δq = R δq_I (eq. 15)
        R[dependent] = -pinv.solve(J[:, independent_columns])
        R1[dependent] = -pinv.solve(J1 @ R)
        R2[dependent] = -pinv.solve(J2 @ R + 2.0 * J1 @ R1)
    return Partition(free, free[independent_columns], free[dependent], R, R1, R2, _redundant(tree, scaled, rank))


def freedom(tree: Tree, k: Kinematics) -> int:
    """Degrees of freedom of the free coordinates at a configuration."""
    free, length = free_coordinates(tree), length_at(tree, k.poses)
    return ranked(
        jacobian(tree, k.B)[:, free], weld_units(tree, length), coordinate_units(tree, length)[free]
    ).null.shape[1]


def _redundant(tree: Tree, J: Array, rank: int) -> tuple[str, ...]:
    """Names of the rows of Φ_q (6w, f), in its units, that depend on others."""
    if rank == len(J):
        return ()
    parts = ("x", "y", "z", "rotation x", "rotation y", "rotation z")
    return tuple(sorted(f"{tree.weld_names[r // 6]}: {parts[r % 6]}" for r in pivots(J.T)[1]))
