"""Mechanisms built in Python: bodies, joints, motions and springs by name; ``solve`` finds the steady state and the modes.

A rigid blade of 40 kg on a lag hinge 0.3 m off the rotor's axis, with a damper across the hinge, at 30 rad/s::

    from southwell import multibody as mb

    blade = mb.Mechanism(
        bodies=(mb.Body("hub"), mb.Body("blade", mb.inertia(40.0, (0.1, 50.0, 50.0), centre=(2.0, 0, 0)))),
        joints=(
            mb.Joint("shaft", "revolute", "ground", "hub"),
            mb.Joint("lag", "revolute", "hub", "blade", mb.at(x=0.3)),
        ),
        motions=(mb.Motion("shaft.rz", rate=30.0),),
        coordinate_springs=(mb.CoordinateSpring("lag.rz", damping=600.0),),
    )
    found = mb.solve(blade)
    found.frequencies, found.damping  # 10.14 rad/s, 0.141 of critical

Lengths in m, angles in rad, SI throughout. A joint's axis is the z axis of its frame (see ``at``); its coordinates are named
``joint.rz`` and so on (see ``joints.SCREWS``). Joints that close loops are found automatically, or marked with ``cut=True``.
"""

from ..element.beams import bushing
from .joints import Joint, at
from .mechanism import Beam, Body, CoordinateSpring, Load, Mechanism, MechanismError, Motion, Spring, inertia
from .motion import Harmonic, Sum
from .solution import Solution, solve, straight_beam

__all__ = [
    "Beam",
    "Body",
    "CoordinateSpring",
    "Harmonic",
    "Joint",
    "Load",
    "Mechanism",
    "MechanismError",
    "Motion",
    "Solution",
    "Spring",
    "Sum",
    "at",
    "bushing",
    "inertia",
    "solve",
    "straight_beam",
]
