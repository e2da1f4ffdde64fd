"""Mode shapes of a chain at the common stations, sampled at massless points of its elements (see ``beams``)."""

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from ..element.mesh import Chain
from .pencil import Shape

Array = NDArray[np.float64]


def mode_shapes(body: Chain, shape: Shape, twists: Array) -> NDArray[np.complex128]:
    """(m, 21, 4) displacement and rotation about x at the common stations, in the hub's axes.

    Args:
        body: the chain.
        shape: its shape in the steady state.
        twists: (2m, n, d) ξ_b and β of the elements, the real and the imaginary parts of one mode after the other; see
            ``pencil.on_nodes``.
    """
    p = body.samples
    nodes, corner, beta, moved = (np.ascontiguousarray(a) for a in (shape.nodes, body.corner, shape.beta, twists))
    element = p.element.astype(np.int64)
    found = kernels.sampled(
        body.beams.law.arrays, nodes, corner, beta, body.parent, element, p.zeta0, p.shape, p.bubble, moved
    )
    return found.view(np.complex128)[..., 0]
