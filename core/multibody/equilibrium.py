"""Assembly of loops and the steady state of a mechanism, by Newton with the analytic tangent."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from . import dynamics, partition
from .dynamics import Cartesian
from .kinematics import Kinematics, kinematics, poses
from .mechanism import MechanismError
from .tree import Tree

Array = NDArray[Any]

_STEPS = 100
_SMALL, _SHORTEST = 1e-2, 1e-3


@dataclass(frozen=True)
class State:
    """A steady state: coordinates, velocities, accelerations (n,), multipliers (w, 6), and what follows from them."""

    q: Array
    v: Array
    a: Array
    multipliers: Array
    kinematics: Kinematics
    cartesian: Cartesian


def assemble(tree: Tree, guess: Mapping[str, float] | None = None) -> Array:
    """Coordinates (n,) that close all loops, near a guess (coordinates not named start at 0 or at their motion's position).

    Raises:
        MechanismError: if the loops do not close.
    """
    q, fixed = _start(tree, guess)
    free = np.setdiff1d(np.arange(len(q)), fixed)
    for _ in range(_STEPS):
        x, J = poses(tree, q)
        gap = partition.misfit(tree, x)
        if np.abs(gap).max(initial=0.0) < 1e-13 * _size(x):
            return q
        B = tree.carries[:, None, :] * J
        jac = partition.jacobian(tree, B)[:, free]
        step = -np.linalg.lstsq(jac, gap, rcond=1e-9)[0]
        q[free] += step * min(1.0, 1.0 / max(float(np.abs(step).max(initial=0.0)), 1e-300))
        if np.abs(step).max(initial=0.0) < 1e-14:
            break
    gap = partition.misfit(tree, poses(tree, q)[0])
    worst = int(np.argmax(np.abs(gap)))
    if np.abs(gap).max() > 1e-9 * _size(poses(tree, q)[0]):
        raise MechanismError(
            f"joint {tree.weld_names[worst // 6]!r}: it does not close its loop (gap {abs(gap[worst]):.3g}); the dimensions "
            "do not fit, or the guess is too far off: give a better one"
        )
    return q


def steady(tree: Tree, guess: Mapping[str, float] | None = None) -> State:
    """The steady state: prescribed coordinates in their motion, all others still or at the rates the loops give them.

    Raises:
        MechanismError: loops that do not close, motions that contradict them, or no equilibrium found.
    """
    q = assemble(tree, guess)
    fixed = partition.held(tree)
    free = np.setdiff1d(np.arange(len(q)), fixed)
    lam = np.zeros((len(tree.welds), 6))
    before = np.inf
    for _ in range(_STEPS):
        state = _state(tree, q, lam)
        tau = dynamics.unbalanced(tree, state.kinematics, state.cartesian, q, state.v)[free]
        K = dynamics.tangent(tree, state.kinematics, state.cartesian)[2][np.ix_(free, free)]
        J = partition.jacobian(tree, state.kinematics.B)[:, free]
        step, more = _constrained_step(K, J, tau, partition.misfit(tree, state.kinematics.poses))
        change = float(np.abs(step).max(initial=0.0))
        if not np.isfinite(change):
            break
        q, lam = _moved(tree, q, lam, free, step, more, (K, J))
        if change < 1e-11 or (change < 1e-8 and change > 0.3 * before):
            return _checked(tree, _state(tree, q, lam), free)
        before = change
    raise MechanismError(
        "no steady state was found near the guess: give a better one, or check for a missing spring or joint"
    )


def _moved(
    tree: Tree,
    q: Array,
    lam: Array,
    free: NDArray[np.intp],
    step: Array,
    more: Array,
    linear: tuple[Array, Array],
) -> tuple[Array, Array]:
    """Newton's step, shortened where it is large until the next one, by the same matrices, would be shorter.

    This natural monotonicity test needs no scale for forces and moments (P. Deuflhard, *Newton Methods for Nonlinear
    Problems*, 2004, sec. 3.3).
    """
    size = float(np.abs(step).max(initial=0.0))
    part = min(1.0, 0.5 / max(size, 0.5))
    length = float(np.linalg.norm(step))
    while True:
        there, forces = q.copy(), lam + part * more.reshape(-1, 6)
        there[free] += part * step
        if size < _SMALL or part < _SHORTEST:
            return there, forces
        state = _state(tree, there, forces)
        tau = dynamics.unbalanced(tree, state.kinematics, state.cartesian, there, state.v)[free]
        following = _constrained_step(*linear, tau, partition.misfit(tree, state.kinematics.poses))[0]
        if np.linalg.norm(following) <= (1.0 - 0.25 * part) * length:
            return there, forces
        part *= 0.5


def _constrained_step(K: Array, J: Array, tau: Array, gap: Array) -> tuple[Array, Array]:
    """Newton's δq and δλ: close the gap, then balance along what the loops leave free; redundant multipliers stay least."""
    if not len(gap):
        return -_least(K, tau), gap
    close = -np.linalg.lstsq(J, gap, rcond=1e-9)[0]
    along = scipy.linalg.null_space(J, rcond=1e-9)
    rest = along.T @ (tau + K @ close)
    step = close - along @ _least(along.T @ K @ along, rest)
    return step, -np.linalg.lstsq(J.T, tau + K @ step, rcond=1e-9)[0]


def _least(K: Array, force: Array) -> Array:
    """The smallest x with K x = force, where K may be singular: a freedom that nothing resists."""
    found = scipy.linalg.lstsq(K, force, cond=1e-13, lapack_driver="gelsy", check_finite=False)
    return cast(tuple[Array, ...], found)[0]


def _check_rates(tree: Tree, state: State) -> None:
    """Refuse loops that move while the motions leave open how: rates would be anybody's choice."""
    given = [tree.coordinate(m.coordinate) for m in tree.mechanism.motions]
    rest = np.setdiff1d(np.arange(len(state.q)), given)
    moving = np.abs(state.v[rest]) > 1e-9 * np.abs(state.v).max(initial=0.0)
    if not moving.any():
        return
    open_ = scipy.linalg.null_space(partition.jacobian(tree, state.kinematics.B)[:, rest], rcond=1e-9)
    free = moving & (np.abs(open_).max(axis=1, initial=0.0) > 1e-9)
    if free.any():
        name = tree.coordinates[rest[int(free.argmax())]]
        raise MechanismError(
            f"coordinate {name!r}: its loop moves, but the motions do not say at which rate: give it one too (held = false if "
            "it is to vibrate)"
        )


def _checked(tree: Tree, state: State, free: NDArray[np.intp]) -> State:
    _check_rates(tree, state)
    tau = dynamics.unbalanced(tree, state.kinematics, state.cartesian, state.q, state.v)[free]
    size = np.abs(state.kinematics.B.transpose(2, 0, 1)[free] * state.cartesian.g).sum((1, 2))
    K = dynamics.tangent(tree, state.kinematics, state.cartesian)[2][np.ix_(free, free)]
    allowed = 1e-7 * np.maximum(size, np.abs(K).max(initial=0.0) * 1e-2 + 1e-12)
    if (np.abs(tau) > allowed).any():
        worst = int(np.argmax(np.abs(tau) - allowed))
        raise MechanismError(
            f"coordinate {tree.coordinates[free[worst]]!r}: no steady state: {tau[worst]:.3g} N or N m remain unbalanced and "
            "nothing resists them; hold its motion, or add a spring"
        )
    return state


def _start(tree: Tree, guess: Mapping[str, float] | None) -> tuple[Array, NDArray[np.intp]]:
    q = np.zeros(len(tree.coordinates))
    for name, value in (guess or {}).items():
        q[tree.coordinate(name)] = value
    for m in tree.mechanism.motions:
        if m.position is not None:
            q[tree.coordinate(m.coordinate)] = m.position
    return q, partition.held(tree)


def _state(tree: Tree, q: Array, multipliers: Array) -> State:
    """Velocities and accelerations that the motions and, through the loops, all other coordinates have (eq. 18, 20)."""
    n = len(q)
    v, a = np.zeros(n), np.zeros(n)
    given = []
    for m in tree.mechanism.motions:
        j = tree.coordinate(m.coordinate)
        v[j], a[j] = m.rate, m.acceleration
        given.append(j)
    if tree.welds:
        rest = np.setdiff1d(np.arange(n), given)
        k = kinematics(tree, q, v, a)
        J = partition.jacobian(tree, k.B)
        v[rest] = np.linalg.lstsq(J[:, rest], -J @ v, rcond=1e-9)[0]
        k = kinematics(tree, q, v, a)
        a[rest] = np.linalg.lstsq(J[:, rest], -J @ a - partition.jacobian(tree, k.B1) @ v, rcond=1e-9)[0]
        left = np.abs(J @ v).max()
        if left > 1e-7 * max(float(np.abs(v).max()), 1e-300) * _size(k.poses):
            raise MechanismError("motions: the prescribed rates contradict a loop; prescribe fewer coordinates")
    k = kinematics(tree, q, v, a)
    c = dynamics.cartesian(tree, k, multipliers)
    return State(q, v, a, multipliers, k, c)


def _size(x: Array) -> float:
    return max(1.0, float(np.abs(x[:, :3, 3]).max(initial=0.0)))
