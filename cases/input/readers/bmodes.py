"""BModes 3 main files (.bmi) of a blade, with the section properties file they reference.

Section axes are x flapwise (downwind), y to the trailing edge, z along the blade, rotated by the structural twist, positive
with the leading edge upwind; offsets are along y, from the reference axis. The mass acts at ``cg_offst`` with principal
moments of inertia about it in axes rotated by ``tw_iner``, stretch and bending at ``tc_offst``, torsion about ``sc_offst``.
Shear is rigid, which fixes the centre of torsion: if a shear centre is off the axis, the line of shear centres is used
as the blade's axis and the other centres are measured from it, as in BModes. Source: G. Bir, *User's Guide to BModes*,
NREL/TP-500-39133, 2005.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....core.blade import SHEAR_Y, SHEAR_Z, Blade, section_mass
from ....core.blade_checks import body_fault
from ..errors import CaseError, located
from .matrices import BEAMDYN, about, bending, in_axes, rigid, rotated, shearing
from .openfast.elastodyn import complete
from .source import OPENFAST_AXES, Mount, Reading, Source
from .text import Table, Text, first_numbers, fractions, integer, keys, load, path_named, table, value

Array = NDArray[np.float64]
Entries = dict[str, tuple[int, str]]

NAME = "BModes"
COLUMNS = (
    *("sec_loc", "str_tw", "tw_iner", "mass_den", "flp_iner", "edge_iner", "flp_stff"),
    *("edge_stff", "tor_stff", "axial_stff", "cg_offst", "sc_offst", "tc_offst"),
)
FACTORS = {
    "sec_mass_mult": "mass_den",
    "flp_iner_mult": "flp_iner",
    "lag_iner_mult": "edge_iner",
    "flp_stff_mult": "flp_stff",
    "edge_stff_mult": "edge_stff",
    "tor_stff_mult": "tor_stff",
    "axial_stff_mult": "axial_stff",
    "cg_offst_mult": "cg_offst",
    "sc_offst_mult": "sc_offst",
    "tc_offst_mult": "tc_offst",
}
ROOTS = {1: [np.inf] * 6, 4: [np.inf, np.inf, np.inf, np.inf, 0.0, 0.0]}
"""Root stiffness (6,) by hub_conn: 1 clamped, 4 pinned-free: flap and lag slopes are free."""


def matches_format(text: Text) -> bool:
    """Whether these are lines of a main file."""
    return {"hub_conn", "sec_props_file"} <= set(keys(text))


def read(path: Path, mount: Mount | None = None) -> Reading:
    """Read the blade of a BModes main file.

    Raises:
        CaseError: naming the file and line at fault.
    """
    main = load(path)
    entries = keys(main)
    if "beam_type" in entries and integer(main, entries, "beam_type") != 1:
        raise CaseError(
            f"{main.at(entries['beam_type'][0])}: beam_type: not 1: this is the file of a tower: give the file of "
            "a blade, or use `southwell modes`"
        )
    sections = section_table(main)
    text = sections.text
    sections.positive("mass_den", "flp_stff", "edge_stff", "tor_stff", "axial_stff")
    sections.positive("flp_iner", "edge_iner", zero=True)
    eta = fractions(sections, "sec_loc")
    by = {column: value(main, entries, factor) for factor, column in FACTORS.items()}
    p = {name: sections[name] * by.get(name, 1.0) for name in COLUMNS}

    tip, hub_radius = value(main, entries, "radius"), value(main, entries, "hub_rad")
    if tip <= hub_radius:
        raise CaseError(
            f"{main.at(entries['radius'][0])}: radius: {tip:g} m is not beyond hub_rad, {hub_radius:g} m: no blade between "
            "them; correct one"
        )
    file_mount = Mount(
        length=tip - hub_radius,
        hub_radius=hub_radius,
        precone=np.radians(value(main, entries, "precone")),
        pitch=-np.radians(value(main, entries, "bl_thp")),
    )
    mounted = complete(mount or Mount(), file_mount)
    y_mass, y_tension = -(p["cg_offst"] - p["sc_offst"]), -(p["tc_offst"] - p["sc_offst"])
    stretch = about(bending(p["axial_stff"], p["flp_stff"], p["edge_stff"]), y_tension, 0.0)
    inertia = rotated(
        section_mass(p["mass_den"], p["flp_iner"], p["edge_iner"]), np.radians(p["str_tw"] - p["tw_iner"])
    )
    with located(f"{text.path}: "):
        blade = Blade(
            name=path.stem,
            stations=eta * float(mounted.length or 0.0),
            stiffness=rigid(stretch + shearing(p["tor_stff"], 0.0, 0.0), SHEAR_Y, SHEAR_Z),
            mass=about(inertia, y_mass, 0.0),
            twist=-np.radians(p["str_tw"]),
            hub_radius=mounted.hub_radius or 0.0,
            precone=mounted.precone or 0.0,
            pitch=mounted.pitch or 0.0,
            tip_mass=_tip(main, entries),
            root=np.array(_root(main, entries)),
        )
    axes = f"{OPENFAST_AXES}; mass and tension centres off the axis along the section's y"
    factor = value(main, {"rpm_mult": (0, "1"), **entries}, "romg_mult", "rpm_mult")
    speed = value(main, entries, "rot_rpm", "romg") * factor * np.pi / 30
    return Reading(blade, Source(NAME, (path, text.path), axes, _notes(p, entries, main)), speed)


def section_table(main: Text) -> Table:
    """The table ``COLUMNS`` of the file that a main file names.

    Raises:
        CaseError: naming the file and line at fault.
    """
    text = load(path_named(main, "sec_props_file"))
    own = keys(text)
    count = integer(text, own, "n_secs")
    return table(text, first_numbers(text, own["n_secs"][0] + 1), count, COLUMNS)


def _notes(p: dict[str, Array], entries: Entries, main: Text) -> tuple[str, ...]:
    out = ["shear is rigid"]
    scaled = [f for f in FACTORS if value(main, entries, f) != 1]
    if scaled:
        out.append(f"multiplied: {', '.join(f'{f} = {value(main, entries, f):g}' for f in scaled)}")
    if "nselt" in entries:
        out.append(
            f"not used: BModes' own mesh (nselt = {entries['nselt'][1]}); here the mesh is refined to the accuracy, and "
            "frequencies that BModes prints with few elements differ by up to several per cent"
        )
    arm = value(main, entries, "cm_loc"), value(main, entries, "cm_axial")
    if any(arm) and any(value(main, entries, n) for n in ("ixx_tip", "iyy_tip", "izz_tip")):
        out.append(
            "moments of the tip mass are about the tip section's axes, as the file's comments say; BModes 3 itself takes them "
            "about the mass centre"
        )
    if p["sc_offst"].any():
        out.append("the line of shear centres is treated as the straight reference axis")
    return tuple(out)


def _root(main: Text, entries: Entries) -> list[float]:
    kind = integer(main, entries, "hub_conn")
    if kind not in ROOTS:
        raise CaseError(
            f"{main.at(entries['hub_conn'][0])}: hub_conn: {kind}: a blade needs a hub: give 1 (clamped) or 4 (pinned)"
        )
    return ROOTS[kind]


def _tip(main: Text, entries: Entries) -> Array:
    """The tip's rigid body (6, 6) about the axis, in section axes; BModes' moments are about the tip section's axes."""
    names = ("tip_mass", "cm_loc", "cm_axial", "ixx_tip", "iyy_tip", "izz_tip", "ixy_tip", "izx_tip", "iyz_tip")
    m, y, z, xx, yy, zz, xy, zx, yz = (value(main, entries, n) for n in names)
    cross = m * np.array([[0.0, -z, y], [z, 0.0, 0.0], [-y, 0.0, 0.0]])
    tensor = np.array([[xx, -xy, -zx], [-xy, yy, -yz], [-zx, -yz, zz]])
    tip = in_axes(np.block([[m * np.eye(3), -cross], [cross, tensor]]), BEAMDYN)
    if tip.any() and (fault := body_fault(tip, "kg")):
        raise CaseError(
            f"{main.at(entries['ixx_tip'][0])}: tip_mass, ixx_tip, iyy_tip, izz_tip: {fault}; moments of 0 leave out the tip's "
            "rotary inertia"
        )
    return tip
