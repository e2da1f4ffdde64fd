"""M, C and K of a mechanism that rotates as one rigid body: products with vectors, solutions, and a count of frequencies.

In axes that rotate with the mechanism B is constant. With ξ̇ = ξ̇_r + Y × ξ the Cartesian matrices become ``C + 2 M Y×`` and
``K + C Y× + M Y× Y×``. A product Bᵀ X B x takes three steps: B x by sums over the tree, X, which is sparse, and Bᵀ as B.

The internal coordinates β of a beam are coupled to the twists of its two ends only. They are eliminated beam by beam before the
projection: from K for solutions, and from H(ω) = K + iωC − ω²M for the count of its negative eigenvalues, both without error
(static and dynamic condensation; Leung, Int. J. Numer. Meth. Eng. 12, 1978, 1705). Dense matrices over the coordinates of
joints remain.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack
from scipy.sparse import bsr_array

from ..space import spatial as sp
from ..tree.congruence import Places, over_joints, places
from ..tree.dynamics import of_joints
from ..tree.kinematics import Kinematics
from ..tree.partition import free_coordinates
from ..tree.screws import Screws, diagonal, of_bodies, onto_joints, screws
from ..tree.state import State
from . import eigen

Array = NDArray[np.float64]
Index = NDArray[np.intp]

_LAPACK: Any = lapack
_SAME = 1e-9  # largest difference between the bodies' twists, as a fraction of the twist
_PANEL = 64  # rows of LAPACK's blocks


@dataclass(frozen=True)
class Rotating:
    """M, C, K (n, n) over the free coordinates of a mechanism without loops: those of joints (f), then the internal ones.

    Attributes:
        kinematics: of the steady state; b bodies.
        free: (n,) the free coordinates.
        row, column: (p,) rows and columns of the blocks, those of the bodies first; see ``dynamics.Cartesian``.
        blocks: (p, 3, 6, 6) of M, C and K in rotating axes.
        on_joints: (f, f) the part of K that is not a projection; see ``dynamics.of_joints``.
        ends: (m, 2) bodies at the ends of the beams that have internal coordinates.
        own: (m, 3, 6, 6) M, C and K on β.
        side: (m, 3, 6, 12) forces on β due to the twists of both ends.
    """

    kinematics: Kinematics
    free: Index
    row: Index
    column: Index
    blocks: Array
    on_joints: Array
    ends: Index
    own: Array
    side: Array

    def __len__(self) -> int:
        return len(self.free)

    @cached_property
    def scale(self) -> Array:
        """(n,) factors that give every coordinate, whatever its unit, a stiffness of about one."""
        inner = np.diagonal(self.own[:, 2], axis1=1, axis2=2)
        return 1.0 / np.sqrt(np.concatenate([np.diagonal(self._condensed), inner.ravel()]))

    def twists(self, x: Array) -> Array:
        """B x (6 (b + m), w) for x (n, w): the twists of the bodies in the ground's axes, then β."""
        return np.concatenate([of_bodies(self._screws, x[: self._f]), x[self._f :]])

    def inertia(self, x: Array) -> Array:
        """M x (n, w) for x (n, w)."""
        return self._products(self._cartesian(slice(0, 1)), x)[0]

    def inertia_and_coriolis(self, x: Array) -> tuple[Array, Array]:
        """M x and C x (n, w) for x (n, w)."""
        M, C = self._products(self._M_and_C, x)
        return M, C

    def stiffness(self, x: Array) -> Array:
        """K x (n, w) for x (n, w)."""
        (out,) = self._products(self._cartesian(slice(2, 3)), x)
        out[: self._f] += self.on_joints @ x[: self._f]
        return out

    def solve(self, force: Array) -> Array:
        """K⁻¹ f (n, w) for f (n, w)."""
        f, reach = self._f, self._reach
        load = force[:f] - onto_joints(self._screws, self._reached @ force[f:])
        joints = _LAPACK.dpotrs(self._root, load, lower=1)[0]
        return np.concatenate([joints, self._flexibility @ force[f:] - reach @ of_bodies(self._screws, joints)])

    def below(self, omega: float) -> int:
        """Number of frequencies below ``omega`` (rad/s): of negative eigenvalues of H(ω), by Sylvester's law of inertia."""
        powers = np.array([-(omega**2), 1j * omega, 1.0])
        blocks, own, side = (np.einsum("k,pkij->pij", powers, a) for a in (self.blocks, self.own, self.side))
        inside = np.linalg.eigvalsh(own)
        return _negative(self._without_inner(blocks, side, np.linalg.solve(own, side))) + int((inside < 0.0).sum())

    @property
    def _f(self) -> int:
        return len(self.on_joints)

    @cached_property
    def _screws(self) -> Screws:
        return screws(self.kinematics, self.free[: self._f])

    def _onto(self, forces: Array) -> Array:
        """Bᵀ g (n, w) of forces g (6 (b + m), w)."""
        bodies = 6 * len(self.kinematics.poses)
        return np.concatenate([onto_joints(self._screws, forces[:bodies]), forces[bodies:]])

    def _without_inner(self, blocks: NDArray[Any], side: NDArray[Any], moved: NDArray[Any]) -> NDArray[Any]:
        """(f, f) over the coordinates of joints, of which only the upper half is complete.

        From blocks (p, 6, 6), ``side`` (m, 6, 12), and −β due to the twists of both ends, ``moved`` (m, 6, 12).
        """
        lost = -side.conj().transpose(0, 2, 1) @ moved
        lost = lost.reshape(-1, 2, 6, 2, 6).transpose(0, 1, 3, 2, 4).reshape(-1, 6, 6)
        J = self.kinematics.J.T[self.free[: self._f]]
        return over_joints(self._places, J, np.concatenate([blocks[self._on_bodies], lost])) + self.on_joints

    @cached_property
    def _on_bodies(self) -> NDArray[np.bool_]:
        """(p,) whether a block couples bodies."""
        bodies = len(self.kinematics.poses)
        return (self.row < bodies) & (self.column < bodies)

    @cached_property
    def _places(self) -> Places:
        """Of the blocks on bodies, and of those that remain of the internal coordinates."""
        row = np.concatenate([self.row[self._on_bodies], self.ends[:, [0, 0, 1, 1]].ravel()])
        column = np.concatenate([self.column[self._on_bodies], self.ends[:, [0, 1, 0, 1]].ravel()])
        return places(self.kinematics.tree, self.free[: self._f], row, column)

    @cached_property
    def _condensed(self) -> Array:
        """K (f, f) without internal coordinates, of which only the upper half is complete."""
        return self._without_inner(self.blocks[:, 2], self.side[:, 2], self._moved)

    @cached_property
    def _root(self) -> Array:
        """L of K = L Lᵀ without internal coordinates, the lower half."""
        root, info = _LAPACK.dpotrf(self._condensed.T, lower=1, clean=0)  # the transpose has the order LAPACK needs
        if info:
            raise eigen.unstable()
        return root

    @cached_property
    def _flexibility(self) -> bsr_array:
        """K⁻¹ on β (6 m, 6 m)."""
        each = np.arange(len(self.own))
        return _sparse(each, each, np.linalg.inv(self.own[:, 2]), (len(each), len(each)))

    @cached_property
    def _moved(self) -> NDArray[Any]:
        """−β (m, 6, 12) due to the twists of both ends, without forces on β."""
        return np.linalg.solve(self.own[:, 2], self.side[:, 2])

    @cached_property
    def _reach(self) -> bsr_array:
        """``_moved`` by the twists of the bodies (6 m, 6 b)."""
        m = len(self.own)
        blocks = self._moved.reshape(-1, 6, 2, 6).transpose(0, 2, 1, 3).reshape(-1, 6, 6)
        return _sparse(np.repeat(np.arange(m), 2), self.ends.ravel(), blocks, (m, len(self.kinematics.poses)))

    @cached_property
    def _reached(self) -> bsr_array:
        return self._reach.T.tobsr()

    @cached_property
    def _M_and_C(self) -> bsr_array:
        return self._cartesian(slice(0, 2))

    def _cartesian(self, parts: slice) -> bsr_array:
        """Some of M, C and K in Cartesian coordinates, one below the other in each block."""
        rows = len(self.kinematics.poses) + len(self.own)
        return _sparse(self.row, self.column, self.blocks[:, parts].reshape(len(self.row), -1, 6), (rows, rows))

    def _products(self, cartesian: bsr_array, x: Array) -> list[Array]:
        """The products (n, w) of each of these matrices with x (n, w)."""
        found = (cartesian @ self.twists(x)).reshape(len(self.kinematics.poses) + len(self.own), -1, 6, x.shape[1])
        return [self._onto(found[:, k].reshape(-1, x.shape[1])) for k in range(found.shape[1])]


def rotating(state: State, coriolis: bool = True) -> Rotating:
    """M, C and K of a mechanism about a steady state in which all bodies have the same twist.

    Args:
        state: the state.
        coriolis: whether C is included; otherwise it is zero.

    Raises:
        ValueError: the bodies' twists differ or are not steady, there are loops, or a beam with mass has an end on the ground.
        UnstableError: K is not positive definite.
        EigenError: if an entry is not finite.
    """
    k, c, tree = state.kinematics, state.cartesian, state.kinematics.tree
    free, b, m = free_coordinates(tree), len(k.poses), len(tree.inner)
    turn = float(np.abs(k.Y).max())
    if tree.welds or np.ptp(k.Y, axis=0).max() > _SAME * turn or np.abs(k.A).max() > _SAME * turn**2:
        raise ValueError("the mechanism has loops, or does not rotate steadily as one rigid body")
    order = np.argsort(c.row, kind="stable")
    row, column = c.row[order], c.column[order]
    blocks = _in_rotating_axes(c.blocks[order], column < b, sp.ad(k.Y[0]))
    if not coriolis:
        blocks[:, 1] = 0.0
    on_beta, aside = row >= b, (row >= b) & (column < b)
    if np.bincount(row[aside] - b, minlength=m).tolist() != [2] * m:
        raise ValueError("a beam with mass has an end on the ground")
    own = np.zeros((m, 3, 6, 6))
    np.add.at(own, row[on_beta & ~aside] - b, blocks[on_beta & ~aside])
    side = blocks[aside].reshape(m, 2, 3, 6, 6).transpose(0, 2, 3, 1, 4).reshape(m, 3, 6, 12)
    joints = free[free < tree.joints]
    on_joints = of_joints(tree, k, c)[np.ix_(joints, joints)]
    found = Rotating(k, free, row, column, blocks, on_joints, column[aside].reshape(m, 2), own, side)
    _check(found)
    return found


def _in_rotating_axes(blocks: Array, body: NDArray[np.bool_], turn: Array) -> Array:
    """Blocks (p, 3, 6, 6) in axes with the twist Y, ``turn`` = Y × (6, 6); ``body`` (p,): they act on the twist of a body."""
    M, C, K = np.moveaxis(blocks, 1, 0)
    on = body[:, None, None]
    of_M, of_C = (on * (part.reshape(-1, 6) @ turn).reshape(part.shape) for part in (M, C))
    return np.stack([M, C + 2.0 * of_M, K + of_C + (of_M.reshape(-1, 6) @ turn).reshape(M.shape)], axis=1)


def _check(p: Rotating) -> None:
    """Raise what ``rotating`` raises for the matrices."""
    eigen.check_finite(p.blocks, p.on_joints)
    try:
        np.linalg.cholesky(p.own[:, 2])
    except np.linalg.LinAlgError:
        raise eigen.unstable() from None
    both = p._on_bodies
    inertia = diagonal(p._screws, p.row[both], p.column[both], p.blocks[both, 0])
    eigen.check_stiffness(np.diagonal(p._condensed), inertia)
    _ = p._root


def _sparse(row: Index, column: Index, blocks: NDArray[Any], shape: tuple[int, int]) -> bsr_array:
    """A matrix of blocks (p, r, 6), sorted by rows; ``shape`` in blocks. Those at the same place add up in products."""
    begin = np.searchsorted(row, np.arange(shape[0] + 1))
    size = (blocks.shape[1] * shape[0], blocks.shape[2] * shape[1])
    return bsr_array((np.ascontiguousarray(blocks), column, begin), shape=size)


def _negative(H: NDArray[np.complex128]) -> int:
    """Number of negative eigenvalues of a Hermitian matrix, which is overwritten, from the pivots of its LDLᴴ factorisation.

    Only its upper half is used. A pivot of two rows has one negative eigenvalue (Bunch and Kaufman 1977).
    """
    factors, pivots, info = _LAPACK.zhetrf(H.T, lower=1, lwork=_PANEL * len(H), overwrite_a=True)
    if info < 0:
        raise eigen.EigenError(f"eigenvalues: LDLᴴ factorisation: argument {-info}")
    single = pivots > 0
    return int((np.real(np.diagonal(factors))[single] < 0.0).sum()) + int((~single).sum()) // 2
