"""The same blade in other units, and random blades."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.space.spatial import skew

Array = NDArray[np.float64]

_ROTATIONS = np.repeat([0.0, 1.0], 3)
_POWERS = _ROTATIONS[:, None] + _ROTATIONS  # power of the unit of length, in addition to that of entry (0, 0)


def in_units(blade: Blade, kg: float, m: float, s: float) -> Blade:
    """The blade with all values for units of mass, length and time that are 1/kg, 1/m and 1/s of the SI units."""
    newton = kg * m / s**2
    return replace(
        blade,
        stations=m * blade.stations,
        curve=m * blade.curve,
        hub_radius=m * blade.hub_radius,
        kinks=tuple(m * kink for kink in blade.kinks),
        stiffness=newton * m**_POWERS * blade.stiffness,
        mass=kg / m * m**_POWERS * blade.mass,
        tip_mass=kg * m**_POWERS * blade.tip_mass,
        root=newton / m * m ** (2 * _ROTATIONS) * blade.root,
    )


def random_blade(rng: np.random.Generator) -> tuple[Blade, float]:
    """A blade and a rotor speed, rad/s.

    Slenderness 16 to 300; with or without shear, rotary inertia, taper, steps, offset mass, coupling of bending and torsion,
    twist, prebend, precone, pitch, tip mass, and a spring at the root.
    """
    n = int(rng.choice([2, 2, 3, 5, 12]))
    length = 10.0 ** rng.uniform(-0.3, 2)
    s = np.concatenate([[0.0], np.sort(rng.uniform(0.05, 0.95, n - 2)), [1.0]])
    mass = 10.0 ** rng.uniform(-1, 3)
    flap = mass * length**4 * 10.0 ** rng.uniform(0, 2)
    edge = flap * (10.0 ** rng.uniform(0, 1.5) if rng.random() < 0.8 else 1.0)
    gyration = length / 10.0 ** rng.uniform(1.2, 2.5)
    axial = flap / gyration**2 * 10.0 ** rng.uniform(0, 1)
    torsion = flap * 10.0 ** rng.uniform(-0.7, 0.7) if rng.random() < 0.9 else np.inf
    shear = axial / rng.uniform(2, 10) if rng.random() < 0.5 else np.inf
    chord = 1.0 + rng.uniform(-0.8, 0.0) * s
    if n > 2 and rng.random() < 0.3:
        chord = chord * np.where(s > rng.uniform(0.2, 0.8), rng.uniform(0.1, 1.0), 1.0)
    k = section_stiffness(
        axial * chord, torsion * chord**2, flap * chord**2, edge * chord, shear * chord, shear * chord
    )
    rotary = gyration**2 * mass * (rng.random() < 0.8)
    inertia = section_mass(mass * chord, rotary * chord**2, 3 * rotary * chord)
    if rotary and rng.random() < 0.3:
        shift = np.eye(6)
        shift[:3, 3:] = -skew(gyration * np.array([0.0, 0.3, 0.1]) * rng.normal(size=3))
        inertia = shift.T @ inertia @ shift
    if np.isfinite(torsion) and rng.random() < 0.25:
        k[:, 3, 4] = k[:, 4, 3] = rng.uniform(-0.4, 0.4) * np.sqrt(k[:, 3, 3] * k[:, 4, 4])
    root = np.full(6, np.inf)
    if rng.random() < 0.2:
        root[rng.integers(3, 6)] = flap / length * 10.0 ** rng.uniform(-1, 1)
    curve = length * np.outer(s, [1.0, 0.0, 0.0])
    if n > 2 and rng.random() < 0.3:  # an arc of a circle
        bend = rng.uniform(0.05, 0.3)
        curve = length / bend * np.stack([np.sin(bend * s), 0.0 * s, 1.0 - np.cos(bend * s)], axis=1)
    tip = mass * length * rng.uniform(0, 0.5) * (rng.random() < 0.2)
    blade = Blade(
        name="random",
        stations=length * s,
        stiffness=k,
        mass=inertia,
        twist=rng.uniform(-0.6, 0.6) * (1.0 - s) * (rng.random() < 0.5),
        hub_radius=length * rng.uniform(0, 0.3) * (rng.random() < 0.5),
        curve=curve,
        precone=rng.uniform(-0.1, 0.1) * (rng.random() < 0.3),
        pitch=rng.uniform(-0.3, 0.3) * (rng.random() < 0.3),
        tip_mass=tip * np.diag([1.0, 1.0, 1.0, gyration**2, gyration**2, gyration**2]),
        root=root,
    )
    omega = np.sqrt(flap / mass) / length**2 * 10.0 ** rng.uniform(-0.5, 1.3) * (rng.random() < 0.75)
    return blade, float(omega)
