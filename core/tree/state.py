"""The state of motion at given coordinates: velocities and accelerations that the motions impose through the loops."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..rank import ranked
from . import dynamics, partition
from .closure import size_of
from .dynamics import Cartesian
from .kinematics import Kinematics, kinematics
from .topology import Tree

Array = NDArray[Any]


@dataclass(frozen=True)
class State:
    """A state of motion: coordinates, velocities, accelerations (n,), multipliers (w, 6), and quantities derived from them."""

    q: Array
    v: Array
    a: Array
    multipliers: Array
    kinematics: Kinematics
    cartesian: Cartesian

    @cached_property
    def tangent(self) -> tuple[Array, Array, Array]:
        """M*, C*, K* (n, n) at this state; see ``dynamics.tangent``."""
        return dynamics.tangent(self.kinematics.tree, self.kinematics, self.cartesian)


class ContradictionError(MechanismError):
    """Prescribed rates that contradict a loop."""


def given(tree: Tree) -> list[int]:
    """Indices of the coordinates with a motion, prescribed or not."""
    return [tree.coordinate(m.coordinate) for m in tree.mechanism.motions]


def state_at(tree: Tree, q: Array) -> State:
    """The state at coordinates q (n,), with the rates that the motions impose, also through the loops (eq. 18, 20)."""
    n = len(q)
    v, a = np.zeros(n), np.zeros(n)
    moved = given(tree)
    for m, j in zip(tree.mechanism.motions, moved, strict=True):
        v[j], a[j] = m.rate, m.acceleration
    k = kinematics(tree, q, v, a)
    if tree.welds:
        following = np.setdiff1d(np.arange(n), moved)
        J = partition.jacobian(tree, k.B)
        back = ranked(J[:, following])
        v[following] = back.solve(-J @ v)
        k = kinematics(tree, q, v, a)
        a[following] = back.solve(-J @ a - partition.jacobian(tree, k.B1) @ v)
        if np.abs(J @ v).max() > 1e-7 * max(float(np.abs(v).max()), 1e-300) * size_of(k.poses):
            raise ContradictionError("motions: the prescribed rates contradict a loop; prescribe fewer coordinates")
        k = kinematics(tree, q, v, a)
    return State(q, v, a, np.zeros((len(tree.welds), 6)), k, dynamics.cartesian(tree, k))


def moving(tree: Tree, state: State) -> NDArray[np.bool_]:
    """(n,) whether a coordinate moves because its loop does."""
    out = np.abs(state.v) > 1e-9 * np.abs(state.v).max(initial=0.0)
    out[given(tree)] = False
    return out


def check_rates(tree: Tree, state: State) -> None:
    """Check that the motions determine the rates of all moving loops.

    Raises:
        MechanismError: a coordinate of a moving loop has no determined rate.
    """
    if not moving(tree, state).any():
        return
    following = np.setdiff1d(np.arange(len(state.q)), given(tree))
    open_ = ranked(partition.jacobian(tree, state.kinematics.B)[:, following]).null
    free = moving(tree, state)[following] & (np.abs(open_).max(axis=1, initial=0.0) > 1e-9)
    if free.any():
        name = tree.coordinates[following[int(free.argmax())]]
        raise MechanismError(
            f"coordinate {name!r}: its loop moves, but the motions do not determine its rate: give it a rate too "
            "(prescribed = false if it is to vibrate)"
        )
