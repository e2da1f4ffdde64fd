"""Products of B and Bᵀ with several vectors at a time, over coordinates of joints, by groups that move the same bodies."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .kinematics import Kinematics

Array = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Screws:
    """The screws of f coordinates of joints, in g groups of up to c (see ``tree.Groups``).

    Attributes:
        members: (g, c) places of a group's coordinates among the f; f pads.
        place: (f,) position of each coordinate in the flattened ``members``.
        J: (g, 6, c), with zeros for padding.
        moves: (b, g) 1: the group moves the body; else 0.
    """

    members: Index
    place: Index
    J: Array
    moves: Array


def screws(k: Kinematics, joints: Index) -> Screws:
    """The screws of the coordinates ``joints`` (f,)."""
    groups, f = k.tree.groups, len(joints)
    last = int(groups.of[joints].max(initial=-1)) + 1
    number = np.full(len(k.q) + 1, f)
    number[joints] = np.arange(f)
    members, first = number[groups.members[:last]], groups.members[:last, 0]
    J = np.append(k.J[:, joints], np.zeros((6, 1)), axis=1)[:, members].transpose(1, 0, 2)
    return Screws(members, groups.place[joints], np.ascontiguousarray(J), k.tree.carries[:, first].astype(float))


def of_bodies(s: Screws, q: Array) -> Array:
    """B q (6 b, w) for coordinates q (f, w): the twists of the bodies."""
    own = s.J @ np.append(q, np.zeros((1, q.shape[1])), axis=0)[s.members]
    return (s.moves @ own.reshape(len(own), -1)).reshape(-1, q.shape[1])


def onto_joints(s: Screws, wrenches: Array) -> Array:
    """Bᵀ g (f, w) for wrenches g (6 b, w) on the bodies."""
    w = wrenches.shape[1]
    carried = (s.moves.T @ wrenches.reshape(len(s.moves), -1)).reshape(-1, 6, w)
    return (s.J.transpose(0, 2, 1) @ carried).reshape(-1, w)[s.place]


def diagonal(s: Screws, row: Index, column: Index, blocks: Array) -> Array:
    """Diagonal (f,) of Bᵀ X B, from blocks (p, 6, 6) of X on bodies."""
    moved = s.moves[row] * s.moves[column]
    carried = (moved.T @ blocks.reshape(-1, 36)).reshape(-1, 6, 6)
    return np.einsum("gic,gij,gjc->gc", s.J, carried, s.J).ravel()[s.place]
