"""The orientation of the bodies of HAWC2's htc file, and how they mount the blade: hub radius, precone and pitch.

A ``relative`` block rotates ``body2`` from ``body1`` by Euler angles in degrees, each about the axes that the angles before it
have rotated, or by Euler parameters; several commands follow each other. ``ini_rotvec_d1`` is the rotor's axis, in the axes of
the body that turns with it, and its speed. A body ends at the last point of its c2_def. Source: T. J. Larsen, A. M. Hansen,
*How 2 HAWC2, the user's manual*, Risø-R-1597, ch. 6.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .....core.space.spatial import rotation, skew
from ..source import Mount
from ..text import number
from .bodies import Body, Command, blocks, main_bodies

Array = NDArray[np.float64]

MAX_BODIES = 10
"""Maximum number of bodies between the rotor's axis and the blade."""

UNIT = 1e-3
"""Largest difference of the norm of Euler parameters from 1."""

ROUNDED = 12
"""Decimals of an angle in rad: the product of rotations by right angles is exact to about 1e-16 only."""

ROUNDING = 1e-9
"""Rounding of positions, m."""

ALONG = 1e-3
"""Largest distance of the blade's root from the line through the hub along the blade, as a fraction of the hub radius."""


@dataclass(frozen=True)
class Relative:
    """One ``relative`` block.

    Attributes:
        parent, child: names of body1 and body2.
        at_end: whether body2 begins at the end of body1 (else at its beginning).
        axes: (3, 3) the axes of body2 in those of body1.
        axis: (3,) rotor's axis in the axes of body2; None if the block has none.
        speed: about this axis, rad/s.
    """

    parent: str
    child: str
    at_end: bool
    axes: Array
    axis: Array | None
    speed: float = 0.0


def relatives(commands: Sequence[Command]) -> dict[str, Relative]:
    """The ``relative`` blocks that are understood, by the name of body2; none of a body that has several."""
    parsed = [block for _, commands in blocks(commands, "relative") if (block := _relative(commands))]
    count = Counter(block.child for block in parsed)
    return {block.child: block for block in parsed if count[block.child] == 1}


def base(commands: Sequence[Command]) -> tuple[str, Array] | None:
    """Name and axes (3, 3) in the ground's axes of the body in the ``base`` block; None if it is not understood."""
    for _, block in blocks(commands, "base"):
        name, axes = "", np.eye(3)
        for command in block:
            body_number, setting = _which(command)
            if (body_number, setting) == ("", "") and len(command.words) > 1:
                name = command.words[1].lower()
            elif body_number == "" and setting in TURNS:
                rotation_matrix = _turned(setting, command)
                if rotation_matrix is None:
                    return None
                axes = axes @ rotation_matrix
            elif body_number != "inipos":
                return None
        return (name, axes) if name else None
    return None


def mounting(commands: Sequence[Command], blade: str) -> Mount | None:
    """Hub radius, precone and pitch of the body ``blade``; None if its orientation does not define them.

    The pitch angle of HAWC2's bearings is a result of a simulation and not included.
    """
    by_child, bodies = relatives(commands), main_bodies(commands)
    axes, root, body = np.eye(3), np.zeros(3), blade
    for _ in range(MAX_BODIES):
        block = by_child.get(body)
        if block is None:
            return None
        if block.axis is not None and body != blade:
            return mounted(root - hub_centre(root, axes, block.axis), axes, block.axis)
        start = _end(bodies.get(block.parent, [])) if block.at_end else np.zeros(3)
        if start is None:
            return None
        root, axes, body = start + block.axes @ root, block.axes @ axes, block.parent
    return None


def hub_centre(root: Array, axes: Array, axis: Array) -> Array:
    """The point (3,), m, where a blade with axes ``axes`` (3, 3) and its root at ``root`` (3,) m meets the axis through 0."""
    unit = axis / np.linalg.norm(axis)
    return np.asarray(np.linalg.lstsq(np.stack([unit, -axes[:, 2]], axis=-1), root, rcond=None)[0][0] * unit)


def mounted(root: Array, axes: Array, axis: Array) -> Mount | None:
    """The mount of a blade with axes ``axes`` (3, 3) and its root at ``root`` (3,) m from the hub's centre; None if it is not
    on the blade's axis.
    """
    along, downwind = axes[:, 2], axis / np.linalg.norm(axis)
    if axes[:, 1] @ downwind < 0:  # HAWC2's y of a blade points downwind
        downwind = -downwind
    radius = float(root @ along)
    if radius < -ROUNDING or np.linalg.norm(root - radius * along) > ALONG * radius + ROUNDING:
        return None
    precone = np.arcsin(np.clip(along @ downwind, -1.0, 1.0))
    pitch = np.arctan2(axes[:, 0] @ downwind, axes[:, 1] @ downwind)
    precone, pitch = np.round([precone, pitch], ROUNDED)
    return Mount(hub_radius=max(radius, 0.0), precone=float(precone), pitch=float(pitch))


TURNS = ("eulerang", "eulerpar")
"""Commands that rotate a body."""


def _which(command: Command) -> tuple[str, str]:
    """The number of the body of a command, and what the command sets: ``body2_eulerang`` is 2 and eulerang."""
    body_number, _, setting = command.words[0].removeprefix("m").removeprefix("body").removeprefix("bdy").partition("_")
    return body_number, setting


def _turned(setting: str, command: Command) -> Array | None:
    """The rotation (3, 3) of a command; None if its numbers are not those of one."""
    if setting == "eulerang":
        angles = _vector(command)
        if angles is None:
            return None
        out = np.eye(3)
        for k, angle in enumerate(np.radians(angles)):
            out = out @ rotation(k, angle)
        return out
    values = [number(word) for word in command.words[1:5]]
    if len(values) != 4 or any(v is None or not np.isfinite(v) for v in values):
        return None
    q = np.array(values, float)
    if abs(np.linalg.norm(q) - 1.0) > UNIT:
        return None
    q /= np.linalg.norm(q)
    cross_matrix = skew(q[1:])
    return np.eye(3) + 2.0 * q[0] * cross_matrix + 2.0 * cross_matrix @ cross_matrix


def _relative(block: Body) -> Relative | None:
    """A block; None if it is incomplete or has commands of another kind."""
    bodies: dict[str, tuple[str, ...]] = {}
    axes, axis, speed = np.eye(3), None, 0.0
    for command in block:
        body_number, setting = _which(command)
        if not setting and body_number in ("1", "2"):
            bodies[body_number] = command.words[1:]
        elif body_number == "2" and setting in TURNS:
            rotation_matrix = _turned(setting, command)
            if rotation_matrix is None:
                return None
            axes = axes @ rotation_matrix
        elif body_number == "2" and setting == "ini_rotvec_d1":
            axis, speed = _vector(command), number((*command.words, "", "")[4]) or 0.0
        elif setting not in ("ini_vec_d1",):
            return None
    if not all(len(bodies.get(body, ())) > 1 for body in "12") or bodies["2"][1] != "1":
        return None
    if bodies["1"][1].lower() not in ("last", "1") or (axis is not None and not axis.any()):
        return None
    at_end = bodies["1"][1].lower() == "last"
    return Relative(bodies["1"][0].lower(), bodies["2"][0].lower(), at_end, axes, axis, abs(speed))


def _vector(command: Command) -> Array | None:
    values = [number(word) for word in command.words[1:4]]
    if len(values) != 3 or any(v is None or not np.isfinite(v) or abs(v) > 1e6 for v in values):
        return None
    return np.array(values, float)


def _end(body: Body) -> Array | None:
    """The last point (3,) m of a body's c2_def."""
    sections = [c for c in body if c.words[0] == "sec"]
    point = [number(word) for word in sections[-1].words[2:5]] if sections else []
    return np.array(point, float) if len(point) == 3 and all(v is not None and np.isfinite(v) for v in point) else None
