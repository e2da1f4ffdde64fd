"""Pseudo-time relaxation of a mechanism from a guess to a stable equilibrium, where Newton's method takes over."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..tree.topology import Tree
from .balance import SMALL_CORRECTION, Balance, balance_at
from .newton import newton

Array = NDArray[Any]

_MAX_RELAXATIONS = 200
_NEGLIGIBLE_WEIGHT = 1e-3  # of the added stiffness, below which Newton's method alone is tried
_MAX_RISES = 20  # successive steps that increase the unbalanced forces
_MAX_WEIGHT = 1e12  # of the added stiffness: beyond, steps vanish in rounding


def relaxed(tree: Tree, q: Array, allow_unstable: bool = False) -> Balance | None:
    """Newton's method with pseudo-time steps: the path of an overdamped mechanism from q to a stable equilibrium.

    With ``allow_unstable``, coordinates with a negative stiffness, such as those of a free body in a rotating frame, move in
    the opposite direction: the equilibrium of such a body is found although it is unstable. No other unstable equilibrium is
    accepted, since rounding would decide which of them is reached.

    An implicit step adds the damping divided by the time step to the stiffness. Time steps grow as unbalanced forces decrease
    (C. T. Kelley and D. E. Keyes, *SIAM J. Numer. Anal.* 35, 1998, 508–523) and shrink if a step is long or forces double.
    """
    weight, last_weight, rises = 1.0, np.inf, 0
    current = balance_at(tree, q)
    for _ in range(_MAX_RELAXATIONS):
        nearly = weight <= min(0.1 * last_weight, _NEGLIGIBLE_WEIGHT) and current.length < SMALL_CORRECTION
        if current.balanced or nearly:
            last_weight = weight
            equilibrium = newton(current)
            if equilibrium and equilibrium.tangent.is_attractor(allow_unstable):
                return equilibrium
        if current.balanced:
            return None
        tangent = current.tangent
        step = tangent.relaxation(current, weight, allow_unstable)
        following = current.after(step) if tangent.length(step) < SMALL_CORRECTION else None
        growth = np.inf if following is None else tangent.norm(following) / tangent.norm(current)
        if following is not None and growth < 2.0:
            weight *= max(growth, 0.1)
            rises = rises + 1 if growth > 1.0 else 0
            if rises > _MAX_RISES:
                return None
            current = following
        elif weight < _MAX_WEIGHT:
            weight *= 4.0
        else:
            return None
    return None
