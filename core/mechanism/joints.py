"""Joints as sequences of screws: each coordinate moves the child along one unit twist fixed in the joint's frame.

A joint places its child at ``X_child = X_parent · at_parent · Π exp(S_k q_k) · at_child⁻¹``. Every kind is a list of screws
S_k along the joint's axes, so one rule covers all kinds; three rotations are the Cardan angles x, y, z.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..space import spatial as sp

Array = NDArray[np.float64]
Kind = Literal["fixed", "revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "free", "elastic"]

TX, TY, TZ, RX, RY, RZ = np.eye(6)

SCREWS: Mapping[str, tuple[tuple[str, Array], ...]] = MappingProxyType(
    {
        "fixed": (),
        "revolute": (("rz", RZ),),
        "prismatic": (("z", TZ),),
        "cylindrical": (("z", TZ), ("rz", RZ)),
        "universal": (("rx", RX), ("ry", RY)),
        "spherical": (("rx", RX), ("ry", RY), ("rz", RZ)),
        "planar": (("x", TX), ("y", TY), ("rz", RZ)),
        "free": (("x", TX), ("y", TY), ("z", TZ), ("rx", RX), ("ry", RY), ("rz", RZ)),
        "elastic": (("x", TX), ("y", TY), ("z", TZ), ("rx", RX), ("ry", RY), ("rz", RZ)),
    }
)
"""Coordinate names and unit twists of each kind, in order from parent to child."""


@dataclass(frozen=True)
class Joint:
    """A connection of a child body to a parent.

    Attributes:
        name: unique; coordinates are named ``name.rz`` and so on.
        kind: see ``SCREWS``; ``elastic`` has the coordinates of ``free`` and is spanned by a beam or bushing.
        parent, child: names of bodies; ``ground`` is the inertial frame.
        at_parent, at_child: (4, 4) pose of the joint's frame in either body. Its z axis is the axis of a revolute,
            prismatic or cylindrical joint and the normal of a planar one; a universal joint turns about x, then y.
        cut: cut the loop at this joint; by default the spanning tree chooses.
    """

    name: str
    kind: Kind
    parent: str
    child: str
    at_parent: Array = field(default_factory=lambda: np.eye(4))
    at_child: Array = field(default_factory=lambda: np.eye(4))
    cut: bool = False


def coordinate_names(joint: Joint) -> list[str]:
    """Names of the joint's coordinates, in the order of ``SCREWS``."""
    return [f"{joint.name}.{name}" for name, _ in SCREWS[joint.kind]]


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0, *, axis: str | Array = "z") -> Array:
    """A joint's frame (4, 4) at a point (m), its z axis along ``axis``: ``x``, ``y``, ``z``, ``-x`` … or a vector (3,).

    Raises:
        ValueError: for an axis without direction or of an unknown name.
    """
    axis_index = {"x": 0, "y": 1, "z": 2}
    if isinstance(axis, str):
        if axis.lstrip("-") not in axis_index:
            raise ValueError(
                f"axis: {axis!r}: give x, y or z (with a minus sign if reversed), or a vector of three components"
            )
        vector = np.eye(3)[axis_index[axis.lstrip("-")]] * (-1.0 if axis.startswith("-") else 1.0)
    else:
        vector = np.asarray(axis, float)
    length = np.linalg.norm(vector)
    if vector.shape != (3,) or not np.isfinite(length) or length == 0.0:
        raise ValueError(f"axis: {axis!r}: it needs three finite components, not all zero")
    third = vector / length
    trial = np.eye(3)[int(np.argmin(np.abs(third)))] if abs(third[2]) < 1.0 else np.array([1.0, 0.0, 0.0])
    first = trial - third * (third @ trial)
    first /= np.linalg.norm(first)
    return sp.pose(np.stack([first, np.cross(third, first), third], axis=-1), np.array([x, y, z], float))
