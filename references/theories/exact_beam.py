"""The complete rotating Kirchhoff beam: extensible, geometrically nonlinear, with rotary inertia; linearised exactly.

In rotation a straight untwisted blade stretches: the section at arc length s moves to the radius r(s), with stretch λ =
r′ and strain e = λ − 1. Its strain energy per undeformed length is ``½ (E A e² + G J φ′² + E I_y κ_y² + E I_z κ_z²)``,
with curvatures per undeformed length; sections stay normal to the axis (G. Kirchhoff, 1859; A. E. H. Love, *A Treatise
on the Mathematical Theory of Elasticity*, 4th ed. 1927, ch. XVIII; e as in E. Reissner, ZAMP 23 (1972) 795–804, without shear).

Steady state: ``N = E A (r′ − 1)``, ``N′ + m Ω² r = 0``, r = R at the root, N at the tip from the tip mass: linear in r,
and the only nonlinear effect on a straight axis. Small motions (u, v, w) about it and torsion φ turn the section by
(φ, −β, θ), θ = v′/λ, β = w′/λ; to second order, with the moments of inertia I per length,

    2 V     = ∫ E A u′² + N/λ (v′² + w′²) + E I_z θ′² + E I_y β′² + G J φ′²
              − Ω² [m (u² + v²) + (I_x − I_z) β² + (I_y − I_z) φ²] ds
    2 T_kin = ∫ m (u̇² + v̇² + ẇ²) + I_z θ̇² + I_y β̇² + I_x φ̇² + 2 Ω [2 m u v̇ − (I_x + I_y − I_z) φ β̇] ds

the last two up to a total time derivative. Stretch couples with edgewise bending. Torsion couples with flapwise
bending, only through the inertia of the sections. Spin softening affects rotations of a section out of the plane of
rotation (β; φ by the tennis racket term I_z − I_y), but not in it: θ is about the rotor's axis. Since E I and G J are
constant, tension does not stiffen torsion: a rod with such a diagonal stiffness has no trapeze effect, and neither has core.

The solution is by Galerkin's method with the polynomials of ``spectral``, for u and φ of one degree less than for v and w.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ...core.blade import TORSION, Blade
from ...core.effects import ALL_EFFECTS
from ...core.modes import STATIONS, Modes
from ..protocol.interface import CodeError, Independence
from .ritz import ROTATION_X, X, Y, Z, apart, coupled_modes, integral, part, shape_of, skew, union
from .spectral import clamped_functions, pinned_functions
from .straight_beam import BeamPoints, ClosedForm, line, refusal, terms

Array = NDArray[np.float64]


def steady_stretch(blade: Blade, at: BeamPoints, omega: float, terms: int) -> tuple[Array, Array]:
    """Stretch λ (q,) of the steady state and its slope λ′ (q,), 1/m.

    Raises:
        CodeError: if the centrifugal force exceeds the axial stiffness, so that no steady state exists.
    """
    u, strain, bend = pinned_functions(at.ends, terms, at.s)
    K = integral(at.weight * at.sections.EA, strain) - omega**2 * integral(at.mass, u)
    force = omega**2 * (u.T @ (at.mass * (blade.hub_radius + at.s)))
    try:
        q = scipy.linalg.solve(K, force, assume_a="pos")
    except np.linalg.LinAlgError as error:
        raise CodeError(
            f"no steady stretch at {omega:g} rad/s: the centrifugal force exceeds the axial stiffness; lower the speed"
        ) from error
    return 1.0 + strain @ q, bend @ q


@dataclass(frozen=True)
class Beam:
    """A blade at one speed: shape functions at the quadrature points, about the steady state.

    Attributes:
        at: the blade at those points.
        omega: rotor speed, rad/s.
        u, u_s: (q, n) functions for stretch and torsion, and their slopes.
        v: (q, n) functions for bending.
        tilt: (q, n) rotation of the section for each function v, v′/λ.
        curvature: (q, n) derivative of ``tilt``.
        tense: (n, n) stiffness due to the steady tension, ``∫ N/λ v′²``.
        u_shape, v_shape: (21, n) the functions at ``core.modes.STATIONS``.
    """

    at: BeamPoints
    omega: float
    u: Array
    u_s: Array
    v: Array
    tilt: Array
    curvature: Array
    tense: Array
    u_shape: Array
    v_shape: Array


def stretched(blade: Blade, omega: float, terms: int) -> Beam:
    """The blade at ``omega`` (rad/s) with ``terms`` polynomials per field in each interval.

    Raises:
        CodeError: if no steady state exists.
    """
    at = line(blade, terms)
    u, u_s, _ = pinned_functions(at.ends, terms, at.s)
    v, v_s, v_ss = clamped_functions(at.ends, terms, at.s)
    stretch, slope = steady_stretch(blade, at, omega, terms)
    tilt = v_s / stretch[:, None]
    where = STATIONS * blade.length
    return Beam(
        at=at,
        omega=omega,
        u=u,
        u_s=u_s,
        v=v,
        tilt=tilt,
        curvature=(v_ss - tilt * slope[:, None]) / stretch[:, None],
        tense=integral(at.weight * at.sections.EA * (stretch - 1) * stretch, tilt),  # N = E A (λ − 1)
        u_shape=pinned_functions(at.ends, terms, where)[0],
        v_shape=clamped_functions(at.ends, terms, where)[0],
    )


Problem = tuple[Array, Array, Array, Array]
"""M, C, K (n, n) and the shape (21, 4, n) of the coordinates."""


def in_plane(beam: Beam) -> Problem:
    """Stretch and edgewise bending."""
    at, square = beam.at, beam.omega**2
    m_uu, m_vv = integral(at.mass, beam.u), integral(at.mass, beam.v)
    M = apart(m_uu, m_vv + integral(at.I_z, beam.tilt))
    C = skew(2 * beam.omega * integral(at.mass, beam.v, beam.u))
    K = apart(
        integral(at.weight * at.sections.EA, beam.u_s) - square * m_uu,
        integral(at.weight * at.sections.EI_z, beam.curvature) + beam.tense - square * m_vv,
    )
    return M, C, K, shape_of([(X, beam.u_shape), (Y, beam.v_shape)])


def out_of_plane(beam: Beam, torsion: bool) -> Problem:
    """Flapwise bending, and torsion if requested."""
    at, square = beam.at, beam.omega**2
    M = integral(at.mass, beam.v) + integral(at.I_y, beam.tilt)
    K = (
        integral(at.weight * at.sections.EI_y, beam.curvature)
        + beam.tense
        - square * integral(at.I_x - at.I_z, beam.tilt)
    )
    if not torsion:
        return M, np.zeros_like(M), K, shape_of([(Z, beam.v_shape)])
    twisting = integral(at.weight * at.sections.GJ, beam.u_s) + square * integral(at.I_z - at.I_y, beam.u)
    C = skew(-beam.omega * integral(at.I_x + at.I_y - at.I_z, beam.tilt, beam.u))
    shape = shape_of([(ROTATION_X, beam.u_shape), (Z, beam.v_shape)])
    return apart(integral(at.I_x, beam.u), M), C, apart(twisting, K), shape


class ExactBeam(ClosedForm):
    """The beam with every effect of ``core.effects``: modes of bending in both planes, stretch and torsion.

    Straight, untwisted, uncoupled and shear-rigid blades, uniform or varying along the span. Torsional modes exist if
    the sections have a polar moment of inertia and finite G J.
    """

    name = "exact-beam"
    title = "Exact extensible beam, spectral"
    independence = Independence("Southwell's Ritz method", "Kirchhoff rod", "exact-beam")
    effects = ALL_EFFECTS

    def unsupported(self, blade: Blade) -> str | None:
        """The reason why the blade is outside this theory; None if it is not."""
        return refusal(blade, twist=False, stretch=True, tip_inertia=True)

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes with ``elements`` polynomials per field in each interval (see ``protocol.interface``).

        Raises:
            CodeError: unsupported blade, or no stable steady state at this speed.
        """
        beam = stretched(blade, omega, terms(blade, elements))
        torsion = bool(beam.at.I_x.any() and np.isfinite(blade.stiffness[:, TORSION, TORSION]).all())
        problems = (in_plane(beam), out_of_plane(beam, torsion))
        parts = [part(shape, *coupled_modes(M, C, K, count)) for M, C, K, shape in problems]
        return union(parts, omega, elements, count)


CODE = ExactBeam()
