"""The rotating tree: its Cartesian pencil M ξ̈ + C ξ̇ + K ξ about a given shape.

All nodes rotate with the hub. Twists and wrenches of node k are in the axes of node k, and ξ is relative to the hub. In these
axes B is constant, so that M̂ = BᵀMB, Ĉ = BᵀCB and K̂ = BᵀKB (``links``).
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from ..effects import ALL_EFFECTS, Effects
from ..element.mesh import Mesh
from ..space import spatial as sp
from . import elimination
from .elimination import Factor
from .links import Links, allowed, gathered, product, twists

Array = NDArray[np.float64]

_ROUNDING = 1e-13  # relative rounding in the stiffness of a rigid motion


@dataclass(frozen=True)
class TreePencil:
    """Residual (dn,) on (ρ, β), and M, C, K (n, d + 6, d + 6) of the elements, see ``links``.

    The inertia of a node is part of the first element that begins there, or, at a tip, of the one that ends there. A direction
    that a joint clamps bears no load and does not move.
    """

    residual: Array
    M: Array
    C: Array
    K: Array
    links: Links

    @cached_property
    def factor(self) -> Factor:
        """Factors of K; ``numpy.linalg.LinAlgError`` if it is singular."""
        return elimination.factor(self.K, self.links)


@dataclass(frozen=True)
class Shape:
    """A configuration of a tree.

    Attributes:
        nodes: (n+1, 4, 4) poses in the hub's axes.
        beta: (n, 6 or 0) the elements' internal coordinates β.
        relative: (n, 4, 4) pose of each node in the frame of its parent. Redundant with ``nodes``, but
            differences of poses lose the last digits of the strain: at radius R, with axial stiffness EA and element length
            h, the force would be wrong by EA R/h times the rounding unit.
        joints: (j,) coordinates of the joints.
    """

    nodes: Array
    beta: Array
    relative: Array
    joints: Array = field(default_factory=lambda: np.zeros(0))


def undeformed(mesh: Mesh) -> Shape:
    """The undeformed shape."""
    beta = np.zeros((len(mesh.nodes) - 1, mesh.beams.internal_count))
    return Shape(mesh.nodes, beta, mesh.between, np.zeros(len(mesh.joints)))


def assembled(mesh: Mesh, relative: Array, beta: Array, joints: Array) -> Shape:
    """The shape with these relative poses (n, 4, 4), in which those of joints are replaced by their coordinates (j,)."""
    for joint, q in zip(mesh.joints, joints, strict=True):
        relative[joint.link] = sp.exp(joint.screw * q) @ mesh.between[joint.link]
    return Shape(kernels.placed(mesh.parent, mesh.nodes[0], relative), beta, relative, joints)


def linearize(mesh: Mesh, shape: Shape, omega: float, gravity: Array, effects: Effects = ALL_EFFECTS) -> TreePencil:
    """Residual and pencil at a shape.

    Args:
        mesh: the nodes and elements.
        shape: the configuration to linearise about.
        omega: rotor speed, rad/s.
        gravity: (3,) m/s², in the hub's axes.
        effects: the effects included; without the geometric ones, the residual is not meaningful.
    """
    nodes, relative, corner, beta, lumps, force, fall = (
        np.ascontiguousarray(a)
        for a in (shape.nodes, shape.relative, mesh.corner, shape.beta, mesh.lumps, mesh.force, gravity)
    )
    f, M, C, K, spring, g, of_C, of_K = kernels.tree_parts(
        mesh.beams.arrays, nodes, relative, corner, beta, lumps, force, mesh.parent, omega, fall, effects.geometric
    )
    links = Links(mesh.parent, sp.adjoint(sp.inverse(relative)), np.zeros((0, 6, 6)))
    for joint in mesh.joints:
        f[joint.link], K[joint.link, :, :12], K[joint.link, :12], spring[joint.link] = 0.0, 0.0, 0.0, 0.0
    residual = gathered(links, f, g)
    if mesh.joints:
        links = _with_joints(mesh, shape, links, residual, K, spring, effects.geometric)
    kernels.tree_sum(links.arrays, M, C, K, spring, lumps, of_C, of_K)
    if not effects.coriolis:
        C[:] = 0.0
    return TreePencil(allowed(links, residual.reshape(1, -1))[0], M, C, K, links)


def _with_joints(
    mesh: Mesh, shape: Shape, links: Links, residual: Array, K: Array, spring: Array, geometric: bool
) -> Links:
    """Add the joints' forces to the residual (n, d) and their stiffness to K and ``spring``; the links with what they clamp."""
    clamped_directions = np.zeros((len(residual), 6, 6))
    for joint, q in zip(mesh.joints, shape.joints, strict=True):
        k, force = joint.link, joint.stiffness * q * joint.rate
        clamped_directions[k] = np.eye(6) - np.outer(joint.screw, joint.rate)
        spring[k] = joint.stiffness * np.outer(joint.rate, joint.rate)
        # the wrench on end b follows end a: see add_elastic in beam.hpp
        turning = sp.coadjoint(-residual[k, :6]) if geometric else np.zeros((6, 6))
        K[k, :6, 6:12] += turning
        K[k, 6:12, 6:12] += turning
        residual[k, :6] += force
    return Links(links.parent, links.to_child, clamped_directions)


def on_nodes(p: TreePencil, vectors: NDArray[np.complex128]) -> Array:
    """(2m, n, d) ξ_b and β of the elements, the real and the imaginary parts of vectors (dn, m) of (ρ, β) in turn."""
    return twists(p.links, np.stack([vectors.real.T, vectors.imag.T], axis=1).reshape(-1, len(vectors)))


def has_free_motion(p: TreePencil) -> bool:
    """Whether the joints allow the parts that they connect to move as rigid bodies without stiffness, apart from rounding."""
    clamped_directions = p.links.clamped_directions
    joints = np.flatnonzero(
        clamped_directions.any(axis=(1, 2)) & (np.trace(clamped_directions, axis1=1, axis2=2) < 5.5)
    )
    if not len(joints):
        return False
    x = np.zeros((len(joints), len(p.links.parent), len(p.residual) // len(p.links.parent)))
    x[np.arange(len(joints)), joints, :6] = np.linalg.svd(np.eye(6) - clamped_directions[joints])[0][
        :, :, 0
    ]  # no strain elsewhere
    x = x.reshape(len(x), -1)
    K = x @ product(p.K, 1.0, p.links, x).T
    node_twists = np.concatenate([np.zeros((len(x), 1, 6)), twists(p.links, x)[..., :6]], axis=1)
    begins = np.abs(node_twists[:, p.links.parent])
    cancelled = np.sqrt(np.einsum("mki,kij,mkj->m", begins, np.abs(p.K[:, :6, :6]), begins))
    unit = np.where(cancelled > 0, cancelled, 1.0)
    scaled = 0.5 * (K + K.T) / unit[:, None] / unit
    return bool(np.linalg.eigvalsh(scaled).min() <= _ROUNDING)
