"""windIO 1 and 2: a turbine's YAML with 6×6 matrices of the blade.

In both the matrices are about the reference axis, order (shear x, shear y, axial, bending about x, about y, torsion), x
downwind (to the suction side), y to the trailing edge, z along the blade, in axes rotated by the twist, positive with the
leading edge upwind: BeamDyn's conventions. (windIO 2's text on K11 has x to the trailing edge, which contradicts its
reference axis, its inertia and its example files; the latter are followed.) ``i_edge`` and ``i_flap`` are about the x
and y of the reference axis, not of the mass centre, and ``i_cp = −M45`` (windIO's converter from 1 to 2).

| | windIO 1 | windIO 2 |
|---|---|---|
| matrices | ``elastic_properties_mb.six_x_six``, 21 per station | ``structure.elastic_properties``, a list per entry |
| axis, twist | with the matrices, else ``outer_shape_bem``; rad | ``reference_axis``, ``outer_shape.twist``; degrees |
| ``hub.cone_angle`` | rad | degrees |

The cone is positive away from the tower, hence upwind for an upwind rotor. Grids are fractions of arc length; reference
axis and twist are interpolated by PCHIP between their own points. Source: IEA Wind Task 37, windIO, turbine schema 1
and 2.1; P. Bortolotti et al., *A Framework for the Definition of Wind Turbine Systems*, IEA Wind (2022).
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator, make_interp_spline

from ....core.blade import AXIAL, SHEAR_Y, SHEAR_Z, TORSION
from ..errors import CaseError
from .matrices import UPPER, fault, mass_fault, rigid, symmetric
from .openfast import beamdyn
from .openfast.beamdyn_axis import Axis, measured
from .openfast.elastodyn import complete
from .source import OPENFAST_AXES, Mount, Reading, Source, unused
from .text import load
from .yaml_fields import Field, fields

Array = NDArray[np.float64]

NAME = "windIO"
ENTRIES = tuple(f"K{i + 1}{j + 1}" for i, j in zip(*UPPER, strict=True))
INERTIA = ("mass", "cm_x", "cm_y", "i_edge", "i_flap", "i_plr", "i_cp")
STRAINS = {"K11": SHEAR_Z, "K22": SHEAR_Y, "K33": AXIAL, "K66": TORSION}
"""Entries that may be missing or zero in a file, and the strain that is then rigid, in the order of ``core.blade``."""

FAR = 1.0
"""Largest plausible twist, rad: windIO 1 files with a larger value give it in degrees, as in windIO 2."""

UNEVEN = 0.01
"""Difference between grid and fraction of arc length of the reference axis that is stated."""

MIN_SPACING = 1e-9
"""Grid points closer than this fraction of the length coincide."""


class Layout(NamedTuple):
    """Layout of a version: the elements, and the factor from its angles to degrees."""

    version: int
    elastic: Field
    axis: Field
    twist: Field
    degrees: float


def read(path: Path, mount: Mount | None = None) -> Reading:
    """Read the blade in a windIO file.

    Args:
        path: path of the file.
        mount: data that override the file; hub radius and precone are those of the hub.

    Raises:
        CaseError: naming the file and line at fault.
    """
    top = fields(load(path))
    layout = _layout(top)
    mounted = complete(mount or Mount(), _hub(top, layout))
    eta, stiffness, mass, zero_strains = (_lists if layout.version == 2 else _rows)(layout.elastic)
    name = top.find("name")
    blade_name = name.word() if name else path.stem
    axis = _axis(layout)
    blade = beamdyn.assemble(blade_name, path, axis, eta, stiffness, mass, mounted)
    blade = replace(blade, stiffness=rigid(blade.stiffness, *zero_strains), tip_mass=_tip(layout.elastic))
    notes = ["reference axis and twist by PCHIP, sampled at their own points and the stations"]
    grid, z = (layout.axis.get("z", key).numbers() for key in ("grid", "values"))
    at = np.interp(z, axis.z, axis.arc) / axis.arc[-1]
    if abs(at - grid)[k := int(np.argmax(abs(at - grid)))] > UNEVEN:
        notes.append(
            f"grid {grid[k]:.3g} of the reference axis is at {at[k]:.3g} of its length, where windIO has them equal"
        )
    if mounted.assumption:
        notes.append(mounted.assumption)
    if layout.version == 1 and layout.degrees == 1.0:
        notes.append(f"twist is in radians in windIO 1; this one goes beyond {FAR:g} and was taken for degrees")
    twist = np.abs(layout.twist.get("values").numbers()).max()
    if layout.version == 2 and 0 < twist <= FAR:
        notes.append(
            f"largest twist {twist:.3g}°: windIO 2 has degrees; check that twist and cone_angle are not in radians"
        )
    if zero_strains:
        keys = ", ".join(key for key, i in STRAINS.items() if i in zero_strains)
        notes.append(f"{keys} zero or not given: those strains are rigid")
    axes = f"{OPENFAST_AXES}; matrices about the reference axis, where they stay"
    mu = layout.elastic.find("structural_damping", "mu") if layout.elastic.find("structural_damping") else None
    unused_values = unused("structural_damping.mu", mu.numbers(), "s", path, "modes are undamped") if mu else ()
    source = Source(f"{NAME} {layout.version}", (path,), axes, tuple(notes), unused_values)
    return Reading(blade, source, unstated=mounted.unstated)


def _layout(top: Field) -> Layout:
    blade = top.get("components", "blade")
    new = blade.find("structure", "elastic_properties") if blade.find("structure") else None
    if new is not None:
        return Layout(2, new, blade.get("reference_axis"), blade.get("outer_shape", "twist"), 1.0)
    old = blade.find("elastic_properties_mb", "six_x_six") if blade.find("elastic_properties_mb") else None
    if old is None:
        raise CaseError(
            f"{blade.at}: no 6×6 matrices: neither structure.elastic_properties (windIO 2) nor "
            "elastic_properties_mb.six_x_six (windIO 1); compute them from the layers first (for instance with WISDEM)"
        )
    axis, twist = (old.find(key) or blade.get("outer_shape_bem", key) for key in ("reference_axis", "twist"))
    already = np.abs(twist.get("values").numbers()).max() > FAR
    return Layout(1, old, axis, twist, 1.0 if already else float(np.degrees(1.0)))


def _hub(top: Field, layout: Layout) -> Mount:
    """Hub radius, and precone towards +z."""
    hub = top.find("components", "hub")
    if hub is None:
        return Mount()
    hub = hub.find("outer_shape_bem") or hub
    diameter, cone = hub.find("diameter"), hub.find("cone_angle")
    orientation = top.find("assembly", "rotor_orientation") if top.find("assembly") else None
    word = orientation.word().lower() if orientation else "upwind"
    if orientation and word not in ("upwind", "downwind"):
        raise CaseError(f"{orientation.at}: {orientation.word()}: give upwind or downwind")
    upwind = word == "upwind"
    radians = cone.number() * (1.0 if layout.version == 1 else np.pi / 180) if cone else None
    return Mount(
        hub_radius=diameter.number() / 2 if diameter else None,
        precone=None if radians is None else float(-radians if upwind else radians),
    )


def _axis(layout: Layout) -> Axis:
    """The curve and the twist in degrees, in windIO's axes."""
    parts = [_curve(layout.axis.get(key)) for key in "xyz"] + [_curve(layout.twist)]
    grid = np.sort(np.concatenate([part.x for part in parts]))
    grid = grid[np.append(True, np.diff(grid) > MIN_SPACING)]
    x, y, z, twist = (part(grid) for part in parts)
    start = np.abs([x[0], y[0], z[0]]).max()
    if start > MIN_SPACING * z[-1]:
        raise CaseError(f"{layout.axis.at}: begins {start:g} m from the root: give it from the root, at 0, 0, 0")
    z[0] = 0.0
    if (flat := np.diff(z) <= MIN_SPACING * np.abs(z).max()).any():
        k = int(np.argmax(flat)) + 1
        raise CaseError(f"{layout.axis.get('z').at}: does not rise at grid {grid[k]:g}: sort it, remove duplicates")
    values = np.stack([x - x[0], y - y[0], twist * layout.degrees], axis=1)
    return measured(CubicSpline(z, values, bc_type="natural"), z)


def _curve(values_on_grid: Field) -> PchipInterpolator:
    return PchipInterpolator(
        _grid(values_on_grid),
        _paired(values_on_grid.get("values").numbers(), values_on_grid.get("values"), values_on_grid),
    )


def _grid(values_on_grid: Field) -> Array:
    """The grid of a field: from 0 to 1, strictly increasing."""
    field = values_on_grid.get("grid")
    grid = field.numbers()
    if len(grid) < 2:
        raise CaseError(f"{field.at}: {len(grid)} points: a blade needs at least a root and a tip")
    for k, end in ((0, 0.0), (-1, 1.0)):
        if abs(grid[k] - end) > MIN_SPACING:
            raise CaseError(f"{field.item(k)}: {grid[k]:g}: fractions of the length: begin at 0 and end at 1")
    if (np.diff(grid) <= 0).any():
        k = int(np.argmax(np.diff(grid) <= 0)) + 1
        raise CaseError(f"{field.item(k)}: {grid[k]:g}: not beyond the previous one: sort them and remove duplicates")
    return grid


def _paired(values: Array, field: Field, grid_of: Field) -> Array:
    count = len(grid_of.get("grid").numbers())
    if len(values) != count:
        raise CaseError(f"{field.at}: {len(values)} values for {count} grid points: give one per point")
    return values


SectionLists = tuple[Array, Array, Array, tuple[int, ...]]


def _rows(elastic: Field) -> SectionLists:
    """windIO 1: stations, stiffness and mass in its axes, and the rigid strains in the order of ``core.blade``."""
    grids, matrices = [], []
    for key in ("stiff_matrix", "inertia_matrix"):
        rows = elastic.get(key)
        grids.append(_grid(rows))
        field = rows.get("values")
        matrices.append(symmetric(_paired(field.rows(21), field, rows)))
    at = elastic.get("stiff_matrix", "values")
    stiffness, zero_strains = _loose(matrices[0], at)
    mass = _checked(matrices[1], mass_fault, elastic.get("inertia_matrix", "values"))
    return *_together(grids, [_checked(stiffness, fault, at), mass]), zero_strains


def _lists(elastic: Field) -> SectionLists:
    """windIO 2: stations, stiffness and mass in its axes, and the rigid strains in the order of ``core.blade``."""
    matrix, inertia = elastic.get("stiffness_matrix"), elastic.get("inertia_matrix")
    _only(matrix, ENTRIES, "the upper triangle, K11 … K66")
    _only(inertia, INERTIA, ", ".join(INERTIA))
    grids = [_grid(matrix)]
    entries = np.zeros((len(grids[0]), 21))
    for k, key in enumerate(ENTRIES):
        field = matrix.find(key)
        if field is not None:
            entries[:, k] = _paired(field.numbers(), field, matrix)
        elif key[1] == key[2] and key not in STRAINS:
            raise CaseError(f"{matrix.at}: no {key}: a blade must resist bending; add it")
    stiffness, zero_strains = _loose(symmetric(entries), matrix)
    stiffness = _checked(stiffness, fault, matrix.get("grid"))
    grids.append(_grid(inertia))
    mass = _checked(_mass(inertia), mass_fault, inertia.get("mass"))
    return *_together(grids, [stiffness, mass]), zero_strains


def _only(matrix: Field, entries: tuple[str, ...], names: str) -> None:
    """Check that a matrix has no other entries."""
    if others := [key for key in matrix.names() if key not in ("grid", *entries)]:
        raise CaseError(f"{matrix.at}: {others[0]}: not an entry in windIO 2, which has {names}: correct the key")


def _loose(stiffness: Array, field: Field) -> tuple[Array, tuple[int, ...]]:
    """Strains whose stiffness is zero at every station are rigid; until then their diagonal is set to 1.

    Raises:
        CaseError: if such a strain is coupled with others.
    """
    zero_strains = []
    for key, strain in STRAINS.items():
        i = int(key[1]) - 1
        if stiffness[:, i, i].any():
            continue
        if stiffness[:, i].any():
            raise CaseError(f"{field.at}: {key} is missing, although couplings with it are given: add it")
        stiffness[:, i, i] = 1.0
        zero_strains.append(strain)
    return stiffness, tuple(zero_strains)


def _mass(inertia: Field) -> Array:
    def column(key: str, needed: bool = False) -> Array:
        field = inertia.get(key) if needed else inertia.find(key)
        if field is None:
            return np.zeros(len(inertia.get("grid").numbers()))
        return _paired(field.numbers(), field, inertia)

    m, cx, cy = column("mass", needed=True), column("cm_x"), column("cm_y")
    edge, flap, cross = column("i_edge"), column("i_flap"), column("i_cp")
    out = np.zeros((len(m), 6, 6))
    out[:, range(3), range(3)] = m[:, None]
    out[:, 0, 5], out[:, 1, 5], out[:, 2, 3], out[:, 2, 4] = -m * cy, m * cx, m * cy, -m * cx
    out[:, 3, 4] = -cross
    out += np.triu(out, 1).swapaxes(1, 2)
    out[:, 3, 3], out[:, 4, 4] = edge, flap
    out[:, 5, 5] = column("i_plr") if inertia.find("i_plr") else edge + flap
    return out


def _checked(matrices: Array, fault_of: Callable[[Array], str | None], field: Field) -> Array:
    for k, matrix in enumerate(matrices):
        if message := fault_of(matrix):
            raise CaseError(f"{field.item(k)}: at station {k + 1}: {message}")
    return matrices


def _together(grids: list[Array], matrices: list[Array]) -> tuple[Array, Array, Array]:
    """Interpolate both matrices to the union of the two grids."""
    eta = np.sort(np.concatenate(grids))
    eta = eta[np.append(True, np.diff(eta) > MIN_SPACING)]
    eta[-1] = 1.0
    first, second = (make_interp_spline(grid, m, k=1)(eta) for grid, m in zip(grids, matrices, strict=True))
    return eta, first, second


def _tip(elastic: Field) -> Array:
    """The point mass at the tip, (6, 6)."""
    point_mass = elastic.find("point_mass")
    out = np.zeros((6, 6))
    if point_mass is None:
        return out
    field = point_mass.get("mass")
    at, masses = point_mass.get("grid").numbers(), _paired(field.numbers(), field, point_mass)
    for k, (where, m) in enumerate(zip(at, masses, strict=True)):
        if m and abs(where - 1) > MIN_SPACING:
            raise CaseError(
                f"{field.item(k)}: {m:g} kg at grid {where:g}: only a point mass at the tip is supported: distribute it in mass"
            )
        out[range(3), range(3)] += m
    return out
