"""How a turbine moves in its modes: displacements of tower, hub and blades, from which it can be drawn at any time.

At time t the motion is the real part of what stands here, times e^{iωt}. Blade k is at the azimuth ψ_k = Ωt + 2πk/N, and moves
relative to the hub by the sum of its multi-blade coordinates with the factors 1, cos ψ_k, sin ψ_k … (``multiblade``).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..tree.links import Links, twists
from ..tree.pencil import Shape

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Motion:
    """Positions and displacements of m modes, m; the scale of each mode is arbitrary.

    Attributes:
        tower: (p, 3) nodes of the tower in the steady state, in the ground's axes (x up, z downwind).
        shaft: (4, 4) pose of the hub's centre in the ground's axes, z along the rotor's axis.
        blade: (q, 3) nodes of one blade in the hub's axes, at the azimuth 0.
        tower_motion: (m, p, 3) displacements of the tower.
        hub: (m, 6) twist of the hub in the shaft's axes.
        blades: (m, N, q, 3) displacements relative to the hub, in the blade's own axes, by multi-blade coordinate.
    """

    tower: Array
    shaft: Array
    blade: Array
    tower_motion: Complex
    hub: Complex
    blades: Complex


def displacements(shape: Shape, links: Links, vectors: Array) -> Array:
    """(r, n + 1, 3) displacements of the nodes of a part in motions (r, dn), in the axes of node 0's carrier."""
    own = twists(links, vectors)[..., :3]
    in_frame = np.einsum("nij,rnj->rni", shape.nodes[1:, :3, :3], own)
    return np.concatenate([np.zeros((len(vectors), 1, 3)), in_frame], axis=1)


def flattened(motion: Motion, angles: Complex, length: float) -> Complex:
    """(m, k) displacements of all nodes and ``length`` times the shaft's ``angles`` (m, s); the largest is 1."""
    count = len(motion.hub)
    parts = (motion.tower_motion.reshape(count, -1), length * angles, motion.blades.reshape(count, -1))
    out: Complex = np.concatenate(parts, axis=1)
    return out / np.abs(out).max(axis=1, keepdims=True)
