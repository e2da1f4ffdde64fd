"""The length of a mechanism, which is the unit of its displacements: tolerances and steps are relative to it."""

import numpy as np

from .description import Mechanism
from .joints import SCREWS, coordinate_names


def coordinate_units(mechanism: Mechanism, length: float) -> dict[str, float]:
    """The unit of each joint's coordinates: ``length`` along an axis, 1 rad about one."""
    return {
        name: length if screw[:3].any() else 1.0
        for joint in mechanism.joints
        for name, (_, screw) in zip(coordinate_names(joint), SCREWS[joint.kind], strict=True)
    }


def length_of(mechanism: Mechanism) -> float:
    """Length of a mechanism, m: the largest of its dimensions and its bodies' radii of gyration; 1 if all are zero."""
    points = [frame[:3, 3] for j in mechanism.joints for frame in (j.at_parent, j.at_child)]
    points += [point for s in mechanism.springs for point in (s.point_a, s.point_b)]
    points += [pose[:3, 3] for b in mechanism.beams for pose in (b.at_a, b.at_b, *b.beams.undeformed)]
    lengths = [float(np.linalg.norm(point)) for point in points]
    lengths += [s.free_length for s in mechanism.springs]
    along = {name for name, unit in coordinate_units(mechanism, 0.0).items() if unit == 0.0}
    lengths += [abs(s.neutral) for s in mechanism.coordinate_springs if s.coordinate in along]
    lengths += [abs(m.position) for m in mechanism.motions if m.position and m.coordinate in along]
    lengths += [
        float(np.sqrt(np.trace(b.inertia[3:, 3:]) / b.inertia[0, 0])) for b in mechanism.bodies if b.inertia[0, 0]
    ]
    return max(lengths, default=0.0) or 1.0
