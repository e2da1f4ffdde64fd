"""Mode shapes of a chain at the common stations, sampled at massless points of its elements (see ``beams``)."""

import numpy as np
from numpy.typing import NDArray

from ..compiled import compiled
from ..element.discretize import Chain
from ..element.pencil import ride
from ..space import rigid
from .pencil import Shape

Array = NDArray[np.float64]


def mode_shapes(body: Chain, shape: Shape, vectors: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) displacement and rotation about x at the common stations, from vectors (dn, m)."""
    e, d, m = body.samples.element, shape.beta.shape[1] + 6, vectors.shape[1]
    read = np.empty((len(e), 4, d + 6))
    p = body.samples
    beta = shape.beta if shape.beta.size else np.zeros((len(shape.beta), 6))
    _readings(p.element, p.zeta0, p.shape, p.bubble, shape.nodes, body.corner, beta, body.beams.law.eta, read)
    blocks = np.ascontiguousarray(vectors).view(np.float64).reshape(-1, d, 2 * m)
    first = blocks[e - 1, -6:]
    first[e == 0] = 0.0  # the clamped node
    found = read @ np.concatenate([first, blocks[e, -6:], blocks[e, :-6]], axis=1)  # of (ξ_a, ξ_b, β)
    return found.view(np.complex128).transpose(2, 0, 1)


@compiled
def _readings(
    element: NDArray[np.intp],
    zeta0: Array,
    shape: Array,
    bubble: Array,
    nodes: Array,
    corner: Array,
    beta: Array,
    eta_undeformed: Array,
    out: Array,
) -> None:
    """(q, 4, 12 or 18) a point's displacement and rotation about x in the hub's axes, from (ξ_a, ξ_b, β) in the nodes'."""
    back, node, x, position = np.empty((4, 4)), np.empty((4, 4)), np.empty((4, 4)), np.empty((4, 4))
    eta, change, zeta = np.empty(6), np.empty(6), np.empty(6)
    inverse, lever, T, slope, H = (
        np.empty((6, 6)),
        np.empty((6, 6)),
        np.empty((6, 6)),
        np.empty((6, 12)),
        np.empty((6, 12)),
    )
    motion = np.empty((6, 18))
    for q in range(len(element)):
        e = element[q]
        rigid.inverse(nodes[e], back)
        rigid.compose(back, nodes[e + 1], node)
        rigid.adjoint(node, lever)
        rigid.compose(node, corner[e], x)
        rigid.log(x, eta)
        rigid.tangent_inverse(eta, inverse)
        for i in range(6):
            change[i] = eta[i] - eta_undeformed[e, i]
        ride(zeta0[q], shape[q], bubble[q], change, inverse, beta[e], zeta, slope, T, H)
        rigid.exp(zeta, position)
        for i in range(6):  # the twist in a's axes, at a
            for j in range(6):
                motion[i, j] = (1.0 if i == j else 0.0) - H[i, j]
                motion[i, 6 + j] = 0.0
                motion[i, 12 + j] = H[i, 6 + j]
                for k in range(6):
                    motion[i, 6 + j] += H[i, k] * lever[k, j]
        for j in range(out.shape[2]):
            for i in range(3):  # velocity of the point: v + w × p
                k, m = (i + 1) % 3, (i + 2) % 3
                motion[i, j] += motion[3 + k, j] * position[m, 3] - motion[3 + m, j] * position[k, 3]
            for i in range(3):
                out[q, i, j] = 0.0
                for k in range(3):
                    out[q, i, j] += nodes[e, i, k] * motion[k, j]
            out[q, 3, j] = 0.0
            for k in range(3):
                out[q, 3, j] += nodes[e, 0, k] * motion[3 + k, j]
