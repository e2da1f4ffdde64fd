"""A mesh as a general mechanism: hub on a revolute, bodies joined by elastic connections (as in Park et al. 2010).

A joint of the mesh is a revolute or prismatic joint with a spring, or rigid.
"""

import numpy as np
from numpy.typing import NDArray

from ..element.beams import Beams, Points
from ..element.measures import part
from ..element.mesh import Mesh
from ..mechanism.description import GROUND, Beam, Body, CoordinateSpring, Load, Mechanism, Motion
from ..mechanism.joints import SCREWS, Joint, Kind, at
from ..space import spatial as sp

Array = NDArray[np.float64]


def mechanism(mesh: Mesh, omega: float, gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mechanism:
    """Hub rotating at ``omega`` about z, node 0 fixed to it, every further node on an elastic connection.

    Args:
        mesh: nodes, elements and joints; its loads turn with the hub.
        omega: rotor speed, rad/s.
        gravity: (3,) m/s², in the hub's axes, which coincide with the ground's at this instant.
    """
    n, between = len(mesh.nodes) - 1, mesh.between
    bodies = (Body("hub"), *(Body(f"body {k}", mesh.lumps[k]) for k in range(n + 1)))
    joints = [
        Joint("hub", "revolute", GROUND, "hub"),
        Joint("root", "fixed", "hub", "body 0", at_parent=mesh.nodes[0]),
    ]
    springs: list[CoordinateSpring] = []
    by_link = {joint.link: joint for joint in mesh.joints}
    for k, a in enumerate(mesh.parent):
        name, parent, child = f"element {k + 1}", f"body {a}", f"body {k + 1}"
        if k not in by_link:
            joints.append(Joint(name, "elastic", parent, child, at_parent=between[k]))
            continue
        kind, frame = _along(by_link[k].screw)
        joints.append(Joint(name, kind, parent, child, at_parent=frame, at_child=sp.inverse(between[k]) @ frame))
        if by_link[k].stiffness:
            springs.append(CoordinateSpring(f"{name}.{SCREWS[kind][0][0]}", by_link[k].stiffness))
    return Mechanism(
        bodies=bodies,
        joints=tuple(joints),
        motions=(Motion("hub.rz", 0.0, omega),),
        coordinate_springs=tuple(springs),
        beams=tuple(
            Beam(f"body {a}", f"body {k + 1}", single_element(mesh.beams, k), at_b=mesh.corner[k], axes_of="hub")
            for k, a in enumerate(mesh.parent)
            if k not in by_link
        ),
        loads=tuple(Load(f"body {k}", f, "hub") for k, f in enumerate(mesh.force) if f.any()),
        gravity=gravity,
    )


def _along(screw: Array) -> tuple[Kind, Array]:
    """The joint whose screw (6,) is given in the axes of its parent, and its frame (4, 4) there."""
    linear, angular = screw[:3], screw[3:]
    if angular.any():
        return "revolute", at(*np.cross(angular, linear), axis=angular)
    return ("prismatic", at(axis=linear)) if linear.any() else ("fixed", np.eye(4))


def single_element(beams: Beams, k: int) -> Beams:
    """The k-th element as a batch of one."""
    inside = beams.points.element == k
    p = beams.points
    no_indices = np.zeros(int(inside.sum()), dtype=np.intp)
    at = slice(k, k + 1)
    return Beams(
        law=part(beams.law, at),
        stiffness=beams.stiffness[at],
        points=Points(no_indices, p.zeta0[inside], p.shape[inside], p.bubble[inside], p.mass[inside], p.force[inside]),
        preload=beams.preload[at],
        internal_preload=beams.internal_preload[at],
    )
