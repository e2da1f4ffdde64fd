"""pyBModes: names of modes use sums of squared lengths and angles, so an almost pure flap mode is called torsion.

campbell_sweep names a mode by the largest of Σ flap², Σ edge², Σ twist² (campbell/_classify.py, _participation;
likewise elastodyn/params.py, _kinetic_participation, called kinetic energy there): displacements in tip radii, twist in
radians. Kinetic energy weighs displacements by the mass and the twist by the polar inertia. Here mass centres lie 0.1 m
off.
Needs: pybmodes, numpy, and pybmodes_blade.py beside it.
"""

from importlib.metadata import version

import numpy as np
from pybmodes.campbell import campbell_sweep
from pybmodes.models import RotatingBlade
from pybmodes_blade import run

RADIUS, MASS, INERTIA = 60.0, 250.0, 300.0  # m, kg/m, kg m
ROW = (0, 0, MASS, INERTIA / 2, INERTIA / 2, 4e8, 1e9, 5e7, 1e10, 0.1, 0, 0)
FAMILIES = ("flap", "edge", "torsion")


def solve(path):
    """Modes of an input file, and pyBModes' names of them."""
    labels = campbell_sweep(path, np.array([0.0, 1.0]), n_blade_modes=6).labels
    return RotatingBlade(path).run(6, check_model=False), labels


def energies(shape):
    """Fractions of the kinetic energy in flap, edge and torsion, without coupling terms."""
    weight = np.gradient(shape.span_loc)
    parts = ((MASS * RADIUS**2, shape.flap_disp), (MASS * RADIUS**2, shape.lag_disp), (INERTIA, shape.twist))
    energy = np.array([inertia * (weight * motion**2).sum() for inertia, motion in parts])
    return energy / energy.sum()


def main():
    print(f"pybmodes {version('pybmodes')}")
    misnamed = 0
    result, labels = run(solve, RADIUS, ROW)
    for frequency, shape, label in zip(result.frequencies, result.shapes, labels, strict=False):
        share = energies(shape)
        family = FAMILIES[int(share.argmax())]
        misnamed += family not in label
        flap, edge, torsion = 100 * share
        print(f"{frequency:.3f} Hz  {label:12}  energy {flap:5.1f} % flap {edge:5.1f} % edge {torsion:5.1f} % torsion")
    print("expected: each named after its largest share of energy")
    print("defect:", "present" if misnamed else "gone")


if __name__ == "__main__":
    main()
