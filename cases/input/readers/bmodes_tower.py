"""BModes main files (.bmi) of a tower: its sections, top mass, guy wires, and the springs of its base.

BModes' axes are x downwind, y to port, z up; here x = its z, y = its −y, z = its x. As in BModes, a tower is straight, equally
stiff in both directions (``flp_stff``, ``flp_iner``), without offsets and without weight. ``cm_loc`` is the top mass's distance
downwind, ``cm_axial`` that above the top. Its moments are about the mass centre in BModes 3, whose files have ``cm_axial``, and
about axes through the top before (source code of BModes 3.00, BldVib; manual of 1.03). Wires of stiffness k at the angle θ from
the ground, n at a node, act like n/2 k cos²θ in every horizontal direction. Source: G. Bir, *User's Guide to BModes*,
NREL/TP-500-39133, 2005.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....core.blade import Blade, section_mass, section_stiffness
from ....core.space import spatial as sp
from ....core.space.inertia import transformed
from ....core.turbine.tower import Support, Tower, check_tower
from ..errors import CaseError, located
from . import bmodes
from .bmodes import COLUMNS, FACTORS, Entries
from .matrices import BEAMDYN, in_axes
from .source import Source, Unused, unused
from .text import Text, fractions, integer, keys, leading, load, value

Array = NDArray[np.float64]

NAME = "BModes tower"
AXES = "BModes: x downwind, y to port, z up; here x = its z, y = its −y, z = its x"

CLAMPED, FREE, LATERAL = 1, 2, 3
"""hub_conn: clamped; free in all directions; only axial motion and torsion are clamped."""

JUMP = 1e-7
"""Distance of two sections between which properties jump, relative to the height."""

ASYMMETRY = 1e-3
"""Largest difference of entries of a matrix across the diagonal, relative to the diagonal entries."""

LATERAL_FREE = (1, 2, 4, 5)
"""Directions of our axes that hub_conn = 3 leaves to the springs of the base."""


def matches_format(text: Text) -> bool:
    """Whether these are lines of a main file of a tower."""
    entries = keys(text)
    return bmodes.matches_format(text) and "beam_type" in entries and entries["beam_type"][1] == "2"


def read(path: Path) -> tuple[Tower, Source]:
    """Read a tower.

    Raises:
        CaseError: naming the file and line at fault.
    """
    main = load(path)
    entries = keys(main)
    rows = bmodes.section_table(main)
    rows.positive("mass_den", "flp_stff", "tor_stff", "axial_stff")
    rows.positive("flp_iner", zero=True)
    jumps = _jumps(rows["sec_loc"])
    by = {column: value(main, entries, factor) for factor, column in FACTORS.items()}
    p = {name: rows[name] * by.get(name, 1.0) for name in COLUMNS}
    draft = value(main, entries, "draft") if "draft" in entries else 0.0
    height = value(main, entries, "radius") + draft - value(main, entries, "hub_rad")
    if height <= 0:
        raise CaseError(
            f"{main.at(entries['radius'][0])}: radius: the top is not above the base; correct radius, hub_rad, draft"
        )
    with located(f"{rows.text.path}: "):
        beam = Blade(
            name=path.stem,
            stations=fractions(rows, "sec_loc") * height,
            stiffness=section_stiffness(p["axial_stff"], p["tor_stff"], p["flp_stff"], p["flp_stff"]),
            mass=section_mass(p["mass_den"], p["flp_iner"], p["flp_iner"]),
            twist=np.zeros(len(rows["sec_loc"])),
            tip_mass=_top(main, entries),
        )
    base, mass, base_note = _base(main, entries, draft)
    wires = _wires(main, entries, height)
    notes = [
        base_note,
        "without weight, as in BModes",
        "side-side stiffness and inertia are those of fore-aft, as in BModes",
        "properties vary linearly between sections; BModes uses their values in the middle of its elements",
    ]
    if len(jumps):
        notes.append(
            f"properties jump at {', '.join(f'{height * part:g} m' for part in jumps)}: two sections at one height"
        )
    if wires:
        heights = ", ".join(f"{h:g} m" for h, _ in wires)
        notes.append(f"guy wires at {heights}: their horizontal stiffness")
    support = Support(base, wires, _soil(main, entries, height), mass)
    with located(f"{path}: ", ValueError):
        check_tower(height, support)
    return Tower(beam, support), Source(NAME, (path, rows.text.path), AXES, tuple(notes), _unused(main, entries))


def _jumps(sec_loc: Array) -> Array:
    """Places at which two sections follow each other; the second is moved up by ``JUMP``."""
    second = np.flatnonzero(np.diff(sec_loc) == 0) + 1
    sec_loc[second] += JUMP
    return sec_loc[second]


def _top(main: Text, entries: Entries) -> Array:
    """(6, 6) inertia at the tower's top."""
    names = ("tip_mass", "cm_loc", "ixx_tip", "iyy_tip", "izz_tip", "ixy_tip", "izx_tip", "iyz_tip")
    m, x, xx, yy, zz, xy, zx, yz = (value(main, entries, n) for n in names)
    central = "cm_axial" in entries  # from BModes 3 on
    arm = sp.skew(np.array([x, 0.0, value(main, entries, "cm_axial") if central else 0.0]))
    cross = m * arm
    tensor = np.array([[xx, -xy, -zx], [-xy, yy, -yz], [-zx, -yz, zz]]) - central * m * arm @ arm
    return in_axes(np.block([[m * np.eye(3), -cross], [cross, tensor]]), BEAMDYN)


def _base(main: Text, entries: Entries, draft: float) -> tuple[Array | None, Array | None, str]:
    """Stiffness and inertia of the base, and a note on them."""
    kind, at = integer(main, entries, "hub_conn"), main.at(entries["hub_conn"][0])
    if kind == CLAMPED:
        return None, None, "clamped at the base (hub_conn = 1)"
    if kind not in (FREE, LATERAL):
        raise CaseError(f"{at}: hub_conn: {kind}: give 1 (clamped), 2 (free on a platform) or 3 (on springs)")
    below = value(main, entries, "ref_msl") - draft if "ref_msl" in entries else 0.0
    K = _symmetric(main, "hydro_K + mooring_K", _matrix(main, "hydro_K") + _matrix(main, "mooring_K"))
    raised = _raised(K, below)
    inertia = _raised(_symmetric(main, "hydro_M", _matrix(main, "hydro_M")), below) + _platform(main, entries, draft)
    mass = inertia if inertia.any() else None
    if kind == FREE:
        return raised, mass, "base on a platform (hydro_K + mooring_K; its inertia and hydro_M), free in all directions"
    base = np.diag([np.inf] * 6)
    base[np.ix_(LATERAL_FREE, LATERAL_FREE)] = raised[np.ix_(LATERAL_FREE, LATERAL_FREE)]
    return base, mass, "base on springs (hydro_K + mooring_K), clamped axially and in torsion (hub_conn = 3)"


def _raised(matrix: Array, below: float) -> Array:
    """A matrix (6, 6) in BModes' axes at a point below the base, at the base in ours."""
    return np.ascontiguousarray(transformed(in_axes(matrix, BEAMDYN), sp.pose(np.eye(3), np.array([-below, 0.0, 0.0]))))


def _platform(main: Text, entries: Entries, draft: float) -> Array:
    """(6, 6) inertia of the platform at the base, from its moments about its mass centre."""
    mass = value(main, entries, "mass_pform") if "mass_pform" in entries else 0.0
    own = np.zeros((6, 6))
    own[:3, :3] = mass * np.eye(3)
    own[3:, 3:] = _matrix(main, "i_matrix_pform", 3)
    return _raised(own, value(main, entries, "cm_pform") - draft if mass else 0.0)


def _symmetric(main: Text, name: str, matrix: Array) -> Array:
    """The mean of a matrix and its transpose, which differ in published files by digits of a linearisation.

    Raises:
        CaseError: they differ by more than ``ASYMMETRY``.
    """
    size = np.sqrt(np.abs(np.diagonal(matrix)))
    difference = np.abs(matrix - matrix.T).max()
    if (np.abs(matrix - matrix.T) > ASYMMETRY * np.outer(size, size)).any():
        raise CaseError(
            f"{main.path}: {name}: entries differ by {difference:g} from those across the diagonal; correct one"
        )
    return 0.5 * (matrix + matrix.T)


def _matrix(main: Text, name: str, size: int = 6) -> Array:
    """The rows of as many numbers below the line that contains a name."""
    head = next((k for k, line in enumerate(main.lines) if f"({name})" in line), None)
    if head is None:
        return np.zeros((size, size))
    rows = [leading(line)[:size] for line in main.lines[head + 1 : head + 1 + size]]
    if len(rows) < size or any(len(row) < size for row in rows) or not np.isfinite(rows).all():
        raise CaseError(f"{main.at(head)}: {name}: give {size} rows of {size} finite numbers below this line")
    return np.array(rows)


def _wires(main: Text, entries: Entries, height: float) -> tuple[tuple[float, Array], ...]:
    """Heights and horizontal stiffness of guy wires."""
    if "n_attachments" not in entries or value(main, entries, "n_attachments") == 0:
        return ()
    count = integer(main, entries, "n_attachments")
    columns = [_row(main, entries, name, count) for name in ("n_wires", "node_attach", "wire_stfness", "th_wire")]
    nodes = [
        number for line in main.lines[entries["nselt"][0] + 1 : entries["nselt"][0] + 4] for number in leading(line)
    ]
    out = []
    for n, node, k, angle in zip(*columns, strict=True):
        if not 1 < node <= len(nodes):
            raise CaseError(f"{main.path}: node_attach: {node:g}: el_loc has {len(nodes)} nodes; correct one")
        lateral = 0.5 * n * k * np.cos(np.radians(angle)) ** 2
        out.append((height * nodes[int(node) - 1], lateral * np.diag([0.0, 1.0, 1.0, 0.0, 0.0, 0.0])))
    return tuple(out)


def _row(main: Text, entries: Entries, name: str, count: int) -> list[float]:
    """The first ``count`` numbers of the line that ends in a name."""
    k = next((k for k, line in enumerate(main.lines) if f"{name}:" in line or f" {name} " in line), None)
    numbers = leading(main.lines[k]) if k is not None else []
    if k is None or len(numbers) < count or not np.isfinite(numbers[:count]).all():
        raise CaseError(f"{main.path}: {name}: give {count} finite numbers, one for each attachment of wires")
    return numbers[:count]


def _soil(main: Text, entries: Entries, height: float) -> Array | None:
    """Distributed stiffness: heights above the base, and N/m²."""
    if "n_secs_k_distr" not in entries or value(main, entries, "n_secs_k_distr") == 0:
        return None
    count = integer(main, entries, "n_secs_k_distr")
    columns = [_row(main, entries, name, count) for name in ("z_distr_k", "distr_k")]
    if max(columns[0]) > height:
        raise CaseError(f"{main.path}: z_distr_k: up to {max(columns[0]):g} m: the tower is {height:g} m high")
    return np.array(columns).T


def _unused(main: Text, entries: Entries) -> tuple[Unused, ...]:
    if "n_secs_m_distr" not in entries:
        return ()
    why = "added mass along the tower is not included"
    return unused("distr_m", [value(main, entries, "n_secs_m_distr")], "sections", main.path, why)
