"""Loop joints as equations between two frames: coincident points, and products of directions that vanish.

E. J. Haug, *Computer-Aided Kinematics and Dynamics of Mechanical Systems* (1989), ch. 9: the basic constraints dot-1
(two directions perpendicular), dot-2 (a direction perpendicular to the line between the points) and spherical. A
product also vanishes where axes are opposed instead of aligned, so check ``reversed_axes`` as well.
"""

import numpy as np

from ...core.mechanism.joints import Joint
from .points import Frame, Function, along, apart, between

X, Y, Z = np.eye(3)

ALIGNED = {"revolute": (Z,), "cylindrical": (Z,), "planar": (Z,), "prismatic": (X, Z), "fixed": (X, Z)}
"""Directions that both frames of a joint share."""


def equations(joint: Joint, p: Frame, c: Frame) -> list[Function]:
    """Functions that vanish where a joint is closed; ``p`` and ``c`` are its frames on the parent and the child."""
    point = [apart(p, c, axis) for axis in (X, Y, Z)]
    parallel = [between(p, axis, c, Z) for axis in (X, Y)]
    in_line = [along(p, axis, c) for axis in (X, Y)]
    return {
        "fixed": [*point, *parallel, between(p, X, c, Y)],
        "revolute": [*point, *parallel],
        "prismatic": [*in_line, *parallel, between(p, X, c, Y)],
        "cylindrical": [*in_line, *parallel],
        "universal": [*point, between(p, X, c, Y)],
        "spherical": point,
        "planar": [along(p, Z, c), *parallel],
        "free": [],
    }[joint.kind]


def reversed_axes(joint: Joint, p: Frame, c: Frame) -> bool:
    """Whether a closed joint has axes opposed that should be aligned."""
    return any(float((p.R @ axis) @ (c.R @ axis)) < 0.0 for axis in ALIGNED.get(joint.kind, ()))
