"""Steady state of a mechanism: loop closure, then the balance of forces by Newton's method, relaxation or continuation."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..tree import partition
from ..tree.closure import assemble, closed, size_of
from ..tree.state import ContradictionError, State, check_rates
from ..tree.strained import out_of_range
from ..tree.topology import Tree
from .balance import residual_at, rounding_at, tangent_at
from .continuation import followed
from .newton import Found, newton, relaxed

Array = NDArray[Any]
Index = NDArray[np.intp]


def steady(tree: Tree, guess: Mapping[str, float] | None = None) -> State:
    """Find the steady state: coordinates with a motion follow it, all others are at rest or at the rates the loops impose.

    Newton's method is used as long as its corrections contract. Otherwise the mechanism relaxes in pseudo-time from a guess
    that was given. Continuation follows the equilibrium from rest, with dead forces that balance the mechanism at the guess:
    rates, accelerations and gravity grow while the dead forces fade. If a mechanism has no equilibrium at rest, as a pendulum
    whose weight grows with gravity, only the dead forces fade. Without a guess, relaxation is the last resort.

    Raises:
        MechanismError: loops that do not close, motions that contradict them, or no equilibrium found.
    """
    q = assemble(tree, guess)
    contradiction = None
    try:
        found = newton(tree, q) or (_relaxed(tree, q) if guess else None)
    except ContradictionError as error:  # at the assembled guess, but perhaps not at the steady state
        found, contradiction = None, error
    reached = []
    for grow in (True, False):
        if found is None:
            part, found = followed(tree, q, grow)
            reached.append(part)
    if found is None and contradiction:
        raise contradiction
    if found is None and not guess:
        found = _relaxed(tree, q)
    beams = out_of_range(tree, found.state.kinematics.poses) if found else []
    unguessed = _without_guess(tree, q) if guess and (beams or not found) else ""
    if found is None:
        raise MechanismError(
            "no steady state was found near the guess: neither Newton's method nor relaxation converges from it, and "
            f"continuation reached {100 * reached[0]:.3g} % from rest with rates and gravity growing, {100 * reached[1]:.3g} % "
            f"from the guess with dead forces fading{unguessed}: give a better guess, or check for a missing spring or joint"
        )
    check_rates(tree, found.state)
    _check_balance(tree, found)
    if beams:
        raise MechanismError(
            f"beam {beams[0]}: the steady state found deforms it beyond the range of its strain measure{unguessed}: divide it "
            "into shorter beams, or give a better guess"
        )
    return found.state


def _relaxed(tree: Tree, q: Array) -> Found | None:
    for towards in (False, True):
        try:
            if found := relaxed(tree, q, towards):
                return found
        except MechanismError:  # the loops are singular on the way
            continue
    return None


def _without_guess(tree: Tree, q: Array) -> str:
    """The steady state found without a guess, in words: its coordinates furthest from the guess q (n,)."""
    try:
        state = steady(tree)
    except MechanismError:
        return ""
    apart = np.abs(state.q - q)
    apart[tree.inner[:, None] + np.arange(6)] = 0.0  # the inside of beams says little
    values = ", ".join(f"{tree.coordinates[j]} = {round(float(state.q[j]), 9):.4g}" for j in np.argsort(-apart)[:3])
    return f"; without a guess one is found, with {values}"


def unresisted(tree: Tree, state: State, independent: tuple[str, ...]) -> tuple[Array, Array]:
    """Bases (i, d) of the null space of K̂, over the independent coordinates, and of its left null space."""
    tangent = tangent_at(tree, residual_at(tree, state.q, independent=independent))
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
    here = residual_at(tree, q, independent=independent)
    return here.state, here.reduced, rounding_at(tree, here)


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
    here = residual_at(tree, closed(tree, q, free)[0], independent=independent)
    q = here.state.q.copy()
    q[free] += tangent_at(tree, here).step(here)
    return residual_at(tree, closed(tree, q, free)[0], independent=independent).state


def _check_balance(tree: Tree, found: Found) -> None:
    """Check that no coordinate carries a force without a stiffness."""
    here, tangent = found.residual, found.tangent
    if not tangent.balanced(here):
        worst = int(np.argmax(np.abs(here.reduced) / np.maximum(tangent.rounding, 1e-300)))
        raise MechanismError(
            f"coordinate {tree.coordinates[here.part.independent[worst]]!r}: no steady state: "
            f"{here.reduced[worst]:.3g} N or N m remain unbalanced and no stiffness resists them; prescribe its motion, or add "
            "a spring"
        )
