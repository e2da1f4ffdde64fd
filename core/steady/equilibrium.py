"""Steady state of a mechanism: loop closure, then the balance of forces by Newton's method, relaxation or continuation."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..tree import partition
from ..tree.closure import ASSEMBLED, CLOSED, MAX_STEP, assemble, close_loops
from ..tree.linearization import Linearization
from ..tree.scales import coordinate_units, length_at
from ..tree.state import ContradictionError, State, check_rates
from ..tree.strained import out_of_range
from ..tree.topology import Tree
from .balance import Balance, balance_at, tangent_at
from .continuation import follow
from .newton import newton
from .relaxation import relaxed

Array = NDArray[Any]
Index = NDArray[np.intp]


def steady_state(tree: Tree, guess: Mapping[str, float] | None = None) -> State:
    """Find the steady state: coordinates with a motion follow it, all others are at rest or at the rates the loops impose.

    Newton's method is used as long as its corrections contract. If it fails and a guess was supplied, pseudo-time relaxation
    starts there. Continuation follows the equilibrium from rest, with dead forces that balance the mechanism at the guess:
    rates, accelerations and gravity grow while the dead forces fade. If a mechanism has no equilibrium at rest, as a pendulum
    whose weight grows with gravity, only the dead forces fade. Without a guess, relaxation is the last resort.

    Raises:
        MechanismError: loops that do not close, motions that contradict them, or no equilibrium found.
    """
    q = assemble(tree, guess)
    contradiction = None
    try:
        equilibrium = newton(balance_at(tree, q)) or (_relaxed(tree, q) if guess else None)
    except ContradictionError as error:  # at the assembled guess, but perhaps not at the steady state
        equilibrium, contradiction = None, error
    reached = []
    for grow in (True, False):
        if equilibrium is None:
            part, equilibrium = _continued(tree, q, grow)
            reached.append(part)
    if equilibrium is None and contradiction:
        raise contradiction
    if equilibrium is None and not guess:
        equilibrium = _relaxed(tree, q)
    beams = out_of_range(tree, equilibrium.state.kinematics.poses) if equilibrium else []
    unguessed = _without_guess(tree, q) if guess and (beams or not equilibrium) else ""
    if equilibrium is None:
        raise MechanismError(
            "no steady state was found near the guess: neither Newton's method nor relaxation converges from it, and "
            f"continuation reached {100 * reached[0]:.3g} % from rest with rates and gravity growing, {100 * reached[1]:.3g} % "
            f"from the guess with dead forces fading{unguessed}: give a better guess, or check for a missing spring or joint"
        )
    check_rates(tree, equilibrium.state)
    _check_balance(equilibrium)
    if beams:
        raise MechanismError(
            f"beam {beams[0]}: the steady state deforms it beyond the range of its strain measure{unguessed}: divide it into "
            "shorter beams, or give a better guess"
        )
    return equilibrium.state


def _continued(tree: Tree, q: Array, grow: bool) -> tuple[float, Balance | None]:
    """Follow the equilibrium from the guess q (n,), which dead forces balance, until they vanish.

    ``grow``: meanwhile rates, accelerations and gravity grow from zero. Returns the fraction of the path that was followed, and
    the equilibrium at its end, if it was reached.
    """
    free = partition.free_coordinates(tree)
    try:
        start = balance_at(_loaded(tree, 0.0) if grow else tree, q)
    except ContradictionError:
        return 0.0, None
    J = partition.jacobian(tree, start.state.kinematics.B)[:, free]
    dead = start.forces + J.T @ start.state.multipliers.ravel()

    def solve(fraction: float, guess: Array) -> tuple[Balance, Array] | None:
        closed, gap = close_loops(tree, guess, free)
        if np.abs(gap).max(initial=0.0) > CLOSED:
            return None
        with suppress(MechanismError):  # the loops are singular there
            guessed = balance_at(_loaded(tree, fraction) if grow else tree, closed, (1.0 - fraction) * dead)
            balance = newton(replace(guessed, trust=(closed, MAX_STEP)))
            if balance and balance.balanced:
                return balance, balance.state.q
        return None

    reached, equilibrium = follow(solve, q)
    return reached, equilibrium if reached == 1.0 else None


def _loaded(tree: Tree, part: float) -> Tree:
    """The tree with accelerations and gravity times ``part``, and rates times its root: inertial forces scale with ``part``."""
    m = tree.mechanism
    motions = tuple(replace(x, rate=x.rate * np.sqrt(part), acceleration=x.acceleration * part) for x in m.motions)
    gravity = (m.gravity[0] * part, m.gravity[1] * part, m.gravity[2] * part)
    return replace(tree, mechanism=replace(m, motions=motions, gravity=gravity))


def _relaxed(tree: Tree, q: Array) -> Balance | None:
    for allow_unstable in (False, True):
        try:
            if equilibrium := relaxed(tree, q, allow_unstable):
                return equilibrium
        except MechanismError:  # the loops are singular on the way
            continue
    return None


def _without_guess(tree: Tree, q: Array) -> str:
    """The steady state found without a guess, in words: its coordinates furthest from the guess q (n,)."""
    try:
        state = steady_state(tree)
    except MechanismError:
        return ""
    distance = np.abs(state.q - q) / coordinate_units(tree, length_at(tree, state.kinematics.poses))
    distance[tree.first_internal[:, None] + np.arange(6)] = 0.0  # internal coordinates of beams are not informative
    furthest = np.argsort(-distance)[:3]
    values = ", ".join(f"{tree.coordinates[j]} = {round(float(state.q[j]), 9):.4g}" for j in furthest)
    return f"; without a guess, a steady state was found at {values}"


def null_motions(linear: Linearization) -> tuple[Array, Array]:
    """Bases (i, d) of the null space of K̂, over the independent coordinates, and of its left null space."""
    tangent = tangent_at(linear.tree, linear.state, linear.partition)
    root = np.sqrt(tangent.scale)[:, None]
    return tangent.K.null / root, tangent.K.left_null / root


def residual_closed_by(tree: Tree, q: Array, follow: Index, independent: tuple[str, ...]) -> Balance:
    """The balance near coordinates q (n,), after coordinates ``follow`` have closed the loops.

    Raises:
        MechanismError: if the loops do not close.
    """
    q, gap = close_loops(tree, q, follow)
    if np.abs(gap).max(initial=0.0) > ASSEMBLED:
        raise MechanismError("loops: they do not close")
    return balance_at(tree, q, independent=independent)


def perturbed_again(tree: Tree, state: State, independent: tuple[str, ...]) -> State:
    """The steady state computed again, by one Newton step from a point a rounding error away, to show its accuracy.

    Raises:
        MechanismError: as ``steady_state``.
    """
    free, eps = partition.free_coordinates(tree), float(np.finfo(float).eps)
    q = state.q.copy()
    sign = np.random.default_rng(1921).choice([-1.0, 1.0], len(free))
    units = coordinate_units(tree, length_at(tree, state.kinematics.poses))[free]
    q[free] += eps * sign * np.maximum(np.abs(q[free]), units)
    balance = balance_at(tree, close_loops(tree, q, free)[0], independent=independent)
    q = balance.state.q.copy()
    q[free] += balance.step
    return balance_at(tree, close_loops(tree, q, free)[0], independent=independent).state


def _check_balance(balance: Balance) -> None:
    """Check that no coordinate carries a force without a stiffness."""
    if balance.balanced:
        return
    rounding = balance.tangent.rounding
    worst = int(np.argmax(np.abs(balance.independent_forces) / np.where(rounding > 0, rounding, 1.0)))
    j = balance.part.independent[worst]
    raise MechanismError(
        f"coordinate {balance.tree.coordinates[j]!r}: no steady state: {balance.independent_forces[worst]:.3g} "
        f"{'N m' if balance.tree.screw[j, 3:].any() else 'N'} remain unbalanced and no stiffness resists them; prescribe its "
        "motion, or add a spring"
    )
