"""BeamDyn's main file (key points: prebend, sweep, twist) and its blade file (6×6 matrices at stations), old and new.

BeamDyn's axes are x downwind, y to the trailing edge, z along the blade; matrices are about the reference curve, order
(Fx, Fy, Fz, Mx, My, Mz), in section axes: z along the tangent, x across it without a y-component, both then rotated by the
twist (BeamDyn's ``BD_ComputeIniNodalCrv``; positive with the leading edge upwind, as in ElastoDyn). The section axes of
``core.blade`` follow from the blade's axes by the smallest rotation, which differs by half the product of the slopes of
prebend and sweep. Positions and twist between key points are natural cubic splines in z; stations are fractions of the
curve's arc length. Source: Q. Wang, J. Jonkman, M. Sprague, B. Jonkman, *BeamDyn User's Guide and Theory Manual*, NREL,
2016.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .....core.blade import Blade
from .....core.blade_checks import follows
from ...errors import CaseError, located
from ..matrices import BEAMDYN, between, fault, in_axes, mass_fault
from ..source import OPENFAST_AXES, Mount, Reading, Source, Unused, unused
from ..text import (
    ROUNDING,
    Table,
    Text,
    first_numbers,
    flag,
    fractions,
    integer,
    keys,
    leading,
    load,
    path_named,
    row,
    table,
    tokens,
    value,
)
from . import elastodyn, elastodyn_unused
from .beamdyn_axis import Axis, line, measured, resolved, roll

Array = NDArray[np.float64]

NAME = "BeamDyn"
KEY_POINTS = ("kp_xr", "kp_yr", "kp_zr", "initial_twist")
MIN_SPACING = 1e-6
"""Key points and stations closer than this fraction of the length coincide."""


def is_blade(text: Text) -> bool:
    """Whether these are lines of a blade file."""
    return "station_total" in keys(text)


def is_main(text: Text) -> bool:
    """Whether these are lines of a main file."""
    return "kp_total" in keys(text)


def read(path: Path, mount: Mount | None = None) -> Reading:
    """Read the blade in BeamDyn's main file, or in a blade file that a main file in the same folder references.

    Args:
        path: path of either file. A blade file with neither a main file nor ``mount.length`` is rejected; with only the
            length it is straight and untwisted.
        mount: hub radius, precone and pitch, which BeamDyn does not have; ``mount.main`` is ElastoDyn's main file.

    Raises:
        CaseError: naming the file and line at fault.
    """
    mount = mount or Mount()
    text = load(path)
    if is_main(text):
        main, text = text, load(_named(text))
    else:
        main = _main(path, mount)
    hub = load(mount.main) if mount.main and is_elastodyn(mount.main) else None
    hub_data = elastodyn.hub(hub) if hub else None
    mounted = elastodyn.complete(mount, hub_data.mount if hub_data else None)
    if main is None and mounted.length is None:
        raise CaseError(
            f"{path}: length: missing: stations are fractions of the length, and no main file with key points is in "
            "the folder: give the main file instead, or --length for a straight, untwisted blade"
        )
    axis = _axis(_points(main)) if main is not None else line(mounted.length or 0.0)
    sections, stiffness, mass = _sections(text)
    eta = fractions(sections, "station_eta")
    files = tuple(t.path for t in (text, main) if t is not None) + ((mount.main,) if hub_data and mount.main else ())
    blade = assemble(path.stem, path, axis, eta, stiffness, mass, mounted)
    if hub_data and hub_data.tip_mass:
        blade = replace(blade, tip_mass=np.diag([hub_data.tip_mass] * 3 + [0.0] * 3))
    notes = [
        "matrices made symmetric",
        "twist between key points: a cubic spline, sampled at key points and stations",
    ]
    if main is None:
        notes.append("no main file: straight, untwisted")
    if hub_data is None and mounted.assumption:
        notes.append(f"no ElastoDyn main file: {mounted.assumption}")
    axes = f"{OPENFAST_AXES}; matrices about the key points' curve, where they stay"
    unused_values = (
        *_damping(text),
        *(_actuator(main) if main else ()),
        *(elastodyn_unused.of_main(hub) if hub else ()),
    )
    return Reading(blade, Source(NAME, files, axes, tuple(notes), unused_values), unstated=mounted.unstated)


DAMPING = "mu1 … mu6"


def _damping(text: Text) -> tuple[Unused, ...]:
    """The stiffness-proportional damping of a blade file: the six numbers below the row that names them."""
    heads = [k for k, line in enumerate(text.lines) if [w.lower() for w in tokens(line)[:2]] == ["mu1", "mu2"]]
    below = next((leading(line) for line in text.lines[heads[0] + 1 :] if leading(line)), []) if heads else []
    entries = keys(text)
    on = "damp_type" not in entries or value(text, entries, "damp_type") != 0
    return unused(DAMPING, below[:6], "s", text.path, "modes are undamped") if on else ()


def _actuator(main: Text) -> tuple[Unused, ...]:
    entries = keys(main)
    if not flag(main, "UsePitchAct"):
        return ()
    why = "the pitch bearing is treated as clamped"
    return tuple(
        u
        for name, unit in (("PitchJ", "kg m^2"), ("PitchK", "kg m^2/s^2"), ("PitchC", "kg m^2/s"))
        if name.lower() in entries
        for u in unused(name, [value(main, entries, name)], unit, main.path, why)
    )


def is_elastodyn(path: Path) -> bool:
    """Whether a file is ElastoDyn's main file."""
    return elastodyn.is_main(load(path))


def _main(path: Path, mount: Mount) -> Text | None:
    if mount.main and not is_elastodyn(mount.main):
        return load(mount.main)
    sibling = elastodyn.sibling_file(path, is_main, _named)
    return load(sibling) if sibling else None


def _named(main: Text) -> Path:
    return path_named(main, "BldFile")


def _points(main: Text) -> Table:
    """The key points: the first rows of four numbers after their count."""
    entries = keys(main)
    count = integer(main, entries, "kp_total")
    members = integer(main, entries, "member_total") if "member_total" in entries else 1
    points = table(main, first_numbers(main, entries["kp_total"][0] + 1 + members), count, KEY_POINTS)
    z = points["kp_zr"]
    for name in ("kp_xr", "kp_yr", "kp_zr"):
        if abs(points[name][0]) <= ROUNDING * np.abs(z).max():
            points[name][0] = 0.0
        points.need(
            np.arange(count) > 0 if points[name][0] else np.ones(count, bool),
            name,
            points[name],
            "the first key point is the root; begin at 0, 0, 0 and put the hub's radius into the main file",
        )
    rises = np.concatenate([[True], np.diff(z) > ROUNDING * np.abs(z).max()])
    points.need(rises, "kp_zr", z, "not beyond the previous key point: sort them and remove duplicates")
    if count < 2:
        raise CaseError(f"{main.at(points.lines[0])}: 1 key point: a blade needs at least a root and a tip")
    return points


def _axis(points: Table) -> Axis:
    z = points["kp_zr"]
    values = np.stack([points["kp_xr"], points["kp_yr"], points["initial_twist"]], axis=1)
    return measured(CubicSpline(z, values, bc_type="natural"), z)


def _sections(text: Text) -> tuple[Table, Array, Array]:
    """Fractions (n,) of the stations, and stiffness and mass (n, 6, 6) in BeamDyn's order and axes."""
    entries = keys(text)
    count = integer(text, entries, "station_total")
    k = entries["station_total"][0] + 1
    while k < len(text.lines) and not _starts(text, k):
        k += 1
    etas, lines, matrices = [], [], []
    for i in range(count):
        k = _next(text, k, i, count)
        (eta,) = row(text, k, ("station_eta",))
        etas.append(eta)
        lines.append(k)
        k += 1
        pair = []
        for quantity in ("stiffness", "mass"):
            first = _next(text, k, i, count)
            rows = [_row(text, first + j, quantity, j, i, count) for j in range(6)]
            matrix = np.array(rows)
            message = fault(matrix) if quantity == "stiffness" else mass_fault(matrix)
            if message:
                raise CaseError(f"{text.at(first)}: {quantity} at station_eta {eta:g}: {message}")
            pair.append((matrix + matrix.T) / 2)
            k = first + 6
        matrices.append(pair)
    if any(_starts(text, j) for j in range(k, len(text.lines))):
        raise CaseError(f"{text.at(k)}: another station after the {count} announced: correct station_total")
    stiffness, mass = np.array(matrices).transpose(1, 0, 2, 3)
    return Table(text, {"station_eta": np.array(etas)}, tuple(lines)), stiffness, mass


def _starts(text: Text, k: int) -> bool:
    """Whether a station starts on line ``k``: one number alone, and six below it."""
    below = next((j for j in range(k + 1, len(text.lines)) if not text.blank(j)), k)
    return len(text.lines[k].split()) == 1 == len(leading(text.lines[k])) and len(leading(text.lines[below])) >= 5


def _next(text: Text, k: int, i: int, count: int) -> int:
    while k < len(text.lines) and text.blank(k):
        k += 1
    if k >= len(text.lines):
        raise CaseError(f"{text.at(k)}: the file ends within station {i + 1} of {count}: give the whole file")
    return k


def _row(text: Text, k: int, quantity: str, j: int, i: int, count: int) -> list[float]:
    if k >= len(text.lines):
        raise CaseError(f"{text.at(k)}: the file ends within station {i + 1} of {count}: give the whole file")
    return row(text, k, tuple(f"{quantity} {j + 1}{c}" for c in range(1, 7)))


def assemble(name: str, path: Path, axis: Axis, eta: Array, stiffness: Array, mass: Array, mount: Mount) -> Blade:
    """A blade from sections at fractions ``eta`` (n,) of a curve's length, in BeamDyn's axes.

    Key points are also stations; more stations are added where the curve needs them. ``path`` is for messages.

    Raises:
        CaseError: if the data are invalid.
    """
    length = axis.arc[-1]
    arc = eta * length
    points = axis.arc[np.abs(axis.arc[:, None] - arc).min(1) > MIN_SPACING * length]
    s = np.sort(np.concatenate([arc, points]))
    s[-1] = length
    if not follows(s, axis.points(axis.at(s))):
        s = resolved(axis, s)
    z = axis.at(s)
    degrees = axis.spline(z)[:, 2]
    if mount.length is not None and abs(mount.length - length) > 0.02 * length:
        raise CaseError(
            f"length: {mount.length:g} m by the main file or --length, {length:g} m by the key points: "
            "check that both are of the same blade"
        )
    at = [between(arc, m, s) for m in (stiffness, mass)]
    with located(f"{path}: "):
        return Blade(
            name=name,
            stations=s,
            stiffness=in_axes(at[0], BEAMDYN),
            mass=in_axes(at[1], BEAMDYN),
            twist=roll(axis, z) - np.radians(degrees),
            hub_radius=mount.hub_radius or 0.0,
            curve=axis.points(z),
            precone=mount.precone or 0.0,
            pitch=mount.pitch or 0.0,
        )
