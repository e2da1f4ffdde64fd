"""The velocity transformation Y = B v of a tree and its rates (Park et al. 2010, eq. 3, 4), in the ground's axes.

With all twists at the ground's origin, no transformation is needed along the tree: ``Y_child = Y_parent + J v``, J the
joint's screw in the ground's frame, so a body's rows of B are the J of the coordinates that carry it. A screw moves with its
parent link, hence ``J̇ = Y × J`` and ``J̈ = Ẏ × J + Y × J̇``, Y the twist of that link. B is stored as these screws and the
tree; the dense matrix is formed only where loops need it.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..space import spatial as sp
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
        m = len(self.tree.inner)
        pick = np.zeros((m, 6, len(self.q)))
        for k in range(6):
            pick[np.arange(m), k, self.tree.inner + k] = 1.0
        return np.concatenate([self._rows(self.J), pick])

    @cached_property
    def B1(self) -> Array:
        """(b + m, 6, n) first rate of B along the motion."""
        return self._with_inner(self._rows(self.J1))

    @cached_property
    def B2(self) -> Array:
        """(b + m, 6, n) second rate of B along the motion."""
        return self._with_inner(self._rows(self.J2))

    def _rows(self, J: Array) -> Array:
        return self.tree.carries[:, None, :] * J

    def _with_inner(self, rows: Array) -> Array:
        return np.concatenate([rows, np.zeros((len(self.tree.inner), *rows.shape[1:]))])


def poses(tree: Tree, q: Array) -> tuple[Array, Array]:
    """Poses (b, 4, 4) of the bodies and screws J (6, n) at coordinates q (n,)."""
    j, groups = tree.joints, tree.groups
    q, screw = q[:j], tree.screw[:j]
    whole = 2.0 * np.pi * np.round(q / (2.0 * np.pi))  # full turns, removed before the exponential's series
    amount = np.where(screw[:, 3:].any(1), q - whole, q)
    steps = tree.fixed[:j] @ sp.exp(screw * amount[:, None])
    before = groups.before[: len(groups.before) - len(tree.inner)]
    series = np.append(steps, np.eye(4)[None], axis=0)[
        groups.members[: len(before)]
    ]  # of a group's links, one after the other
    for k in range(1, series.shape[1]):
        series[:, k] = series[:, k - 1] @ series[:, k]
    base = np.empty((len(series) + 1, 4, 4))
    base[-1] = np.eye(4)  # the ground, so that index −1 finds it
    for g, parent in enumerate(before):
        base[g] = base[parent] @ series[g, -1]
    series = base[before][:, None] @ series
    links = np.append(series.reshape(-1, 4, 4)[groups.place[:j]], np.eye(4)[None], axis=0)
    J = np.zeros((6, len(tree.coordinates)))
    J[:, :j] = (sp.adjoint(links[:-1]) @ screw[..., None])[..., 0].T  # a screw is invariant under motion along it
    return links[tree.link] @ tree.on_link, J


def kinematics(tree: Tree, q: Array, v: Array, a: Array) -> Kinematics:
    """Poses, screws and twists at coordinates, velocities and accelerations, each (n,)."""
    x, J = poses(tree, q)
    Y = _before(tree, J * v)  # of the links that the screws move with
    J1 = _cross(Y, J)
    A = _before(tree, J * a + J1 * v)
    J2 = _cross(A, J) + _cross(Y, J1)
    carries = tree.carries.astype(float)
    Y = carries @ (J * v).T  # Y = B v (eq. 3)
    A = carries @ (J * a + J1 * v).T  # Ẏ = B v̇ + Ḃ v (eq. 4)
    return Kinematics(tree, q, x, J, J1, J2, Y, A)


def _before(tree: Tree, twists: Array) -> Array:
    """(n, 6) sum of the twists (6, n) of the coordinates before each one."""
    out, j = np.zeros(twists.T.shape), tree.joints
    out[:j] = tree.beyond[:j, :j] @ twists[:, :j].T
    return out


def projected(k: Kinematics, wrenches: Array, J: Array | None = None) -> Array:
    """Bᵀ w (n,) for wrenches w (b + m, 6); ``J`` (6, n) replaces the screws if given."""
    b = len(k.poses)
    out = np.einsum("in,ni->n", k.J if J is None else J, k.tree.carries.T.astype(float) @ wrenches[:b])
    if len(k.tree.inner):
        out[k.tree.inner[:, None] + np.arange(6)] += wrenches[b:]
    return out


def _cross(Y: Array, J: Array) -> Array:
    return (sp.ad(Y) @ J.T[..., None])[..., 0].T
