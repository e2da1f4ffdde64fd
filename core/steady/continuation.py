"""Continuation of a mechanism's equilibrium from a guess, which dead forces balance, until they vanish."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..rank import ranked
from ..tree import partition
from ..tree.closure import MAX_STEP, closed
from ..tree.state import ContradictionError
from ..tree.topology import Tree
from .balance import residual_at
from .newton import Found, newton

Array = NDArray[Any]

_FIRST_STRIDE, _MIN_STRIDE = 0.25, 1e-3  # fractions of the path


def followed(tree: Tree, q: Array, grow: bool) -> tuple[float, Found | None]:
    """Follow the equilibrium from the guess, which dead forces balance, until they vanish; the fraction reached, the result.

    ``grow``: meanwhile rates, accelerations and gravity grow from zero.
    """
    free = partition.free_coordinates(tree)

    def at(part: float) -> Tree:
        return _loaded(tree, part) if grow else tree

    try:
        start = residual_at(at(0.0), q)
    except ContradictionError:
        return 0.0, None
    J = partition.jacobian(tree, start.state.kinematics.B)[:, free]
    dead = start.forces - J.T @ ranked(J.T).solve(start.forces)
    part, stride, slope = 0.0, _FIRST_STRIDE, np.zeros_like(q)
    found = None
    while part < 1.0:
        to = min(1.0, part + stride)
        ahead, gap, size = closed(tree, q + (to - part) * slope, free)
        loops_close = np.abs(gap).max(initial=0.0) <= 1e-11 * size
        try:
            found = newton(at(to), ahead, (1.0 - to) * dead, MAX_STEP) if loops_close else None
        except MechanismError:  # the loops are singular there
            found = None
        if found is None or not found.tangent.balanced(found.residual):
            stride *= 0.5
            if stride < _MIN_STRIDE:
                return part, None
            continue
        slope, part, q = (found.state.q - q) / (to - part), to, found.state.q
        stride *= 1.5
    return 1.0, found


def _loaded(tree: Tree, part: float) -> Tree:
    """The tree with accelerations and gravity times ``part``, and rates times its root: inertial forces scale with ``part``."""
    m = tree.mechanism
    motions = tuple(replace(x, rate=x.rate * np.sqrt(part), acceleration=x.acceleration * part) for x in m.motions)
    gravity = (m.gravity[0] * part, m.gravity[1] * part, m.gravity[2] * part)
    return replace(tree, mechanism=replace(m, motions=motions, gravity=gravity))
