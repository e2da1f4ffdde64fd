"""HAWC2's structural files (``st``): 19 columns, or 30 with full stiffness matrices; curve and twist from c2_def.

HAWC2's blade axes are x to the leading edge, y downwind, z along the blade; offsets are from the half-chord line, in
axes rotated by c2_def's twist, and ``pitch`` is the angle from these to the principal bending axes, both positive from
x towards y. The half-chord line becomes the reference axis. 19 columns: stretch and bending (E A, E I_x, E I_y) act at
the elastic centre in the principal axes, torsion and shear (G I_p, k G A) at the shear centre; 30 columns: the matrix is
about the elastic centre in the principal axes, order (shear x, shear y, axial, bending x, bending y, torsion). Radii of
gyration are about the elastic centre, in the principal axes, according to the manual; some files (IEA-15's) have numbers
about the mass centre. c2_def is interpolated by Akima splines in z. Source: T. J. Larsen, A. M. Hansen, *How 2 HAWC2,
the user's manual*, Risø-R-1597, ch. 6.
"""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .....core.blade import Blade, BladeError
from ...errors import CaseError
from ..matrices import HAWC2, about, bending, between, fault, in_axes, rotated, shearing, symmetric
from ..openfast.elastodyn import complete
from ..source import Mount, Reading, Source
from ..text import ROUNDING, Table, Text, first_numbers, leading, load, table
from . import bodies, c2_def
from .orientation import Relative, mounting, relatives
from .parts import of_file

Array = NDArray[np.float64]

NAME = "HAWC2"
SHARED = ("r", "m", "x_cg", "y_cg", "ri_x", "ri_y")
PLAIN = (*SHARED, "x_sh", "y_sh", "E", "G", "I_x", "I_y", "I_p", "k_x", "k_y", "A", "pitch", "x_e", "y_e")
FULL = (*SHARED, "pitch", "x_e", "y_e", *(f"K{i + 1}{j + 1}" for i, j in zip(*np.triu_indices(6), strict=True)))
AXES = (
    "HAWC2: x to the leading edge, y downwind, z along the blade; here x = its z, y = its x, z = its y, twist alike; "
    "matrices brought from elastic, shear and mass centres to the half-chord line"
)
ALONE = "tower, nacelle, shaft and hub of the htc are not part of the blade"
STRETCH = 1e-4
"""Relative difference of the lengths of structural file and c2_def that is stated."""

_SET, _SUBSET = re.compile(r"\s*#\s*(\d+)"), re.compile(r"\s*\$\s*(\d+)\s+(\d+)")


def is_st(text: Text) -> bool:
    """Whether these are lines of a structural file."""
    return any(_SUBSET.match(line) for line in text.lines)


def is_htc(text: Text) -> bool:
    """Whether these are lines of an htc file."""
    return bodies.matches_format(text)


def read(path: Path, mount: Mount | None = None) -> Reading:
    """Read the blade in a structural file, or that of an htc's body with c2_def and a name beginning with "blade".

    Args:
        path: path of either file. Without an htc (``mount.main``) the half-chord line is straight and untwisted.
        mount: ``subset`` selects set and subset if the file has several.

    Raises:
        CaseError: naming the file and line at fault.
    """
    mount = mount or Mount()
    columns, body, file_mount, files = contents(path, mount)
    r = columns["r"]
    notes = []
    stations, curve, twist = r, np.zeros((0, 3)), np.zeros(len(r))
    stiffness, mass = stiffness_of(columns), mass_of(columns)
    if body is not None:
        stations, curve, twist, at, (deviation, angle) = c2_def.half_chords(body, r)
        stiffness, mass = between(r, stiffness, at), between(r, mass, at)
        notes.append(
            f"stations: {len(r)} of the structural file and {len(at) - len(r)} more of c2_def; between them curve and twist "
            f"stray from its Akima splines by up to {deviation:.1g} m and {np.degrees(angle):.1g}°"
        )
        if abs(stations[-1] / r[-1] - 1.0) > STRETCH:
            notes.append(
                f"positions r of the structural file times {stations[-1] / r[-1]:.6g}, so that they end with c2_def's arc, as "
                "in HAWC2"
            )
        notes.append(
            "section planes are perpendicular to the half-chord line, rotated from the blade axes by the smallest angle"
        )
    else:
        notes.append("no htc file: the half-chord line is straight and untwisted; only `pitch` rotates the sections")
    mounted = complete(mount, file_mount)
    for htc in files[1:]:
        turbine = of_file(load(htc))
        notes.append(f"not the whole turbine: {turbine}" if isinstance(turbine, str) else ALONE)
    if file_mount is not None:
        angles = ", ".join(f"{name} {np.degrees(getattr(file_mount, name)):.6g}°" for name in ("precone", "pitch"))
        notes.append(f"orientation of the htc's bodies: hub_radius {file_mount.hub_radius:.6g} m, {angles}")
    if mounted.assumption:
        notes.append(f"{mounted.assumption}: in HAWC2 the orientation of the bodies defines them")
    try:
        blade = Blade(
            name=path.stem,
            stations=stations,
            stiffness=stiffness,
            mass=mass,
            twist=twist,
            hub_radius=mounted.hub_radius or 0.0,
            curve=curve,
            precone=mounted.precone or 0.0,
            pitch=mounted.pitch or 0.0,
        )
    except BladeError as error:
        raise CaseError(f"{columns.text.path}: {error}") from error
    unused_values = bodies.unused_quantities(body) if body is not None else ()
    return Reading(
        blade,
        Source(NAME, files, AXES, tuple(notes), unused_values),
        unstated=mounted.unstated,
    )


class Contents(NamedTuple):
    """The files of a blade: columns, the htc's body and what its orientation states (None without an htc), and paths."""

    columns: Table
    body: bodies.Body | None
    file_mount: Mount | None
    files: tuple[Path, ...]


def contents(path: Path, mount: Mount) -> Contents:
    """The contents of a structural file and its htc, of which ``path`` is one; arguments as for ``read``.

    Raises:
        CaseError: naming the file and line at fault.
    """
    text, htc, subset, body, file_mount = load(path), None, mount.subset, None, None
    if is_htc(text):
        htc, text = text, None
    elif mount.main is not None:
        htc = load(mount.main)
    if htc is not None:
        commands = bodies.commands(htc)
        by_child = relatives(commands)
        name, body = bodies.body_named(htc, commands, "blade", by_child)
        _whole(htc, name, by_child)
        file_mount = mounting(commands, name)
        file, stated_subset = bodies.properties(htc, body)
        subset = subset or stated_subset
        text = text or load(file)
    assert text is not None
    columns = _subset(text, subset)
    r = columns["r"]
    rises = np.concatenate([[True], np.diff(r) > ROUNDING * abs(r[-1])])
    columns.need(rises, "r", r, "not beyond the previous station: sort them and remove duplicates")
    return Contents(columns, body, file_mount, (text.path, *([htc.path] if htc else [])))


def _whole(htc: Text, name: str, by_child: dict[str, Relative]) -> None:
    """Check that a main_body is a whole blade."""
    for child, block in by_child.items():
        if name == block.parent or (name == child and block.parent.startswith("blade")):
            raise CaseError(
                f"{htc.path}: {child} is on {block.parent}: a blade of several bodies is not supported: give one main_body"
            )


def sections(text: Text, subset: tuple[int, int] | None) -> tuple[Array, Array, Array]:
    """Positions r (n,), m, stiffness and mass (n, 6, 6) of a structural file, about the axis of the body.

    Raises:
        CaseError: naming the file and line at fault.
    """
    columns = _subset(text, subset)
    return columns["r"], stiffness_of(columns), mass_of(columns)


def _subset(text: Text, subset: tuple[int, int] | None) -> Table:
    heads, current = {}, 1
    for k, line in enumerate(text.lines):
        if match := _SET.match(line):
            current = int(match[1])
        elif match := _SUBSET.match(line):
            if (current, int(match[1])) in heads:
                raise CaseError(
                    f"{text.at(k)}: set {current}, subset {match[1]}: there already is one: renumber or remove it"
                )
            heads[current, int(match[1])] = (k, int(match[2]))
    if not heads:
        raise CaseError(
            f"{text.path}: no line that begins with $, set and number of rows: check that it is the right file"
        )
    if subset is None and len(heads) > 1:
        names = ", ".join(f"{a}:{b}" for a, b in heads)
        raise CaseError(
            f"{text.path}: {len(heads)} sets: subsets {names}: choose one with --subset, or give the htc with --main"
        )
    subset = subset or next(iter(heads))
    if subset not in heads:
        names = ", ".join(f"{a}:{b}" for a, b in heads)
        raise CaseError(
            f"{text.path}: no set {subset[0]}, subset {subset[1]}: it has {names}: correct --subset or the htc's set"
        )
    k, count = heads[subset]
    first = first_numbers(text, k + 1)
    wide = first < len(text.lines) and len(leading(text.lines[first])) > (len(PLAIN) + len(FULL)) // 2
    columns = table(text, first, count, FULL if wide else PLAIN)
    stiffness = (
        ("K11", "K22", "K33", "K44", "K55", "K66") if wide else ("E", "G", "I_x", "I_y", "I_p", "k_x", "k_y", "A")
    )
    columns.positive("m", *stiffness)
    columns.positive("ri_x", "ri_y", zero=True)
    r, row = columns["r"], np.arange(count)
    r[0] = 0.0 if abs(r[0]) <= ROUNDING * abs(r[-1]) else r[0]
    columns.need((row > 0) | (r == 0), "r", r, "the first station is the root; begin at 0")
    columns.need(r >= np.concatenate([[0.0], r[:-1]]), "r", r, "before the previous station: sort them")
    columns.need((row + 1 < count) | (r > 0), "r", r, "the last station is the end: give two or more")
    return columns


def stiffness_of(p: Table) -> Array:
    """Stiffness (n, 6, 6) about the half-chord line, in axes rotated by the twist."""
    angle = np.radians(p["pitch"])
    if "K11" in p.columns:
        full = symmetric(np.stack([p[name] for name in FULL[-21:]], axis=1))
        for k, matrix in enumerate(full):
            if message := fault(matrix):
                raise CaseError(f"{p.text.at(p.lines[k])}: stiffness: {message}")
        return about(rotated(in_axes(full, HAWC2), angle), p["x_e"], p["y_e"])
    bend = rotated(bending(p["E"] * p["A"], p["E"] * p["I_x"], p["E"] * p["I_y"]), angle)
    ga = p["G"] * p["A"]
    shear = rotated(shearing(p["G"] * p["I_p"], p["k_x"] * ga, p["k_y"] * ga), angle)
    return about(bend, p["x_e"], p["y_e"]) + about(shear, p["x_sh"], p["y_sh"])


def mass_of(p: Table) -> Array:
    """Mass about the half-chord line: moments about the elastic centre are transferred to the mass centre first."""
    m, y, z = p["m"], p["x_cg"] - p["x_e"], p["y_cg"] - p["y_e"]
    rotary = np.zeros((len(m), 6, 6))
    rotary[:, 4, 4], rotary[:, 5, 5] = m * p["ri_x"] ** 2, m * p["ri_y"] ** 2
    rotary = rotated(rotary, np.radians(p["pitch"]))
    rotary[:, 4, 4] -= m * z**2
    rotary[:, 5, 5] -= m * y**2
    rotary[:, 4, 5] += m * y * z
    rotary[:, 5, 4] += m * y * z
    smallest = np.linalg.eigvalsh(rotary[:, 4:, 4:])[:, 0]
    remedy = "less than the mass centre's distance from the elastic centre, about which it must be given"
    p.need(smallest >= -1e-9 * np.abs(rotary[:, 4:, 4:]).max(), "ri_x, ri_y", p["ri_y"], remedy)
    rotary[:, 3, 3] = rotary[:, 4, 4] + rotary[:, 5, 5]
    rotary[:, range(3), range(3)] = m[:, None]
    return about(rotary, p["x_cg"], p["y_cg"])
