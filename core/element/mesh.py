"""The mesh that the engine solves: nodes, elements and joints over a tree."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..space import spatial as sp
from .beams import Beams, Points

Array = NDArray[Any]


@dataclass(frozen=True)
class JointLink:
    """A link of a mesh that is a joint with one coordinate q, like the links of a mechanism; or a rigid connection.

    Attributes:
        link: its index.
        screw: (6,) twist ρ of its end b relative to end a, in the axes of end a, at a rate of 1; zero if rigid.
        stiffness: of the spring on its coordinate, N/m or N m/rad; 0 without one.
    """

    link: int
    screw: Array
    stiffness: float = 0.0

    @cached_property
    def rate(self) -> Array:
        """(6,) the rate of q is its product with ρ."""
        square = self.screw @ self.screw
        return self.screw / square if square else self.screw


@dataclass(frozen=True)
class Mesh:
    """Nodes and elements over a tree of which node 0 is fixed to the rotating hub; a blade is a tree with one branch.

    Attributes:
        nodes: (n+1, 4, 4) undeformed poses in the hub's axes.
        lumps: (n+1, 6, 6) inertia of the rigid body at each node, in the node's axes.
        beams: the n elements, from node ``parent[k]`` to node k+1.
        samples: massless points at ``modes.STATIONS``, where mode shapes are evaluated.
        scale: the blade's length, m.
        force: (n+1, 3) steady loads on the nodes, N, in the hub's axes.
        corner: (n, 4, 4) pose of each element's end b in the frame of its node: the identity (the default), except at a kink,
            where the node has the frame of the section on the tip side.
        parent: (n,) node at which each element begins, at most its own index; a chain by default.
        joints: the links that are joints instead of elements; they have neither mass nor length.
    """

    nodes: Array
    lumps: Array
    beams: Beams
    samples: Points
    scale: float
    force: Array
    corner: Array = field(default_factory=lambda: np.zeros((0, 4, 4)))
    parent: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    joints: tuple[JointLink, ...] = ()

    def __post_init__(self) -> None:
        if not self.corner.size:
            object.__setattr__(self, "corner", np.tile(np.eye(4), (len(self.nodes) - 1, 1, 1)))
        if not self.parent.size:
            object.__setattr__(self, "parent", np.arange(len(self.nodes) - 1, dtype=np.int64))

    @cached_property
    def between(self) -> Array:
        """(n, 4, 4) undeformed poses of nodes 1 … n, each in the frame of its parent."""
        return self.beams.undeformed @ sp.inverse(self.corner)

    @property
    def elements(self) -> int:
        """Number of beam elements."""
        return len(self.beams.undeformed) - len(self.joints)
