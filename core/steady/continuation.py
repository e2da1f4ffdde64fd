"""Continuation of a mechanism's equilibrium from a guess, which dead forces balance, until they vanish."""

from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..tree import partition
from ..tree.closure import CLOSED, MAX_STEP, close_loops
from ..tree.state import ContradictionError
from ..tree.topology import Tree
from .balance import residual_at
from .newton import Equilibrium, newton

Array = NDArray[Any]

_FIRST_STRIDE, _MIN_STRIDE = 0.25, 1e-3  # fractions of the path


def continue_from(tree: Tree, q: Array, grow: bool) -> tuple[float, Equilibrium | None]:
    """Follow the equilibrium from the guess q (n,), which dead forces balance, until they vanish.

    ``grow``: meanwhile rates, accelerations and gravity grow from zero. Returns the fraction of the path that was followed, and
    the equilibrium at its end.
    """
    free = partition.free_coordinates(tree)

    def loaded(part: float) -> Tree:
        return _loaded(tree, part) if grow else tree

    try:
        start = residual_at(loaded(0.0), q)
    except ContradictionError:
        return 0.0, None
    J = partition.jacobian(tree, start.state.kinematics.B)[:, free]
    dead = start.forces + J.T @ start.state.multipliers.ravel()
    part, stride, slope = 0.0, _FIRST_STRIDE, np.zeros_like(q)
    equilibrium = None
    while part < 1.0:
        to = min(1.0, part + stride)
        ahead, gap = close_loops(tree, q + (to - part) * slope, free)
        equilibrium = None
        if np.abs(gap).max(initial=0.0) <= CLOSED:
            with suppress(MechanismError):  # the loops are singular there
                equilibrium = newton(loaded(to), ahead, (1.0 - to) * dead, MAX_STEP)
        if equilibrium is None or not equilibrium.tangent.balanced(equilibrium.residual):
            stride *= 0.5
            if stride < _MIN_STRIDE:
                return part, None
            continue
        slope, part, q = (equilibrium.state.q - q) / (to - part), to, equilibrium.state.q
        stride *= 1.5
    return 1.0, equilibrium


def _loaded(tree: Tree, part: float) -> Tree:
    """The tree with accelerations and gravity times ``part``, and rates times its root: inertial forces scale with ``part``."""
    m = tree.mechanism
    motions = tuple(replace(x, rate=x.rate * np.sqrt(part), acceleration=x.acceleration * part) for x in m.motions)
    gravity = (m.gravity[0] * part, m.gravity[1] * part, m.gravity[2] * part)
    return replace(tree, mechanism=replace(m, motions=motions, gravity=gravity))
