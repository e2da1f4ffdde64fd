"""pyBModes: in rotation, a mass at the tip causes neither tension nor spin softening.

First flapwise frequency of a uniform beam with a tip mass equal to its mass and zero hub radius, in units of
sqrt(EI / m L^4), at zero speed and at rotor speeds in the same unit. Expected: Ritz's method with the exact tension,
below; at speed 4 G. S. Bir, NREL/CP-500-47953 (2010), Table 5, has 4.543.
Needs: pybmodes, numpy.
"""

import tempfile
from importlib.metadata import version
from pathlib import Path

import numpy as np
from numpy.polynomial import Polynomial
from pybmodes.models import RotatingBlade

RADIUS, MASS, EI = 60.0, 250.0, 4e8  # m, kg/m, N m²


def write(folder, rpm):
    """Write an input file and its section table; return its path. A uniform blade with its mass again at the tip."""
    row = f"0 0 {MASS} 150. 150. {EI} {2.5 * EI} 5e7 1e10 0 0 0"
    (folder / "sections.dat").write_text(f"blade\n2 n_secs\n\nhead\nunits\n0. {row}\n1. {row}\n")
    ends = " ".join(f"{end:.4f}" for end in np.linspace(0, 1, 41))
    lines = ["====", "blade", "", "---- General", "f Echo", "1 beam_type", f"{rpm!r} rot_rpm", "1. rpm_mult"]
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
    lines += ["---- Tip mass", f"{MASS * RADIUS} tip_mass", *["0. -"] * 8, "", "---- Properties", "1 id_mat"]
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


def expected(speed):
    """Lowest frequency by polynomials x² … x⁹; x, EI, m and L are 1, the tension is speed² ((1 − x²)/2 + 1)."""
    shapes = [Polynomial([0] * k + [1]) for k in range(2, 10)]
    tension = speed**2 * Polynomial([1.5, 0, -0.5])

    def integral(p):
        return p.integ()(1.0) - p.integ()(0.0)

    mass = np.array([[integral(p * q) + p(1.0) * q(1.0) for q in shapes] for p in shapes])
    stiffness = np.array(
        [[integral(p.deriv(2) * q.deriv(2) + tension * p.deriv() * q.deriv()) for q in shapes] for p in shapes]
    )
    return np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real.min())


def main():
    print(f"pybmodes {version('pybmodes')}")
    worst = 0.0
    unit = np.sqrt(EI / MASS) / RADIUS**2
    for speed in (0.0, 4.0, 12.0):
        with tempfile.TemporaryDirectory() as folder:
            path = write(Path(folder), float(speed * unit * 30 / np.pi))
            result = RotatingBlade(path).run(4, check_model=False)
        flap = next(
            f for f, s in zip(result.frequencies, result.shapes, strict=True) if np.abs(s.flap_disp).max() > 1e-6
        )
        found = 2 * np.pi * flap / unit
        print(f"speed {speed:4g}: {found:.4f} (expected {expected(speed):.4f})")
        worst = max(worst, abs(found / expected(speed) - 1))
    print("defect:", "present" if worst > 1e-3 else "gone")


if __name__ == "__main__":
    main()
