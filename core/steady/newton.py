"""Newton's method on the balance of forces of a mechanism, near the solution or globalised by pseudo-time."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..tree import partition
from ..tree.closure import closed
from ..tree.state import State
from ..tree.strained import out_of_range
from ..tree.topology import Tree
from .balance import Residual, Tangent, norm, residual_at, tangent_at

Array = NDArray[Any]

_MAX_STEPS, _MAX_RELAXATIONS = 60, 200
_SMALL_CORRECTION = 0.05  # rad, or fraction of the length
_NEARLY = 1e-3  # weight of the added stiffness below which Newton's method alone is tried
_RUNS_AWAY = 20  # successive steps that increase the unbalanced forces, after which it gives up
_MAX_WEIGHT = 1e12  # of the added stiffness: beyond, steps vanish in rounding


@dataclass(frozen=True)
class Found:
    """The result of Newton's method."""

    state: State
    residual: Residual
    tangent: Tangent


def newton(tree: Tree, q: Array, dead: Array | float = 0.0, far: float = np.inf) -> Found | None:
    """Newton's method as long as each correction is at most half the previous one; else, or ``far`` from the start, None.

    Near the solution a first correction may grow (P. Deuflhard, *Newton Methods for Nonlinear Problems*, 2004, sec. 2.1.1).
    """
    free = partition.free_coordinates(tree)
    start, here = q, residual_at(tree, q, dead)
    for _ in range(_MAX_STEPS):
        at = tangent_at(tree, here)
        step = at.step(here)
        length = norm(step, at)
        done = at.balanced(here)
        if length < 1e-15 or (done and length < 1e-13):
            return Found(here.state, here, at)
        following = _moved(tree, here, step, dead) if np.isfinite(length) else None
        contraction = np.inf if following is None else norm(at.step(following), at) / length
        if done and contraction > 0.5:  # only rounding is left
            return Found(here.state, here, at)
        near = max(length, length * contraction) < _SMALL_CORRECTION
        if following is None or not (contraction <= 0.5 or near or length < 1e-9):
            return None
        here = following
        if norm((here.state.q - start)[free], at) > far:
            return None
    return None


def relaxed(tree: Tree, q: Array, towards: bool = False) -> Found | None:
    """Newton's method with pseudo-time steps: the path of an overdamped mechanism from q to a stable equilibrium.

    With ``towards``, coordinates with a negative stiffness, such as those of a free body in a rotating frame, move in the
    opposite direction: the equilibrium of such a body is found although it is unstable. No other unstable equilibrium is
    accepted, since rounding would decide which of them is reached.

    An implicit step adds the damping divided by the time step to the stiffness. Time steps grow as the forces left decrease
    (C. T. Kelley and D. E. Keyes, *SIAM J. Numer. Anal.* 35, 1998, 508–523) and shrink if a step is long or forces double.
    """
    weight, tried, rising = 1.0, np.inf, 0
    here = residual_at(tree, q)
    at = tangent_at(tree, here)
    for _ in range(_MAX_RELAXATIONS):
        arrived = at.balanced(here)
        if arrived or (weight <= min(0.1 * tried, _NEARLY) and norm(at.step(here), at) < _SMALL_CORRECTION):
            tried = weight
            found = newton(tree, here.state.q)
            if found and found.tangent.attracts(towards):
                return found
        if arrived:
            return None
        step = at.relaxation(here, weight, towards)
        following = _moved(tree, here, step, 0.0) if norm(step, at) < _SMALL_CORRECTION else None
        growth = np.inf if following is None else at.left(following) / at.left(here)
        if following is not None and growth < 2.0:
            weight *= max(growth, 0.1)
            rising = rising + 1 if growth > 1.0 else 0
            if rising > _RUNS_AWAY:
                return None
            here = following
            at = tangent_at(tree, here)
        elif weight < _MAX_WEIGHT:
            weight *= 4.0
        else:
            return None
    return None


def _moved(tree: Tree, here: Residual, step: Array, dead: Array | float) -> Residual | None:
    """The residual after a step (f,) of the free coordinates; None if loops do not close or beams are out of range."""
    free = partition.free_coordinates(tree)
    q = here.state.q.copy()
    q[free] += step
    q, gap, size = closed(tree, q, free)
    if np.abs(gap).max(initial=0.0) > 1e-11 * size:
        return None
    names = tuple(tree.coordinates[j] for j in here.part.independent)
    moved = residual_at(tree, q, dead, names)
    return None if out_of_range(tree, moved.state.kinematics.poses) else moved
