"""The joint at a chain's root: six screws along, then about, the root's axes x, y, z; some of them are clamped.

Node 1 moves by the joint's coordinates q only. Two hinges do not commute: the free twists F(q) depend on how far the joint
has turned, and with the reaction r of the clamped directions that change is a stiffness of its own, ``r · ∂F_i/∂q_j``.
Without it K is not symmetric, and the steady state depends on the steps that led to it.
"""

import numpy as np
from numpy.typing import NDArray

from ..element.discretize import Chain
from ..multibody.joints import SCREWS
from ..space import spatial as sp

Array = NDArray[np.float64]

_SCREWS = np.array([screw for _, screw in SCREWS["elastic"]])


def clamped_freedoms(chain: Chain) -> NDArray[np.bool_]:
    """(6,) which of the joint's freedoms are clamped."""
    to_section = _root_to_section(chain)
    return np.diagonal(to_section.T @ chain.clamped @ to_section) > 0.5


def put(chain: Chain, nodes: Array) -> tuple[Array, Array]:
    """Node poses (n+1, 4, 4) with node 1 where the joint allows it, its clamped coordinates zero; the blade is carried along.

    Also returned: the pose (4, 4) of node 1 in the frame of node 0.
    """
    fixed = clamped_freedoms(chain)
    if not fixed.any():
        return nodes, sp.inverse(nodes[0]) @ nodes[1]
    q = np.where(fixed, 0.0, _coordinates(chain, nodes))
    frame = sp.pose(chain.root_axes, np.zeros(3))
    here = frame.copy()
    for step in sp.exp(_SCREWS * q[:, None]):
        here = here @ step
    first = here @ frame.T
    out = nodes.copy()
    out[1:] = nodes[0] @ first @ sp.inverse(nodes[1]) @ nodes[1:]
    return out, first


def clamped_projector(chain: Chain, nodes: Array, wrench: Array) -> tuple[Array, Array]:
    """The clamped directions at a shape, in node 1's own axes.

    Args:
        chain: the blade.
        nodes: (n+1, 4, 4) poses in the hub's axes.
        wrench: (6,) reaction of the joint, N and N m.

    Returns:
        The projector (6, 6) on the clamped directions and the geometric stiffness (6, 6) of the reaction.
    """
    fixed = clamped_freedoms(chain)
    if not fixed.any() or fixed.all():
        return chain.clamped, np.zeros((6, 6))
    q = np.where(fixed, 0.0, _coordinates(chain, nodes))
    F, outer = np.empty((6, 6)), np.eye(4)  # columns: twists of node 1 in the joint's axes, from the last screw inwards
    for i in reversed(range(6)):
        F[:, i] = sp.adjoint(outer) @ _SCREWS[i]
        outer = outer @ sp.exp(-_SCREWS[i] * q[i])
    F = (_root_to_section(chain) @ F)[:, ~fixed]
    back = np.linalg.pinv(F)
    turning = np.triu(
        -np.einsum("k,jkl,li->ij", wrench, sp.ad(F.T), F), 1
    )  # r · ∂F_i/∂q_j = −r · (F_j × F_i), j beyond i
    return np.eye(6) - F @ back, back.T @ turning @ back


def _root_to_section(chain: Chain) -> Array:
    """(6, 6) twists in the root's axes to the first section's."""
    return sp.adjoint(sp.pose(chain.root_axes, np.zeros(3)))


def _coordinates(chain: Chain, nodes: Array) -> Array:
    """(6,) of the joint's screws, from the poses of nodes 0 and 1: displacements, and Cardan angles x, y, z."""
    frame = sp.pose(chain.root_axes, np.zeros(3))
    x = frame.T @ sp.inverse(nodes[0]) @ nodes[1] @ frame
    angles = np.arctan2(-x[1, 2], x[2, 2]), np.arcsin(np.clip(x[0, 2], -1.0, 1.0)), np.arctan2(-x[0, 1], x[0, 0])
    return np.array([*x[:3, 3], *angles])
