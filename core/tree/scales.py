"""Units in which the equations of a mechanism are of order one: its length along an axis, 1 rad about one."""

import numpy as np
from numpy.typing import NDArray

from .topology import Tree

Array = NDArray[np.float64]


def length_at(tree: Tree, poses: Array) -> float:
    """Length of a mechanism with body poses (b, 4, 4), m: the larger of its dimensions and its distance from the origin."""
    return max(tree.length, float(np.abs(poses[:, :3, 3]).max(initial=0.0)))


def coordinate_units(tree: Tree, length: float) -> Array:
    """(n,) unit of each coordinate; that of a beam's internal ones displaces its points by ``length`` or 1 rad."""
    units = np.where(tree.screw[:, 3:].any(1), 1.0, length)
    twist = np.repeat([length, 1.0], 3)[:, None]
    for batch in tree.batches:
        if not batch.beams.internal_count:
            continue
        displacement = np.zeros((len(batch.index), 6))
        np.maximum.at(displacement, batch.beams.points.element, np.abs(batch.beams.points.bubble / twist).max(1))
        units[batch.first_internal[:, None] + np.arange(6)] = 1.0 / np.where(displacement > 0, displacement, 1.0)
    return units


def weld_units(tree: Tree, length: float) -> Array:
    """(6w,) unit of each constraint equation of the welds."""
    return np.tile(np.repeat([length, 1.0], 3), len(tree.welds))
