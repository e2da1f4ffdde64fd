"""The velocity transformation Y = B v of a tree and its rates (Park et al. 2010, eq. 3, 4), in the ground's axes.

With twists taken at the ground's origin, passing down the tree needs no transformation: ``Y_child = Y_parent + J v``, J the
joint's screw brought to the ground, so a body's rows of B are the J of the coordinates that carry it. A screw moves with
the link it hangs on, hence ``J̇ = Y × J`` and ``J̈ = Ẏ × J + Y × J̇``, Y the twist of that link.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..space import spatial as sp
from .tree import Tree

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Kinematics:
    """A tree's state and its velocity transformation; b bodies, n coordinates.

    Attributes:
        q: (n,) coordinates.
        poses: (b, 4, 4) of the bodies.
        J: (6, n) screws.
        B, B1, B2: (b + m, 6, n) velocity transformation, its first and second rates along the motion; the last m rows pick
            the internal coordinates of the m beams that have them.
        Y, A: (b, 6) twists of the bodies and their rates, ``A = B v̇ + Ḃ v``.
    """

    q: Array
    poses: Array
    J: Array
    B: Array
    B1: Array
    B2: Array
    Y: Array
    A: Array


def poses(tree: Tree, q: Array) -> tuple[Array, Array]:
    """Poses (b, 4, 4) of the bodies and screws J (6, n) at coordinates q (n,)."""
    whole = 2.0 * np.pi * np.round(q / (2.0 * np.pi))  # turns, which the exponential's series need not follow
    amount = np.where(tree.screw[:, 3:].any(1), q - whole, q)
    steps = tree.fixed @ sp.exp(tree.screw * amount[:, None])
    links = np.empty((len(q) + 1, 4, 4))
    links[-1] = np.eye(4)  # the ground, so that index −1 finds it
    for j, before in enumerate(tree.before):
        links[j] = links[before] @ steps[j]
    # a screw is the same seen from either side of its own motion
    J = (sp.adjoint(links[:-1]) @ tree.screw[..., None])[..., 0].T
    return links[tree.link] @ tree.on_link, J


def kinematics(tree: Tree, q: Array, v: Array, a: Array) -> Kinematics:
    """Everything that follows from coordinates, velocities and accelerations, each (n,)."""
    x, J = poses(tree, q)
    hangs = tree.above.astype(float) - np.eye(len(q))  # the links strictly above
    Y = hangs @ (J * v).T
    J1 = _cross(Y, J)
    A = hangs @ (J * a + J1 * v).T
    J2 = _cross(A, J) + _cross(Y, J1)
    carries = tree.carries.astype(float)
    B, B1, B2 = (carries[:, None, :] * j for j in (J, J1, J2))
    Y = B @ v  # (eq. 3)
    A = B @ a + B1 @ v  # Ẏ = B v̇ + Ḃ v (eq. 4)
    pick = np.zeros((len(tree.inner), 6, len(q)))
    for k in range(6):
        pick[np.arange(len(tree.inner)), k, tree.inner + k] = 1.0
    none = np.zeros_like(pick)
    return Kinematics(q, x, J, np.concatenate([B, pick]), np.concatenate([B1, none]), np.concatenate([B2, none]), Y, A)


def _cross(Y: Array, J: Array) -> Array:
    return (sp.ad(Y) @ J.T[..., None])[..., 0].T
