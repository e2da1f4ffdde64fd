"""A uniform blade as the input file and section table of pyBModes, for the scripts beside this file."""

import tempfile
from pathlib import Path

import numpy as np

ELEMENTS = 40

MAIN = """====
blade

---- General
f Echo
1 beam_type
{rpm!r} rot_rpm
1. rpm_mult
{radius!r} radius
0. hub_rad
0. precone
0. bl_thp
1 hub_conn
20 modepr
t Tab
f mid_tw

---- Tip mass
{tip!r} tip_mass
{rows}

---- Properties
1 id_mat
'sections.dat' sec_props_file

Scaling
{scaling}

---- Elements
{elements} nselt
ends
{ends}
"""


def run(solve, radius, row, rpm=0.0, tip=0.0):
    """``solve(path)`` of the input file of a blade.

    ``row`` has the twelve numbers of a section after its position: twist, twist of the inertia, mass, inertia in flap and
    edge, stiffness in flap, edge, torsion and stretch, offsets of mass, shear and tension centre. ``tip``: mass, kg.
    """
    numbers = " ".join(map(str, row))
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "sections.dat").write_text(f"blade\n2 n_secs\n\nhead\nunits\n0. {numbers}\n1. {numbers}\n")
        text = MAIN.format(
            rpm=float(rpm),
            radius=float(radius),
            tip=float(tip),
            rows="\n".join(["0. -"] * 8),
            scaling="\n".join(["1. -"] * 10),
            elements=ELEMENTS,
            ends=" ".join(f"{end:.4f}" for end in np.linspace(0, 1, ELEMENTS + 1)),
        )
        path = Path(folder, "blade.bmi")
        path.write_text(text)
        return solve(path)
