"""The machine of HAWC2's htc file and what it weighs, read by wetb as it comes with weio.

Bodies are followed from each blade to the ground by their ``relative`` blocks, in the ground's axes: x to port, y downwind,
z down. They are added by their mass, first moments and ∫ r rᵀ dm. What turns with ``ini_rotvec_d1`` is the rotor; the inertia
about its axis of the shaft and of the masses on it belongs to the generator as far as the shaft twists beyond it. Only bodies
along their z axis whose centres are on it are weighed. Source: T. J. Larsen, A. M. Hansen, *How 2 HAWC2, the user's manual*,
Risø-R-1597, ch. 6.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from .hawc2 import sibling_file
from .openfast_turbine import Quantities
from .quadrature import Mounted, moments
from .stations import NotReadError, parser
from .turbine_mass import Moments, Weighed

Array = NDArray[np.float64]

UP = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""From the ground's axes to x up, y to starboard, z downwind."""

NOTHING = Moments(0.0, np.zeros(3), np.zeros((3, 3)))

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(8)

MAX_MISALIGNMENT = 1e-6
"""Largest difference of lengths, relative, and of directions that are the same."""


@dataclass(frozen=True)
class Part:
    """A body: stations (k,), m, products of its table there, its nodes along z (n,), and the masses at nodes."""

    r: Array
    columns: dict[str, Array]
    z: Array
    lumped: tuple[tuple[int, Moments], ...]

    def integral(self, name: str, *powers: float) -> Array:
        """∫ of a product times the body's z to each power."""
        s, w = self.points
        values = np.interp(s, self.r, self.columns[name])
        return np.array([np.sum(w * values * (np.sign(self.z[-1]) * s) ** power) for power in powers])

    @property
    def points(self) -> tuple[Array, Array]:
        """Gauss points and weights between stations and nodes."""
        grid = np.union1d(self.r, np.abs(self.z))
        half_length = 0.5 * np.diff(grid)[:, None]
        return (0.5 * (grid[1:] + grid[:-1])[:, None] + half_length * POINTS).ravel(), (half_length * WEIGHTS).ravel()

    def twisted(self, at: Array) -> Array:
        """Twist at distances ``at`` (k,) from the first node under a unit moment, rad/(N m)."""
        s, w = self.points
        steps = w / np.interp(s, self.r, self.columns["GJ"])
        ends = np.concatenate([[0.0], np.cumsum(w)])
        return np.interp(at, ends, np.concatenate([[0.0], np.cumsum(steps)]))

    @property
    def line(self) -> Moments:
        """Of the sections, in the body's axes."""
        mass, first, second = self.integral("m", 0, 1, 2).tolist()
        x, y = (float(self.integral(name, 0)[0]) for name in ("xx", "yy"))
        return Moments(mass, np.array([0.0, 0.0, first]), np.diag([x, y, second]))

    @property
    def total(self) -> Moments:
        """Of sections and masses."""
        return sum((lump for _, lump in self.lumped), self.line)


@dataclass(frozen=True)
class Machine:
    """Bodies by name, their axes (3, 3) and places (3,) in the ground's axes, and their parts in the turbine."""

    parts: dict[str, Part]
    axes: dict[str, Array]
    places: dict[str, Array]
    tower: str
    nacelle: tuple[str, ...]
    rotor: tuple[str, ...]
    blades: tuple[str, ...]
    axis: Array

    def moments(self, name: str) -> Moments:
        """Of a body, in the ground's axes."""
        return self.parts[name].total.moved(self.axes[name], self.places[name])

    @property
    def top(self) -> Array:
        """(3,) the tower's top."""
        return self.places[self.tower] + self.axes[self.tower][:, 2] * self.parts[self.tower].z[-1]

    @property
    def generator(self) -> float:
        """Inertia about the shaft that belongs to the generator, kg m²."""
        shaft = self.parts[self.rotor[0]]
        s, w = shaft.points
        total = shaft.twisted(np.abs(shaft.z[-1:]))[0]
        polar = np.interp(s, shaft.r, shaft.columns["xx"] + shaft.columns["yy"])
        own = float(np.sum(w * polar * (1.0 - shaft.twisted(s) / total)))
        share = 1.0 - shaft.twisted(np.abs(shaft.z)) / total
        return own + sum(share[node] * (lump.second[0, 0] + lump.second[1, 1]) for node, lump in shaft.lumped)

    @property
    def hub(self) -> tuple[Array, float, float]:
        """Place (3,) of the hub's centre in the ground's axes, the hub radius, m, and the cone downwind, rad, of a blade."""
        shaft, blade = self.rotor[0], self.blades[0]
        root, along = self.places[blade] - self.places[shaft], self.axes[blade][:, 2]
        slope = float(along @ self.axis)
        distance = float(np.linalg.norm(root - (root @ self.axis) * self.axis))
        radius = distance / np.sqrt(1.0 - slope**2)
        return (
            self.places[shaft] + (root @ self.axis - radius * slope) * self.axis,
            float(radius),
            float(np.arcsin(slope)),
        )


def read(path: Path) -> tuple[Quantities, str]:
    """The quantities of the machine, from the tower's top: downwind, to port, up; and name and version of the reader.

    Raises:
        NotReadError: if wetb does not read them, or a body is not along its z axis.
    """
    machine, reader = _machine(path)
    tower, shaft = machine.parts[machine.tower], machine.parts[machine.rotor[0]]
    nacelle = sum((machine.moments(name) for name in machine.nacelle), NOTHING).moved(np.eye(3), -machine.top)
    centre, radius, cone = machine.hub
    rotor = sum((machine.moments(name) for name in machine.rotor), NOTHING).moved(np.eye(3), -centre)
    about_shaft = float(np.trace(rotor.second) - machine.axis @ rotor.second @ machine.axis)
    to_hub = centre - machine.top

    def along(name: str) -> float:
        return float(np.trapezoid(tower.columns[name], tower.r))

    out: Quantities = {
        "height of the tower": (float(abs(tower.z[-1])), "m"),
        "mass of the tower": (along("m"), "kg"),
        "fore-aft stiffness along the tower": (along("EIx"), "N m³"),
        "side-to-side stiffness along the tower": (along("EIy"), "N m³"),
        "hub's centre above the tower's top": (-to_hub[2], "m"),
        "hub's centre downwind of the tower's top": (to_hub[1], "m"),
        "rise of the shaft downwind": (-machine.axis[2], ""),
        "mass of the nacelle": (nacelle.mass, "kg"),
        "moment of the nacelle's mass downwind": (nacelle.first[1], "kg m"),
        "moment of the nacelle's mass to port": (nacelle.first[0], "kg m"),
        "moment of the nacelle's mass up": (-nacelle.first[2], "kg m"),
        "nacelle's inertia about the yaw axis": (float(nacelle.inertia[2]), "kg m²"),
        "mass of the hub": (rotor.mass, "kg"),
        "hub's inertia about the shaft": (about_shaft - machine.generator, "kg m²"),
        "generator's inertia on the rotor's side": (machine.generator, "kg m²"),
        "hub radius": (radius, "m"),
        "cone of the blades": (cone, "rad"),
    }
    if machine.generator > 0:
        out["stiffness of the shaft"] = (1.0 / float(shaft.twisted(np.abs(shaft.z[-1:]))[0]), "N m/rad")
    return {name: (float(value), unit) for name, (value, unit) in out.items()}, reader


def weigh(path: Path, blade: Mounted, tip: Array) -> Weighed:
    """The turbine of an htc with these blades, of which ``tip`` (6, 6) is the body at the tip; without the generator's inertia.

    Raises:
        NotReadError: as ``read``.
    """
    machine, _ = _machine(path)
    count = len(machine.blades)
    centre, _, _ = machine.hub
    axis = UP @ machine.axis
    level = np.cross(axis, [0.0, 1.0, 0.0])
    axes = np.column_stack([-level / np.linalg.norm(level), np.zeros(3), axis])
    axes[:, 1] = np.cross(axes[:, 2], axes[:, 0])
    blade_moments = Moments(*moments(blade, tip))
    blades = NOTHING
    for k in range(count):
        rotation = Rotation.from_euler("z", 2.0 * np.pi * k / count).as_matrix()
        blades += blade_moments.moved(rotation, np.zeros(3))
    hub = sum((machine.moments(name) for name in machine.rotor), NOTHING).moved(UP, np.zeros(3))
    hub_centre = UP @ centre
    turning = Moments(0.0, np.zeros(3), -0.5 * machine.generator * (np.eye(3) - 2.0 * np.outer(axis, axis)))
    rotor = hub.moved(np.eye(3), -hub_centre) + turning + blades.moved(axes, np.zeros(3))
    polar = float(np.trace(rotor.second) - axis @ rotor.second @ axis)
    standing = sum((machine.moments(name) for name in (machine.tower, *machine.nacelle)), NOTHING)
    base = UP @ machine.places[machine.tower]
    total = (standing.moved(UP, np.zeros(3)) + rotor.moved(np.eye(3), hub_centre)).moved(np.eye(3), -base)
    return Weighed(total, polar, float(abs(machine.parts[machine.tower].z[-1])))


def _machine(path: Path) -> tuple[Machine, str]:
    def imported() -> Any:
        from weio.wetb.hawc2.htc_file import HTCFile
        from weio.wetb.hawc2.st_file import StFile

        return HTCFile, StFile

    (HTCFile, StFile), reader = parser("weio", imported)
    try:
        structure = HTCFile(str(path), modelpath=str(path.parent)).new_htc_structure
        return _assembled(path, structure, StFile), reader.replace("weio", "wetb in weio")
    except NotReadError:
        raise
    except Exception as error:  # of a foreign parser, whatever it raises
        raise NotReadError(" ".join(f"{type(error).__name__}: {error}".split())[:300]) from error


def _assembled(path: Path, structure: Any, StFile: Any) -> Machine:
    bodies: dict[str, Any] = {}
    for body in _sections(structure, "main_body"):
        copied = body.contents.get("copy_main_body")
        bodies[str(body.name[0]).lower()] = bodies[str(copied.values[0]).lower()] if copied else body
    parents: dict[str, tuple[str, bool]] = {}
    turns: dict[str, Array] = {}
    axis_of: dict[str, Array] = {}
    for block in _sections(structure.orientation, "relative"):
        commands = [(_plain(key), line.values) for key, line in block.contents.items()]
        body_values = {key: values for key, values in commands if key in ("body1", "body2")}
        child = str(body_values["body2"][0]).lower()
        parents[child] = str(body_values["body1"][0]).lower(), str(body_values["body1"][1]).lower() == "last"
        turns[child] = _rotation(commands, "body2_")
        for key, values in commands:
            if key == "body2_ini_rotvec_d1":
                axis_of[child] = np.array(values[:3], float)
    base = [(_plain(key), line.values) for key, line in structure.orientation.base.contents.items()]
    tower = str(dict(base)["body"][0]).lower()
    blades = tuple(name for name in parents if name.startswith("blade"))
    below: dict[str, list[str]] = {}
    for blade in blades:
        chain = [blade]
        while chain[-1] != tower:
            chain.append(parents[chain[-1]][0])
        below[blade] = chain[::-1]
    unattached = [name for name in parents if not any(name in chain for chain in below.values())]
    if unattached:
        raise NotReadError(f"{unattached[0]} carries no blade: bodies beside the others are not weighed a second time")
    shaft = next((n for n in below[blades[0]] if n in axis_of and all(n in chain for chain in below.values())), None)
    if shaft is None:
        raise NotReadError("no ini_rotvec_d1 of a shaft: the rotor's axis is not read a second time")
    names = list(dict.fromkeys(name for chain in below.values() for name in chain))
    parts = {name: _part(path, name, bodies[name], StFile) for name in names if name not in blades}
    ends = tuple(lump for lump in parts[tower].lumped if lump[0] == len(parts[tower].z) - 1)
    parts[tower] = replace(parts[tower], lumped=ends)  # those between the ends are not part of the turbine
    axes, places = {tower: _rotation(base, "body_")}, {tower: np.zeros(3)}
    for name in names[1:]:
        parent, at_end = parents[name]
        end = np.array([0.0, 0.0, parts[parent].z[-1] if at_end else 0.0])
        axes[name], places[name] = axes[parent] @ turns[name], places[parent] + axes[parent] @ end
    axis = axes[shaft] @ axis_of[shaft]
    axis = axis / np.linalg.norm(axis) * (1.0 if axis @ axes[blades[0]][:, 1] >= 0 else -1.0)
    if (
        abs(axis[0]) > MAX_MISALIGNMENT
        or axis[1] < 0
        or np.abs(axes[tower][:, 1] - [0.0, 1.0, 0.0]).max() > MAX_MISALIGNMENT
    ):
        raise NotReadError("the nacelle is yawed: its places are not read a second time")
    order = names.index(shaft)
    rotor = (shaft, *(name for name in names if name not in names[: order + 1] and name not in blades))
    return Machine(parts, axes, places, tower, tuple(names[1:order]), rotor, blades, axis)


def _sections(section: Any, name: str) -> list[Any]:
    return [part for key, part in section.contents.items() if key.partition("__")[0] == name]


def _plain(key: str) -> str:
    """A command without its number, and with ``body`` for ``mbdy``."""
    return key.partition("__")[0].replace("mbdy", "body")


def _rotation(commands: list[tuple[str, Any]], prefix: str) -> Array:
    out = np.eye(3)
    for key, values in commands:
        if key == f"{prefix}eulerang":
            out = out @ Rotation.from_euler("XYZ", [float(v) for v in values[:3]], degrees=True).as_matrix()
        elif key == f"{prefix}eulerpar":
            w, x, y, z = (float(v) for v in values[:4])
            out = out @ Rotation.from_quat([x, y, z, w]).as_matrix()
    return out


def _part(path: Path, name: str, body: Any, StFile: Any) -> Part:
    table = body.timoschenko_input
    file = StFile(str(sibling_file(path, str(table.filename[0]))))
    subset = tuple(int(v) for v in table.set[:2]) if "set" in table.contents else (1, 1)
    rows = file.main_data_sets[subset[0]][subset[1]]
    p = dict(zip(file.cols, rows.T, strict=True))
    points = np.array([line.values[1:5] for line in _sections(body.c2_def, "sec")], float)
    if "E" not in p or points[:, [0, 1, 3]].any() or any(p[c].any() for c in ("x_cg", "y_cg", "x_e", "y_e", "pitch")):
        raise NotReadError(f"{name}: not along its z axis, or with centres aside: not weighed a second time")
    z = points[:, 2]
    length = abs(z[-1])
    scale = length / p["r"][-1]
    columns = {
        "m": p["m"],
        "xx": p["m"] * p["ri_y"] ** 2,
        "yy": p["m"] * p["ri_x"] ** 2,
        "EIx": p["E"] * p["I_x"],
        "EIy": p["E"] * p["I_y"],
        "GJ": p["G"] * p["I_p"],
    }
    lumped = []
    for line in _sections(body, "concentrated_mass"):
        node, *values = (float(v) for v in line.values[:8])
        about_centre = np.array(values[4:7])
        centre = np.array([0.0, 0.0, z[round(node) - 1]]) + values[:3]
        lump = Moments(values[3], np.zeros(3), np.diag(0.5 * about_centre.sum() - about_centre)).moved(
            np.eye(3), centre
        )
        lumped.append((round(node) - 1, lump))
    return Part(p["r"] * scale, columns, z, tuple(lumped))
