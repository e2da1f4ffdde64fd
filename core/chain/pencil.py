"""The rotating chain: the Cartesian pencil M ξ̈ + C ξ̇ + K ξ about a shape of it.

With elastic connections only, every node moves freely: the velocity transformation B of the general solver is square and
invertible, so modes may be had from the bodies' own twists, where the matrices are block-tridiagonal. Twists and wrenches
of node k are in its own axes.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..compiled import compiled
from ..effects import FULL, Model
from ..element import beams as bm
from ..element import inertia
from ..element.discretize import Chain
from ..space import rigid
from . import blocks, root_joint, strained
from .blocks import Factor, Tridiagonal
from .strained import Strained

Array = NDArray[np.float64]

_CANCELLED, _STRAINLESS = (
    1e-13,
    1e-28,
)  # what rounding leaves of a rigid motion's stiffness: of forces, of strain energy


@dataclass(frozen=True)
class Linear:
    """Residual (dn,) and block-tridiagonal M, C, K of β and nodes 1 … n; K = ``rest`` + ``spring`` on ρ = Ad ξ_b − ξ_a.

    ``spring`` is (n, 6, 6) and ``lever`` the Ad (n, 6, 6) of the relative poses, the identity for a joint at the root, whose
    springs are on the twist of node 1; ``held`` as in ``Chain``,
    at this shape. What is held is replaced by a unit stiffness on its own, without mass or load: it stays where it is, and
    makes no mode.
    """

    residual: Array
    M: Tridiagonal
    C: Tridiagonal
    rest: Tridiagonal
    spring: Array
    lever: Array
    held: Array

    @cached_property
    def K(self) -> Tridiagonal:
        """The whole stiffness."""
        on_b = np.swapaxes(self.lever, -1, -2) @ self.spring
        diagonal, upper, lower = self.rest.diagonal.copy(), self.rest.upper.copy(), self.rest.lower.copy()
        diagonal[:, -6:, -6:] += on_b @ self.lever
        diagonal[:-1, -6:, -6:] += self.spring[1:]
        upper[:, :, -6:] -= self.spring[1:] @ self.lever[1:]
        lower[:, -6:] -= on_b[1:]
        return _hold(Tridiagonal(diagonal, upper, lower), self.held, 1.0)

    @cached_property
    def factor(self) -> Factor:
        """Of the whole stiffness; ``numpy.linalg.LinAlgError`` if it is singular."""
        return blocks.factor(self.K)

    @property
    def strained(self) -> Strained:
        """The whole stiffness, for products without loss of digits."""
        held = self.held if self.held.size else np.zeros((6, 6))
        return Strained(blocks.turned(self.rest), self.spring, self.lever, held)


@dataclass(frozen=True)
class Shape:
    """Where a chain is.

    Attributes:
        nodes: (n+1, 4, 4) poses in the hub's axes.
        beta: (n, 6 or 0) the elements' internal coordinates β.
        relative: (n, 4, 4) pose of each node in the frame of the one before. They follow from ``nodes``, but differences of
            poses lose the strains' last digits: with an axial stiffness EA and elements of length h, at a radius R, a force of
            EA R/h times the rounding of one.
    """

    nodes: Array
    beta: Array
    relative: Array


def rest(chain: Chain) -> Shape:
    """The undeformed shape."""
    return Shape(chain.nodes, np.zeros((len(chain.nodes) - 1, chain.beams.inner)), chain.between)


def linearize(chain: Chain, shape: Shape, omega: float, gravity: Array, model: Model = FULL) -> Linear:
    """Residual and pencil at a shape.

    Args:
        chain: the blade.
        shape: where it is.
        omega: rotor speed, rad/s.
        gravity: (3,) free-fall acceleration in the hub's axes, turning with it.
        model: effects kept.
    """
    n, d = len(shape.nodes), 6 + chain.beams.inner
    frame, fall, axes, push = np.empty((n, 6)), np.empty((n, 6)), np.empty((n, 3, 3)), np.empty((n, 3))
    x, lever = np.empty((n - 1, 4, 4)), np.empty((n - 1, 6, 6))
    nodes, relative, corner = (np.ascontiguousarray(a) for a in (shape.nodes, shape.relative, chain.corner))
    _place(nodes, relative, omega, gravity, chain.force, corner, frame, fall, axes, push, x, lever)
    p = bm.pencil(chain.beams, x, shape.beta, frame[:-1], fall[:-1], model, axes[:-1])
    g, C, K = np.empty((n, 6)), np.empty((n, 6, 6)), np.empty((n, 6, 6))
    inertia.carried(chain.lumps, frame, fall, push, model.geometric, g, C, K)
    residual, held = np.empty((n - 1, d)), chain.held
    if held.size:  # the joint takes the first element's place
        p.residual[0], p.rest[0, :, :12], p.rest[0, :12], lever[0] = 0.0, 0.0, 0.0, np.eye(6)
    _balance(p.residual, lever, g, residual)
    if held.size:
        joint = root_joint.response(chain, relative[0], residual[0, -6:])
        held, p.spring[0] = joint.held, joint.stiffness
        residual[0, -6:] += joint.wrench
        residual[0, -6:] -= held @ residual[0, -6:]
        if model.geometric:
            K[1] += joint.turning
    moving = 1.0 if model.coriolis else 0.0
    return Linear(
        residual.ravel(),
        _hold(blocks.from_elements(p.M, lever, chain.lumps), held, 0.0),
        _hold(blocks.from_elements(moving * p.C, lever, moving * C), held, 0.0),
        blocks.from_elements(p.rest, lever, K),
        p.spring,
        lever,
        held,
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
    """Of every node, in its own axes: twist of the hub's frame, free fall, load, and the hub's axes; x is end b seen from a."""
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
    """Forces (n, d) on β and nodes 1 … n in their own axes, from elements (n, d + 6), ordered a, b, β, and nodes (n+1, 6)."""
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


def _hold(t: Tridiagonal, held: Array, unit: float) -> Tridiagonal:
    """The matrix with the held part of node 1's twist cut loose from the rest, ``unit`` on its diagonal."""
    if not held.size:
        return t
    free = np.eye(6) - held
    diagonal, upper, lower = t.diagonal.copy(), t.upper.copy(), t.lower.copy()
    diagonal[0, -6:] = free @ diagonal[0, -6:]
    diagonal[0, :, -6:] = diagonal[0, :, -6:] @ free
    diagonal[0, -6:, -6:] += unit * held
    upper[:1], lower[:1] = free @ upper[:1], lower[:1] @ free
    return Tridiagonal(diagonal, upper, lower)


def loose(p: Linear) -> bool:
    """Whether a joint at the root lets the blade turn as a rigid body against no stiffness, but for rounding."""
    if not p.held.size:
        return False
    free = np.linalg.svd(np.eye(6) - p.held)[0][:, : 6 - round(float(np.trace(p.held)))]
    x = np.zeros((free.shape[1], len(p.lever), p.rest.diagonal.shape[1]))
    twist = free
    for k in range(len(p.lever)):  # ξ_b = Ad⁻¹ ξ_a: no strain
        twist = twist if k == 0 else np.linalg.solve(p.lever[k], twist)
        x[:, k, -6:] = twist.T
    rows = x.reshape(len(x), -1)
    force = np.empty_like(rows)
    strained.times(p.strained, rows, force)
    K = rows @ force.T
    cancelled = np.einsum("mki,kij,mkj->", np.abs(x), np.abs(p.rest.diagonal), np.abs(x))
    rounding = _CANCELLED * cancelled + _STRAINLESS * np.abs(p.spring).max() * (rows**2).sum()
    return bool(np.linalg.eigvalsh(0.5 * (K + K.T)).min(initial=np.inf) <= rounding)
