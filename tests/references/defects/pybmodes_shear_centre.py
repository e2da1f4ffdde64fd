"""pyBModes: a shear centre off the reference axis shifts the tension centre, but not the mass centre.

All of io/sec_props.py's offsets are from the reference axis. nondim_section_props (fem/nondim.py) subtracts
sc_offst from tc_offst but not from cg_offst, although the elements' axis is that of the shear centres. A non-rotating
uniform blade with all three centres 0.5 m off the axis is the blade without offsets, displaced as a whole, with the
same frequencies; moments of inertia are about the mass centre.
Needs: pybmodes, numpy.
"""

import tempfile
from importlib.metadata import version
from pathlib import Path

import numpy as np
from pybmodes.models import RotatingBlade

RADIUS, MASS, INERTIA = 60.0, 250.0, 150.0  # m, kg/m, kg m


def frequencies(cg, sc, tc):
    """Frequencies, Hz, of a non-rotating uniform blade with these offsets, m."""
    row = f"0 0 {MASS} {INERTIA} {INERTIA} 4e8 1e9 5e7 1e10 {cg} {sc} {tc}"
    ends = " ".join(f"{end:.4f}" for end in np.linspace(0, 1, 41))
    lines = ["====", "blade", "", "---- General", "f Echo", "1 beam_type", "0. rot_rpm", "1. rpm_mult"]
    lines += [
        f"{RADIUS} radius",
        "0. hub_rad",
        "0. precone",
        "0. bl_thp",
        "1 hub_conn",
        "20 modepr",
        "t Tab",
        "f mid",
        "",
    ]
    lines += ["---- Tip mass", *["0. -"] * 9, "", "---- Properties", "1 id_mat", "'sections.dat' sec_props_file", ""]
    lines += ["Scaling", *["1. -"] * 10, "", "---- Elements", "40 nselt", "ends", ends]
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "sections.dat").write_text(f"blade\n2 n_secs\n\nhead\nunits\n0. {row}\n1. {row}\n")
        path = Path(folder, "blade.bmi")
        path.write_text("\n".join(lines) + "\n")
        return RotatingBlade(path).run(6, check_model=False).frequencies


def main():
    print(f"pybmodes {version('pybmodes')}")
    expected, moved = frequencies(0.0, 0.0, 0.0), frequencies(0.5, 0.5, 0.5)
    for k, (found, plain) in enumerate(zip(moved, expected, strict=True)):
        print(f"mode {k + 1}: {found:.4f} Hz with all centres 0.5 m off the axis (expected {plain:.4f})")
    print("defect:", "present" if np.abs(moved / expected - 1).max() > 1e-3 else "gone")


if __name__ == "__main__":
    main()
