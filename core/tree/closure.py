"""Loop closure: coordinates at which all cut joints of a mechanism close."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..rank import ranked
from . import partition
from .kinematics import poses
from .topology import Tree

Array = NDArray[Any]
Index = NDArray[np.intp]

_MAX_STEPS = 60
MAX_STEP = 0.2
"""Longest step of a coordinate while loops close or a path is followed, rad or m."""


def assemble(tree: Tree, guess: Mapping[str, float] | None = None) -> Array:
    """Coordinates (n,) that close all loops, near a guess (coordinates not named start at 0 or at their motion's position).

    Raises:
        MechanismError: if the loops do not close.
    """
    q = np.zeros(len(tree.coordinates))
    for name, value in (guess or {}).items():
        q[tree.coordinate(name)] = value
    for m in tree.mechanism.motions:
        if m.position is not None:
            q[tree.coordinate(m.coordinate)] = m.position
    q, gap, length = closed(tree, q, partition.free_coordinates(tree))
    worst = int(np.argmax(np.abs(gap))) if len(gap) else 0
    if len(gap) and abs(gap[worst]) > 1e-9 * length:
        raise MechanismError(
            f"joint {tree.weld_names[worst // 6]!r}: its loop does not close (gap {abs(gap[worst]):.3g}): wrong dimensions, or "
            "a poor guess? correct either"
        )
    return q


def closed(tree: Tree, q: Array, free: Index) -> tuple[Array, Array, float]:
    """Close the loops from coordinates q (n,), changing only the ``free`` ones; also the remaining gap (6w,) and length, m.

    Levenberg–Marquardt steps damped by the squared gap: robust near singular configurations, and quadratic at the end.
    """
    q = q.copy()
    if not tree.welds:
        return q, np.zeros(0), 1.0
    last = np.inf
    for _ in range(_MAX_STEPS):
        x, J = poses(tree, q)
        gap, length = partition.misfit(tree, x), size_of(x)
        size = float(np.abs(gap).max(initial=0.0))
        if size < 1e-15 * length or (size < 1e-11 * length and size > 0.5 * last):
            break
        last = size
        step = -ranked(partition.jacobian(tree, tree.carries[:, None, :] * J)[:, free]).solve(gap, float(gap @ gap))
        q[free] += step * min(1.0, MAX_STEP / max(float(np.abs(step).max(initial=0.0)), 1e-300))
    return q, gap, length


def size_of(x: Array) -> float:
    """Length of a mechanism with body poses ``x`` (b, 4, 4), m; at least 1."""
    return max(1.0, float(np.abs(x[:, :3, 3]).max(initial=0.0)))
