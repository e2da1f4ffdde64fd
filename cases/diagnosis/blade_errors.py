"""Plausible errors of input, each a function from the blade that was meant to the blade that a program received."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, TORSION, Blade, straight
from ...core.sampling import stiffness_at
from ...core.space.inertia import about_centre
from ...core.space.spatial import skew

Array = NDArray[np.float64]
Alteration = Callable[[Blade], Blade]

OFFSET = 0.25
"""Shift of the reference axis, as a fraction of the radius of gyration √(EI_z/EA) at midspan."""

STEP = 1e-7
"""Length of a step of the properties, as a fraction of the interval between stations."""


def scaled_strain(factor: float, *strains: int) -> Alteration:
    """Rows and columns of the stiffness of some strains times √``factor``, so that the diagonal scales by ``factor``."""

    def alter(blade: Blade) -> Blade:
        scale = np.ones(6)
        scale[list(strains)] = np.sqrt(factor)
        return replace(blade, stiffness=blade.stiffness * np.outer(scale, scale))

    return alter


def rigid(*strains: int) -> Alteration:
    """Some strains are rigid at every station; their couplings are dropped."""

    def alter(blade: Blade) -> Blade:
        stiffness = blade.stiffness.copy()
        for strain in strains:
            stiffness[:, strain, :] = stiffness[:, :, strain] = 0.0
            stiffness[:, strain, strain] = np.inf
        return replace(blade, stiffness=stiffness)

    return alter


def scaled_mass(factor: float) -> Alteration:
    """All mass times ``factor``, with the tip mass."""
    return lambda blade: replace(blade, mass=factor * blade.mass, tip_mass=factor * blade.tip_mass)


def scaled_length(factor: float) -> Alteration:
    """The blade stretched in its length, with the properties per length unchanged."""
    return lambda blade: replace(
        blade,
        stations=factor * blade.stations,
        curve=factor * blade.curve,
        kinks=tuple(factor * kink for kink in blade.kinks),
    )


def rotor_radius_as_length(blade: Blade) -> Blade:
    """The tip's radius is taken as the length of a blade that begins on the rotor's axis."""
    return replace(scaled_length(1.0 + blade.hub_radius / blade.length)(blade), hub_radius=0.0)


def exchanged_bending(blade: Blade) -> Blade:
    """Flapwise and edgewise bending stiffness exchanged."""
    stiffness = blade.stiffness.copy()
    stiffness[:, BEND_Y, BEND_Y], stiffness[:, BEND_Z, BEND_Z] = (
        blade.stiffness[:, BEND_Z, BEND_Z],
        blade.stiffness[:, BEND_Y, BEND_Y],
    )
    return replace(blade, stiffness=stiffness)


def scaled_coupling(factor: float) -> Alteration:
    """All couplings of torsion with the other strains times ``factor``."""

    def alter(blade: Blade) -> Blade:
        stiffness = blade.stiffness.copy()
        coupled_strains = [k for k in range(6) if k != TORSION]
        stiffness[:, TORSION, coupled_strains] *= factor
        stiffness[:, coupled_strains, TORSION] *= factor
        return replace(blade, stiffness=stiffness)

    return alter


def uncoupled_stiffness(blade: Blade) -> Blade:
    """The off-diagonal entries of the stiffness are dropped."""
    return replace(blade, stiffness=np.where(np.eye(6, dtype=bool), blade.stiffness, 0.0))


def moved_mass_centres(factor: float) -> Alteration:
    """The offsets of the sections' mass centres from the reference curve times ``factor``; 0 puts them on the curve."""

    def alter(blade: Blade) -> Blade:
        m, centre, inertia = about_centre(blade.mass)
        cross = skew(factor * centre)
        mass = blade.mass.copy()
        mass[:, :3, 3:], mass[:, 3:, :3] = -m[:, None, None] * cross, m[:, None, None] * cross
        mass[:, 3:, 3:] = inertia - m[:, None, None] * cross @ cross
        return replace(blade, mass=mass)

    return alter


def shifted_axis(blade: Blade) -> Blade:
    """Sections about an axis shifted by ``OFFSET`` along y, with the parallel-axis terms but without the couplings.

    About an axis shifted by e, EI_z grows by EA e², GJ by GA_y e² and the moments of inertia by m e²; stretch couples
    with bending by EA e, and translation with rotation by m e. Omitting only the couplings makes the section too stiff.
    Rigid shear has no such term in torsion here. With a rigid stretch there is no radius, and nothing changes.
    """
    middle = stiffness_at(blade, blade.length / 2)[0]
    if np.isinf(middle[AXIAL, AXIAL]):
        return blade
    square = OFFSET**2 * middle[BEND_Z, BEND_Z] / middle[AXIAL, AXIAL]
    stiffness, mass = blade.stiffness.copy(), blade.mass.copy()
    stiffness[:, BEND_Z, BEND_Z] += stiffness[:, AXIAL, AXIAL] * square
    if np.isfinite(stiffness[:, SHEAR_Y, SHEAR_Y]).all():
        stiffness[:, TORSION, TORSION] += stiffness[:, SHEAR_Y, SHEAR_Y] * square
    for turning in (TORSION, BEND_Z):
        mass[:, turning, turning] += mass[:, AXIAL, AXIAL] * square
    return replace(blade, stiffness=stiffness, mass=mass)


def lost_station_mass(station: int) -> Alteration:
    """The mass of one station is lost; properties are linear between stations."""

    def alter(blade: Blade) -> Blade:
        mass = blade.mass.copy()
        mass[station] *= 1e-6
        return replace(blade, mass=mass)

    return alter


def mirrored_curve(flap: float, edge: float) -> Alteration:
    """Prebend (z) and sweep (y) of the reference curve times factors; −1 reverses, 0 drops, and keeps the arc length."""

    def alter(blade: Blade) -> Blade:
        curve = blade.curve * np.array([1.0, edge, flap])
        if not (flap and edge):
            steps = np.diff(curve, axis=0)
            along = np.sqrt(np.maximum(np.diff(blade.stations) ** 2 - (steps[:, 1:] ** 2).sum(1), 0.0))
            curve[1:, 0] = np.cumsum(along)
        return replace(blade, curve=curve)

    return alter


def mirrored_tip(blade: Blade) -> Blade:
    """The mass centre of the tip body on the other side of the axis, along y."""
    flip = np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    return replace(blade, tip_mass=flip @ blade.tip_mass @ flip)


def point_tip(blade: Blade) -> Blade:
    """The tip body as a point mass on the axis."""
    m = blade.tip_mass[0, 0]
    return replace(blade, tip_mass=np.diag([m, m, m, 0.0, 0.0, 0.0]))


def stepwise(weight: float) -> Alteration:
    """Properties constant between stations: those of the inner station (0), of the outer one (1), or their mean (½).

    The twist stays linear. A curved blade stays as it is: its curve is a spline through the stations.
    """

    def alter(blade: Blade) -> Blade:
        if not straight(blade) or len(blade.stations) < 3:
            return blade
        s = blade.stations
        next_stations = s[1:-1] + STEP * np.minimum(np.diff(s)[:-1], np.diff(s)[1:])
        stations = np.sort(np.concatenate([s, next_stations]))

        def steps(values: Array) -> Array:
            finite = np.where(np.isinf(values), 0.0, values)
            mean = np.where(np.isinf(values[1:]), np.inf, (1.0 - weight) * finite[:-1] + weight * finite[1:])
            return np.repeat(mean, 2, axis=0)

        return replace(
            blade,
            stations=stations,
            stiffness=steps(blade.stiffness),
            mass=steps(blade.mass),
            twist=np.interp(stations, s, blade.twist),
            curve=np.zeros((0, 3)),
        )

    return alter
