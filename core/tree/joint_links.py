"""Joints between the nodes of a tree: a sequence of screws along the axes x, y, z of a frame, then about x, y, z.

Each coordinate q_i is clamped at zero, free, or on a spring: the potential of the springs is ``½ Σ k_i q_i²``. The relative
twist ρ = F q̇ of the link's ends, in the axes of its end a, is a combination of the screws' present twists
``F_i = Ad(exp(S_1 q_1) … exp(S_{i−1} q_{i−1})) S_i``. A screw moves with those before it, ``∂F_i/∂q_j = F_j × F_i`` for
j < i, so that the wrench w that the joint transmits contributes the geometric stiffness ``w · (F_j × F_i)``. Without it K is
not symmetric, and the steady state depends on the path of the iteration.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..element.mesh import JointLink
from ..mechanism.joints import SCREWS
from ..space import spatial as sp

Array = NDArray[np.float64]

_SCREWS = np.array([screw for _, screw in SCREWS["elastic"]])


class Response(NamedTuple):
    """Contribution of a joint to the balance of its link, in the axes of its end a.

    Attributes:
        clamped: (6, 6) projector of ρ on the directions that the joint clamps.
        force: (6,) of its springs, on ρ.
        stiffness: (6, 6) of its springs, and the geometric one of the wrench it transmits, on ρ.
    """

    clamped: Array
    force: Array
    stiffness: Array


def pose(joint: JointLink, q: Array) -> Array:
    """(4, 4) pose of end b in the frame of end a at coordinates q (6,)."""
    out = joint.at_a
    for step in sp.exp(_SCREWS * q[:, None]):
        out = out @ step
    return out @ sp.inverse(joint.at_b)


def coordinates(joint: JointLink, relative: Array) -> Array:
    """Joint coordinates (6,) from the pose (4, 4) of end b in the frame of end a: displacements, and Cardan angles x, y, z."""
    x = sp.inverse(joint.at_a) @ relative @ joint.at_b
    angles = np.arctan2(-x[1, 2], x[2, 2]), np.arcsin(np.clip(x[0, 2], -1.0, 1.0)), np.arctan2(-x[0, 1], x[0, 0])
    return np.where(joint.clamped, 0.0, np.array([*x[:3, 3], *angles]))


def response(joint: JointLink, q: Array, carried: Array, preload: Array) -> Response:
    """The contribution of a joint at coordinates q (6,) to the balance of its link.

    Args:
        joint: the joint.
        q: its coordinates; those that it clamps are zero.
        carried: (6,) wrench on all that lies beyond, in the axes of end a.
        preload: (6,) force on ρ at q = 0.
    """
    free = ~joint.clamped
    F = twists(joint, q)[:, free]
    rates = np.linalg.pinv(F)  # q̇ from ρ
    k = joint.stiffness[free]
    turning = np.einsum("k,jkl,li->ij", carried, sp.ad(F.T), F)  # w · (F_j × F_i), j before i
    return Response(
        clamped=np.eye(6) - F @ rates,
        force=rates.T @ (k * q[free]) + preload,
        stiffness=rates.T @ (np.diag(k) + np.tril(turning, -1)) @ rates,
    )


def twists(joint: JointLink, q: Array) -> Array:
    """F (6, 6) by columns: twists ρ of end b relative to end a, in the axes of end a, from the rates of the coordinates."""
    F, inner = np.empty((6, 6)), joint.at_a
    for i in range(6):
        F[:, i] = sp.adjoint(inner) @ _SCREWS[i]
        inner = inner @ sp.exp(_SCREWS[i] * q[i])
    return F
