"""A whole turbine from HAWC2's htc file: tower, nacelle, shaft, hubs and blades from its bodies and their structural files.

The tower's axes here are x up, z downwind in the htc's sense, y = z × x. The bodies between tower and blades are rigid, with
all their mass (``rigid``), except the torsion of the shaft (``drivetrain``). Source: T. J. Larsen, A. M. Hansen, *How 2 HAWC2,
the user's manual*, Risø-R-1597, ch. 6.
"""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .....core.blade import Blade, BladeError
from .....core.space import spatial as sp
from .....core.turbine.turbine import Turbine
from ...errors import CaseError
from ..openfast.elastodyn import complete
from ..openfast.turbine import GROUND
from ..source import Mount, Source, TurbineReading, Unused, unused
from ..text import load, number
from . import blade as blade_reader
from . import bodies
from . import tower as tower_reader
from .drivetrain import generator_note, hub_and_drivetrain
from .frames import Frames, frames
from .parts import Parts, of_file, parts
from .rigid import Line, line, moved
from .rigid_bodies import rigid_bodies

Array = NDArray[np.float64]

NAME = "HAWC2 turbine"
AXES = "HAWC2: y downwind, z down; here x = −(its z), y = −(its x), z = its y"

GRAVITY = 9.81
"""HAWC2's, m/s²."""


def is_turbine(path: Path) -> bool:
    """Whether a file is an htc with the bodies of a whole turbine, whose structural files exist."""
    if path.suffix.lower() != ".htc" or not path.is_file():
        return False
    try:
        htc = load(path)
    except (CaseError, OSError):
        return False
    return bodies.matches_format(htc) and isinstance(of_file(htc), Parts)


def read(path: Path, mount: Mount | None = None) -> TurbineReading:
    """Read a turbine.

    Args:
        path: the htc.
        mount: data that override those of the blade, such as its pitch.

    Raises:
        CaseError: naming the file and line at fault.
    """
    htc = load(path)
    commands = bodies.commands(htc)
    split = parts(htc, commands)
    if isinstance(split, str):
        raise CaseError(f"{path}: {split}; --blade-only takes one blade")
    try:
        return _read(path, split, mount or Mount())
    except (CaseError, BladeError) as error:
        raise CaseError(f"{error}; --blade-only takes one blade of the turbine") from error


def _read(path: Path, split: Parts, mount: Mount) -> TurbineReading:
    htc = load(path)
    tower, tower_file = tower_reader.beam(htc, f"{path.stem}'s tower", split.commands[split.tower])
    tower_line = line(htc, split.tower, split.commands[split.tower])
    names = (*split.nacelle, *split.rotating)
    lines = {name: line(htc, name, split.commands[name]) for name in (*names, *split.fixed_bodies)}
    body_frames = frames(path, split, tower_line, lines)
    tower, tower_unused = _top(tower, tower_line, body_frames)
    fixed_bodies, fixed_unused = _beside(split, lines, htc.path)
    nacelle = np.zeros((6, 6))
    for name in (*split.nacelle, *fixed_bodies[False]):
        nacelle += moved(lines[name].inertia(), body_frames.pose[name])
    hub, drivetrain, drive_notes = hub_and_drivetrain(htc.path, split, lines, body_frames, fixed_bodies[True])
    blade = blade_reader.read(path, complete(mount, body_frames.mount))
    _equal_blades(htc.path, split)
    gravity, gravity_note = _gravity(split.commands[split.tower])
    turbine = Turbine(
        name=path.stem,
        tower=tower,
        blade=blade.blade,
        blades=len(split.blades),
        nacelle=nacelle,
        hub=hub,
        shaft=body_frames.hub,
        drivetrain=drivetrain,
        gravity=gravity,
    )
    notes = (
        GROUND,
        f"gravity {gravity_note} acts on the tower through all that it carries, not on the blades' own motions",
        *drive_notes,
        *generator_note(turbine),
        *_locked(split),
        *rigid_bodies(turbine, split, lines, body_frames),
        *(
            note
            for note in blade.source.notes
            if note != blade_reader.ALONE and "orientation of the htc's bodies" not in note
        ),
    )
    used_lines = {name: lines[name] for name in dict.fromkeys([*names, *fixed_bodies[False], *fixed_bodies[True]])}
    distinct_lines = {id(split.commands[name]): body_line for name, body_line in reversed(used_lines.items())}
    not_used = (
        *tower_unused,
        *(u for body_line in reversed(distinct_lines.values()) for u in body_line.unused),
        *fixed_unused,
        *unused("yaw", [np.degrees(body_frames.yaw)], "deg", path, "the nacelle faces the wind"),
        *blade.source.unused,
    )
    files = dict.fromkeys(
        [path, tower_file, *(body_line.file for body_line in used_lines.values()), *blade.source.files]
    )
    speed = split.relatives[split.shaft].speed
    return TurbineReading(turbine, Source(NAME, tuple(files), AXES, notes, _merged(not_used)), float(speed))


def _merged(quantities: tuple[Unused, ...]) -> tuple[Unused, ...]:
    """Quantities of several bodies that have the same name as one."""
    out: dict[tuple[str, Path, str], Unused] = {}
    for u in quantities:
        previous = out.get((u.name, u.file, u.why))
        out[u.name, u.file, u.why] = u if previous is None else replace(previous, values=(*previous.values, *u.values))
    return tuple(out.values())


def _top(tower: Blade, tower_line: Line, body_frames: Frames) -> tuple[Blade, tuple[Unused, ...]]:
    """The tower with the masses at its last node; those between its ends are not used."""
    last, tip = len(tower_line.nodes) - 1, np.zeros((6, 6))
    for mass in tower_line.masses:
        if mass.node == last:
            tip += moved(mass.inertia, sp.inverse(body_frames.top))
    between = [float(mass.inertia[0, 0]) for mass in tower_line.masses if 0 < mass.node < last]
    why = "a concentrated mass between the tower's ends is not supported: distribute it in the structural file's m"
    return replace(tower, tip_mass=tip), (
        *tower_line.unused,
        *unused("concentrated_mass", between, "kg", tower_line.file, why),
    )


def _equal_blades(path: Path, split: Parts) -> None:
    """Check that the blades are copies or have the same commands."""
    content = [
        [c.words for c in split.commands[name] if c.words[0] not in ("name", "nbodies")] for name in split.blades
    ]
    unequal = next((name for name, words in zip(split.blades, content, strict=True) if words != content[0]), None)
    if unequal:
        raise CaseError(
            f"{path}: {unequal}: not equal to {split.blades[0]}: a turbine has equal blades: use copy_main_body"
        )


def _beside(split: Parts, lines: dict[str, Line], path: Path) -> tuple[dict[bool, list[str]], tuple[Unused, ...]]:
    """Bodies fixed to the nacelle (False) and to shaft and hubs (True); those elsewhere are not used."""
    out: dict[bool, list[str]] = {False: [], True: []}
    not_used: list[Unused] = []
    for name in split.fixed_bodies:
        holder = name
        while holder in split.fixed_bodies:
            joint = split.joints.get((split.fixed_bodies[holder], holder))
            if joint is None or joint.kind == "bearing1":
                raise CaseError(f"{path}: {holder}: not fixed to {split.fixed_bodies[holder]} by fix1: not supported")
            holder = split.fixed_bodies[holder]
        if holder in split.nacelle or holder in split.rotating:
            out[holder in split.rotating].append(name)
        else:
            mass = float(lines[name].inertia()[0, 0])
            not_used += unused(
                f"main_body {name}", [mass], "kg", path, f"a body on {holder} is not part of the turbine"
            )
    return out, tuple(not_used)


def _locked(split: Parts) -> tuple[str, ...]:
    """Check the joints of the bodies besides the shaft's; notes on those that could turn."""
    out: dict[str, list[str]] = {}
    for chain in zip(split.hubs, split.blades, strict=True):
        names = (split.tower, *split.nacelle, split.shaft, *chain[0], chain[1])
        for parent, child in pairwise(names):
            joint = split.joints.get((parent, child))
            if child == split.shaft:
                continue
            if joint is None or joint.kind == "bearing1":
                reason = (
                    "no constraint (fix1, bearing2) joins it to" if joint is None else "it turns freely (bearing1) on"
                )
                raise CaseError(f"{child}: {reason} {parent}, which is not supported")
            if joint.kind != "fix1":
                out.setdefault(joint.kind, []).append(f"{child} on {parent}")
    return tuple(
        f"locked at the angle of the orientation ({kind}): {', '.join(dict.fromkeys(pairs))}"
        for kind, pairs in out.items()
    )


def _gravity(tower: bodies.Body) -> tuple[float, str]:
    command = next((c for c in reversed(tower) if c.words[0] == "gravity"), None)
    if command is None:
        return GRAVITY, f"{GRAVITY:g} m/s² (HAWC2's)"
    word = " ".join(command.words[1:2])
    value = number(word)
    if value is None or not 0 <= value < np.inf:
        raise CaseError(f"{command.at}: gravity: {word}: not a number, or negative (upwards): correct it")
    return value, f"{value:g} m/s² (of the tower)"
