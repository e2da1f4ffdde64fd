"""pyBModes: in rotation, a mass at the tip causes neither tension nor spin softening.

First flapwise frequency of a uniform beam with a tip mass equal to its mass and zero hub radius, in units of
sqrt(EI / m L^4), at zero speed and at rotor speeds in the same unit. Expected: Ritz's method with the exact tension,
below; at speed 4 G. S. Bir, NREL/CP-500-47953 (2010), Table 5, has 4.543.
Needs: pybmodes, numpy, and pybmodes_blade.py beside it.
"""

from importlib.metadata import version

import numpy as np
from numpy.polynomial import Polynomial
from pybmodes.models import RotatingBlade
from pybmodes_blade import run

RADIUS, MASS, EI = 60.0, 250.0, 4e8  # m, kg/m, N m²
ROW = (0, 0, MASS, 150.0, 150.0, EI, 2.5 * EI, 5e7, 1e10, 0, 0, 0)


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
        rpm = speed * unit * 30 / np.pi
        result = run(lambda path: RotatingBlade(path).run(4, check_model=False), RADIUS, ROW, rpm, tip=MASS * RADIUS)
        flap = next(
            f for f, s in zip(result.frequencies, result.shapes, strict=True) if np.abs(s.flap_disp).max() > 1e-6
        )
        computed = 2 * np.pi * flap / unit
        print(f"speed {speed:4g}: {computed:.4f} (expected {expected(speed):.4f})")
        worst = max(worst, abs(computed / expected(speed) - 1))
    print("defect:", "present" if worst > 1e-3 else "gone")


if __name__ == "__main__":
    main()
