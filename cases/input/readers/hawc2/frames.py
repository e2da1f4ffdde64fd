"""Where the bodies of a turbine are: their poses from the orientation of an htc, the rotor's axis, and the hub's centre.

HAWC2's ground axes are x to port, y downwind, z down; the axes here, at the tower's top, x up, z downwind, y = z × x. The hub's
centre is where the blades' axes meet that of the shaft.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .....core.space import spatial as sp
from .....core.turbine.turbine import shaft_pose
from ...errors import CaseError
from ..source import Mount
from . import orientation
from .parts import Parts
from .rigid import Line

Array = NDArray[np.float64]

EQUAL = 1e-6
"""Largest difference of angles, rad, and relative difference of lengths and inertias that are equal."""

LEVEL = 0.5
"""Smallest level part of the axis of a rotor, of 1."""


@dataclass(frozen=True)
class Frames:
    """Poses in the frame of the tower's top, about whose x axis the nacelle is turned to face the wind.

    Attributes:
        top: (4, 4) pose of this frame in the tower's own axes.
        pose: (4, 4) of each body above, by name.
        yaw: angle that the nacelle is turned back by, rad, about x.
        hub: (4, 4) pose of the hub's centre, z along the rotor's axis.
        mount: of the blades.
        azimuths: (n,) of the blades, rad.
    """

    top: Array
    pose: dict[str, Array]
    yaw: float
    hub: Array
    mount: Mount
    azimuths: Array


def frames(path: Path, split: Parts, tower: Line, lines: dict[str, Line]) -> Frames:
    """Where the bodies are.

    Raises:
        CaseError: the tower is not vertical, the rotor's axis is not level, or the blades are mounted differently.
    """
    vertical = np.sign(tower.end[2] - tower.nodes[0, 2])
    if np.abs(split.base @ np.array([0.0, 0.0, vertical]) - [0.0, 0.0, -1.0]).max() > EQUAL:
        raise CaseError(f"{path}: {split.tower}: not vertical, which is not supported")
    downwind = np.array([0.0, 1.0, 0.0])
    x = np.array([0.0, 0.0, vertical])
    top = sp.pose(np.stack([x, np.cross(downwind, x), downwind], axis=-1), tower.end)
    pose = {split.tower: sp.inverse(top)}
    ends = {split.tower: tower.end, **{name: body.end for name, body in lines.items()}}
    for name in (*split.nacelle, *split.rotating, *split.blades, *split.fixed_bodies):
        _place(name, split, ends, pose)
    shaft_axis = split.relatives[split.shaft].axis
    if shaft_axis is None:
        shaft_axis = _bearing(path, split, pose)
    axis = pose[split.shaft][:3, :3] @ (shaft_axis / np.linalg.norm(shaft_axis))
    first = pose[split.blades[0]]
    axis = axis if axis @ first[:3, 1] >= 0 else -axis  # HAWC2's y of a blade points downwind
    level = float(np.hypot(axis[1], axis[2]))
    if level < LEVEL:
        raise CaseError(f"{path}: {split.shaft}: its axis is not horizontal, which is not supported")
    yaw = float(np.arctan2(-axis[1], axis[2]))
    to_wind = sp.pose(sp.rotation(0, np.array(-yaw)), np.zeros(3))
    pose = {name: to_wind @ at for name, at in pose.items()}
    axis = to_wind[:3, :3] @ axis
    tilt = float(np.arctan2(axis[0], axis[2]))
    hub, mount, azimuths = _hub(path, split, pose, axis, tilt)
    return Frames(top, pose, yaw if abs(yaw) > EQUAL else 0.0, hub, mount, azimuths)


def _place(name: str, split: Parts, ends: dict[str, Array], pose: dict[str, Array]) -> Array:
    """The pose of a body from that of its parent."""
    if name not in pose:
        block = split.relatives[name]
        parent = _place(block.parent, split, ends, pose) if block.parent in split.relatives else pose[block.parent]
        start = ends[block.parent] if block.at_end else np.zeros(3)
        pose[name] = parent @ sp.pose(block.axes, start)
    return pose[name]


def _bearing(path: Path, split: Parts, pose: dict[str, Array]) -> Array:
    """The axis of the shaft's bearing, in the shaft's axes."""
    parent = split.relatives[split.shaft].parent
    joint = split.joints.get((parent, split.shaft))
    if joint is None or joint.vector is None:
        raise CaseError(
            f"{path}: {split.shaft}: neither ini_rotvec_d1 nor a bearing_vector gives the rotor's axis: add one"
        )
    reference, vector = joint.vector
    if reference == 2:
        return vector
    ground = sp.pose(split.base, np.zeros(3)) @ pose[split.tower]
    frame = pose[parent] if reference == 1 else sp.inverse(ground)
    return (sp.inverse(pose[split.shaft]) @ frame)[:3, :3] @ vector


def _hub(path: Path, split: Parts, pose: dict[str, Array], axis: Array, tilt: float) -> tuple[Array, Mount, Array]:
    """Pose of the hub's centre, where the blades' axes meet that of the shaft; the blades' mount, and their azimuths (n,)."""
    origin = pose[split.shaft][:3, 3]
    axes = shaft_pose(0.0, 0.0, tilt)[:3, :3]
    centres, mounts, azimuths = [], [], []
    for name in split.blades:
        root, along = pose[name][:3, 3], pose[name][:3, 2]
        centre = origin + orientation.hub_centre(root - origin, pose[name][:3, :3], axis)
        mount = orientation.mounted(root - centre, pose[name][:3, :3], axis)
        if mount is None:
            raise CaseError(f"{path}: {name}: its axis does not meet that of {split.shaft}: not supported")
        centres.append(centre)
        mounts.append([mount.hub_radius, mount.precone, mount.pitch])
        azimuths.append(float(np.arctan2(axes[:, 1] @ along, axes[:, 0] @ along)))
    sizes = np.array([max(1.0, np.abs(centres[0]).max())] * 3)
    if (np.abs(np.array(centres) - centres[0]) > EQUAL * sizes).any() or np.ptp(np.array(mounts), axis=0).max() > EQUAL:
        raise CaseError(
            f"{path}: {split.blades[0]} …: mounted differently (hub radius, precone or pitch): give equal blades"
        )
    n = len(split.blades)
    gaps = np.mod(np.array(azimuths) - azimuths[0] + np.pi / n, 2.0 * np.pi) - np.pi / n
    if np.abs(np.sort(gaps) - 2.0 * np.pi / n * np.arange(n)).max() > EQUAL:
        raise CaseError(f"{path}: {split.blades[0]} …: not at equal angles around the shaft: give equal angles")
    radius, precone, pitch = mounts[0]
    return sp.pose(axes, centres[0]), Mount(hub_radius=radius, precone=precone, pitch=pitch), np.array(azimuths)
