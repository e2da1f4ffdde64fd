"""The description of a blade that every code receives.

Axes, defined here and converted by each adapter (right-handed, all rotating with the hub):

* ``x`` runs along the blade, from the hub's centre outwards;
* ``z`` is the rotor's axis: the rotor rotates at ``omega`` about ``+z``;
* ``y = z × x`` lies in the plane of rotation, in the direction of motion.

Motion along ``y`` (bending about ``z``) is edgewise (chordwise, lag); motion along ``z`` (bending about ``y``) is
flapwise. Section axes are the blade axes rotated by ``twist`` about ``x`` (right-handed: from ``y`` towards ``z``).

Strains and velocities are ordered ``(axial x, shear y, shear z, torsion x, bending about y, bending about z)``;
forces are ordered ``(Fx, Fy, Fz, Mx, My, Mz)``, all at the reference curve. SI units and radians throughout.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .blade_checks import ROOT_TOLERANCE, check_blade
from .blade_checks import BladeError as BladeError
from .space.inertia import about_centre
from .space.spatial import skew

Array = NDArray[np.float64]

AXIAL, SHEAR_Y, SHEAR_Z, TORSION, BEND_Y, BEND_Z = range(6)

COUPLING_ROUNDING = 1e-12
"""Largest off-diagonal entry, of a matrix scaled to a unit diagonal, that counts as rounding."""


@dataclass(frozen=True, repr=False)
class Blade:
    """A rotating blade on its hub; properties vary linearly between stations.

    Attributes:
        name: label in tables.
        stations: (n,) arc length along the reference curve from the root, m; strictly increasing from 0 (a first station
            within rounding of 0 is set to 0).
        stiffness: (n, 6, 6) section stiffness in section axes, N, N m, N m²; ``inf`` on the diagonal marks a rigid strain
            (its row and column are otherwise zero): an Euler–Bernoulli beam has ``inf`` in both shears.
        mass: (n, 6, 6) mass per length in section axes, kg/m, kg, kg m: maps velocity and angular velocity at the reference
            point to linear and angular momentum.
        twist: (n,) structural twist, rad.
        curve: (n, 3) reference curve from the root in blade axes (prebend, sweep), m; straight along x by default. A cubic
            spline of the arc length interpolates between stations.
        hub_radius: distance from the hub's centre to the root, m, measured along the coned axis of the blade: the root is
            hub_radius × cos(precone) from the rotor's axis.
        precone: tilt of the blade's axis from the plane of rotation towards +z, rad.
        pitch: rotation of the whole blade about its axis at the root, rad; same sense as twist.
        tip_mass: (6, 6) inertia of a rigid body at the tip, in the tip section's axes.
        root: (6,) stiffness of the root joint along and about the blade's axes there (pitched, not twisted), N/m and
            N m/rad: ``inf`` clamps (the default for all six), 0 is free, any other number is a spring. The blade slides
            along x, y and z, then rotates about x, y and z in sequence; each spring acts on one of these coordinates.
        kinks: inner stations where the curve's tangent jumps, m. Each piece between kinks is a separate spline; a piece of
            two stations is straight. The sections rotate with the tangent.

    Raises:
        BladeError: invalid data; see ``blade_checks``.
    """

    name: str
    stations: Array
    stiffness: Array
    mass: Array
    twist: Array
    hub_radius: float = 0.0
    curve: Array = field(default_factory=lambda: np.zeros((0, 3)))
    precone: float = 0.0
    pitch: float = 0.0
    tip_mass: Array = field(default_factory=lambda: np.zeros((6, 6)))
    root: Array = field(default_factory=lambda: np.full(6, np.inf))
    kinks: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        set_ = object.__setattr__
        for name in ("stations", "stiffness", "mass", "twist", "curve", "tip_mass", "root"):
            set_(self, name, np.ascontiguousarray(getattr(self, name), dtype=float))
        s = self.stations
        if s.ndim == 1 and len(s) and 0 < abs(s[0]) <= ROOT_TOLERANCE * abs(s[-1]):
            set_(self, "stations", np.concatenate([[0.0], s[1:]]))
        set_(self, "kinks", _on_stations(self))
        if self.curve.size == 0:
            set_(self, "curve", np.outer(self.stations, [1.0, 0.0, 0.0]))
        check_blade(self)

    @property
    def length(self) -> float:
        """Arc length of the reference curve, m."""
        return float(self.stations[-1])

    def __repr__(self) -> str:
        mass = float(np.trapezoid(self.mass[:, 0, 0], self.stations)) + float(self.tip_mass[0, 0])
        angles = (("precone", self.precone), ("pitch", self.pitch))
        angles_text = [f"{name} {np.degrees(angle):.4g}°" for name, angle in angles if angle]
        facts = [f"{self.length:.6g} m", f"hub radius {self.hub_radius:.6g} m", *angles_text, f"{mass:.6g} kg"]
        return f"<Blade {self.name}: {', '.join(facts)}, {len(self.stations)} stations>"


def _on_stations(blade: Blade) -> tuple[float, ...]:
    """The kinks, each replaced by the station that it equals within rounding."""
    s = blade.stations
    if s.ndim != 1 or not len(s):
        return ()
    nearest = ((float(kink), float(s[np.abs(s - kink).argmin()])) for kink in blade.kinks)
    return tuple(at if abs(kink - at) <= ROOT_TOLERANCE * abs(s[-1]) else kink for kink, at in nearest)


def section_stiffness(
    EA: ArrayLike, GJ: ArrayLike, EI_y: ArrayLike, EI_z: ArrayLike, GA_y: ArrayLike = np.inf, GA_z: ArrayLike = np.inf
) -> Array:
    """Uncoupled section stiffness (n, 6, 6), N and N m²; EI_y resists flap, EI_z edgewise motion (at zero twist)."""
    return _diagonal(EA, GA_y, GA_z, GJ, EI_y, EI_z)


def section_mass(mass: ArrayLike, I_y: ArrayLike = 0.0, I_z: ArrayLike = 0.0) -> Array:
    """Section mass (n, 6, 6) centred on the axis: mass kg/m, rotary inertias ``I_y``, ``I_z`` kg m, polar their sum."""
    return _diagonal(mass, mass, mass, np.add(I_y, I_z), I_y, I_z)


def _diagonal(*entries: ArrayLike) -> Array:
    columns = np.stack(np.broadcast_arrays(*[np.atleast_1d(np.asarray(e, float)) for e in entries]), axis=-1)
    out = np.zeros((*columns.shape, 6))
    out[:, range(6), range(6)] = columns
    return out


def uniform_blade(
    name: str,
    length: float,
    hub_radius: float,
    *,
    EA: float,
    GJ: float,
    EI_y: float,
    EI_z: float,
    mass: float,
    I_y: float = 0.0,
    I_z: float = 0.0,
    GA_y: float = np.inf,
    GA_z: float = np.inf,
) -> Blade:
    """A straight uniform untwisted cantilever; lengths in m, sections as for ``section_stiffness`` and ``section_mass``."""
    return Blade(
        name=name,
        stations=np.array([0.0, length]),
        twist=np.zeros(2),
        hub_radius=hub_radius,
        stiffness=np.repeat(section_stiffness(EA, GJ, EI_y, EI_z, GA_y, GA_z), 2, axis=0),
        mass=np.repeat(section_mass(mass, I_y, I_z), 2, axis=0),
    )


def coupled(blade: Blade) -> bool:
    """Whether any section has off-diagonal stiffness or mass about the reference curve."""
    return _off_diagonal(blade.stiffness) or _off_diagonal(blade.mass)


def _off_diagonal(matrices: Array) -> bool:
    """Whether an entry (i, j) of matrices (n, 6, 6) exceeds the fraction ``COUPLING_ROUNDING`` of √(dᵢ dⱼ), d the diagonal."""
    d = np.sqrt(np.diagonal(matrices, axis1=1, axis2=2))
    off = ~np.eye(6, dtype=bool)
    return bool((np.abs(matrices) > COUPLING_ROUNDING * (d[:, :, None] * d[:, None, :]))[:, off].any())


def straight(blade: Blade) -> bool:
    """Whether the reference curve runs along x (no prebend or sweep)."""
    return bool(np.abs(blade.curve - np.outer(blade.stations, [1, 0, 0])).max() <= 1e-12 * blade.length)


def clamped(blade: Blade) -> bool:
    """Whether the root is clamped in every direction."""
    return bool(np.isinf(blade.root).all())


def uniform(blade: Blade) -> bool:
    """Whether all sections are equal and uncoupled, and the blade straight, clamped, without twist, cone, pitch, tip mass."""
    equal_sections = all(
        np.allclose(v, v[0], rtol=1e-12, atol=0)
        for v in (np.diagonal(blade.mass, axis1=1, axis2=2), np.diagonal(blade.stiffness, axis1=1, axis2=2))
    )
    return (
        equal_sections
        and clamped(blade)
        and not coupled(blade)
        and straight(blade)
        and not blade.twist.any()
        and not (blade.precone or blade.pitch or blade.tip_mass.any())
    )


def without_rotary_inertia(blade: Blade) -> Blade:
    """Copy of a blade without the moments of inertia of its sections about their mass centres."""
    mass = blade.mass.copy()
    m, centre, _ = about_centre(mass)
    mass[:, 3:, 3:] = -m[:, None, None] * skew(centre) @ skew(centre)
    return replace(blade, mass=mass)
