"""Continuation of a steady state: loads grow from zero, or forces that balance a guess fade, and the state follows."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from . import extrapolation

Array = NDArray[Any]
State = TypeVar("State")

MAX_PREVIOUS = 8
"""Number of states from which the next one is extrapolated."""

_FIRST_STRIDE = 0.5  # fraction of the path
_MIN_STRIDE, _MIN_FIRST_STRIDE = 1e-3, 1e-9  # as a fraction of the path followed, and of the whole path
_MAX_STATES = 300  # number of states that are tried


def follow(solve: Callable[[float, Array], tuple[State, Array] | None], start: Array) -> tuple[float, State | None]:
    """Follow a state from 0, where its coordinates are ``start``, to 1.

    Each state starts from an extrapolation of the previous ones. A success doubles the stride, a failure halves it.

    Args:
        solve: the state at a fraction of the path and its coordinates, from a guess of these; None if there is none near.
        start: coordinates at 0, of any shape.

    Returns:
        The fraction of the path that was followed, and the state there; None if it is 0.
    """
    previous, state = {0.0: start}, None
    reached, stride = 0.0, _FIRST_STRIDE
    for _ in range(_MAX_STATES):
        fraction = min(1.0, reached + stride)
        solution = solve(fraction, extrapolated(previous, fraction))
        if solution is None:
            stride *= 0.5
            if stride < max(_MIN_STRIDE * reached, _MIN_FIRST_STRIDE):
                break
            continue
        state, coordinates = solution
        if fraction == 1.0:
            return 1.0, state
        previous = dict([*previous.items(), (fraction, coordinates)][-MAX_PREVIOUS:])
        reached, stride = fraction, 2.0 * stride
    return reached, state


def extrapolated(previous: Mapping[float, Array], at: float) -> Array:
    """The coordinates at ``at`` from those at other values of the same parameter, the last one last."""
    if at in previous:
        return previous[at]
    return extrapolation.at_zero(np.array(list(previous)) - at, np.array(list(previous.values())))
