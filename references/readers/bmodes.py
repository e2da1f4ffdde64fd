"""BModes' main file and section table, read by pyBModes.

Offsets are along the section's chord towards the leading edge being negative (y to the trailing edge). With rigid shear the
line of shear centres is the axis of torsion, about which all offsets are taken. Source: G. Bir, *User's Guide to BModes*,
NREL/TP-500-39133, 2005.
"""

from math import radians
from pathlib import Path
from typing import Any

import numpy as np

from . import sections
from .stations import ReadingOptions, Stations, parser, straight


def read(path: Path, options: ReadingOptions) -> Stations:
    """The stations of a main file and its section table.

    Raises:
        NotReadError: if pyBModes is not installed.
    """

    def imported() -> Any:
        from pybmodes.io import bmi, sec_props

        return bmi, sec_props

    (bmi, sec_props), reader = parser("pybmodes", imported)
    main = bmi.read_bmi(path)
    table = sec_props.read_sec_props(main.resolve_sec_props_path())
    by = main.scaling
    s = table.span_loc / table.span_loc[-1] * (options.length or main.radius - main.hub_rad)
    # towards the leading edge: minus BModes' y
    ahead_mass, ahead_tension = (
        by.sc_offst * table.sc_offst - scale * values
        for scale, values in ((by.cg_offst, table.cg_offst), (by.tc_offst, table.tc_offst))
    )
    m = by.sec_mass * table.mass_den
    zz, yy = by.flp_iner * table.flp_iner, by.lag_iner * table.edge_iner
    angle = np.radians(table.str_tw - table.tw_iner)
    c, sine = np.cos(angle), np.sin(angle)
    # principal second moments about the mass centre, in axes rotated by the angle from y towards z
    about_centre = (yy * c**2 + zz * sine**2, yy * sine**2 + zz * c**2, (yy - zz) * sine * c)
    tension = sections.energy(
        sections.strains(ahead_tension, 0.0, 0.0),
        sections.diagonal(
            *(by.axial_stff * table.axial_stff, 0.0, 0.0, by.tor_stff * table.tor_stff),
            *(by.flp_stff * table.flp_stff, by.edge_stff * table.edge_stff),
        ),
    )
    return Stations(
        reader,
        s,
        sections.rigid(tension, 1, 2),
        sections.mass(m, ahead_mass, 0.0, about_centre[0] + m * ahead_mass**2, about_centre[1], about_centre[2]),
        -np.radians(table.str_tw),
        straight(s),
        {
            "hub_radius": main.hub_rad,
            "precone": radians(main.precone),
            "pitch": radians(-main.bl_thp),
            "tip_mass": main.tip_mass.mass,
        },
    )
