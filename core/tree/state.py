"""The state of motion at given coordinates: velocities and accelerations that the motions impose through the loops."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanism.description import MechanismError
from ..rank import Ranked, ranked
from . import dynamics, partition
from .dynamics import Cartesian
from .kinematics import Kinematics, kinematics
from .scales import coordinate_units, length_at, weld_units
from .topology import Tree

Array = NDArray[Any]

_MOVES = 1e-9  # rate of a coordinate, as a fraction of the largest, above which it moves
_CONTRADICTION = 1e-7  # rate of a loop's gap, as a fraction of the largest rate


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


def driven(tree: Tree) -> list[int]:
    """Indices of the coordinates with a motion, prescribed or not."""
    return [tree.coordinate(m.coordinate) for m in tree.mechanism.motions]


def not_driven(tree: Tree) -> NDArray[np.intp]:
    """Indices of the coordinates without a motion."""
    return np.setdiff1d(np.arange(len(tree.coordinates)), driven(tree))


def loop_jacobian(tree: Tree, k: Kinematics, columns: NDArray[np.intp]) -> Ranked:
    """Φ_q over some coordinates, decomposed in the mechanism's units."""
    length = length_at(tree, k.poses)
    J = partition.jacobian(tree, k.B)[:, columns]
    return ranked(J, weld_units(tree, length), coordinate_units(tree, length)[columns])


def state_at(tree: Tree, q: Array) -> State:
    """The state at coordinates q (n,), with the rates that the motions impose, also through the loops (eq. 18, 20).

    Raises:
        ContradictionError: the motions contradict a loop.
    """
    v, a = np.zeros(len(q)), np.zeros(len(q))
    for m, j in zip(tree.mechanism.motions, driven(tree), strict=True):
        v[j], a[j] = m.rate, m.acceleration
    k = kinematics(tree, q, v, a)
    if tree.welds:
        J, following = partition.jacobian(tree, k.B), not_driven(tree)
        pinv = loop_jacobian(tree, k, following)
        v[following] = pinv.solve(-J @ v)
        k = kinematics(tree, q, v, a)
        a[following] = pinv.solve(-J @ a - partition.jacobian(tree, k.B1) @ v)
        length = length_at(tree, k.poses)
        opening = np.abs(J @ v / weld_units(tree, length)).max()
        if opening > _CONTRADICTION * np.abs(v / coordinate_units(tree, length)).max():
            raise ContradictionError("motions: the prescribed rates contradict a loop; prescribe fewer coordinates")
        k = kinematics(tree, q, v, a)
    return State(q, v, a, np.zeros((len(tree.welds), 6)), k, dynamics.cartesian(tree, k))


def driven_by_loops(tree: Tree, state: State) -> NDArray[np.bool_]:
    """(n,) whether a coordinate moves because its loop does."""
    rate = np.abs(state.v) / coordinate_units(tree, length_at(tree, state.kinematics.poses))
    out = rate > _MOVES * rate.max(initial=0.0)
    out[driven(tree)] = False
    return out


def check_rates(tree: Tree, state: State) -> None:
    """Check that the motions determine the rates of all moving loops.

    Raises:
        MechanismError: a coordinate of a moving loop has no determined rate.
    """
    moves = driven_by_loops(tree, state)
    if not moves.any():
        return
    following = not_driven(tree)
    units = coordinate_units(tree, length_at(tree, state.kinematics.poses))[following]
    null = loop_jacobian(tree, state.kinematics, following).null / units[:, None]
    undetermined = moves[following] & (np.abs(null).max(axis=1, initial=0.0) > _MOVES)
    if undetermined.any():
        name = tree.coordinates[following[int(undetermined.argmax())]]
        raise MechanismError(
            f"coordinate {name!r}: its loop moves, but the motions do not determine its rate: give it a rate too "
            "(prescribed = false if it is to vibrate)"
        )
