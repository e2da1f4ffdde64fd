"""The steady state of a rotating chain, by Newton, and guesses of it from those at the speeds before."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import prod

import numpy as np
from numpy.typing import NDArray

from ..compiled import compiled
from ..effects import Model
from ..element import beams as bm
from ..element.discretize import Chain
from ..space import rigid
from ..space import spatial as sp
from . import blocks, root_joint
from .pencil import Linear, Shape, linearize, rest

Array = NDArray[np.float64]

_STEPS = 40
_BALANCED, _ROUNDING = 1e-10, 1e-15  # Newton's step, of the displacement, and of the blade's length (or a radian)
ORDER = 3  # of the extrapolation along the speeds
_SMALLEST_RAMP = 2.0**-8


class SteadyStateError(ValueError):
    """No steady rotating state was found at this speed."""


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
        if chain.held.size:
            shape = Shape(root_joint.put(chain, shape.nodes), shape.beta)
        p = linearize(chain, shape, omega, gravity)
        try:
            step = blocks.solution(p.factor, -p.residual).reshape(len(chain.nodes) - 1, -1)
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
    now = next(iter(latest.values()))
    step = np.zeros((len(now.beta), now.beta.shape[1] + 6))
    for x, shape in latest.items():
        weight = prod((omega**2 - other) / (x - other) for other in latest if other != x)
        step[:, :-6] += weight * (shape.beta - now.beta)
        _add_step(weight, now.nodes[1:], shape.nodes[1:], step)
    return moved(now, step)


def prestress_at_rest(chain: Chain, omega: float, gravity: Array) -> Chain:
    """The undeformed chain carrying the internal forces of a linear static analysis: Yoo and Shin's linear theory."""
    still = Model(geometric=False)
    residual = linearize(chain, rest(chain), omega, gravity, still).residual.reshape(len(chain.nodes) - 1, -1)
    bare = replace(chain, lumps=np.zeros_like(chain.lumps), beams=bm.massless(chain.beams))
    elastic = linearize(bare, rest(bare), 0.0, np.zeros(3), still).factor
    step = np.concatenate([np.zeros((1, 6)), blocks.solution(elastic, -residual[:, -6:].ravel()).reshape(-1, 6)])
    rho = (sp.adjoint(chain.between) @ step[1:, :, None])[..., 0] - step[:-1]
    loaded = replace(chain.beams, preload=bm.linear_force(chain.beams, rho))
    return replace(chain, beams=replace(loaded, inner_preload=-residual[:, :-6]))
