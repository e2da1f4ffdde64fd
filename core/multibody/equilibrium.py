"""Steady state of a mechanism: loop closure, then Newton's method on the balance of forces, globalised by continuation."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..rank import TOLERANCE, Ranked, Regular, factored, ranked
from . import dynamics, partition
from .kinematics import projected
from .loops import MAX_STEP, assemble, closed, size_of
from .mechanism import MechanismError
from .state import ContradictionError, State, check_rates, given, moving, state_at
from .tree import Tree

Array = NDArray[Any]
Index = NDArray[np.intp]

BALANCE_TOLERANCE = 1e-11
"""Rounding of a residual, as a fraction of the forces of which it is the sum; checked for each coordinate."""

STIFFNESS_ROUNDING = 1e-13
"""Rounding of a stiffness, as a fraction of the forces and stiffnesses of which it is the sum."""

_MAX_STEPS = 60
_FIRST_STRIDE, _MIN_STRIDE = 0.25, 1e-3  # fractions of the continuation path
_MIN_FRACTION = 1e-3  # smallest fraction of a Newton step
_SMALL_CORRECTION = 0.05  # rad, or fraction of the length: smaller corrections need not contract at once


def steady(tree: Tree, guess: Mapping[str, float] | None = None) -> State:
    """Find the steady state: coordinates with a motion follow it, all others are at rest or at the rates the loops impose.

    Newton's method from the guess is used as long as its corrections contract (P. Deuflhard, *Newton Methods for Nonlinear
    Problems*, 2004, sec. 2.1.1). Otherwise continuation starts at rest, with dead forces that balance the mechanism at the
    guess: rates and loads grow while the dead forces fade. If a mechanism has no equilibrium at rest, as a pendulum whose
    weight grows with the loads, only the dead forces fade. Newton's method with shortened steps is the last resort.

    Raises:
        MechanismError: loops that do not close, motions that contradict them, or no equilibrium found.
    """
    q = assemble(tree, guess)
    reached = {"from rest with rates and loads growing": 0.0, "from the guess with dead forces fading": 0.0}
    contradiction, found = None, None
    try:
        found = _newton(tree, q)
    except ContradictionError as error:  # at the assembled guess, but perhaps not at the steady state
        contradiction = error
    for way, grow in zip(reached, (True, False), strict=True):
        if found is None:
            reached[way], found = _follow(tree, q, grow)
    if found is None and contradiction:
        raise contradiction
    if found is None:
        found = _newton(tree, q, damped=True)
    if found is None:
        progress = ", ".join(f"{100 * part:.3g} % {way}" for way, part in reached.items())
        raise MechanismError(
            "no steady state was found near the guess: Newton's method does not converge from it, continuation reached "
            f"{progress}: give a better guess, or check for a missing spring or joint"
        )
    check_rates(tree, found.state)
    _check_balance(tree, found)
    return found.state


def unresisted(tree: Tree, state: State, independent: tuple[str, ...]) -> tuple[Array, Array]:
    """Bases (i, d) of the null space of K̂, over the independent coordinates, and of its left null space."""
    tangent = _tangent(tree, _residual(tree, state.q, independent=independent))
    root = np.sqrt(tangent.scale)[:, None]
    return tangent.K.null / root, tangent.K.left_null * root


def left_over(tree: Tree, q: Array, follow: Index, independent: tuple[str, ...]) -> tuple[State, Array, Array]:
    """The state at q (n,), with loops closed by coordinates ``follow``; its unbalanced forces and their size, each (i,).

    Raises:
        MechanismError: if the loops do not close.
    """
    q, gap, length = closed(tree, q, follow)
    if np.abs(gap).max(initial=0.0) > 1e-9 * length:
        raise MechanismError("loops: they do not close")
    here = _residual(tree, q, independent=independent)
    return here.state, here.reduced, _tangent(tree, here).rounding


def again(tree: Tree, state: State, independent: tuple[str, ...]) -> State:
    """The steady state computed again, by one Newton step from a point a rounding error away, to show its accuracy.

    Raises:
        MechanismError: as ``steady``.
    """
    free, eps = partition.free_coordinates(tree), float(np.finfo(float).eps)
    q = state.q.copy()
    sign = np.random.default_rng(1921).choice([-1.0, 1.0], len(free))
    turns = tree.screw[free, 3:].any(1)
    q[free] += eps * sign * np.maximum(np.abs(q[free]), np.where(turns, 1.0, size_of(state.kinematics.poses)))
    here = _residual(tree, closed(tree, q, free)[0], independent=independent)
    q = here.state.q.copy()
    q[free] += _tangent(tree, here).step(here)
    return _residual(tree, closed(tree, q, free)[0], independent=independent).state


# -------------------------------------------------------------------------------------------------------------- balance


@dataclass(frozen=True)
class _Residual:
    """The unbalanced forces at a configuration with closed loops.

    Attributes:
        state: the state of motion.
        part: partition of the free coordinates.
        forces: (f,) generalised forces on the free coordinates, including those that loop reactions balance.
        reduced: (i,) along the independent coordinates, where reactions do no work.
    """

    state: State
    part: partition.Partition
    forces: Array
    reduced: Array


@dataclass(frozen=True)
class _Tangent:
    """The derivative of the residual, with coordinates scaled by their stiffness.

    Attributes:
        K: scaled (i, i) derivative, decomposed.
        scale: (i,) stiffness of each independent coordinate, or a fraction of its forces per unit if that is larger.
        rounding: (i,) size of the forces of which the residual is the sum.
        units: (f,) 1 rad, or the mechanism's length.
    """

    K: Ranked | Regular
    scale: Array
    rounding: Array
    units: Array

    def step(self, here: _Residual) -> Array:
        """Newton's step (f,) of the free coordinates; of least norm along motions without stiffness."""
        root = np.sqrt(self.scale)
        return -here.part.spread(self.K.solve(here.reduced / root) / root)

    def balanced(self, here: _Residual) -> bool:
        """Whether each independent coordinate is balanced, apart from rounding."""
        return bool((np.abs(here.reduced) <= BALANCE_TOLERANCE * self.rounding).all())


@dataclass(frozen=True)
class _Found:
    """The result of Newton's method."""

    state: State
    residual: _Residual
    tangent: _Tangent


def _residual(tree: Tree, q: Array, dead: Array | float = 0.0, independent: tuple[str, ...] | None = None) -> _Residual:
    state = state_at(tree, q)
    free = partition.free_coordinates(tree)
    forces = dynamics.unbalanced(tree, state.kinematics, state.cartesian, q, state.v)[free] - dead
    if tree.welds:
        J = partition.jacobian(tree, state.kinematics.B)[:, free]
        reactions = -ranked(J.T).solve(forces).reshape(-1, 6)
        state = replace(state, multipliers=reactions, cartesian=dynamics.cartesian(tree, state.kinematics, reactions))
    part = partition.partition(tree, state.kinematics, independent)
    return _Residual(state, part, forces, part.onto(forces))


def _tangent(tree: Tree, here: _Residual) -> _Tangent:
    """K̂ = Rᵀ (K R + C δv/δq + M δv̇/δq): in moving loops, rates and accelerations change with q."""
    state, part, k = here.state, here.part, here.state.kinematics
    pick, R = np.ix_(part.free, part.free), part.R
    K = state.tangent[2][pick]
    by_independent = K @ R if len(part.dependent) else K
    if moving(tree, state).any():
        J, J1, J2 = (partition.jacobian(tree, b)[:, part.free] for b in (k.B, k.B1, k.B2))
        following = ~np.isin(part.free, given(tree))
        back = ranked(J[:, following])
        R1, R2 = np.zeros_like(R), np.zeros_like(R)
        R1[following] = -back.solve(J1 @ R)
        R2[following] = -back.solve(J2 @ R + 2.0 * J1 @ R1)
        M, C = (a[pick] for a in state.tangent[:2])
        by_independent += C @ R1 + M @ R2
    turns = tree.screw[part.free, 3:].any(1)
    units = np.where(turns, 1.0, size_of(k.poses))
    size = _sizes(tree, state)[part.free] + np.abs(K) @ np.maximum(units, np.abs(state.q[part.free]))
    sizes = replace(part, R=np.abs(R))
    rounding, unit = sizes.onto(size), units[np.isin(part.free, part.independent)]
    least = (sizes.onto(_carried(state)[part.free]) + rounding) / unit
    reduced = part.onto(by_independent)
    scale = np.maximum(np.abs(np.diagonal(reduced)), STIFFNESS_ROUNDING / TOLERANCE * least)
    root = np.sqrt(np.where(scale > 0, scale, 1.0))
    return _Tangent(factored(reduced / root[:, None] / root), root**2, rounding, units)


def _sizes(tree: Tree, state: State) -> Array:
    """(n,) sum of the absolute values of the forces on each coordinate."""
    k = state.kinematics
    out = projected(k, state.cartesian.size, np.abs(k.J))
    for s in tree.mechanism.coordinate_springs:
        j = tree.coordinate(s.coordinate)
        out[j] += s.stiffness * (abs(state.q[j]) + abs(s.neutral)) + abs(s.damping * state.v[j])
    return out


def _carried(state: State) -> Array:
    """(n,) forces on a coordinate from a unit strain of all stiffnesses that it carries: they bound its rounding."""
    k, c = state.kinematics, state.cartesian
    units = np.tile(np.repeat([size_of(k.poses), 1.0], 3), len(c.g))
    wrench = np.append((abs(c.K) @ units).reshape(-1, 6), np.zeros((1, 6)), axis=0)
    np.add.at(wrench, c.ends, (np.abs(c.stiffness) @ units[:6])[:, None, :])
    return projected(k, wrench[:-1], np.abs(k.J))


def _newton(
    tree: Tree, q: Array, dead: Array | float = 0.0, far: float = np.inf, damped: bool = False
) -> _Found | None:
    """Newton's method as long as each correction is at most half the previous one; else, or ``far`` from the start, None.

    ``damped``: steps that do not contract are shortened until they do (Deuflhard 2004, sec. 3.3).
    """
    free = partition.free_coordinates(tree)
    start, here = q, _residual(tree, q, dead)
    for _ in range(_MAX_STEPS):
        tangent = _tangent(tree, here)
        step = tangent.step(here)
        length = _norm(step, tangent)
        done = tangent.balanced(here)
        if length < 1e-15 or (done and length < 1e-13):
            return _Found(here.state, here, tangent)
        names = tuple(tree.coordinates[j] for j in here.part.independent)
        part = min(1.0, 0.5 / max(length, 0.5)) if damped else 1.0
        while True:
            following, contraction = _tried(tree, q, part * step, dead, names, tangent, length)
            if done and contraction > 0.5:  # only rounding is left
                return _Found(here.state, here, tangent)
            near = max(length, length * contraction) < _SMALL_CORRECTION  # near the guess: a first correction may grow
            if contraction <= (1.0 - 0.25 * part if damped else 0.5) or near or length < 1e-9:
                break
            part *= 0.5
            if not damped or part < _MIN_FRACTION:
                return None
        if following is None or _norm((following.state.q - start)[free], tangent) > far:
            return None
        q, here = following.state.q, following
    return None


def _tried(
    tree: Tree, q: Array, step: Array, dead: Array | float, names: tuple[str, ...], tangent: _Tangent, length: float
) -> tuple[_Residual | None, float]:
    """The residual after a step, and the length of its correction divided by that of the previous Newton step."""
    free = partition.free_coordinates(tree)
    there = q.copy()
    there[free] += step
    there, gap, size = closed(tree, there, free)
    if not np.isfinite(length) or np.abs(gap).max(initial=0.0) > 1e-11 * size:
        return None, np.inf
    following = _residual(tree, there, dead, names)
    return following, _norm(tangent.step(following), tangent) / length


def _norm(step: Array, tangent: _Tangent) -> float:
    return float(np.abs(step / tangent.units).max(initial=0.0))


# --------------------------------------------------------------------------------------------------------- continuation


def _follow(tree: Tree, q: Array, grow: bool) -> tuple[float, _Found | None]:
    """Follow the equilibrium from the guess, which dead forces balance, until they vanish; the fraction reached, the result.

    ``grow``: meanwhile rates, accelerations and gravity grow from zero.
    """
    free = partition.free_coordinates(tree)

    def at(part: float) -> Tree:
        return _loaded(tree, part) if grow else tree

    try:
        start = _residual(at(0.0), q)
    except ContradictionError:
        return 0.0, None
    J = partition.jacobian(tree, start.state.kinematics.B)[:, free]
    dead = start.forces - J.T @ ranked(J.T).solve(start.forces)
    part, stride, slope = 0.0, _FIRST_STRIDE, np.zeros_like(q)
    found = None
    while part < 1.0:
        to = min(1.0, part + stride)
        ahead, gap, size = closed(tree, q + (to - part) * slope, free)
        loops_close = np.abs(gap).max(initial=0.0) <= 1e-11 * size
        try:
            found = _newton(at(to), ahead, (1.0 - to) * dead, MAX_STEP) if loops_close else None
        except MechanismError:  # the loops are singular there
            found = None
        if found is None or not found.tangent.balanced(found.residual):
            stride *= 0.5
            if stride < _MIN_STRIDE:
                return part, None
            continue
        slope, part, q = (found.state.q - q) / (to - part), to, found.state.q
        stride *= 1.5
    return 1.0, found


def _loaded(tree: Tree, part: float) -> Tree:
    """The tree with accelerations and gravity times ``part``, and rates times its root: inertial forces scale with ``part``."""
    m = tree.mechanism
    motions = tuple(replace(x, rate=x.rate * np.sqrt(part), acceleration=x.acceleration * part) for x in m.motions)
    gravity = (m.gravity[0] * part, m.gravity[1] * part, m.gravity[2] * part)
    return replace(tree, mechanism=replace(m, motions=motions, gravity=gravity))


def _check_balance(tree: Tree, found: _Found) -> None:
    """Check that no coordinate carries a force without a stiffness."""
    here, tangent = found.residual, found.tangent
    if not tangent.balanced(here):
        worst = int(np.argmax(np.abs(here.reduced) / np.maximum(tangent.rounding, 1e-300)))
        raise MechanismError(
            f"coordinate {tree.coordinates[here.part.independent[worst]]!r}: no steady state: "
            f"{here.reduced[worst]:.3g} N or N m remain unbalanced and no stiffness resists them; prescribe its motion, or add "
            "a spring"
        )
