"""OpenFAST's files, read by weio: ElastoDyn's blade and main files, FAST 7's additional columns, BeamDyn, and the .fst.

OpenFAST's blade axes are x downwind, y to the trailing edge, z along the blade; positive twist moves the leading edge upwind,
a rotation from z towards y in the axes of ``core.blade``. Sources: J. Jonkman, M. Buhl, *FAST User's Guide*,
NREL/EL-500-38230, 2005; J. Jonkman, FAST v7.02, ``FAST2ADAMS.f90``; Q. Wang et al., *BeamDyn User's Guide and Theory
Manual*, NREL, 2016.
"""

from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline

from . import sections
from .axis import Curve, beamdyn_roll, tangents
from .stations import Array, NotReadError, ReadingOptions, Stations, parser

PLANES = ("EdgEAOf", "FlpEAOf", "EdgcgOf", "FlpcgOf", "PreswpRef", "PrecrvRef")
"""FAST 7's offsets: of the elastic axis and the mass centre from the reference axis, and of that from the pitch axis."""


DESCRIPTION = 1
"""Index of the line that describes a file in words, which weio 2.0.0 takes for the head of BeamDyn's table if it contains
"distributed properties"."""


def parsed(path: Path) -> tuple[Any, str]:
    """A file read by weio, and the name and version of weio."""

    def imported() -> Any:
        from weio.fast_input_file import FASTInputFile

        return FASTInputFile

    reader, name = parser("weio", imported)
    return reader(str(path), IComment=[DESCRIPTION]), name


def first_of(file: Any, *labels: str) -> Any:
    """The value of the first label that a file has.

    Raises:
        NotReadError: if it has none.
    """
    for label in labels:
        if label in file.keys():  # noqa: SIM118  a file of weio is no dictionary
            return file[label]
    raise NotReadError(f"weio finds no {labels[0]}")


def text_of(file: Any, *labels: str) -> str:
    """The unquoted text of the first label that a file has, with forward slashes."""
    return str(first_of(file, *labels)).strip("\"'").replace("\\", "/")


def has(file: Any, label: str) -> bool:
    """Whether a file has a label."""
    return label in file.keys()  # noqa: SIM118


def read(path: Path, options: ReadingOptions) -> Stations:
    """The stations of the first blade that a file of OpenFAST describes.

    Raises:
        NotReadError: if weio does not find it.
    """
    file, reader = parsed(path)
    siblings = [parsed(sibling)[0] for sibling in options.siblings if sibling != path]
    hub = next((sibling for sibling in siblings if has(sibling, "TipRad")), None)
    if has(file, "EDFile"):
        main = path.parent / text_of(file, "EDFile")
        if not has(file, "CompElast") or int(file["CompElast"]) == 1:
            return read(main, replace(options, siblings=()))
        blade = path.parent / text_of(file, "BDBldFile(1)", "BDBldFile1", "BDBldFile")
        return read(blade, replace(options, siblings=(main,)))
    if has(file, "TipRad"):
        blade, _ = parsed(path.parent / text_of(file, "BldFile(1)", "BldFile1", "BldFile"))
        return _elastodyn(blade, file, reader, options)
    if has(file, "BldProp"):
        return _elastodyn(file, hub, reader, options)
    if has(file, "MemberGeom"):
        table, _ = parsed(path.parent / text_of(file, "BldFile"))
        return _beamdyn(table, file, hub, reader, options)
    if has(file, "BeamProperties"):
        main = next((sibling for sibling in siblings if has(sibling, "MemberGeom")), None)
        return _beamdyn(file, main, hub, reader, options)
    raise NotReadError("weio finds no blade in it")


def mounting(hub: Any) -> dict[str, float]:
    """The mounting that ElastoDyn's main file states; precone is positive downwind."""
    if hub is None:
        return {}
    return {
        "hub_radius": float(first_of(hub, "HubRad")),
        "precone": radians(first_of(hub, "PreCone(1)", "PreCone1", "PreCone")),
        "tip_mass": float(first_of(hub, "TipMass(1)", "TipMass1", "TipMass")),
    }


def length_of(hub: Any, options: ReadingOptions) -> float:
    """The blade's length: as asked, or from hub to tip.

    Raises:
        NotReadError: if neither is known.
    """
    if options.length:
        return options.length
    if hub is None:
        raise NotReadError("no length: its stations are fractions of it")
    return float(first_of(hub, "TipRad") - first_of(hub, "HubRad"))


def _elastodyn(file: Any, hub: Any, reader: str, options: ReadingOptions) -> Stations:
    length = length_of(hub, options)
    names = next(entry["tabColumnNames"] for entry in file.data if entry["label"] == "BldProp")
    table = {name.lower(): values for name, values in zip(names, np.array(file["BldProp"], float).T, strict=True)}
    zeros = np.zeros(len(table["blfract"]))
    by = options.multipliers or tuple(float(file[name]) for name in ("AdjBlMs", "AdjFlSt", "AdjEdSt"))
    twist = -np.radians(table["strctwst"])
    edge_axis, flap_axis, edge_mass, flap_mass, sweep, bend = (
        table.get(name.lower(), zeros) if options.offsets else zeros for name in PLANES
    )
    z = table["blfract"] / table["blfract"][-1] * length
    # n1 = x_b cos(StrcTwst) − y_b sin, n2 = x_b sin + y_b cos: from the reference axis to the elastic axis
    c, s = np.cos(-twist), np.sin(-twist)
    downwind = bend + flap_axis * c + edge_axis * s
    trailing = sweep - flap_axis * s + edge_axis * c
    ahead, up = edge_axis - edge_mass, flap_mass - flap_axis  # of the mass centre, from the elastic axis
    mass = by[0] * table["bmassden"]
    yy, zz = (table.get(name, zeros) for name in ("edginer", "flpiner"))
    rigid = np.full(len(z), np.inf)
    stiffness = np.zeros((len(z), 6, 6))
    stiffness[:, range(6), range(6)] = sections.diagonal(
        *(table.get("eastff", rigid), rigid, rigid, table.get("gjstff", rigid)),
        *(by[1] * table["flpstff"], by[2] * table["edgstff"]),
    )
    points = np.stack([z, -trailing, downwind], axis=1)
    arc = z if not (trailing.any() or downwind.any()) else _spline(z, points).lengths()
    inertia = sections.mass(mass, ahead, up, yy + mass * ahead**2, zz + mass * up**2, mass * ahead * up)
    return Stations(reader, arc, stiffness, inertia, twist, points, mounting(hub))


def _spline(z: Array, points: Array) -> Curve:
    """Natural cubic splines through points (n, 3) at ``z`` (n,), smooth between them."""
    degree, ends = (3, "natural") if len(z) > 2 else (1, None)
    spline = make_interp_spline(z, points, k=degree, bc_type=ends)
    return Curve(lambda at, n=0: spline(at, nu=n), z)


def _beamdyn(table: Any, main: Any, hub: Any, reader: str, options: ReadingOptions) -> Stations:
    if main is not None:
        key = np.array(first_of(main, "MemberGeom"), float)
    else:
        key = np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, length_of(hub, options), 0.0]])
    at = key[:, 2]
    curve = _spline(at, np.stack([at, -key[:, 1], key[:, 0]], axis=1))
    twist = _spline(at, key[:, 3:])
    properties = table["BeamProperties"]
    eta, stiffness, mass = (np.array(properties[name], float) for name in ("span", "K", "M"))
    arc = curve.lengths()[-1] * eta
    where = curve.parameter(arc)
    matrices = [sections.permuted(0.5 * (k + np.swapaxes(k, 1, 2)), *sections.OPENFAST) for k in (stiffness, mass)]
    twist_angle = beamdyn_roll(tangents(curve, where)) - np.radians(twist.values(where)[:, 0])
    return Stations(reader, arc, matrices[0], matrices[1], twist_angle, curve.values(where), mounting(hub))
