"""HAWC2's structural files and the c2_def of an htc, read by wetb as it comes with weio.

HAWC2's axes are x to the leading edge, y downwind, z along the blade: y and z of ``core.blade`` are its x and y, and angles
from x towards y keep their sign. With 19 columns stretch and bending act at the elastic centre along axes rotated by
``pitch``, shear and torsion at the shear centre; with 30 columns the matrix is about the elastic centre in the rotated axes.
The radii of gyration are about the elastic centre, in the rotated axes: ``ri_x`` belongs to rotation about x. Source:
T. J. Larsen, A. M. Hansen, *How 2 HAWC2, the user's manual*, Risø-R-1597, ch. 6.
"""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from . import sections
from .axis import Curve
from .stations import Array, NotReadError, ReadingOptions, Stations, parser, straight


def read(path: Path, options: ReadingOptions) -> Stations:
    """The stations of a structural file, or of the blade of an htc.

    Raises:
        NotReadError: if wetb does not find them.
    """

    def imported() -> Any:
        from weio.wetb.hawc2.htc_file import HTCFile
        from weio.wetb.hawc2.st_file import StFile

        return HTCFile, StFile

    (HTCFile, StFile), reader = parser("weio", imported)
    files = (path, *options.siblings)
    htc = next((file for file in files if "new_htc_structure" in file.read_text("latin-1").lower()), None)
    body = _blade(HTCFile(str(htc), modelpath=str(htc.parent))) if htc else None
    subset = options.subset
    if body is not None:
        table_input = body.timoschenko_input
        subset = subset or (tuple(int(v) for v in table_input.set[:2]) if "set" in table_input.keys() else None)  # noqa: SIM118
        path = sibling_file(htc, str(table_input.filename[0])) if htc is not None and path == htc else path
    file = StFile(str(path))
    subset = subset or next((a, b) for a, data in file.main_data_sets.items() for b in data)
    rows = file.main_data_sets[subset[0]][subset[1]]
    table = dict(zip(file.cols, rows.T, strict=True))
    r = table["r"]
    curve, twist, s = straight(r), np.zeros(len(r)), r
    if body is not None:
        curve, twist, s = _half_chord(body, r)
    name = reader.replace("weio", "wetb in weio")
    return Stations(name, s, _stiffness(table), _mass(table), twist, curve)


def _blade(htc: Any) -> Any:
    bodies = {str(v.name[0]).lower(): v for k, v in htc.new_htc_structure.contents.items() if k.startswith("main_body")}
    blades = [n for n, body in bodies.items() if n.startswith("blade") and "c2_def" in body.keys()]  # noqa: SIM118
    if not blades:
        raise NotReadError("wetb finds no main_body whose name begins with blade")
    orientation = htc.new_htc_structure.contents.get("orientation")
    relatives = [part.contents for part in orientation.contents.values()] if orientation else []
    mounted = {str(r[key].values[0]).lower() for r in relatives for key in ("body2", "mbdy2") if key in r}
    return bodies[next((name for name in blades if name in mounted), blades[0])]


def sibling_file(htc: Path, name: str) -> Path:
    """The file that an htc names, relative to its folder or the one above.

    Raises:
        NotReadError: it is not there.
    """
    relative = Path(name.replace("\\", "/"))
    for candidate in (htc.parent / relative, htc.parent.parent / relative, htc.parent / relative.name):
        if candidate.is_file():
            return candidate
    raise NotReadError(f"{name}: not found from the htc's folder or the one above")


def _half_chord(body: Any, r: Array) -> tuple[Array, Array, Array]:
    """Curve (n, 3), twist (n,) and arc length (n,) at the stations ``r``, whose last is at the end of c2_def."""
    rows = [line.values[1:5] for key, line in body.c2_def.contents.items() if key.startswith("sec")]
    x, y, z, degrees = np.array(rows, float).T
    values = Akima1DInterpolator(z, np.stack([z, x, y, np.radians(degrees)], axis=1))
    curve = Curve(lambda at, n=0: values(at, nu=n)[:, :3], z)
    s = r * (curve.lengths()[-1] / r[-1])
    at = curve.parameter(s)
    return curve.values(at), values(at)[:, 3], s


def _stiffness(p: dict[str, Array]) -> Array:
    angle, zeros = np.radians(p["pitch"]), np.zeros(len(p["r"]))
    elastic = sections.strains(p["x_e"], p["y_e"], angle)
    if "K_11" in p:
        full = np.zeros((len(angle), 6, 6))
        for i in range(6):
            for j in range(i, 6):
                full[:, i, j] = full[:, j, i] = p[f"K_{i + 1}{j + 1}"]
        return sections.energy(elastic, sections.permuted(full, *sections.HAWC2))
    ga = p["G"] * p["A"]
    bending = sections.diagonal(p["E"] * p["A"], zeros, zeros, zeros, p["E"] * p["I_x"], p["E"] * p["I_y"])
    shearing = sections.diagonal(zeros, p["k_x"] * ga, p["k_y"] * ga, p["G"] * p["I_p"], zeros, zeros)
    at_shear_centre = sections.strains(p["x_sh"], p["y_sh"], angle)
    return sections.energy(elastic, bending) + sections.energy(at_shear_centre, shearing)


def _mass(p: dict[str, Array]) -> Array:
    """∫ r rᵀ dm about the half-chord line is J_e + m (e cᵀ + c eᵀ − e eᵀ): e the elastic centre, c the mass centre."""
    m, ey, ez, cy, cz = p["m"], p["x_e"], p["y_e"], p["x_cg"], p["y_cg"]
    c, s = np.cos(np.radians(p["pitch"])), np.sin(np.radians(p["pitch"]))
    chordwise, across = m * p["ri_y"] ** 2, m * p["ri_x"] ** 2
    yy = chordwise * c**2 + across * s**2 + m * (2 * ey * cy - ey**2)
    zz = chordwise * s**2 + across * c**2 + m * (2 * ez * cz - ez**2)
    yz = (chordwise - across) * s * c + m * (ey * cz + cy * ez - ey * ez)
    return sections.mass(m, cy, cz, yy, zz, yz)
