"""The beams the tests share, and what is known of them."""

import numpy as np

from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade

E, RHO, A, I = 7e10, 3000.0, 4e-4, 2e-7

PARK = uniform_blade(
    "Park 2010 cantilever",
    6.0,
    0.3,
    EA=E * A,
    GJ=E / 2.6 * 2 * I,
    EI_y=E * I,
    EI_z=E * I,
    mass=RHO * A,
    I_y=RHO * I,
    I_z=RHO * I,
)
"""The paper's cantilever (identified from its printed digits, not printed there)."""

EXACT_EDGEWISE = np.array([11.710953, 70.419355, 189.81994])
EXACT_FLAPWISE = np.array([15.400199, 71.126584, 190.083784])
"""Full extensible beam at 10 rad/s, rad/s: two spectral solutions that agree to 1e-6."""

TIP_MASS = np.diag([40.0, 40.0, 40.0, 9.0, 1.0, 8.0])
TIP_MASS[:3, 3:] = [[0, 0, -20.0], [0, 0, 0], [20.0, 0, 0]]  # half a metre off along y
TIP_MASS[3:, :3] = TIP_MASS[:3, 3:].T
TIP_MASS[[3, 5], [3, 5]] += 10.0
"""Inertia (6, 6) of a body of 40 kg beside the tip."""


def yoo_shin(hub_ratio: float, alpha: float = 70.0) -> Blade:
    """Yoo and Shin's dimensionless beam: length, mass and EI one, slenderness α, no rotary inertia."""
    return uniform_blade("Yoo and Shin 1998", 1.0, hub_ratio, EA=alpha**2, GJ=1.0, EI_y=1.0, EI_z=1.0, mass=1.0)


def tapered() -> Blade:
    """A twisted, tapered blade of 40 m with its own rotary inertia: smooth in nothing but the straight axis."""
    s = np.array([0.0, 4.0, 10.0, 20.0, 32.0, 40.0])
    flap, edge = np.array([9e9, 4e9, 1.5e9, 4e8, 6e7, 8e6]), np.array([9e9, 6e9, 3e9, 1.2e9, 3e8, 5e7])
    mass = np.array([800.0, 500.0, 320.0, 230.0, 110.0, 30.0])
    return Blade(
        name="tapered",
        stations=s,
        stiffness=section_stiffness(EA=0.6 * edge, GJ=0.1 * flap, EI_y=flap, EI_z=edge),
        mass=section_mass(mass, I_y=mass * 0.02, I_z=mass * 0.3),
        twist=np.radians([13.0, 13.0, 9.0, 4.0, 1.0, 0.0]),
        hub_radius=1.5,
    )


def curved() -> Blade:
    """The tapered blade with prebend, sweep, shear flexibility, bend–twist coupling, offset mass, precone and pitch."""
    base = tapered()
    x = base.stations / base.length
    stiffness = section_stiffness(
        EA=np.diagonal(base.stiffness, axis1=1, axis2=2)[:, 0],
        GJ=np.diagonal(base.stiffness, axis1=1, axis2=2)[:, 3],
        EI_y=np.diagonal(base.stiffness, axis1=1, axis2=2)[:, 4],
        EI_z=np.diagonal(base.stiffness, axis1=1, axis2=2)[:, 5],
        GA_y=0.1 * base.stiffness[:, 0, 0],
        GA_z=0.05 * base.stiffness[:, 0, 0],
    )
    coupling = 0.2 * np.sqrt(stiffness[:, 3, 3] * stiffness[:, 4, 4])
    stiffness[:, 3, 4] = stiffness[:, 4, 3] = coupling
    mass = base.mass.copy()
    offset = 0.1 * (1 - 0.5 * x)  # centre of mass along the section's y
    mass[:, 0, 5] = mass[:, 5, 0] = -base.mass[:, 0, 0] * offset
    mass[:, 2, 3] = mass[:, 3, 2] = base.mass[:, 0, 0] * offset
    mass[:, 3, 3] += base.mass[:, 0, 0] * offset**2
    mass[:, 5, 5] += base.mass[:, 0, 0] * offset**2
    along = _parabola(base.stations, 1.7 / base.length**2)
    curve = np.outer(along, [1.0, 0.0, 0.0]) + np.outer((along / base.length) ** 2, [0.0, -0.8, 1.5])
    return Blade(
        name="curved",
        stations=base.stations,
        stiffness=stiffness,
        mass=mass,
        twist=base.twist,
        hub_radius=1.5,
        curve=curve,
        precone=np.radians(2.5),
        pitch=np.radians(5.0),
    )


def _parabola(s: np.ndarray, a: float) -> np.ndarray:
    """Where the parabola y = a x² has the arc length s = x √(1 + 4a²x²)/2 + asinh(2ax)/4a, by Newton's method."""
    x = s.copy()
    for _ in range(8):
        speed = np.sqrt(1 + (2 * a * x) ** 2)
        x -= (x * speed / 2 + np.arcsinh(2 * a * x) / (4 * a) - s) / speed
    return x
