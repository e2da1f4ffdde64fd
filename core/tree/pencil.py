"""The rotating chain: its Cartesian pencil M ξ̈ + C ξ̇ + K ξ about a given shape.

With elastic connections only, every node moves freely: the velocity transformation B of the general solver is square and
invertible, so the modes follow from the twists of the bodies, of which each element couples two. Twists and wrenches of
node k are in the axes of node k.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from ..effects import ALL_EFFECTS, Effects
from ..element.discretize import Chain
from . import elimination, matrices, root_joint
from .elimination import Factor

Array = NDArray[np.float64]

_ROUNDING = 1e-13  # relative rounding in the stiffness of a rigid motion


@dataclass(frozen=True)
class ChainPencil:
    """Residual (dn,) on (ρ, β), and M, C, K (n, d + 6, d + 6) of the elements, see ``matrices``.

    The inertia carried by a node is part of the element that begins there, or, at the tip, of the last one. ``back`` is the
    Ad⁻¹ (n, 6, 6) of the relative poses. For a joint at the root, ρ of the first element is the twist of node 1, on which its
    springs act, and ``back`` the projector on the free directions; ``clamped`` is as in ``Chain``, at this shape. A clamped
    direction bears no load and does not move.
    """

    residual: Array
    M: Array
    C: Array
    K: Array
    back: Array
    clamped: Array

    @cached_property
    def factor(self) -> Factor:
        """Factors of K; ``numpy.linalg.LinAlgError`` if it is singular."""
        return elimination.factor(self.K, self.back, self.clamped)


@dataclass(frozen=True)
class Shape:
    """A configuration of a chain.

    Attributes:
        nodes: (n+1, 4, 4) poses in the hub's axes.
        beta: (n, 6 or 0) the elements' internal coordinates β.
        relative: (n, 4, 4) pose of each node in the frame of the one before. Redundant with ``nodes``, but
            differences of poses lose the last digits of the strain: at radius R, with axial stiffness EA and element length
            h, the force would be wrong by EA R/h times the rounding unit.
    """

    nodes: Array
    beta: Array
    relative: Array


def undeformed(chain: Chain) -> Shape:
    """The undeformed shape."""
    return Shape(chain.nodes, np.zeros((len(chain.nodes) - 1, chain.beams.inner)), chain.between)


def linearize(chain: Chain, shape: Shape, omega: float, gravity: Array, effects: Effects = ALL_EFFECTS) -> ChainPencil:
    """Residual and pencil at a shape.

    Args:
        chain: the chain.
        shape: its configuration.
        omega: rotor speed, rad/s.
        gravity: (3,) free-fall acceleration in the hub's axes, turning with it, m/s².
        effects: effects included.
    """
    nodes, relative, corner, beta, lumps, force, fall = (
        np.ascontiguousarray(a)
        for a in (shape.nodes, shape.relative, chain.corner, shape.beta, chain.lumps, chain.force, gravity)
    )
    f, M, C, K, spring, back, g, of_C, of_K = kernels.chain_parts(
        chain.beams.arrays, nodes, relative, corner, beta, lumps, force, omega, fall, effects.geometric
    )
    clamped = chain.clamped
    if clamped.size:  # the joint replaces the first element
        joint = root_joint.response(chain, relative[0], g[1] + f[1, :6] - f[1, 6:12])
        clamped, spring[0] = joint.clamped, joint.stiffness
        back[0] = np.eye(6) - clamped
        f[0], K[0, :, :12], K[0, :12] = 0.0, 0.0, 0.0
        f[0, 6:12] = joint.wrench
        if effects.geometric:
            of_K[1] += joint.turning
    residual = kernels.chain_sum(f, M, C, K, spring, back, lumps, g, of_C, of_K)
    if not effects.coriolis:
        C[:] = 0.0
    if clamped.size:
        residual[0, :6] -= clamped @ residual[0, :6]
    return ChainPencil(residual.ravel(), M, C, K, back, clamped)


def on_nodes(p: ChainPencil, vectors: NDArray[np.complex128]) -> Array:
    """(2m, n, d) ξ_b and β of the elements, the real and the imaginary parts of vectors (dn, m) of (ρ, β) in turn."""
    return matrices.twists(p.back, np.stack([vectors.real.T, vectors.imag.T], axis=1).reshape(-1, len(vectors)))


def loose(p: ChainPencil) -> bool:
    """Whether the root joint allows a rigid-body motion of the blade without stiffness, apart from rounding."""
    if not p.clamped.size:
        return False
    free = np.linalg.svd(np.eye(6) - p.clamped)[0][:, : 6 - round(float(np.trace(p.clamped)))]
    x = np.zeros((free.shape[1], len(p.residual)))
    x[:, :6] = free.T  # no strain beyond the joint
    K = x @ matrices.product(p.K, 1.0, p.back, x).T
    begins = np.abs(matrices.twists(p.back, x)[:, :-1, :6])
    cancelled = np.einsum("mki,kij,mkj->", begins, np.abs(p.K[1:, :6, :6]), begins)
    return bool(np.linalg.eigvalsh(0.5 * (K + K.T)).min(initial=np.inf) <= _ROUNDING * cancelled)
