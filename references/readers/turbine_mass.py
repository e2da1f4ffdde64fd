"""Mass, mass centre and inertia of a whole turbine, directly from OpenFAST's files read by weio, and the stations of its blade.

Bodies are added by their mass, first moments and ∫ r rᵀ dm. Axes at the tower's base: x up, y to starboard, z downwind. Sources
as for ``openfast_turbine``; the nacelle's inertia is that about the yaw axis alone, the hub's that about the shaft alone.
"""

from dataclasses import dataclass
from math import cos, pi, radians, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .openfast import first_of, has, parsed, text_of
from .openfast_turbine import tower_table
from .quadrature import Mounted, moments
from .stations import NotReadError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Moments:
    """Mass, kg, first moments (3,), kg m, and ∫ r rᵀ dm (3, 3), kg m², of a body."""

    mass: float
    first: Array
    second: Array

    def moved(self, axes: Array, origin: Array) -> "Moments":
        """The moments in other axes, in which the body has its axes ``axes`` (3, 3) and its origin at ``origin`` (3,)."""
        first = axes @ self.first
        cross = np.outer(origin, first)
        second = axes @ self.second @ axes.T + cross + cross.T + self.mass * np.outer(origin, origin)
        return Moments(self.mass, first + self.mass * origin, second)

    def __add__(self, other: "Moments") -> "Moments":
        """The moments of two bodies together, given in the same axes."""
        return Moments(self.mass + other.mass, self.first + other.first, self.second + other.second)

    @property
    def inertia(self) -> Array:
        """(3,) moments of inertia about the axes, kg m²."""
        return np.asarray(np.trace(self.second) - np.diagonal(self.second), float)


@dataclass(frozen=True)
class Weighed:
    """Mass and inertia of a turbine.

    Attributes:
        total: moments of the whole turbine.
        rotor: moment of inertia about the shaft without the generator, kg m².
        height: of the tower's top, m.
    """

    total: Moments
    rotor: float
    height: float


def weigh(path: Path, blade: Mounted, tip: Array) -> Weighed:
    """The turbine of a primary file with these blades, of which ``tip`` (6, 6) is the body at the tip.

    Raises:
        NotReadError: if weio does not read the files.
    """
    try:
        primary, _ = parsed(path)
        main_path = path.parent / text_of(primary, "EDFile")
        main, _ = parsed(main_path)
        tower, _ = parsed(main_path.parent / text_of(main, "TwrFile"))

        def number(name: str, otherwise: float = 0.0) -> float:
            return float(first_of(main, name)) if has(main, name) else otherwise

        at, density = tower_table(main, tower)
        count = round(number("NumBl"))
        tilt, overhang = radians(number("ShftTilt")), number("OverHang")
        masses = {name: number(name) for name in ("NacMass", "NacYIner", "YawBrMass", "HubMass", "HubIner", "HubCM")}
        x, y, z = (number(f"NacCM{axis}n") for axis in "xyz")
        shaft_height = number("Twr2Shft")
    except NotReadError:
        raise
    except Exception as error:  # of a foreign parser, whatever it raises
        raise NotReadError(" ".join(f"{type(error).__name__}: {error}".split())[:300]) from error
    rotor = _rotor(masses["HubMass"], masses["HubCM"], masses["HubIner"])
    of_blade = Moments(*moments(blade, tip))
    for k in range(count):
        angle = 2.0 * pi * k / count
        axes = np.array([[cos(angle), -sin(angle), 0.0], [sin(angle), cos(angle), 0.0], [0.0, 0.0, 1.0]])
        rotor += of_blade.moved(axes, np.zeros(3))
    up = np.array([at[-1], 0.0, 0.0])
    axis = np.array([sin(tilt), 0.0, cos(tilt)])
    axes = np.column_stack([[cos(tilt), 0.0, -sin(tilt)], [0.0, 1.0, 0.0], axis])
    apex = up + np.array([shaft_height, 0.0, 0.0]) + overhang * axis
    centre = np.array([z, -y, x])
    own = masses["NacYIner"] - masses["NacMass"] * float(centre[1:] @ centre[1:])
    about_yaw = Moments(masses["NacMass"], np.zeros(3), 0.5 * own * np.diag([-1.0, 1.0, 1.0]))
    total = (
        _tower(at, density)
        + Moments(masses["YawBrMass"], np.zeros(3), np.zeros((3, 3))).moved(np.eye(3), up)
        + about_yaw.moved(np.eye(3), up + centre)
        + rotor.moved(axes, apex)
    )
    return Weighed(total, float(rotor.inertia[2]), float(at[-1]))


def _rotor(mass: float, centre: float, about_shaft: float) -> Moments:
    """The hub, in the shaft's axes; ∫ r rᵀ dm of a body that has inertia I about z alone is I/2 diag(1, 1, −1)."""
    first = np.array([0.0, 0.0, mass * centre])
    second = 0.5 * about_shaft * np.diag([1.0, 1.0, -1.0]) + np.diag([0.0, 0.0, mass * centre**2])
    return Moments(mass, first, second)


def _tower(at: Array, density: Array) -> Moments:
    """A line of mass, linear between heights; Simpson's rule is exact for it."""
    low, high = at[:-1], at[1:]
    middle = 0.5 * (low + high)
    mean = 0.5 * (density[:-1] + density[1:])

    def integral(power: int) -> float:
        parts = density[:-1] * low**power + 4.0 * mean * middle**power + density[1:] * high**power
        return float((parts * (high - low)).sum() / 6.0)

    return Moments(integral(0), np.array([integral(1), 0.0, 0.0]), np.diag([integral(2), 0.0, 0.0]))
