"""The tower in a HAWC2 htc: its structural file and the height of its c2_def.

HAWC2's ground axes are x to the side, y downwind, z down. Only sections without offsets are read: bending about x is fore-aft,
about y side-side. Nacelle, shaft and rotor are other bodies (``turbine``). Source: T. J. Larsen, A. M. Hansen,
*How 2 HAWC2, the user's manual*, Risø-R-1597, ch. 6.
"""

from pathlib import Path

import numpy as np

from .....core.blade import Blade, BladeError, coupled
from .....core.turbine.tower import Tower
from ...errors import CaseError
from ..source import Source
from ..text import Text, load
from . import blade, bodies, c2_def, orientation
from .c2_def import LENGTHS

NAME = "HAWC2 tower"
AXES = "HAWC2: y downwind, z down; here x = −(its z), z = its y"


def read(path: Path) -> tuple[Tower, Source]:
    """Read the tower of an htc file, clamped at its base, without weight and without what it carries.

    Raises:
        CaseError: naming the file and line at fault.
    """
    htc = load(path)
    commands = bodies.commands(htc)
    ground = orientation.base(commands)
    name, body = bodies.body_named(htc, commands, "tower", ground[:1] if ground else ())
    tower, file = beam(htc, path.stem, body)
    notes = (
        f"main_body {name}, clamped at the base, without weight",
        "nacelle, shaft and rotor are other bodies of the htc, which are not part of the tower",
    )
    return Tower(tower), Source(NAME, (path, file), AXES, notes, bodies.unused_quantities(body))


def beam(htc: Text, name: str, body: bodies.Body) -> tuple[Blade, Path]:
    """The tower's sections as a beam that stands, and its structural file.

    Raises:
        CaseError: naming the file and line at fault.
    """
    file, subset = bodies.properties(htc, body)
    text = load(file)
    r, stiffness, mass = blade.sections(text, subset)
    points = c2_def.points(body)
    if np.abs(points[:, [0, 1, 3]]).max() > 1e-9 * np.abs(points[:, 2]).max():
        at = c2_def.sections(body)[0].at
        raise CaseError(f"{at}: sec: the tower is not straight and vertical without twist, which is not supported")
    height = abs(float(points[-1, 2] - points[0, 2]))
    if r[0] != 0 or abs(r[-1] - height) > LENGTHS * height:
        raise CaseError(f"{file}: r: from {r[0]:g} to {r[-1]:g} m: c2_def is {height:g} m high; correct one")
    try:
        tower = Blade(name, r * (height / r[-1]), stiffness, mass, np.zeros(len(r)))
    except BladeError as error:
        raise CaseError(f"{file}: {error}") from error
    if coupled(tower):
        raise CaseError(f"{file}: offsets of centres or inclined principal axes: not supported for a tower")
    return tower, file
