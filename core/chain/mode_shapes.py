"""Mode shapes of a chain at the common stations, sampled at massless points of its elements (see ``beams``)."""

import numpy as np
from numpy.typing import NDArray

from ..element.discretize import Chain
from ..space import spatial as sp
from .pencil import Shape

Array = NDArray[np.float64]


def mode_shapes(body: Chain, shape: Shape, vectors: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) displacement and rotation about x at the common stations, from vectors (dn, m) of ``pencil.on_nodes``."""
    e, d, m = body.samples.element, shape.beta.shape[1] + 6, vectors.shape[1]
    read = _readings(body, shape)
    blocks = np.ascontiguousarray(vectors).view(np.float64).reshape(-1, d, 2 * m)
    first = blocks[e - 1, -6:]
    first[e == 0] = 0.0  # the clamped node
    found = read @ np.concatenate([first, blocks[e, -6:], blocks[e, :-6]], axis=1)  # of (ξ_a, ξ_b, β)
    return found.view(np.complex128).transpose(2, 0, 1)


def _readings(body: Chain, shape: Shape) -> Array:
    """(q, 4, 12 or 18) a point's displacement and rotation about x in the hub's axes, from (ξ_a, ξ_b, β) in the nodes'."""
    p, e = body.samples, body.samples.element
    node = sp.inverse(shape.nodes[e]) @ shape.nodes[e + 1]
    eta = sp.log(node @ body.corner[e])
    zeta = p.zeta0 + (p.shape @ (eta - body.beams.law.eta[e])[..., None])[..., 0]
    if shape.beta.size:
        zeta += (p.bubble @ shape.beta[e][..., None])[..., 0]
    T = sp.tangent(zeta)
    H = T @ p.shape @ sp.tangent_inverse(eta)  # see ``beams``
    twist = np.concatenate([np.eye(6) - H, H @ sp.adjoint(node), T @ p.bubble], axis=2)[..., : 12 + shape.beta.shape[1]]
    motion = twist.copy()
    motion[:, :3] -= sp.skew(sp.exp(zeta)[:, :3, 3]) @ twist[:, 3:]  # velocity of the point: v + w × p
    turn = shape.nodes[e, :3, :3]
    return np.concatenate([turn @ motion[:, :3], turn[:, :1] @ motion[:, 3:]], axis=1)
