"""Mode shapes of a tree at the common stations, sampled at massless points of its elements (see ``beams``)."""

import numpy as np
from numpy.typing import NDArray

from ..element.mesh import Mesh
from ..space import spatial as sp
from .pencil import Shape

Array = NDArray[np.float64]


def mode_shapes(body: Mesh, shape: Shape, twists: Array) -> NDArray[np.complex128]:
    """(m, q, 4) displacement and rotation about x at the mesh's sample points, in the hub's axes.

    Args:
        body: the mesh.
        shape: its shape in the steady state.
        twists: (2m, n, d) ξ_b and β of the elements, the real and the imaginary parts of one mode after the other; see
            ``pencil.on_nodes``.
    """
    element = body.samples.element
    begins = np.concatenate([np.zeros((len(twists), 1, 6)), twists[..., :6]], axis=1)[:, body.parent[element]]
    motions = np.concatenate([begins, twists[:, element]], axis=2)  # (ξ_a, ξ_b, β)
    sampled = np.einsum("qij,mqj->mqi", sampling_matrix(body, shape)[..., : motions.shape[2]], motions)
    return sampled[::2] + 1j * sampled[1::2]


def sampling_matrix(body: Mesh, shape: Shape) -> Array:
    """(q, 4, 18) displacement and rotation about x of sample points, in the hub's axes, from (ξ_a, ξ_b, β) in the nodes'."""
    p = body.samples
    k = p.element
    between = shape.relative[k]
    eta = sp.log(between @ body.corner[k])
    bubbles = p.bubble @ shape.beta[k][..., None] if shape.beta.size else np.zeros((len(k), 6, 1))
    zeta = p.zeta0 + (p.shape @ (eta - body.beams.law.eta[k])[..., None] + bubbles)[..., 0]
    tangent = sp.tangent(zeta)
    H = tangent @ p.shape @ sp.tangent_inverse(eta)  # the point's twist is ξ_a + H ρ: see ``beams``
    twist = np.concatenate([np.eye(6) - H, H @ sp.adjoint(between), tangent @ p.bubble], axis=2)
    velocity = twist[:, :3] - sp.skew(sp.exp(zeta)[:, :3, 3]) @ twist[:, 3:]  # v + w × p
    axes = shape.nodes[body.parent[k], :3, :3]
    return np.concatenate([axes @ velocity, axes[:, :1] @ twist[:, 3:]], axis=1)
