"""pyBModes's input file and section table of a blade."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ..sampling import sample

Array = NDArray[np.float64]

MAIN = """==== pyBModes main input file ====
{name}

---- General parameters ----
f  Echo
1  beam_type  1: blade
{rpm!r}  rot_rpm
1.0  rpm_mult
{radius!r}  radius  of the tip, m
{hub!r}  hub_rad  m
0.0  precone  deg
0.0  bl_thp  deg
1  hub_conn  1: clamped
{count}  modepr
t  TabDelim
f  mid_node_tw

---- Tip mass ----
{tip}

---- Distributed-property identifiers ----
1  id_mat  1: isotropic
'sections.dat'  sec_props_file

Property scaling factors
{scaling}

---- Finite element discretization ----
{elements}  nselt
Ends of the elements over the blade's length
{ends}
"""

TABLE = """{name}
{count}  n_secs

sec_loc str_tw tw_iner mass_den flp_iner edge_iner flp_stff edge_stff tor_stff axial_stff cg_offst sc_offst tc_offst
(-) (deg) (deg) (kg/m) (kg-m) (kg-m) (Nm^2) (Nm^2) (Nm^2) (N) (m) (m) (m)
{rows}
"""


def write(folder: Path, blade: Blade, omega: float, s: Array, count: int) -> Path:
    """Write the input file, and the section table in the same folder; return the path of the input file.

    pyBModes's axes: v and w are y and z here, and twist has the opposite sign. Its polar inertia is the sum of a
    section's two inertias, and spin softening depends on their difference; they are chosen to match both values of the blade.
    """
    at = sample(blade, blade.stations)
    difference = at.I_z - at.I_y
    zeros = np.zeros(len(blade.stations))
    angle = -np.degrees(at.twist + blade.pitch)
    flap, edge = (at.I_x - difference) / 2, (at.I_x + difference) / 2
    columns = (
        *(blade.stations / blade.length, angle, angle, at.mass, flap, edge),
        *(at.EI_y, at.EI_z, at.GJ, at.EA, zeros, zeros, zeros),
    )
    rows = "\n".join(" ".join(f"{v:.17g}" for v in row) for row in zip(*columns, strict=True))
    table = TABLE.format(name=blade.name, count=len(blade.stations), rows=rows)
    (folder / "sections.dat").write_text(table, encoding="latin-1", errors="replace")
    main = MAIN.format(
        name=blade.name,
        rpm=float(omega) * 30 / np.pi,
        radius=float(blade.hub_radius + blade.length),
        hub=float(blade.hub_radius),
        count=count,
        tip="\n".join(["0.0  -"] * 9),
        scaling="\n".join(["1.0  -"] * 10),
        elements=len(s) - 1,
        ends=" ".join(f"{v:.17g}" for v in s / blade.length),
    )
    path = folder / "blade.bmi"
    path.write_text(main, encoding="latin-1", errors="replace")
    return path
