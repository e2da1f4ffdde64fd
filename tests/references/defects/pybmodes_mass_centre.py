"""pyBModes: with mass centres off the axis, the steady moment of a rotating blade does not couple flap with torsion.

The centrifugal force of mass centres off the axis bends the blade steadily in its stiff plane. For a section that
rotates by phi, this moment M adds (1 - EI_flap / EI_edge) M phi w'' to the energy, which is of the size of the term in
x phi w' in _element_matrices_batch (fem/element.py). Without it results are right at zero speed, and nearly so if both
stiffnesses are equal. Expected: Ritz's method below with the energy of finite motion (rotations by Cayley's formula)
about the steady state from Newton's method, also without the Coriolis force.
Needs: pybmodes, numpy, and pybmodes_blade.py beside it.
"""

from importlib.metadata import version

import numpy as np
from pybmodes.models import RotatingBlade
from pybmodes_blade import run

RADIUS, MASS, FLAP, EI, GJ, EA = 10.0, 10.0, 0.001, 1e4, 2e3, 1e8  # m, kg/m, kg m, N m², N m², N
OFFSET, EDGE = 0.05, 0.02  # m; kg m, about the mass centre


class Exact:
    """The beam in finite motion by Ritz's method: Cayley rotation vectors and stretch are polynomials of the span."""

    def __init__(self, speed, edge_stiffness, terms=8):
        x, w = (0.5 * v for v in np.polynomial.legendre.leggauss(16))
        self.x, self.w, self.speed, self.edge, self.n = (x + 0.5) * RADIUS, w * RADIUS, speed, edge_stiffness, terms
        k = np.arange(1, 17)[:, None]
        powers = ((x + 0.5) ** k) * RADIUS / k
        self.integral = np.linalg.solve(
            (x + 0.5) ** (k - 1), powers
        ).T  # values of a polynomial to its integral from the root
        k = k[:terms]
        self.turn, self.slope = (x + 0.5) ** k, k * (x + 0.5) ** (k - 1) / RADIUS

    def motion(self, q):
        """Sections' axes (16, 3, 3), curvatures (16, 3), stretch (16,), mass centres (16, 3)."""
        q = q.reshape(4, self.n)
        p, dp = (q[:3] @ self.turn).T, (q[:3] @ self.slope).T
        S = np.cross(np.eye(3), p[:, None])
        share = 1 + (p**2).sum(1) / 4
        R = np.eye(3) + (S + S @ S / 2) / share[:, None, None]
        stretch = q[3] @ self.slope * RADIUS
        place = self.integral @ ((1 + stretch)[:, None] * R[:, :, 0])
        return R, (dp - np.cross(p, dp) / 2) / share[:, None], stretch, place + OFFSET * R[:, :, 1]

    def energy(self, q):
        """Strain energy minus half the speed squared times the moment of inertia about the rotor's axis."""
        R, bend, stretch, centre = self.motion(q)
        strain = EA * stretch**2 + bend**2 @ np.array([GJ, EI, self.edge])
        inertia = ((v[:, :2] ** 2).sum(1) for v in (centre, R[:, :, 1], R[:, :, 2]))
        return (
            self.w @ (strain - self.speed**2 * sum(m * i for m, i in zip((MASS, EDGE, FLAP), inertia, strict=True))) / 2
        )

    def gradient(self, q):
        """Gradient by complex steps, exact."""
        return np.array([self.energy(q + 1e-30j * e).imag for e in np.eye(len(q))]) / 1e-30

    def hessian(self, q, h=1e-6):
        """Hessian by central differences."""
        H = np.array([self.gradient(q + h * e) - self.gradient(q - h * e) for e in np.eye(len(q))]) / (2 * h)
        return (H + H.T) / 2

    def frequencies(self):
        """Frequencies, rad/s, ascending, about the steady state."""
        q = np.zeros(4 * self.n)
        for _ in range(4):
            q = q - np.linalg.solve(self.hessian(q), self.gradient(q))
        rows = []
        for e in np.eye(len(q)):
            R, _, _, centre = self.motion(q + 1e-30j * e)
            moved = ((m, v.imag / 1e-30) for m, v in ((MASS, centre), (EDGE, R[:, :, 1]), (FLAP, R[:, :, 2])))
            rows.append(np.concatenate([(np.sqrt(m * self.w)[:, None] * v).ravel() for m, v in moved]))
        rows = np.array(rows)
        return np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(rows @ rows.T, self.hessian(q))).real))


def main():
    print(f"pybmodes {version('pybmodes')}")
    worst = {}
    for rpm, ratio in ((0.0, 16.0), (60.0, 1.0), (60.0, 4.0), (60.0, 16.0)):
        row = (
            0,
            0,
            MASS,
            FLAP,
            EDGE + MASS * OFFSET**2,
            EI,
            ratio * EI,
            GJ,
            EA,
            -OFFSET,
            0,
            0,
        )  # inertia about the axis
        result = run(lambda path: RotatingBlade(path).run(8, check_model=False).frequencies[:5], RADIUS, row, rpm)
        expected = Exact(rpm * np.pi / 30, ratio * EI).frequencies()[:5] / (2 * np.pi)
        off = np.abs(result / expected - 1)
        worst[rpm, ratio] = off.max()
        k = int(off.argmax())
        print(
            f"{rpm:2g} rpm, EI_edge = {ratio:2g} EI_flap: five modes within {off[k]:.2%}, "
            f"the worst {result[k]:.4f} Hz (expected {expected[k]:.4f})"
        )
    print("defect:", "present" if worst[60.0, 16.0] > 0.01 > 4 * worst[0.0, 16.0] else "gone")


if __name__ == "__main__":
    main()
