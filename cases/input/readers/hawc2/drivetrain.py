"""Hub and drivetrain of an htc: bodies on the shaft, its torsion, and the bearing that holds it.

The shaft, which HAWC2 bends too, is reduced to its torsional stiffness between its bearing and its end. The inertia about it of
what is on it is divided between generator and hub as its torsion divides it.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .....core.element.discretize import discretize
from .....core.space import spatial as sp
from .....core.space.inertia import transformed
from .....core.turbine.machine import rigid_rotor
from .....core.turbine.turbine import Drivetrain, Turbine
from ...errors import CaseError
from . import orientation
from .frames import EQUAL, Frames
from .parts import Parts
from .rigid import Line, moved

Array = NDArray[np.float64]


def hub_and_drivetrain(
    path: Path, split: Parts, lines: dict[str, Line], body_frames: Frames, fixed_bodies: list[str]
) -> tuple[Array, Drivetrain, tuple[str, ...]]:
    """Inertia (6, 6) of the hub at its centre, the drivetrain, and notes on it."""
    into = sp.inverse(body_frames.hub)
    hub = np.zeros((6, 6))
    for name in (*split.rotating, *fixed_bodies):
        hub += moved(lines[name].inertia(), into @ body_frames.pose[name])
    shaft, at = lines[split.shaft], into @ body_frames.pose[split.shaft]
    points = shaft.nodes @ at[:3, :3].T + at[:3, 3]
    if np.abs(points[:, :2]).max() > orientation.ALONG * shaft.length:
        raise CaseError(f"{path}: {split.shaft}: not along its axis of rotation, which is not supported")
    twisting = shaft.twisting() * shaft.weights
    flexibility = float(twisting.sum())
    twisted = np.concatenate([[0.0], np.cumsum(twisting)]) / flexibility
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(shaft.nodes, axis=0), axis=1))])
    ends = np.concatenate([[0.0], np.cumsum(shaft.weights)])
    share = np.interp(arc, ends, twisted)  # of the torsion between bearing and end
    polar = transformed(shaft.mass, at @ shaft.at)[:, 5, 5]
    generator = float(shaft.weights @ (polar * (1.0 - np.interp(shaft.arc, ends, twisted))))
    generator += float(sum((1.0 - share[m.node]) * float(moved(m.inertia, at)[5, 5]) for m in shaft.masses))
    hub[5, 5] -= generator
    asymmetry = hub.copy()
    asymmetry[[0, 1, 3, 4], [0, 1, 3, 4]] = 0.0
    asymmetry[[2, 5], [2, 5]] = asymmetry[[0, 4, 1, 3], [4, 0, 3, 1]] = 0.0
    moment = max(hub[3, 3], hub[5, 5], hub[0, 0] * shaft.length**2)
    uneven = max(np.abs(asymmetry).max(), abs(hub[3, 3] - hub[4, 4]))
    if uneven > EQUAL * moment:
        raise CaseError(
            f"{path}: {split.shaft}: the moments of inertia of shaft and hubs across the axis differ ({uneven:g} of "
            f"{moment:g} kg m²), so that the turbine has no constant modes: make them equal"
        )
    joint = split.joints.get((split.relatives[split.shaft].parent, split.shaft))
    if joint is None:
        raise CaseError(f"{path}: {split.shaft}: no bearing1, bearing2, bearing3 or fix1 holds it: add one")
    free = joint.kind == "bearing1"
    stiffness = 1.0 / flexibility if generator > 0 or not free else np.inf
    state = "free (bearing1)" if free else f"locked ({joint.kind})"
    between = [m for m in shaft.masses if 0 < m.node < len(shaft.nodes) - 1 and moved(m.inertia, at)[5, 5] > 0]
    notes = [
        f"generator {state}; shaft "
        + (
            f"{stiffness:g} N m/rad (G I_p of {split.shaft})"
            if np.isfinite(stiffness)
            else "rigid: no generator is behind it"
        )
    ]
    if between:
        notes.append(
            f"inertias between the ends of {split.shaft} are divided between generator and hub as its torsion is"
        )
    return hub, Drivetrain(stiffness, generator, 1.0, free), tuple(notes)


def generator_note(turbine: Turbine) -> tuple[str, ...]:
    """What the generator's inertia does not do."""
    generator = turbine.drivetrain.generator
    if not generator:
        return ()
    rotor = rigid_rotor(turbine, discretize(turbine.blade, 8))[5, 5]
    part = f"{generator:g} kg m² ({100 * generator / rotor:.2g} % of the rotor's)"
    return (f"the generator's inertia about the shaft, {part}, has no gyroscopic moments",)
