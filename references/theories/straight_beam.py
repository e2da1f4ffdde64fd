"""Common to the closed forms: a straight blade at quadrature points, its tension, and the check for unsupported blades."""

from dataclasses import dataclass, replace
from importlib.metadata import version as installed

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

from ...core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, Blade, clamped, coupled, straight
from ..protocol.fingerprint import Fingerprint, of_points
from ..protocol.interface import BladeAdapter
from ..sampling import SampledSections, sample
from .spectral import gauss, intervals

Array = NDArray[np.float64]

LEVELS: tuple[int, ...] = (8, 16, 32)
"""Terms in each interval. For a uniform beam, per plane: 8 give mode 3 to 1e-6, 16 mode 5 to 1e-10, 32 mode 10 to rounding."""

MAX_INTERVALS = 8
"""Number of intervals above which fewer terms suffice in each: at least five, and twice as many at the finest level."""

EXTRA = 8
"""Gauss points in addition to those for polynomial integrands, for sines of the twist and quotients of the steady stretch."""


@dataclass(frozen=True)
class BeamPoints:
    """A straight blade at quadrature points; the last point is the tip and represents the tip mass.

    Attributes:
        ends: (k+1,) boundaries of the intervals within which all properties are smooth, m.
        s: (q,) arc lengths, m.
        weight: (q,) length that each point represents, m; 0 at the tip.
        sections: properties at ``s``.
        mass, I_x, I_y, I_z: (q,) lumped at each point, kg and kg m².
    """

    ends: Array
    s: Array
    weight: Array
    sections: SampledSections
    mass: Array
    I_x: Array
    I_y: Array
    I_z: Array


def terms(blade: Blade, level: int) -> int:
    """Polynomials in each interval at a level of refinement: ``level``, or fewer for a blade with many intervals."""
    if len(intervals(blade)) - 1 <= MAX_INTERVALS:
        return level
    return round(5.0 * np.sqrt(level / LEVELS[0]))


def line(blade: Blade, terms: int) -> BeamPoints:
    """The blade at the quadrature points for ``terms`` polynomials per interval."""
    ends = intervals(blade)
    s, weight = gauss(ends, terms + EXTRA)
    s, weight = np.append(s, blade.length), np.append(weight, 0.0)
    at = sample(blade, s)
    lumps = np.diagonal(blade.tip_mass)
    mass, I_x, I_y, I_z = (weight * per_length for per_length in (at.mass, at.I_x, at.I_y, at.I_z))
    for inertia, lump in zip((mass, I_x, I_y, I_z), (lumps[0], *lumps[3:]), strict=True):
        inertia[-1] = lump
    return BeamPoints(ends, s, weight, at, mass, I_x, I_y, I_z)


def tension(blade: Blade, s: Array) -> Array:
    """Centrifugal tension (q,) of the undeformed blade over Ω², kg m: ``∫ m (R + s) ds`` from ``s`` to the tip."""
    start, m = blade.stations[:-1], blade.mass[:, 0, 0]
    slope = np.diff(m) / np.diff(blade.stations)
    radius = blade.hub_radius + start
    moment = PPoly([slope, m[:-1] + slope * radius, m[:-1] * radius], blade.stations).antiderivative()
    return moment(blade.length) - moment(s) + blade.tip_mass[0, 0] * (blade.hub_radius + blade.length)


def refusal(blade: Blade, *, twist: bool, stretch: bool, tip_inertia: bool) -> str | None:
    """The reason why a blade is not a straight Euler–Bernoulli beam; None if it is.

    Args:
        blade: the blade.
        twist: whether the code supports twist and pitch.
        stretch: whether it needs a finite axial stiffness.
        tip_inertia: whether it supports a tip mass with moments of inertia.
    """
    rigid = {int(strain) for strain in np.argwhere(np.isinf(blade.stiffness))[:, 1]}
    lump = np.diagonal(blade.tip_mass)
    masses = np.diagonal(blade.mass, axis1=1, axis2=2)[:, :3]
    reasons: tuple[tuple[object, str], ...] = (
        (not clamped(blade), "the root is not clamped: this code supports a clamped root only"),
        (
            coupled(blade),
            "the sections couple (offset centres, or bend-twist); this code supports uncoupled ones",
        ),
        (not straight(blade), "the blade is prebent or swept; this code supports straight blades only"),
        (
            blade.precone != 0,
            f"precone {blade.precone:g} rad bends the steady state; this code supports no precone",
        ),
        (not twist and blade.twist.any(), "the blade is twisted; this code treats the two bending planes separately"),
        (
            not twist and blade.pitch != 0,
            f"pitch {blade.pitch:g} rad; this code treats the two bending planes separately",
        ),
        (
            not {SHEAR_Y, SHEAR_Z} <= rigid,
            "the sections are flexible in shear; this beam is rigid in shear (Euler–Bernoulli)",
        ),
        (rigid & {BEND_Y, BEND_Z}, "a bending stiffness is infinite; this beam bends in both planes"),
        (stretch and AXIAL in rigid, "the axial stiffness is infinite; this beam stretches"),
        (
            not all(np.allclose(m, m[..., :1], rtol=1e-12) for m in (masses, lump[:3])),
            "the mass differs with the direction of motion",
        ),
        (
            not np.allclose(blade.tip_mass, np.diag(lump), rtol=0, atol=1e-12 * lump.max()),
            "the tip mass is off the axis; this code supports a tip mass on the axis only",
        ),
        (
            not tip_inertia and lump[3:].any(),
            "the tip mass has moments of inertia; this code supports a point mass only",
        ),
    )
    return next((reason for applies, reason in reasons if applies), None)


class ClosedForm(BladeAdapter):
    """An adapter of this package's own series solution; its version is that of the package."""

    levels = LEVELS
    order = 0

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From the masses at the quadrature points of its integrals; see ``interface.BladeAdapter``."""
        at = line(blade, terms(blade, elements))
        position = np.zeros((len(at.s), 3))
        position[:, 0] = blade.hub_radius + at.s
        points = of_points(at.mass, position, elements)
        own = at.I_z.sum() if self.effects.rotary_inertia else at.I_z[-1]
        return replace(points, rotor_inertia=points.rotor_inertia + float(own))

    def version(self) -> str:
        """Version of this package, which needs no foreign code."""
        return f"southwell {installed('southwell')}"
