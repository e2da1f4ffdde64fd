"""The rotating chain: its Cartesian pencil M ξ̈ + C ξ̇ + K ξ about a given shape.

With elastic connections only, every node moves freely: the velocity transformation B of the general solver is square and
invertible, so the modes follow from the twists of the bodies, for which the matrices are block-tridiagonal. Twists and
wrenches of node k are in the axes of node k.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..compiled import compiled
from ..effects import ALL_EFFECTS, Effects
from ..element import beams as bm
from ..element import inertia
from ..element.discretize import Chain
from ..space import rigid
from . import blocks, root_joint, strained
from .blocks import Factor, Tridiagonal
from .strained import Strained

Array = NDArray[np.float64]

_FORCE_ROUNDING, _ENERGY_ROUNDING = (
    1e-13,
    1e-28,
)  # relative rounding in the stiffness of a rigid motion: forces, strain energy


@dataclass(frozen=True)
class ChainPencil:
    """Residual (dn,) and block-tridiagonal M, C, K of β and nodes 1 … n; K = ``remainder`` + ``spring`` on ρ = Ad ξ_b − ξ_a.

    ``spring`` is (n, 6, 6) and ``lever`` the Ad (n, 6, 6) of the relative poses, the identity for a joint at the root, whose
    springs act on the twist of node 1; ``clamped`` is as in ``Chain``, at this shape. A clamped direction has a unit
    stiffness and neither mass nor load: it does not move and contributes no mode.
    """

    residual: Array
    M: Tridiagonal
    C: Tridiagonal
    remainder: Tridiagonal
    spring: Array
    lever: Array
    clamped: Array

    @cached_property
    def K(self) -> Tridiagonal:
        """The complete stiffness."""
        on_b = np.swapaxes(self.lever, -1, -2) @ self.spring
        diagonal, upper, lower = (
            self.remainder.diagonal.copy(),
            self.remainder.upper.copy(),
            self.remainder.lower.copy(),
        )
        diagonal[:, -6:, -6:] += on_b @ self.lever
        diagonal[:-1, -6:, -6:] += self.spring[1:]
        upper[:, :, -6:] -= self.spring[1:] @ self.lever[1:]
        lower[:, -6:] -= on_b[1:]
        return _clamp(Tridiagonal(diagonal, upper, lower), self.clamped, 1.0)

    @cached_property
    def factor(self) -> Factor:
        """LU factors of K; ``numpy.linalg.LinAlgError`` if it is singular."""
        return blocks.factor(self.K)

    @property
    def strained(self) -> Strained:
        """K for products without cancellation; see ``strained``."""
        clamped = self.clamped if self.clamped.size else np.zeros((6, 6))
        return Strained(blocks.transposed(self.remainder), self.spring, self.lever, clamped)


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
    n, d = len(shape.nodes), 6 + chain.beams.inner
    frame, fall, axes, push = np.empty((n, 6)), np.empty((n, 6)), np.empty((n, 3, 3)), np.empty((n, 3))
    x, lever = np.empty((n - 1, 4, 4)), np.empty((n - 1, 6, 6))
    nodes, relative, corner = (np.ascontiguousarray(a) for a in (shape.nodes, shape.relative, chain.corner))
    _place(nodes, relative, omega, gravity, chain.force, corner, frame, fall, axes, push, x, lever)
    p = bm.pencil(chain.beams, x, shape.beta, frame[:-1], fall[:-1], effects, axes[:-1])
    g, C, K = np.empty((n, 6)), np.empty((n, 6, 6)), np.empty((n, 6, 6))
    inertia.carried(chain.lumps, frame, fall, push, effects.geometric, g, C, K)
    residual, clamped = np.empty((n - 1, d)), chain.clamped
    if clamped.size:  # the joint replaces the first element
        p.residual[0], p.remainder[0, :, :12], p.remainder[0, :12], lever[0] = 0.0, 0.0, 0.0, np.eye(6)
    _balance(p.residual, lever, g, residual)
    if clamped.size:
        joint = root_joint.response(chain, relative[0], residual[0, -6:])
        clamped, p.spring[0] = joint.clamped, joint.stiffness
        residual[0, -6:] += joint.wrench
        residual[0, -6:] -= clamped @ residual[0, -6:]
        if effects.geometric:
            K[1] += joint.turning
    moving = 1.0 if effects.coriolis else 0.0
    return ChainPencil(
        residual.ravel(),
        _clamp(blocks.from_elements(p.M, lever, chain.lumps), clamped, 0.0),
        _clamp(blocks.from_elements(moving * p.C, lever, moving * C), clamped, 0.0),
        blocks.from_elements(p.remainder, lever, K),
        p.spring,
        lever,
        clamped,
    )


@compiled
def _place(
    nodes: Array,
    relative: Array,
    omega: float,
    gravity: Array,
    force: Array,
    corner: Array,
    frame: Array,
    fall: Array,
    axes: Array,
    push: Array,
    x: Array,
    lever: Array,
) -> None:
    """For every node, in its own axes: the hub's twist, gravity, load and the hub's axes; x is the pose of end b in a."""
    back, to_node = np.empty((4, 4)), np.empty((6, 6))
    for k in range(len(nodes)):
        rigid.inverse(nodes[k], back)
        rigid.adjoint(back, to_node)
        for i in range(6):
            frame[k, i], fall[k, i] = omega * to_node[i, 5], 0.0
        for i in range(3):
            push[k, i] = 0.0
            for j in range(3):
                axes[k, i, j] = back[i, j]
                fall[k, i] += back[i, j] * gravity[j]
                push[k, i] += back[i, j] * force[k, j]
        if k + 1 < len(nodes):
            rigid.adjoint(relative[k], lever[k])
            rigid.compose(relative[k], corner[k], x[k])


@compiled
def _balance(on_ends: Array, lever: Array, on_nodes: Array, out: Array) -> None:
    """Forces (n, d) on β and nodes 1 … n in their axes, from elements (n, d + 6), ordered a, b, β, and nodes (n+1, 6)."""
    inner = out.shape[1] - 6
    for k in range(len(out)):
        for i in range(inner):
            out[k, i] = on_ends[k, 12 + i]
        for i in range(6):
            out[k, inner + i] = on_nodes[k + 1, i]
            for j in range(6):
                out[k, inner + i] += lever[k, j, i] * on_ends[k, 6 + j]
            if k > 0:
                out[k - 1, inner + i] += on_ends[k, i]


def _clamp(t: Tridiagonal, clamped: Array, unit: float) -> Tridiagonal:
    """The matrix with the clamped part of node 1's twist decoupled from the others, ``unit`` on its diagonal."""
    if not clamped.size:
        return t
    free = np.eye(6) - clamped
    diagonal, upper, lower = t.diagonal.copy(), t.upper.copy(), t.lower.copy()
    diagonal[0, -6:] = free @ diagonal[0, -6:]
    diagonal[0, :, -6:] = diagonal[0, :, -6:] @ free
    diagonal[0, -6:, -6:] += unit * clamped
    upper[:1], lower[:1] = free @ upper[:1], lower[:1] @ free
    return Tridiagonal(diagonal, upper, lower)


def loose(p: ChainPencil) -> bool:
    """Whether the root joint allows a rigid-body motion of the blade without stiffness, apart from rounding."""
    if not p.clamped.size:
        return False
    free = np.linalg.svd(np.eye(6) - p.clamped)[0][:, : 6 - round(float(np.trace(p.clamped)))]
    x = np.zeros((free.shape[1], len(p.lever), p.remainder.diagonal.shape[1]))
    twist = free
    for k in range(len(p.lever)):  # ξ_b = Ad⁻¹ ξ_a: no strain
        twist = twist if k == 0 else np.linalg.solve(p.lever[k], twist)
        x[:, k, -6:] = twist.T
    rows = x.reshape(len(x), -1)
    force = np.empty_like(rows)
    strained.times(p.strained, rows, force)
    K = rows @ force.T
    cancelled = np.einsum("mki,kij,mkj->", np.abs(x), np.abs(p.remainder.diagonal), np.abs(x))
    rounding = _FORCE_ROUNDING * cancelled + _ENERGY_ROUNDING * np.abs(p.spring).max() * (rows**2).sum()
    return bool(np.linalg.eigvalsh(0.5 * (K + K.T)).min(initial=np.inf) <= rounding)
