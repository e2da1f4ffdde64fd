"""A five-bar linkage that moves on a turning table, with a bead on one rod."""

from dataclasses import replace

import numpy as np
from numpy.polynomial import Polynomial

from southwell import multibody as mb

G = 9.81


def bar(name: str, length: float, mass: float) -> mb.Body:
    across = mass * length**2 / 12
    return mb.Body(name, mb.inertia(mass, (0.02 * across, across, 1.1 * across), (length / 2, 0.05, 0.02)))


def five_bar(cut: str = "C", drive: float = 2.0) -> mb.Mechanism:
    """Two cranks, two rods, on a turning table: one crank driven, the other at a rate of its own, free to vibrate about it.

    A bead slides on one of the rods, held by a spring. The linkage changes as it moves: a law asks for this instant.
    """
    joints = (
        mb.Joint("turn", "revolute", "ground", "table", mb.at(axis="y"), mb.at(axis="y")),
        mb.Joint("A", "revolute", "table", "left"),
        mb.Joint("B", "revolute", "left", "rod", mb.at(0.6)),
        mb.Joint("C", "spherical", "rod", "rope", mb.at(1.3), mb.at(1.1)),
        mb.Joint("D", "universal", "right", "rope", mb.at(0.7, axis="x"), mb.at(axis="x")),
        mb.Joint("E", "revolute", "table", "right", mb.at(1.4)),
        mb.Joint("F", "prismatic", "rod", "bead", mb.at(0.3, axis="x"), mb.at(axis="x")),
    )
    return mb.Mechanism(
        (
            mb.Body("table"),
            bar("left", 0.6, 1.0),
            bar("rod", 1.3, 0.8),
            bar("rope", 1.1, 0.9),
            bar("right", 0.7, 1.2),
            bar("bead", 0.1, 0.4),
        ),
        tuple(replace(j, cut=j.name == cut) for j in joints),
        (
            mb.Motion("turn.rz", 0.2, 1.5),
            mb.Motion("A.rz", law=Polynomial([2.0, drive])),
            mb.Motion("E.rz", None, -1.0, 0.3, prescribed=False),
        ),
        coordinate_springs=(
            mb.CoordinateSpring("E.rz", 60.0, 2.0, 0.6),
            mb.CoordinateSpring("A.rz", 10.0),
            mb.CoordinateSpring("D.rx", 8.0, 0.3, 0.2),
            mb.CoordinateSpring("D.ry", 9.0, 0.2, 0.1),
            mb.CoordinateSpring("F.z", 40.0, 0.5, 0.2),
        ),
        gravity=(0.4, -G, 0.2),
    )


GUESS = {"A.rz": 2.0, "B.rz": -1.5, "E.rz": 0.8, "D.rx": 0.1, "D.ry": 0.5}


def undamped() -> mb.Mechanism:
    """The five-bar without dampers on a table that turns steadily about a slanting axis, gravity along it."""
    m, slant = five_bar(), np.array([0.3, 1.0, 0.8])
    turn = replace(m.joints[0], at_parent=mb.at(axis=slant), at_child=mb.at(axis=slant))
    return replace(
        m,
        joints=(turn, *m.joints[1:]),
        motions=(mb.Motion("turn.rz", 0.2, 3.0),),
        coordinate_springs=tuple(replace(s, damping=0.0) for s in m.coordinate_springs),
        gravity=(-3.0, -10.0, -8.0),  # along the axis of rotation, or it would be another force each instant
    )
