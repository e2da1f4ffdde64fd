"""The velocity transformation Y = B v of a tree and its rates (Park et al. 2010, eq. 3, 4), in the ground's axes.

With all twists at the ground's origin, no transformation is needed along the tree: ``Y_child = Y_parent + J v``, J the
joint's screw in the ground's frame. This is the recursion of ``links`` with Ad = 1. A screw moves with its parent link, hence
``J̇ = Y × J`` and ``J̈ = Ẏ × J + Y × J̇``, Y the twist of that link. The dense B is formed, by the same recursion on unit
vectors, only where it is needed: for loops, and for M̂, Ĉ and K̂ as matrices.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from ..space import spatial as sp
from .links import twists
from .topology import Tree

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Kinematics:
    """A tree's state and its velocity transformation; b bodies, n coordinates.

    Attributes:
        tree: the mechanism.
        q: (n,) coordinates.
        poses: (b, 4, 4) of the bodies.
        J, J1, J2: (6, n) screws, their first and second rates along the motion.
        Y, A: (b, 6) twists of the bodies and their rates, ``A = B v̇ + Ḃ v``.
    """

    tree: Tree
    q: Array
    poses: Array
    J: Array
    J1: Array
    J2: Array
    Y: Array
    A: Array

    @cached_property
    def B(self) -> Array:
        """(b + m, 6, n) velocity transformation; the last m rows select the internal coordinates of beams that have them."""
        m = len(self.tree.first_internal)
        pick = np.zeros((m, 6, len(self.q)))
        for k in range(6):
            pick[np.arange(m), k, self.tree.first_internal + k] = 1.0
        return np.concatenate([transformation(self.tree, self.J), pick])

    @cached_property
    def B1(self) -> Array:
        """(b + m, 6, n) first rate of B along the motion."""
        return self._with_internal(transformation(self.tree, self.J1))

    @cached_property
    def B2(self) -> Array:
        """(b + m, 6, n) second rate of B along the motion."""
        return self._with_internal(transformation(self.tree, self.J2))

    def _with_internal(self, rows: Array) -> Array:
        return np.concatenate([rows, np.zeros((len(self.tree.first_internal), *rows.shape[1:]))])


def transformation(tree: Tree, J: Array) -> Array:
    """(b, 6, n) velocity transformation of the bodies from screws J (6, n), or its rates from theirs."""
    n = len(tree.coordinates)
    rows = np.zeros((n + 1, 6, n))  # the last one is the ground's, of index −1
    for link, parent in enumerate(tree.parent.tolist()):
        rows[link] = rows[parent]
        rows[link, :, link] = J[:, link]
    return rows[tree.link]


def poses(tree: Tree, q: Array) -> tuple[Array, Array]:
    """Poses (b, 4, 4) of the bodies and screws J (6, n) at coordinates q (n,)."""
    j = tree.joints
    q, screw = q[:j], tree.screw[:j]
    full_turns = 2.0 * np.pi * np.round(q / (2.0 * np.pi))  # full turns, removed before the exponential's series
    amount = np.where(screw[:, 3:].any(1), q - full_turns, q)
    steps = tree.fixed[:j] @ sp.exp(screw * amount[:, None])
    frames = kernels.placed(tree.links.parent[:j], np.eye(4), steps)  # of the ground and of the links
    J = np.zeros((6, len(tree.coordinates)))
    J[:, :j] = (sp.adjoint(frames[1:]) @ screw[..., None])[..., 0].T  # a screw is invariant under motion along it
    return frames[tree.link + 1] @ tree.on_link, J


def kinematics(tree: Tree, q: Array, v: Array, a: Array) -> Kinematics:
    """Poses, screws and twists at coordinates, velocities and accelerations, each (n,)."""
    x, J = poses(tree, q)
    along = tree.links.parent  # node at which each screw's link begins, 0 for the ground
    Y = _of_links(tree, (J * v).T[None])[0]  # Y = B v (eq. 3)
    J1 = _cross(Y[along], J)
    A = _of_links(tree, (J * a + J1 * v).T[None])[0]  # Ẏ = B v̇ + Ḃ v (eq. 4)
    J2 = _cross(A[along], J) + _cross(Y[along], J1)
    return Kinematics(tree, q, x, J, J1, J2, Y[tree.link + 1], A[tree.link + 1])


def _of_links(tree: Tree, relative: Array) -> Array:
    """(k, n + 1, 6) twists of the ground, which rests, and of the links, from those relative to their parents (k, n, 6)."""
    link_twists = twists(tree.links, np.ascontiguousarray(relative).reshape(len(relative), -1))
    return np.concatenate([np.zeros((len(link_twists), 1, 6)), link_twists], axis=1)


def carried(tree: Tree, wrenches: Array) -> Array:
    """(n, 6, …) total wrench on all bodies that each coordinate moves, from those on the bodies (b, 6, …)."""
    n = len(tree.coordinates)
    total = np.zeros((n + 1, *wrenches.shape[1:]))  # the last one is the ground's, of index −1
    for link, wrench in zip(tree.link.tolist(), wrenches, strict=True):
        total[link] += wrench
    for link, parent in reversed([*enumerate(tree.parent.tolist())]):
        total[parent] += total[link]
    return total[:n]


def projected(k: Kinematics, wrenches: Array, J: Array | None = None) -> Array:
    """Bᵀ w (n, …) for wrenches w (b + m, 6, …); ``J`` (6, n) replaces the screws if given."""
    b = len(k.poses)
    out = np.einsum("in,ni...->n...", k.J if J is None else J, carried(k.tree, wrenches[:b]))
    if len(k.tree.first_internal):
        out[k.tree.first_internal[:, None] + np.arange(6)] += wrenches[b:]
    return out


def _cross(Y: Array, J: Array) -> Array:
    return (sp.ad(Y) @ J.T[..., None])[..., 0].T
