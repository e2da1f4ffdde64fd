"""windIO 1 and 2, YAML read by ruamel.yaml.

Matrices are about the reference axis in OpenFAST's axes and order; windIO 1 lists 21 numbers per station (rows of the upper
triangle), windIO 2 one list per entry. Angles are in radians in windIO 1 and in degrees in windIO 2. Grids are fractions of arc
length, reference axis and twist PCHIP. Source: IEA Wind Task 37, windIO, turbine schema 1 and 2.1.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator, make_interp_spline

from . import sections
from .axis import Curve, beamdyn_roll, tangents
from .stations import Array, NotReadError, ReadingOptions, Stations, parser
from .windio_schema import violations

PLAUSIBLE = 1.0
"""Largest twist in radians: a file of windIO 1 with a larger number has degrees."""

MIN_STEP = 1e-9
"""Grid points closer than this fraction of the length are one."""


def read(path: Path, options: ReadingOptions) -> Stations:
    """The stations of a turbine's blade.

    Raises:
        NotReadError: if there are no matrices.
    """
    yaml, reader = parser("ruamel.yaml", lambda: __import__("ruamel.yaml").yaml)
    with path.open(encoding="utf-8") as stream:
        turbine = yaml.YAML(typ="safe", pure=True).load(stream)
    blade = turbine["components"]["blade"]
    if "elastic_properties" in blade.get("structure", {}):
        elastic, axis, twist = (
            blade["structure"]["elastic_properties"],
            blade["reference_axis"],
            blade["outer_shape"]["twist"],
        )
        grids, stiffness, mass = _entries(elastic)
        to_radians = np.pi / 180.0
    elif "six_x_six" in blade.get("elastic_properties_mb", {}):
        elastic = blade["elastic_properties_mb"]["six_x_six"]
        axis, twist = (elastic.get(key) or blade["outer_shape_bem"][key] for key in ("reference_axis", "twist"))
        rows = [elastic[key] for key in ("stiff_matrix", "inertia_matrix")]
        grids = [np.array(row["grid"], float) for row in rows]
        stiffness, mass = (_symmetric(np.array(row["values"], float)) for row in rows)
        to_radians = 1.0 if np.abs(twist["values"]).max() <= PLAUSIBLE else np.pi / 180.0
    else:
        raise NotReadError("no 6×6 matrices in it")
    eta = np.sort(np.concatenate(grids))
    eta = eta[np.append(True, np.diff(eta) > MIN_STEP)]
    matrices = [
        sections.permuted(make_interp_spline(grid, values, k=1)(eta), *sections.OPENFAST)
        for grid, values in zip(grids, (stiffness, mass), strict=True)
    ]
    rigid_strains = [i for i in (0, 1, 2, 3) if not matrices[0][:, i, i].any()]
    curve, angle = _axis(axis, twist, to_radians)
    arc = eta * curve.lengths()[-1]
    at = curve.parameter(arc)
    twist_angle = beamdyn_roll(tangents(curve, at)) - angle(at)
    mount = {**_hub(turbine), "tip_mass": _tip(elastic)}
    return Stations(
        *(reader, arc, sections.rigid(matrices[0], *rigid_strains), matrices[1], twist_angle, curve.values(at), mount),
        violations=violations(turbine) if "structure" in blade else (),
    )


def _entries(elastic: Mapping[str, Any]) -> tuple[list[Array], Array, Array]:
    """Grids, stiffness and mass of windIO 2."""
    k, inertia = elastic["stiffness_matrix"], elastic["inertia_matrix"]
    grids = [np.array(part["grid"], float) for part in (k, inertia)]
    stiffness = np.zeros((len(grids[0]), 6, 6))
    for i in range(6):
        for j in range(i, 6):
            stiffness[:, i, j] = stiffness[:, j, i] = k.get(f"K{i + 1}{j + 1}", 0.0)
    zeros = np.zeros(len(grids[1]))
    m, x, y, about_x, about_y, product = (
        np.array(inertia.get(key, zeros), float) for key in ("mass", "cm_x", "cm_y", "i_edge", "i_flap", "i_cp")
    )
    mass = np.zeros((len(m), 6, 6))
    for i, j, value in (
        *((0, 0, m), (1, 1, m), (2, 2, m), (0, 5, -m * y), (1, 5, m * x), (2, 3, m * y), (2, 4, -m * x)),
        *((3, 3, about_x), (4, 4, about_y), (3, 4, -product)),
        (5, 5, np.array(inertia.get("i_plr", about_x + about_y), float)),
    ):
        mass[:, i, j] = mass[:, j, i] = value
    return grids, stiffness, mass


def _symmetric(upper: Array) -> Array:
    out = np.zeros((len(upper), 6, 6))
    columns = iter(upper.T)
    for i in range(6):
        for j in range(i, 6):
            out[:, i, j] = out[:, j, i] = next(columns)
    return out


def _axis(axis: Mapping[str, Any], twist: Mapping[str, Any], to_radians: float) -> tuple[Curve, Any]:
    """The reference curve, natural cubic splines in z through all grid points, and the twist (rad) along it."""
    parts = [axis["x"], axis["y"], axis["z"], twist]
    grid = np.sort(np.concatenate([np.array(part["grid"], float) for part in parts]))
    grid = grid[np.append(True, np.diff(grid) > MIN_STEP)]
    x, y, z, angle = (PchipInterpolator(np.array(p["grid"], float), np.array(p["values"], float))(grid) for p in parts)
    z[0] = 0.0
    natural = "natural" if len(z) > 2 else None
    spline = make_interp_spline(
        z,
        np.stack([z, y[0] - y, x - x[0], angle * to_radians], axis=1),
        k=3 if natural else 1,
        bc_type=natural,
    )
    return Curve(lambda at, n=0: spline(at, nu=n)[:, :3], z), lambda at: spline(at)[:, 3]


def _hub(turbine: Mapping[str, Any]) -> dict[str, float]:
    hub = turbine["components"].get("hub", {})
    hub = hub.get("outer_shape_bem", hub)
    out: dict[str, float] = {}
    if "diameter" in hub:
        out["hub_radius"] = hub["diameter"] / 2
    if "cone_angle" in hub:
        new = "structure" in turbine["components"]["blade"]
        upwind = str(turbine.get("assembly", {}).get("rotor_orientation", "upwind")).lower() == "upwind"
        out["precone"] = hub["cone_angle"] * (np.pi / 180.0 if new else 1.0) * (-1.0 if upwind else 1.0)
    return out


def _tip(elastic: Mapping[str, Any]) -> float:
    return float(sum(elastic.get("point_mass", {}).get("mass", [])))
