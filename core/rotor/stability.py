"""Limits of stability of a periodic system: the speeds at which a solution begins to grow."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .floquet import floquet
from .periodic import Periodic

GROWS = 1e-11
"""Growth, as a fraction of Ω, that never counts."""

ACCURACY = 1e-10
"""Relative uncertainty of a limit by default."""


class Limit(NamedTuple):
    """A limit of stability.

    Attributes:
        at: the speed, in the unit of the speeds given.
        uncertainty: half the interval in which it lies.
        grows_above: whether solutions grow above it; below it otherwise.
    """

    at: float
    uncertainty: float
    grows_above: bool


def grows(system: Periodic) -> bool:
    """Whether a solution grows by more than the error of its exponent."""
    solution = floquet(system)
    return bool((solution.values.real > np.maximum(solution.error, GROWS * abs(system.omega))).any())


def limits(system: Callable[[float], Periodic], speeds: Sequence[float], accuracy: float = ACCURACY) -> list[Limit]:
    """Limits of stability between speeds, by bisection.

    A limit is found if the state is stable at one of two successive speeds and unstable at the other; two limits between
    them are not.

    Args:
        system: the periodic system at a speed.
        speeds: ascending.
        accuracy: relative uncertainty of each limit.
    """
    out: list[Limit] = []
    unstable = [grows(system(speed)) for speed in speeds]
    for (low, high), (unstable_below, unstable_above) in zip(pairwise(speeds), pairwise(unstable), strict=True):
        if unstable_below == unstable_above:
            continue
        while high - low > 2.0 * accuracy * abs(high):
            middle = 0.5 * (low + high)
            if grows(system(middle)) == unstable_below:
                low = middle
            else:
                high = middle
        out.append(Limit(0.5 * (low + high), 0.5 * (high - low), unstable_above))
    return out
