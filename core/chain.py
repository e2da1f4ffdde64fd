"""The rotating chain: its steady state, and the Cartesian pencil M ξ̈ + C ξ̇ + K ξ about it.

With elastic connections only, every node moves freely: the velocity transformation B of the general solver is square and
invertible, so modes may be had from the bodies' own twists, where the matrices are block-tridiagonal. Twists and wrenches
of node k are in its own axes.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from . import beams as bm
from . import blocks, inertia, rigid
from . import spatial as sp
from .blocks import Tridiagonal
from .compiled import compiled
from .discretize import Chain
from .model import FULL, Model
from .strained import Strained

Array = NDArray[np.float64]

_STEPS = 40
_BALANCED, _ROUNDING = 1e-10, 1e-15  # Newton's step, of the displacement, and of the blade's length (or a radian)
ORDER = 3  # of the extrapolation along the speeds
_SMALLEST_RAMP = 2.0**-8


class SteadyStateError(ValueError):
    """No steady rotating state was found at this speed."""


@dataclass(frozen=True)
class Linear:
    """Residual (dn,) and block-tridiagonal M, C, K of β and nodes 1 … n; K = ``rest`` + ``spring`` on ρ = Ad ξ_b − ξ_a.

    ``spring`` is (n, 6, 6) and ``lever`` the Ad (n, 6, 6) of the relative poses; ``held`` as in ``Chain``. What is held is
    replaced by a unit stiffness on its own, without mass or load: it stays where it is, and makes no mode.
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

    @property
    def strained(self) -> Strained:
        """The whole stiffness, for products without loss of digits."""
        held = self.held if self.held.size else np.zeros((6, 6))
        return Strained(blocks.columns(self.rest), self.spring, self.lever, held)


def spin(omega: float) -> Array:
    """The hub's twist (6,) at rotor speed ``omega`` about z."""
    return np.array([0.0, 0.0, 0.0, 0.0, 0.0, omega])


@dataclass(frozen=True)
class Shape:
    """Where a chain is: node poses (n+1, 4, 4) in the hub's axes and the elements' internal coordinates β (n, 6 or 0)."""

    nodes: Array
    beta: Array


def rest(chain: Chain) -> Shape:
    """The undeformed shape."""
    return Shape(chain.nodes, np.zeros((len(chain.nodes) - 1, chain.beams.inner)))


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
    _place(np.ascontiguousarray(shape.nodes), omega, gravity, chain.force, frame, fall, axes, push, x, lever)
    p = bm.pencil(chain.beams, x, shape.beta, frame[:-1], fall[:-1], model, axes[:-1])
    g, C, K = np.empty((n, 6)), np.empty((n, 6, 6)), np.empty((n, 6, 6))
    inertia.carried(chain.lumps, frame, fall, push, model.geometric, g, C, K)
    residual = np.empty((n - 1, d))
    _balance(p.residual, lever, g, residual)
    if chain.held.size:
        residual[0, -6:] -= chain.held @ residual[0, -6:]
    moving = 1.0 if model.coriolis else 0.0
    return Linear(
        residual.ravel(),
        _hold(blocks.from_elements(p.M, lever, chain.lumps), chain.held, 0.0),
        _hold(blocks.from_elements(moving * p.C, lever, moving * C), chain.held, 0.0),
        blocks.from_elements(p.rest, lever, K),
        p.spring,
        lever,
        chain.held,
    )


@compiled
def _place(
    nodes: Array,
    omega: float,
    gravity: Array,
    force: Array,
    frame: Array,
    fall: Array,
    axes: Array,
    push: Array,
    x: Array,
    lever: Array,
) -> None:
    """Of every node, in its own axes: twist of the hub's frame, free fall, load; the hub's axes; and what is relative to a."""
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
            rigid.compose(back, nodes[k + 1], x[k])
            rigid.adjoint(x[k], lever[k])


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


@dataclass(frozen=True)
class Steady:
    """A steady state: its shape, and the pencil about it."""

    shape: Shape
    linear: Linear


def steady(chain: Chain, omega: float, gravity: Array, start: Shape | None = None) -> Steady:
    """The steady state, by Newton from ``start``; if that fails, from the undeformed shape with the speed ramped up.

    Raises:
        SteadyStateError: if there is none near the undeformed blade.
    """
    if start is not None:
        try:
            return _newton(chain, start, omega, gravity)
        except SteadyStateError:
            pass  # too far off: begin where there is no load
    found = None
    done, step = 0.0, 1.0
    while found is None or done < 1.0:
        load = min(1.0, done + step)
        try:
            shape = rest(chain) if found is None else found.shape
            found = _newton(chain, shape, omega * load**0.5, gravity * load)
            done = load
        except SteadyStateError:
            step *= 0.5
            if step < _SMALLEST_RAMP:
                raise SteadyStateError(
                    f"omega: no steady state at {omega:.6g} rad/s; the loads were followed up to {done:.0%} of Ω²: the "
                    "centrifugal force outgrows the axial stiffness there, or the blade is far too soft; check units or "
                    "lower the speed"
                ) from None
    return found


def _newton(chain: Chain, shape: Shape, omega: float, gravity: Array) -> Steady:
    size = np.repeat([chain.scale, 1.0], 3)
    before = np.inf
    for _ in range(_STEPS):
        p = linearize(chain, shape, omega, gravity)
        try:
            step = _solution(p.K, -p.residual).reshape(len(chain.nodes) - 1, -1)
        except np.linalg.LinAlgError:
            raise SteadyStateError("singular stiffness") from None
        change = float(np.abs(step[:, -6:] / size).max())
        if not np.isfinite(change) or change > 10.0:
            raise SteadyStateError("diverged")
        displaced = np.abs(shape.nodes - chain.nodes)
        far = max(displaced[:, :3, 3].max() / chain.scale, displaced[:, :3, :3].max())
        # there, or as near as rounding lets it; the last step still improves the shape, from which others are extrapolated
        if change < max(_BALANCED * far, _ROUNDING) or (change < 1e-6 and change > 0.1 * before):
            return Steady(moved(shape, step), p)
        step *= min(1.0, 0.5 / max(change, 0.5))
        shape = moved(shape, step)
        before = change
    raise SteadyStateError("no convergence")


def _solution(t: Tridiagonal, b: Array) -> Array:
    x = b[None].copy()
    blocks.solve(blocks.factor(t), x)
    return x[0]


def moved(shape: Shape, step: Array) -> Shape:
    """A shape whose β change and whose nodes 1 … n move along twists in their own axes: ``step`` (n, 6 or 12)."""
    nodes = shape.nodes.copy()
    _move(step, nodes[1:])
    return Shape(nodes, shape.beta + step[:, :-6])


@compiled
def _move(step: Array, nodes: Array) -> None:
    inner, here, change = step.shape[1] - 6, np.empty((4, 4)), np.empty((4, 4))
    for k in range(len(nodes)):
        rigid.exp(step[k, inner:], change)
        for i in range(4):
            for j in range(4):
                here[i, j] = nodes[k, i, j]
        rigid.compose(here, change, nodes[k])


@compiled
def _add_step(weight: float, now: Array, other: Array, step: Array) -> None:
    """Add to the steps (n, d) the weighted twists that bring nodes (n, 4, 4) from where they are to where others are."""
    inner, back, between, twist = step.shape[1] - 6, np.empty((4, 4)), np.empty((4, 4)), np.empty(6)
    for k in range(len(now)):
        rigid.inverse(now[k], back)
        rigid.compose(back, other[k], between)
        rigid.log(between, twist)
        for i in range(6):
            step[k, inner + i] += weight * twist[i]


def extrapolate(known: Sequence[tuple[float, Shape]], omega: float) -> Shape | None:
    """A guess of the shape at ``omega`` from those at the speeds before: a polynomial in Ω² through the last few."""
    latest: dict[float, Shape] = {}
    for speed, shape in reversed(known):
        if len(latest) <= ORDER:
            latest.setdefault(speed**2, shape)
    if not latest:
        return None
    x = np.array(list(latest))
    now = next(iter(latest.values()))
    step = np.zeros((len(now.beta), now.beta.shape[1] + 6))
    for k, shape in enumerate(latest.values()):
        others = np.delete(x, k)
        weight = float(np.prod((omega**2 - others) / (x[k] - others)))
        step[:, :-6] += weight * (shape.beta - now.beta)
        _add_step(weight, now.nodes[1:], shape.nodes[1:], step)
    return moved(now, step)


def prestress_at_rest(chain: Chain, omega: float, gravity: Array) -> Chain:
    """The undeformed chain carrying the internal forces of a linear static analysis: Yoo and Shin's linear theory."""
    still = Model(geometric=False)
    residual = linearize(chain, rest(chain), omega, gravity, still).residual.reshape(len(chain.nodes) - 1, -1)
    bare = replace(chain, lumps=np.zeros_like(chain.lumps), beams=bm.massless(chain.beams))
    elastic = linearize(bare, rest(bare), 0.0, np.zeros(3), still).K
    step = np.concatenate([np.zeros((1, 6)), _solution(elastic, -residual[:, -6:].ravel()).reshape(-1, 6)])
    x = chain.beams.rest
    rho = (sp.adjoint(x) @ step[1:, :, None])[..., 0] - step[:-1]
    loaded = replace(chain.beams, preload=bm.linear_force(chain.beams, rho))
    return replace(chain, beams=replace(loaded, inner_preload=-residual[:, :-6]))
