"""A mechanism's spanning tree, built from its bodies and joints independently of core: one link per coordinate.

Joints with a motion or a spring belong to the tree, so that these act on its coordinates; joints marked as cut are left
out first. The choice of the other joints that close the loops is immaterial.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.mechanism.description import Mechanism
from ...core.mechanism.joints import Joint

Array = NDArray[np.float64]

GROUND = "ground"

AXES = {
    "fixed": "",
    "revolute": "rz",
    "prismatic": "z",
    "cylindrical": "z rz",
    "universal": "rx ry",
    "spherical": "rx ry rz",
    "planar": "x y rz",
    "free": "x y z rx ry rz",
}
"""Coordinates of each kind of joint, in order from parent to child: along (x, y, z) or about (rx, ry, rz) an axis."""


@dataclass(frozen=True)
class Link:
    """A link of the tree: the body that one coordinate moves relative to its parent.

    Attributes:
        name: of the coordinate, e.g. ``flap.rz``.
        parent: index of its parent link, −1 for the ground.
        frame: (4, 4) pose of its axes in that link.
        axis: (3,) unit vector along or about which it moves; reversed if the joint is traversed from child to parent.
        turns: whether it rotates.
    """

    name: str
    parent: int
    frame: Array
    axis: Array
    turns: bool


@dataclass(frozen=True)
class Spanning:
    """A spanning tree, and the joints that close its loops.

    Attributes:
        links: (n) one per coordinate, each followed by its subtree: Pinocchio's matrices are wrong otherwise.
        bodies: name → index of its link (−1: the ground) and its pose (4, 4) on the link.
        loops: joints that are not in the tree.
    """

    links: tuple[Link, ...]
    bodies: dict[str, tuple[int, Array]]
    loops: tuple[Joint, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return tuple(link.name for link in self.links)


def spanning(mechanism: Mechanism) -> Spanning:
    """Build the tree, with the joints that have motions or springs and, as far as possible, without those marked as cut.

    Raises:
        ValueError: a body is not connected to the ground, or the kind of a joint is unknown.
    """
    needed = {m.coordinate.rpartition(".")[0] for m in mechanism.motions}
    needed |= {s.coordinate.rpartition(".")[0] for s in mechanism.coordinate_springs}
    links: list[Link] = []
    bodies: dict[str, tuple[int, Array]] = {GROUND: (-1, np.eye(4))}
    waiting = list(mechanism.joints)
    for joint in waiting:
        if joint.kind not in AXES:
            raise ValueError(f"joint {joint.name!r}: kind {joint.kind!r} is not supported by this adapter")
    while len(bodies) <= len(mechanism.bodies):
        within = [j for j in waiting if (j.parent in bodies) != (j.child in bodies)]
        if not within:
            unconnected = next(b.name for b in mechanism.bodies if b.name not in bodies)
            raise ValueError(f"body {unconnected!r}: no joint connects it to the ground")
        joint = min(within, key=lambda j: (j.name not in needed, j.cut))
        waiting.remove(joint)
        _lay(joint, links, bodies)
    return _depth_first(links, bodies, tuple(waiting))


def _depth_first(links: list[Link], bodies: dict[str, tuple[int, Array]], loops: tuple[Joint, ...]) -> Spanning:
    """The tree with each link followed by its subtree."""
    order: list[int] = []
    pending = [-1]
    while pending:
        part = pending.pop()
        order.append(part)
        pending += [k for k, link in reversed(list(enumerate(links))) if link.parent == part]
    renumbered = {old: new for new, old in enumerate(order, -1)}
    ordered = tuple(replace(links[old], parent=renumbered[links[old].parent]) for old in order[1:])
    return Spanning(ordered, {name: (renumbered[link], pose) for name, (link, pose) in bodies.items()}, loops)


def _lay(joint: Joint, links: list[Link], bodies: dict[str, tuple[int, Array]]) -> None:
    """Add a joint's links from the end in the tree, and place the body at its other end."""
    forward = joint.parent in bodies
    inboard, outboard = (joint.at_parent, joint.at_child) if forward else (joint.at_child, joint.at_parent)
    parent, pose = bodies[joint.parent if forward else joint.child]
    frame = pose @ inboard
    steps = AXES[joint.kind].split()
    for step in steps if forward else steps[::-1]:
        axis = np.eye(3)["xyz".index(step[-1])]
        links.append(Link(f"{joint.name}.{step}", parent, frame, axis if forward else -axis, step[0] == "r"))
        parent, frame = len(links) - 1, np.eye(4)
    bodies[joint.child if forward else joint.parent] = parent, frame @ np.linalg.inv(outboard)
