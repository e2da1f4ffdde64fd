"""How HAWC2's htc file mounts the blade on the rotor: hub radius, precone and pitch from the orientation of its bodies.

A ``relative`` block rotates ``body2`` from ``body1`` by Euler angles in degrees, each about the axes that the angles before it
have rotated; several commands follow each other. ``ini_rotvec_d1`` is the rotor's axis, in the axes of the body that turns with
it. A body ends at the last point of its c2_def. Source: T. J. Larsen, A. M. Hansen, *How 2 HAWC2, the user's manual*,
Risø-R-1597, ch. 6.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .....core.space.spatial import rotation
from ..source import Mount
from ..text import number
from .bodies import Body, Command

Array = NDArray[np.float64]

MAX_BODIES = 10
"""Maximum number of bodies between the rotor's axis and the blade."""

ROUNDED = 12
"""Decimals of an angle in rad: the product of rotations by right angles is exact to about 1e-16 only."""

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
    """

    parent: str
    child: str
    at_end: bool
    axes: Array
    axis: Array | None


def mounting(commands: Sequence[Command], blade: str) -> Mount | None:
    """Hub radius, precone and pitch of the body ``blade``; None if its orientation does not define them.

    The pitch angle of HAWC2's bearings is a result of a simulation and not included.
    """
    blocks = {block.child: block for block in map(_relative, _blocks(commands)) if block}
    ends = _ends(commands)
    axes, root, body = np.eye(3), np.zeros(3), blade
    for _ in range(MAX_BODIES):
        block = blocks.get(body)
        if block is None:
            return None
        if block.axis is not None and body != blade:
            return _mount(root, axes, block.axis)
        turns = blocks.get(block.parent)
        rotor = turns is not None and turns.axis is not None
        start = ends.get(block.parent) if block.at_end and not rotor else np.zeros(3)
        if start is None:
            return None
        root, axes, body = start + block.axes @ root, block.axes @ axes, block.parent
    return None


def _mount(root: Array, axes: Array, axis: Array) -> Mount | None:
    """The mount of a blade with axes ``axes`` (3, 3) and its root at ``root`` (3,) m from a point of the rotor's axis."""
    along, downwind = axes[:, 2], axis / np.linalg.norm(axis)
    if axes[:, 1] @ downwind < 0:  # HAWC2's y of a blade points downwind
        downwind = -downwind
    radius = float(root @ along)
    if radius < 0 or np.linalg.norm(root - radius * along) > ALONG * radius:
        return None
    precone = np.arcsin(np.clip(along @ downwind, -1.0, 1.0))
    pitch = np.arctan2(axes[:, 0] @ downwind, axes[:, 1] @ downwind)
    precone, pitch = np.round([precone, pitch], ROUNDED)
    return Mount(hub_radius=radius, precone=float(precone), pitch=float(pitch))


def _blocks(commands: Sequence[Command]) -> list[Body]:
    """The commands of each ``relative`` block."""
    out: list[Body] = []
    inside = False
    for command in commands:
        words = tuple(word.lower() for word in command.words[:2])
        if words == ("begin", "relative"):
            out.append([])
        elif inside and words != ("end", "relative"):
            out[-1].append(command)
        inside = words == ("begin", "relative") or (inside and words != ("end", "relative"))
    return out


def _relative(block: Body) -> Relative | None:
    """A block; None if it is incomplete or has commands of another kind."""
    named: dict[str, tuple[str, ...]] = {}
    axes, axis = np.eye(3), None
    for command in block:
        body, _, what = command.words[0].removeprefix("m").removeprefix("body").removeprefix("bdy").partition("_")
        if not what:
            named[body] = command.words[1:]
        elif body == "2" and what == "eulerang":
            angles = _vector(command)
            if angles is None:
                return None
            for k, angle in enumerate(np.radians(angles)):
                axes = axes @ rotation(k, angle)
        elif body == "2" and what == "ini_rotvec_d1":
            axis = _vector(command)
        elif what not in ("ini_vec_d1",):
            return None
    if not all(len(named.get(body, ())) > 1 for body in "12") or named["2"][1] != "1":
        return None
    if named["1"][1].lower() not in ("last", "1") or (axis is not None and not axis.any()):
        return None
    return Relative(named["1"][0].lower(), named["2"][0].lower(), named["1"][1].lower() == "last", axes, axis)


def _vector(command: Command) -> Array | None:
    values = [number(word) for word in command.words[1:4]]
    if len(values) != 3 or any(v is None or not np.isfinite(v) or abs(v) > 1e6 for v in values):
        return None
    return np.array(values, float)


def _ends(commands: Sequence[Command]) -> dict[str, Array]:
    """The last point (3,) m of each body's c2_def by the body's name; bodies that are copies included."""
    out: dict[str, Array] = {}
    name = ""
    for command in commands:
        words = [word.lower() for word in command.words]
        if words[:2] == ["begin", "main_body"]:
            name = ""
        elif words[0] == "name" and len(words) > 1:
            name = words[1]
        elif words[0] == "copy_main_body" and len(words) > 1 and words[1] in out:
            out[name] = out[words[1]]
        elif words[0] == "sec" and name:
            point = [number(word) for word in words[2:5]]
            if len(point) == 3 and all(v is not None and np.isfinite(v) for v in point):
                out[name] = np.array(point, float)
    return out
