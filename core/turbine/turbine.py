"""The description of a turbine: tower, nacelle, drivetrain, hub and N equal blades; two may teeter.

Axes as for a ``Blade``: the tower's x axis points up, z downwind and y = z × x; the shaft's z axis is the rotor's, along which
the wind blows.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..blade import Blade
from ..space import spatial as sp
from .tower import Support

Array = NDArray[np.float64]

G = 9.80665
"""m/s²."""


@dataclass(frozen=True)
class Drivetrain:
    """The shaft between hub and generator; inertia and angles on the side of the rotor.

    Attributes:
        stiffness: torsional, N m/rad; ``inf`` is a rigid shaft.
        generator: moment of inertia of the generator about its own shaft, kg m².
        gear_ratio: speed of the generator over that of the rotor.
        free: whether the generator turns freely about its steady speed; otherwise it is locked.
    """

    stiffness: float = np.inf
    generator: float = 0.0
    gear_ratio: float = 1.0
    free: bool = False


@dataclass(frozen=True)
class Teeter:
    """The hinge between the shaft and a hub of two blades, about the y axis of the hub: across the shaft and the blades.

    Attributes:
        undersling: distance from the hinge to the hub's centre, positive if the centre is upwind, m.
        stiffness: N m/rad.
    """

    undersling: float = 0.0
    stiffness: float = 0.0

    @property
    def twist(self) -> Array:
        """(6, 1) twist of the hub at its centre, per unit of the hinge's angle."""
        return np.array([[-self.undersling, 0.0, 0.0, 0.0, 1.0, 0.0]]).T


@dataclass(frozen=True)
class Turbine:
    """A turbine; SI units.

    Attributes:
        name: for tables.
        tower: a beam along x, upwards; its ``tip_mass`` is the body at its top without nacelle and rotor.
        blade: one of the blades.
        blades: N ≥ 2.
        nacelle: (6, 6) inertia at the tower's top, in the tower's axes.
        hub: (6, 6) inertia of the hub at its centre, in the shaft's axes; it turns with the rotor.
        shaft: (4, 4) pose of the hub's centre, z along the rotor's axis and x in the vertical plane, from the tower's top.
        yaw: stiffness of the yaw bearing, N m/rad; ``inf`` is a locked one.
        drivetrain: the shaft and generator.
        gravity: m/s².
        support: springs that hold the tower; rigid ground by default.
        teeter: the hinge of a hub of two blades; None if the hub is fixed to the shaft.
    """

    name: str
    tower: Blade
    blade: Blade
    blades: int
    nacelle: Array
    hub: Array
    shaft: Array
    yaw: float = np.inf
    drivetrain: Drivetrain = field(default_factory=Drivetrain)
    gravity: float = G
    support: Support = field(default_factory=Support)
    teeter: Teeter | None = None

    @property
    def hinge(self) -> Array:
        """(6, h) twist of the hub, in its axes, per unit of the angle of each of h = 0 or 1 hinges between it and the shaft."""
        return np.zeros((6, 0)) if self.teeter is None else self.teeter.twist


def shaft_pose(to_shaft: float, overhang: float, tilt: float) -> Array:
    """Pose (4, 4) of the hub's centre in the axes of the tower's top.

    Args:
        to_shaft: height of the shaft above the tower's top on the yaw axis, m.
        overhang: distance from there to the hub's centre along the shaft, positive downwind, m.
        tilt: rad, positive if the downwind end is higher: an upwind turbine has negative tilt and overhang.
    """
    c, s = np.cos(tilt), np.sin(tilt)
    axis = np.array([s, 0.0, c])
    rotation = np.stack([[c, 0.0, -s], [0.0, 1.0, 0.0], axis], axis=-1)
    return sp.pose(rotation, np.array([to_shaft, 0.0, 0.0]) + overhang * axis)
