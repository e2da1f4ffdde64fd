"""Straight blades for the closed forms, and what to ask of their modes."""

import numpy as np

from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.modes import Modes

X, Y, Z, TURN = range(4)
"""Columns of a shape."""


def park(GJ: float = np.inf) -> Blade:
    """The paper's cantilever, as identified; rigid in torsion unless told."""
    return uniform_blade("park", 6.0, 0.3, EA=2.8e7, GJ=GJ, EI_y=1.4e4, EI_z=1.4e4, mass=1.2, I_y=6e-4, I_z=6e-4)


def slender(slenderness: float = 70.0, hub_ratio: float = 0.0, EI_y: float = 1.0) -> Blade:
    return uniform_blade("slender", 1.0, hub_ratio, EA=slenderness**2, GJ=1.0, EI_y=EI_y, EI_z=1.0, mass=1.0)


def kinked(twist: float = 0.0, inertia: float = 1.0, stations: int = 3, tip: float = 0.0) -> Blade:
    """Stubby, soft axially and in torsion, tapered with a kink at 0.4: every effect is large."""
    s = np.linspace(0.0, 1.0, stations) if stations > 3 else np.array([0.0, 0.4, 1.0])
    k = np.interp(s, [0.0, 0.4, 1.0], [1.5, 1.0, 0.4])
    m = np.interp(s, [0.0, 0.4, 1.0], [1.0, 0.8, 0.3])
    return Blade(
        name="kinked",
        stations=s,
        stiffness=section_stiffness(300 * k, 3 * k, k, 2.5 * k),
        mass=section_mass(m, 0.02 * inertia * m, 0.05 * inertia * m),
        twist=twist * np.interp(s, [0.0, 0.4, 1.0], [1.0, 0.3, 0.0]),
        hub_radius=0.2,
        tip_mass=tip * np.diag([0.3, 0.3, 0.3, 0.012, 0.004, 0.01]),
    )


def family(modes: Modes, column: int) -> np.ndarray:
    """Frequencies of the modes that move most along one column of their shapes (metres and radians alike)."""
    return modes.frequencies[np.abs(modes.shapes).max(1).argmax(1) == column]
