"""Loop closure: coordinates at which all cut joints of a mechanism close."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..rank import ranked
from . import partition
from .kinematics import poses, transformation
from .scales import coordinate_units, length_at, weld_units
from .topology import Tree

Array = NDArray[Any]
Index = NDArray[np.intp]

_MAX_ITERATIONS = 60

MAX_STEP = 0.2
"""Longest step of a coordinate while loops close or a path is followed, rad or fraction of the mechanism's length."""

CLOSED, ASSEMBLED = 1e-11, 1e-9
"""Largest gap of a loop, rad or fraction of the mechanism's length: while Newton's method converges, and at assembly."""


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
    q, gap = close_loops(tree, q, partition.free_coordinates(tree))
    if np.abs(gap).max(initial=0.0) > ASSEMBLED:
        worst = int(np.abs(gap).argmax())
        size = gap[worst] * weld_units(tree, length_at(tree, poses(tree, q)[0]))[worst]
        raise MechanismError(
            f"joint {tree.weld_names[worst // 6]!r}: its loop does not close: a gap of {abs(size):.3g} "
            f"{'m' if worst % 6 < 3 else 'rad'} remains; check the dimensions or give a better initial guess"
        )
    return q


def close_loops(tree: Tree, q: Array, free: Index) -> tuple[Array, Array]:
    """Close the loops from coordinates q (n,), changing only the ``free`` ones; also the remaining gap (6w,).

    Gaps are in rad and fractions of the mechanism's length. Levenberg–Marquardt steps damped by the squared gap: robust near
    singular configurations, and quadratic at the end.
    """
    q = q.copy()
    gap = np.zeros(6 * len(tree.welds))
    if not tree.welds:
        return q, gap
    last = np.inf
    for _ in range(_MAX_ITERATIONS):
        x, J = poses(tree, q)
        length = length_at(tree, x)
        equations, units = weld_units(tree, length), coordinate_units(tree, length)[free]
        gap = partition.misfit(tree, x) / equations
        size = float(np.abs(gap).max())
        if size < 1e-15 or (size < CLOSED and size > 0.5 * last):
            break
        last = size
        rows = partition.jacobian(tree, transformation(tree, J))[:, free]
        step = -ranked(rows, equations, units).solve(gap * equations, float(gap @ gap))
        q[free] += step * min(1.0, MAX_STEP / max(float(np.abs(step / units).max(initial=0.0)), MAX_STEP))
    return q, gap
