"""pyBModes: a shear centre off the reference axis shifts the tension centre, but not the mass centre.

All of io/sec_props.py's offsets are from the reference axis. nondim_section_props (fem/nondim.py) subtracts
sc_offst from tc_offst but not from cg_offst, although the elements' axis is that of the shear centres. A non-rotating
uniform blade with all three centres 0.5 m off the axis is the blade without offsets, displaced as a whole, with the
same frequencies; moments of inertia are about the mass centre.
Needs: pybmodes, numpy, and pybmodes_blade.py beside it.
"""

from importlib.metadata import version

import numpy as np
from pybmodes.models import RotatingBlade
from pybmodes_blade import run

RADIUS, MASS, INERTIA = 60.0, 250.0, 150.0  # m, kg/m, kg m


def frequencies(cg, sc, tc):
    """Frequencies, Hz, of a non-rotating uniform blade with these offsets, m."""
    row = (0, 0, MASS, INERTIA, INERTIA, 4e8, 1e9, 5e7, 1e10, cg, sc, tc)
    return run(lambda path: RotatingBlade(path).run(6, check_model=False).frequencies, RADIUS, row)


def main():
    print(f"pybmodes {version('pybmodes')}")
    expected, moved = frequencies(0.0, 0.0, 0.0), frequencies(0.5, 0.5, 0.5)
    for k, (result, plain) in enumerate(zip(moved, expected, strict=True)):
        print(f"mode {k + 1}: {result:.4f} Hz with all centres 0.5 m off the axis (expected {plain:.4f})")
    print("defect:", "present" if np.abs(moved / expected - 1).max() > 1e-3 else "gone")


if __name__ == "__main__":
    main()
