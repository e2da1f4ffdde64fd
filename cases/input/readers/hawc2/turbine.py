"""A whole turbine from HAWC2's htc file: tower, nacelle, shaft, hubs and blades from its bodies and their structural files.

The tower's axes here are x up, z downwind in the htc's sense, y = z × x. The shaft, which HAWC2 bends too, is reduced to its
torsional stiffness between its bearing and its end; the bodies between tower and blades are rigid, with all their mass. The
inertia about the shaft of what is on it is divided between generator and hub as its torsion divides it. Source: T. J. Larsen,
A. M. Hansen, *How 2 HAWC2, the user's manual*, Risø-R-1597, ch. 6.
"""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .....core.blade import Blade, BladeError
from .....core.element.discretize import discretize
from .....core.space import spatial as sp
from .....core.space.inertia import transformed
from .....core.turbine.machine import machine, rigid_rotor
from .....core.turbine.rigid_parts import MODES, RigidPart, lowering
from .....core.turbine.turbine import Drivetrain, Turbine
from .....core.turbine.turbine_modes import turbine_modes
from ...errors import CaseError
from ..openfast.elastodyn import complete
from ..openfast.turbine import GROUND
from ..source import Mount, Source, TurbineReading, Unused, unused
from ..text import load, number
from . import blade as blade_reader
from . import bodies, orientation
from . import tower as tower_reader
from .frames import EQUAL, Frames, frames
from .parts import Parts, of_file, parts
from .rigid import Line, line

Array = NDArray[np.float64]

NAME = "HAWC2 turbine"
AXES = "HAWC2: y downwind, z down; here x = −(its z), y = −(its x), z = its y"

GRAVITY = 9.81
"""HAWC2's, m/s²."""


SHOWN = 1e-5
"""Smallest effect of a rigid part on a frequency that is stated as a number."""


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


def _read(path: Path, split: Parts, given: Mount) -> TurbineReading:
    htc = load(path)
    tower, tower_file = tower_reader.beam(htc, f"{path.stem}'s tower", split.commands[split.tower])
    tower_line = line(htc, split.tower, split.commands[split.tower])
    names = (*split.nacelle, *split.rotating)
    lines = {name: line(htc, name, split.commands[name]) for name in (*names, *split.beside)}
    placed = frames(path, split, tower_line, lines)
    tower, tower_unused = _top(tower, tower_line, placed)
    beside, beside_unused = _beside(split, lines, htc.path)
    nacelle = np.zeros((6, 6))
    for name in (*split.nacelle, *beside[False]):
        nacelle += _at(lines[name].inertia(), placed.pose[name])
    hub, drivetrain, drive_notes = _rotor(htc.path, split, lines, placed, beside[True])
    blade = blade_reader.read(path, complete(given, placed.mount))
    _equal_blades(htc.path, split)
    gravity, gravity_note = _gravity(split.commands[split.tower])
    turbine = Turbine(
        name=path.stem,
        tower=tower,
        blade=blade.blade,
        blades=len(split.blades),
        nacelle=nacelle,
        hub=hub,
        shaft=placed.hub,
        drivetrain=drivetrain,
        gravity=gravity,
    )
    notes = (
        GROUND,
        f"gravity {gravity_note} acts on the tower through all that it carries, not on the blades' own motions",
        *drive_notes,
        *_generator(turbine),
        *_locked(split),
        *_rigid(turbine, split, lines, placed),
        *(note for note in blade.source.notes if "orientation of the htc's bodies" not in note and not _alone(note)),
    )
    shown = {name: lines[name] for name in dict.fromkeys([*names, *beside[False], *beside[True]])}
    once = {id(split.commands[name]): one for name, one in reversed(shown.items())}
    left = (
        *tower_unused,
        *(u for one in reversed(once.values()) for u in one.unused),
        *beside_unused,
        *unused("yaw", [np.degrees(placed.yaw)], "deg", path, "the nacelle faces the wind"),
        *blade.source.unused,
    )
    files = dict.fromkeys([path, tower_file, *(one.file for one in shown.values()), *blade.source.files])
    speed = split.relatives[split.shaft].speed
    return TurbineReading(turbine, Source(NAME, tuple(files), AXES, notes, _merged(left)), float(speed))


def _merged(left: tuple[Unused, ...]) -> tuple[Unused, ...]:
    """Quantities of several bodies that have the same name as one."""
    out: dict[tuple[str, Path, str], Unused] = {}
    for u in left:
        before = out.get((u.name, u.file, u.why))
        out[u.name, u.file, u.why] = u if before is None else replace(before, values=(*before.values, *u.values))
    return tuple(out.values())


def _at(inertia: Array, pose: Array) -> Array:
    return np.asarray(transformed(np.ascontiguousarray(inertia), np.ascontiguousarray(pose)), float)


def _top(tower: Blade, read: Line, placed: Frames) -> tuple[Blade, tuple[Unused, ...]]:
    """The tower with the masses at its last node; those between its ends are not used."""
    last, tip = len(read.nodes) - 1, np.zeros((6, 6))
    for mass in read.masses:
        if mass.node == last:
            tip += _at(mass.inertia, sp.inverse(placed.top))
    between = [float(mass.inertia[0, 0]) for mass in read.masses if 0 < mass.node < last]
    why = "a concentrated mass between the tower's ends is not supported: distribute it in the structural file's m"
    return replace(tower, tip_mass=tip), (*read.unused, *unused("concentrated_mass", between, "kg", read.file, why))


def _equal_blades(path: Path, split: Parts) -> None:
    """Check that the blades are copies or have the same commands."""
    content = [
        [c.words for c in split.commands[name] if c.words[0] not in ("name", "nbodies")] for name in split.blades
    ]
    other = next((name for name, words in zip(split.blades, content, strict=True) if words != content[0]), None)
    if other:
        raise CaseError(
            f"{path}: {other}: not equal to {split.blades[0]}: a turbine has equal blades: use copy_main_body"
        )


def _beside(split: Parts, lines: dict[str, Line], path: Path) -> tuple[dict[bool, list[str]], tuple[Unused, ...]]:
    """Bodies fixed to the nacelle (False) and to shaft and hubs (True); those elsewhere are not used."""
    out: dict[bool, list[str]] = {False: [], True: []}
    left: list[Unused] = []
    for name in split.beside:
        holder = name
        while holder in split.beside:
            joint = split.joints.get((split.beside[holder], holder))
            if joint is None or joint.kind == "bearing1":
                raise CaseError(f"{path}: {holder}: not fixed to {split.beside[holder]} by fix1: not supported")
            holder = split.beside[holder]
        if holder in split.nacelle or holder in split.rotating:
            out[holder in split.rotating].append(name)
        else:
            mass = float(lines[name].inertia()[0, 0])
            left += unused(f"main_body {name}", [mass], "kg", path, f"a body on {holder} is not part of the turbine")
    return out, tuple(left)


def _rotor(
    path: Path, split: Parts, lines: dict[str, Line], placed: Frames, beside: list[str]
) -> tuple[Array, Drivetrain, tuple[str, ...]]:
    """Inertia (6, 6) of the hub at its centre, the drivetrain, and notes on it."""
    into = sp.inverse(placed.hub)
    hub = np.zeros((6, 6))
    for name in (*split.rotating, *beside):
        hub += _at(lines[name].inertia(), into @ placed.pose[name])
    shaft, at = lines[split.shaft], into @ placed.pose[split.shaft]
    points = shaft.nodes @ at[:3, :3].T + at[:3, 3]
    if np.abs(points[:, :2]).max() > orientation.ALONG * shaft.length:
        raise CaseError(f"{path}: {split.shaft}: not along its axis of rotation, which is not supported")
    twisting = shaft.twisting() * shaft.weights
    flexibility = float(twisting.sum())
    done = np.concatenate([[0.0], np.cumsum(twisting)]) / flexibility
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(shaft.nodes, axis=0), axis=1))])
    ends = np.concatenate([[0.0], np.cumsum(shaft.weights)])
    share = np.interp(arc, ends, done)  # of the torsion between bearing and end
    polar = transformed(shaft.mass, at @ shaft.at)[:, 5, 5]
    generator = float(shaft.weights @ (polar * (1.0 - np.interp(shaft.arc, ends, done))))
    generator += float(sum((1.0 - share[m.node]) * float(_at(m.inertia, at)[5, 5]) for m in shaft.masses))
    hub[5, 5] -= generator
    spread = hub.copy()
    spread[[0, 1, 3, 4], [0, 1, 3, 4]] = 0.0
    spread[[2, 5], [2, 5]] = spread[[0, 4, 1, 3], [4, 0, 3, 1]] = 0.0
    moment = max(hub[3, 3], hub[5, 5], hub[0, 0] * shaft.length**2)
    uneven = max(np.abs(spread).max(), abs(hub[3, 3] - hub[4, 4]))
    if uneven > EQUAL * moment:
        raise CaseError(
            f"{path}: {split.shaft}: with the hubs it is not alike in all directions around its axis ({uneven:g} of "
            f"{moment:g} kg m²), so that the turbine has no constant modes: give equal moments of inertia"
        )
    joint = split.joints.get((split.relatives[split.shaft].parent, split.shaft))
    if joint is None:
        raise CaseError(f"{path}: {split.shaft}: no bearing1, bearing2, bearing3 or fix1 holds it: add one")
    free = joint.kind == "bearing1"
    stiffness = 1.0 / flexibility if generator > 0 or not free else np.inf
    state = "free (bearing1)" if free else f"locked ({joint.kind})"
    between = [m for m in shaft.masses if 0 < m.node < len(shaft.nodes) - 1 and _at(m.inertia, at)[5, 5] > 0]
    notes = [
        f"generator {state}; shaft "
        + (
            f"{stiffness:g} N m/rad (G I_p of {split.shaft})"
            if np.isfinite(stiffness)
            else "rigid: no generator is behind it"
        )
    ]
    if between:
        notes.append(
            f"inertias between the ends of {split.shaft} are divided between generator and hub as its torsion is"
        )
    return hub, Drivetrain(stiffness, generator, 1.0, free), tuple(notes)


def _generator(turbine: Turbine) -> tuple[str, ...]:
    """What the generator's inertia does not do."""
    generator = turbine.drivetrain.generator
    if not generator:
        return ()
    rotor = rigid_rotor(turbine, discretize(turbine.blade, 8))[5, 5]
    part = f"{generator:g} kg m² ({100 * generator / rotor:.2g} % of the rotor's)"
    return (f"the generator's inertia about the shaft, {part}, has no gyroscopic moments",)


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
                what = (
                    "no constraint (fix1, bearing2) joins it to" if joint is None else "it turns freely (bearing1) on"
                )
                raise CaseError(f"{child}: {what} {parent}, which is not supported")
            if joint.kind != "fix1":
                out.setdefault(joint.kind, []).append(f"{child} on {parent}")
    return tuple(
        f"locked at the angle of the orientation ({kind}): {', '.join(dict.fromkeys(joined))}"
        for kind, joined in out.items()
    )


def _rigid(turbine: Turbine, split: Parts, lines: dict[str, Line], placed: Frames) -> tuple[str, ...]:
    """How much lower the frequencies would be if the bodies taken as rigid were as flexible as the htc has them."""
    rigid_parts: list[RigidPart] = []
    for k, name in enumerate(split.nacelle):
        move = sp.adjoint(placed.pose[name])
        carried = sum((_at(lines[n].inertia(), placed.pose[n]) for n in split.nacelle[k + 1 :]), np.zeros((6, 6)))
        carried = carried + _at(lines[name].inertia(beyond_root=True), placed.pose[name])
        rigid_parts.append(RigidPart(name, "all", move @ lines[name].compliance() @ move.T, carried))
    into = sp.inverse(placed.hub)
    move = sp.adjoint(into @ placed.pose[split.shaft])
    rigid_parts.append(RigidPart(split.shaft, "rotor", move @ lines[split.shaft].compliance(torsion=False) @ move.T))
    common = [name for name in split.hubs[0] if all(name in hub for hub in split.hubs)]
    for name in split.hubs[0]:
        around = sp.pose(sp.rotation(2, np.array(0.0 if name in common else -placed.azimuths[0])), np.zeros(3))
        move = sp.adjoint(around @ into @ placed.pose[name])
        rigid_parts.append(
            RigidPart(name, "rotor" if name in common else "blade", move @ lines[name].compliance() @ move.T)
        )
    try:
        made = machine(turbine)
        lower = lowering(made, rigid_parts)
        names = turbine_modes(made, 0.0, lower.shape[1]).names
    except ValueError as error:  # no steady state
        flexible = ", ".join(part.name for part in rigid_parts)
        return (f"taken as rigid, with all mass: {flexible}; the effect of their flexibility is unknown: {error}",)
    words = []
    for part, fractions in zip(rigid_parts, lower, strict=True):
        k = int(fractions.argmax())
        size = f"{100 * fractions[k]:.1g} % ({names[k]})" if fractions[k] > SHOWN else f"below {100 * SHOWN:g} %"
        words.append(f"{part.name}{' besides its torsion' if part.name == split.shaft else ''} {size}")
    return (
        f"taken as rigid, with all mass: {', '.join(words)}: the most by which the htc's flexibility would lower one of the "
        f"{MODES} lowest frequencies, to first order at rest",
    )


def _gravity(tower: bodies.Body) -> tuple[float, str]:
    given = [number(c.words[1]) for c in tower if c.words[0] == "gravity" and len(c.words) > 1]
    if given and given[-1] is not None and np.isfinite(given[-1]):
        return float(given[-1]), f"{given[-1]:g} m/s² (of the tower)"
    return GRAVITY, f"{GRAVITY:g} m/s² (HAWC2's)"


def _alone(note: str) -> bool:
    return note == blade_reader.ALONE
