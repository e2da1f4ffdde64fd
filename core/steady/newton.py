"""Newton's method on the balance of forces of a mechanism, near the solution or globalised by pseudo-time."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..tree import partition
from ..tree.closure import CLOSED, close_loops
from ..tree.state import State
from ..tree.strained import out_of_range
from ..tree.topology import Tree
from .balance import Residual, Tangent, residual_at, tangent_at

Array = NDArray[Any]

_MAX_ITERATIONS, _MAX_RELAXATIONS = 60, 200
_SMALL_CORRECTION = 0.05  # rad, or fraction of the length
_NEGLIGIBLE_WEIGHT = 1e-3  # of the added stiffness, below which Newton's method alone is tried
_MAX_RISES = 20  # successive steps that increase the unbalanced forces
_MAX_WEIGHT = 1e12  # of the added stiffness: beyond, steps vanish in rounding


@dataclass(frozen=True)
class Equilibrium:
    """A converged residual and its derivative."""

    residual: Residual
    tangent: Tangent

    @property
    def state(self) -> State:
        """The state of motion."""
        return self.residual.state


def newton(tree: Tree, q: Array, dead: Array | float = 0.0, trust_radius: float = np.inf) -> Equilibrium | None:
    """Newton's method as long as each correction is at most half the previous one; None otherwise, or beyond ``trust_radius``.

    Near the solution a first correction may grow (P. Deuflhard, *Newton Methods for Nonlinear Problems*, 2004, sec. 2.1.1).
    ``dead`` (f,): constant forces on the free coordinates.
    """
    free = partition.free_coordinates(tree)
    start, here = q, residual_at(tree, q, dead)
    for _ in range(_MAX_ITERATIONS):
        at = tangent_at(tree, here)
        step = at.step(here)
        length = at.length(step)
        balanced = at.balanced(here)
        if length < 1e-15 or (balanced and length < 1e-13):
            return Equilibrium(here, at)
        following = _moved(tree, here, step, dead) if np.isfinite(length) else None
        contraction = np.inf if following is None else at.length(at.step(following)) / length
        if balanced and contraction > 0.5:  # only rounding is left
            return Equilibrium(here, at)
        near = max(length, length * contraction) < _SMALL_CORRECTION
        if following is None or not (contraction <= 0.5 or near or length < 1e-9):
            return None
        here = following
        if at.length((here.state.q - start)[free]) > trust_radius:
            return None
    return None


def relaxed(tree: Tree, q: Array, allow_unstable: bool = False) -> Equilibrium | None:
    """Newton's method with pseudo-time steps: the path of an overdamped mechanism from q to a stable equilibrium.

    With ``allow_unstable``, coordinates with a negative stiffness, such as those of a free body in a rotating frame, move in
    the opposite direction: the equilibrium of such a body is found although it is unstable. No other unstable equilibrium is
    accepted, since rounding would decide which of them is reached.

    An implicit step adds the damping divided by the time step to the stiffness. Time steps grow as unbalanced forces decrease
    (C. T. Kelley and D. E. Keyes, *SIAM J. Numer. Anal.* 35, 1998, 508–523) and shrink if a step is long or forces double.
    """
    weight, tried, rises = 1.0, np.inf, 0
    here = residual_at(tree, q)
    at = tangent_at(tree, here)
    for _ in range(_MAX_RELAXATIONS):
        arrived = at.balanced(here)
        nearly = weight <= min(0.1 * tried, _NEGLIGIBLE_WEIGHT) and at.length(at.step(here)) < _SMALL_CORRECTION
        if arrived or nearly:
            tried = weight
            equilibrium = newton(tree, here.state.q)
            if equilibrium and equilibrium.tangent.is_attractor(allow_unstable):
                return equilibrium
        if arrived:
            return None
        step = at.relaxation(here, weight, allow_unstable)
        following = _moved(tree, here, step, 0.0) if at.length(step) < _SMALL_CORRECTION else None
        growth = np.inf if following is None else at.norm(following) / at.norm(here)
        if following is not None and growth < 2.0:
            weight *= max(growth, 0.1)
            rises = rises + 1 if growth > 1.0 else 0
            if rises > _MAX_RISES:
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
    q, gap = close_loops(tree, q, free)
    if np.abs(gap).max(initial=0.0) > CLOSED:
        return None
    names = tuple(tree.coordinates[j] for j in here.part.independent)
    moved = residual_at(tree, q, dead, names)
    return None if out_of_range(tree, moved.state.kinematics.poses) else moved
