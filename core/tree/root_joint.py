"""The joint at a chain's root: a sequence of screws along the root's axes x, y, z, then about x, y, z.

Each coordinate q_i is clamped at zero, free, or on a spring: the potential of the springs is ``½ Σ k_i q_i²``. Node 1 moves
only by the joint's coordinates. Rotations about two hinges do not commute: the twists F_i(q) of node 1 depend on the joint's
angles, so that a wrench w contributes the geometric stiffness ``w · ∂F_i/∂q_j``. Without it K is not symmetric, and the
steady state depends on the path of the iteration.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..element.discretize import Chain
from ..mechanism.joints import SCREWS
from ..space import spatial as sp

Array = NDArray[np.float64]

_SCREWS = np.array([screw for _, screw in SCREWS["elastic"]])


class Response(NamedTuple):
    """Contribution of the joint to the balance of node 1, in that node's axes.

    Attributes:
        clamped: (6, 6) projector on the twists that the joint clamps.
        wrench: (6,) residual of its springs.
        stiffness: (6, 6) of its springs.
        turning: (6, 6) geometric stiffness due to the wrench on node 1.
    """

    clamped: Array
    wrench: Array
    stiffness: Array
    turning: Array


def clamped_freedoms(chain: Chain) -> NDArray[np.bool_]:
    """(6,) whether each of the joint's coordinates is clamped."""
    turn = _root_to_section(chain)
    return np.diagonal(turn.T @ chain.clamped @ turn) > 0.5


def springs(chain: Chain) -> Array:
    """(6,) stiffness of each of the joint's coordinates, N/m and N m/rad; zero where it is clamped or free."""
    turn = _root_to_section(chain)
    return np.diagonal(turn.T @ chain.beams.stiffness[0] @ turn).copy()


def put(chain: Chain, nodes: Array, first: Array) -> tuple[Array, Array]:
    """Set the joint's clamped coordinates to zero, and move node 1 and the blade beyond it accordingly.

    ``first`` is the pose (4, 4) of node 1 in the frame of node 0. Returns the node poses (n+1, 4, 4) and the new ``first``.
    """
    fixed = clamped_freedoms(chain)
    if not fixed.any():
        return nodes, first
    q = np.where(fixed, 0.0, _coordinates(chain, first))
    frame = sp.pose(chain.root_axes, np.zeros(3))
    here = frame.copy()
    for step in sp.exp(_SCREWS * q[:, None]):
        here = here @ step
    allowed = here @ frame.T
    out = nodes.copy()
    out[1:] = nodes[0] @ allowed @ sp.inverse(nodes[1]) @ nodes[1:]
    return out, allowed


def response(chain: Chain, first: Array, wrench: Array) -> Response:
    """The contribution of the joint to the balance of node 1.

    Args:
        chain: a chain on a joint.
        first: (4, 4) pose of node 1 in the frame of node 0.
        wrench: (6,) residual of node 1 without the joint, in the node's axes.
    """
    fixed = clamped_freedoms(chain)
    q = np.where(fixed, 0.0, _coordinates(chain, first))
    F, outer = np.empty((6, 6)), np.eye(4)  # columns: twists of node 1 in the joint's axes, from the last screw inwards
    for i in reversed(range(6)):
        F[:, i] = sp.adjoint(outer) @ _SCREWS[i]
        outer = outer @ sp.exp(-_SCREWS[i] * q[i])
    F = (_root_to_section(chain) @ F)[:, ~fixed]
    back = np.linalg.pinv(F)  # q̇ from a twist
    k = springs(chain)[~fixed]
    second = -np.einsum("k,jkl,li->ij", wrench, sp.ad(F.T), F)  # w · ∂F_i/∂q_j = −w · (F_j × F_i), j beyond i
    return Response(
        clamped=np.eye(6) - F @ back,
        wrench=back.T @ (k * q[~fixed]) + chain.beams.preload[0],
        stiffness=back.T * k @ back,
        turning=back.T @ np.triu(second, 1) @ back,
    )


def _root_to_section(chain: Chain) -> Array:
    """(6, 6) from twists in the root's axes to those in the first section's."""
    return sp.adjoint(sp.pose(chain.root_axes, np.zeros(3)))


def _coordinates(chain: Chain, first: Array) -> Array:
    """Joint coordinates (6,) from the pose of node 1 in the frame of node 0: displacements, and Cardan angles x, y, z."""
    frame = sp.pose(chain.root_axes, np.zeros(3))
    x = frame.T @ first @ frame
    angles = np.arctan2(-x[1, 2], x[2, 2]), np.arcsin(np.clip(x[0, 2], -1.0, 1.0)), np.arctan2(-x[0, 1], x[0, 0])
    return np.array([*x[:3, 3], *angles])
