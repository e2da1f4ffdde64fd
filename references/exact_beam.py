"""The rotating Kirchhoff beam in full: extensible, geometrically nonlinear, with rotary inertia; linearised exactly.

A straight untwisted blade at rest stretches, when it turns, to the radius r(s) of the section at arc length s, with stretch
λ = r′ and strain e = λ − 1. Its strain energy per rest length is ``½ (E A e² + G J φ′² + E I_y κ_y² + E I_z κ_z²)``,
with curvatures per rest length; sections stay normal to the axis (G. Kirchhoff, 1859; A. E. H. Love, *A Treatise on the
Mathematical Theory of Elasticity*, 4th ed. 1927, ch. XVIII; e as in E. Reissner, ZAMP 23 (1972) 795–804, without shear).

Steady state: ``N = E A (r′ − 1)``, ``N′ + m Ω² r = 0``, r = R at the root, N at the tip from the tip mass: linear in r, and
the only nonlinearity there is about a straight axis. Small motions (u, v, w) about it and torsion φ turn the section by
(φ, −β, θ), θ = v′/λ, β = w′/λ; to second order, with the moments of inertia I per length,

    2 V     = ∫ E A u′² + N/λ (v′² + w′²) + E I_z θ′² + E I_y β′² + G J φ′²
              − Ω² [m (u² + v²) + (I_x − I_z) β² + (I_y − I_z) φ²] ds
    2 T_kin = ∫ m (u̇² + v̇² + ẇ²) + I_z θ̇² + I_y β̇² + I_x φ̇² + 2 Ω [2 m u v̇ − (I_x + I_y − I_z) φ β̇] ds

the last two up to a total time derivative. So stretch goes with chordwise bending and torsion, by the inertia of the
sections alone, with flapwise bending. Spin softens the turning of a section out of the plane of rotation (β; φ by the
tennis racket's I_z − I_y), not in it: θ turns about the rotor's axis. E I and G J being constants, tension does not stiffen
torsion: a rod with such a diagonal stiffness has no trapeze effect, and neither has core.

Galerkin's method with the polynomials of ``spectral``, for u and φ of one degree less than for v and w.
"""

from time import perf_counter

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..core.blade import TORSION, Blade
from ..core.model import FULL
from ..core.modes import STATIONS, Modes
from .interface import Code, CodeError, Shares
from .ritz import ROTATION_X, X, Y, Z, apart, coupled_modes, integral, part, shape_of, skew, union
from .spectral import clamped, pinned
from .straight_beam import LEVELS, Line, line, refusal, refuse, version

Array = NDArray[np.float64]


def steady(blade: Blade, at: Line, omega: float, terms: int) -> tuple[Array, Array]:
    """Stretch λ (q,) of the steady state and its slope λ′ (q,), 1/m.

    Raises:
        CodeError: if the centrifugal force outgrows the axial stiffness, so that there is no steady state.
    """
    u, strain, bend = pinned(at.ends, terms, at.s)
    K = integral(at.weight * at.sections.EA, strain) - omega**2 * integral(at.mass, u)
    force = omega**2 * (u.T @ (at.mass * (blade.hub_radius + at.s)))
    try:
        q = scipy.linalg.solve(K, force, assume_a="pos")
    except np.linalg.LinAlgError as error:
        raise CodeError(
            f"steady stretch: none at {omega:g} rad/s, the centrifugal force outgrows the axial stiffness; lower the speed"
        ) from error
    return 1.0 + strain @ q, bend @ q


class Beam:
    """Functions and steady state of one blade at one speed, from which both its uncoupled problems are made."""

    def __init__(self, blade: Blade, omega: float, terms: int) -> None:
        self.at = line(blade, terms)
        self.omega = omega
        self.u, self.u_s, _ = pinned(self.at.ends, terms, self.at.s)
        self.v, v_s, v_ss = clamped(self.at.ends, terms, self.at.s)
        stretch, slope = steady(blade, self.at, omega, terms)
        stretch, slope = stretch[:, None], slope[:, None]
        self.turn = v_s / stretch
        self.curvature = v_ss / stretch - v_s * slope / stretch**2
        # ∫ N/λ v′², with N = E A (λ − 1)
        self.tense = integral(self.at.weight * self.at.sections.EA * ((stretch - 1) * stretch)[:, 0], self.turn)
        s = STATIONS * blade.length
        self.u_shape, self.v_shape = pinned(self.at.ends, terms, s)[0], clamped(self.at.ends, terms, s)[0]

    def in_plane(self) -> tuple[Array, Array, Array, Array]:
        """M, C, K of stretch and chordwise bending, and the shape (21, 4, n) of their coordinates."""
        at, omega = self.at, self.omega
        m_uu, m_vv = integral(at.mass, self.u), integral(at.mass, self.v)
        gyro = 2 * omega * integral(at.mass, self.v, self.u)
        M = apart(m_uu, m_vv + integral(at.I_z, self.turn))
        K = apart(
            integral(at.weight * at.sections.EA, self.u_s) - omega**2 * m_uu,
            integral(at.weight * at.sections.EI_z, self.curvature) + self.tense - omega**2 * m_vv,
        )
        return M, skew(gyro), K, shape_of([(X, self.u_shape), (Y, self.v_shape)])

    def out_of_plane(self, torsion: bool) -> tuple[Array, Array, Array, Array]:
        """The same of torsion, if wanted, and flapwise bending."""
        at, omega = self.at, self.omega
        M = integral(at.mass, self.v) + integral(at.I_y, self.turn)
        K = integral(at.weight * at.sections.EI_y, self.curvature) + self.tense
        K -= omega**2 * integral(at.I_x - at.I_z, self.turn)
        if not torsion:
            return M, np.zeros_like(M), K, shape_of([(Z, self.v_shape)])
        gyro = -omega * integral(at.I_x + at.I_y - at.I_z, self.turn, self.u)
        M = apart(integral(at.I_x, self.u), M)
        twisting = integral(at.weight * at.sections.GJ, self.u_s) + omega**2 * integral(at.I_z - at.I_y, self.u)
        K = apart(twisting, K)
        return M, skew(gyro), K, shape_of([(ROTATION_X, self.u_shape), (Z, self.v_shape)])


class ExactBeam:
    """The full beam: every effect of ``core.model``. Bending in both planes, stretching and torsional modes.

    Straight, untwisted, uncoupled and shear-rigid blades, uniform or varying along the span. Torsional modes are there if
    the sections have a polar moment of inertia and finite G J.
    """

    name = "exact-beam"
    title = "Exact extensible beam, spectral"
    shares: Shares = "nothing"
    model = FULL
    levels = LEVELS
    order = 0
    hint = ""

    def version(self) -> str | None:
        """Of this package."""
        return version()

    def unsupported(self, blade: Blade) -> str | None:
        """Why the blade is not this beam."""
        return refusal(blade, twist=False, stretch=True, tip_inertia=True)

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes with ``elements`` polynomials a field in each interval (see ``references.interface``).

        Raises:
            CodeError: also if there is no steady state, or no stable one, at this speed.
        """
        refuse(self.unsupported(blade))
        start = perf_counter()
        beam = Beam(blade, omega, elements)
        torsion = bool(beam.at.I_x.any() and np.isfinite(blade.stiffness[:, TORSION, TORSION]).all())
        problems = (beam.in_plane(), beam.out_of_plane(torsion))
        parts = [part(shape, *coupled_modes(M, C, K, count)) for M, C, K, shape in problems]
        return union(parts, omega, elements, count, perf_counter() - start)


CODE: Code = ExactBeam()
