"""pyBModes: names of modes use sums of squared lengths and angles, so an almost pure flap mode is called torsion.

campbell_sweep names a mode by the largest of Σ flap², Σ edge², Σ twist² (campbell/_classify.py, _participation;
likewise elastodyn/params.py, _kinetic_participation, called kinetic energy there): displacements in tip radii, twist in
radians. Kinetic energy weighs displacements by the mass and the twist by the polar inertia. Here mass centres lie 0.1 m
off.
Needs: pybmodes, numpy.
"""

import tempfile
from importlib.metadata import version
from pathlib import Path

import numpy as np
from pybmodes.campbell import campbell_sweep
from pybmodes.models import RotatingBlade

RADIUS, MASS, INERTIA = 60.0, 250.0, 300.0  # m, kg/m, kg m
FAMILIES = ("flap", "edge", "torsion")


def write(folder):
    """Write an input file and its section table; return its path. A uniform blade, mass centres 0.1 m off the axis."""
    row = f"0 0 {MASS} {INERTIA / 2} {INERTIA / 2} 4e8 1e9 5e7 1e10 0.1 0 0"
    (folder / "sections.dat").write_text(f"blade\n2 n_secs\n\nhead\nunits\n0. {row}\n1. {row}\n")
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
        "f mid_tw",
        "",
    ]
    lines += ["---- Tip mass", *["0. -"] * 9, "", "---- Properties", "1 id_mat"]
    lines += [
        "'sections.dat' sec_props_file",
        "",
        "Scaling",
        *["1. -"] * 10,
        "",
        "---- Elements",
        "40 nselt",
        "ends",
        ends,
    ]
    path = folder / "blade.bmi"
    path.write_text("\n".join(lines) + "\n")
    return path


def energies(shape):
    """Fractions of the kinetic energy in flap, edge and torsion, without coupling terms."""
    weight = np.gradient(shape.span_loc)
    parts = ((MASS * RADIUS**2, shape.flap_disp), (MASS * RADIUS**2, shape.lag_disp), (INERTIA, shape.twist))
    energy = np.array([inertia * (weight * motion**2).sum() for inertia, motion in parts])
    return energy / energy.sum()


def main():
    print(f"pybmodes {version('pybmodes')}")
    misnamed = 0
    with tempfile.TemporaryDirectory() as folder:
        path = write(Path(folder))
        result = RotatingBlade(path).run(6, check_model=False)
        labels = campbell_sweep(path, np.array([0.0, 1.0]), n_blade_modes=6).labels
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
