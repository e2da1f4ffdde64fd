"""A mesh as a general mechanism: hub on a revolute, bodies joined by elastic connections (as in Park et al. 2010).

A joint is an elastic connection too, without a beam: its clamped coordinates are prescribed as zero (Φᴹ), and its springs act
on the others.
"""

import numpy as np

from ..element.beams import Beams, Points
from ..element.measures import part
from ..element.mesh import Mesh
from ..mechanism.description import GROUND, Beam, Body, CoordinateSpring, Load, Mechanism, Motion
from ..mechanism.joints import SCREWS, Joint


def mechanism(mesh: Mesh, omega: float, gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mechanism:
    """Hub rotating at ``omega`` about z, node 0 fixed to it, every further node on an elastic connection.

    Args:
        mesh: nodes, elements and joints; its loads turn with the hub.
        omega: rotor speed, rad/s.
        gravity: (3,) m/s², in the hub's axes, which coincide with the ground's at this instant.
    """
    n, between = len(mesh.nodes) - 1, mesh.between
    bodies = (Body("hub"), *(Body(f"body {k}", mesh.lumps[k]) for k in range(n + 1)))
    frames = {joint.link: (joint.at_a, joint.at_b) for joint in mesh.joints}
    joints = [
        Joint("hub", "revolute", GROUND, "hub"),
        Joint("root", "fixed", "hub", "body 0", at_parent=mesh.nodes[0]),
    ]
    for k, a in enumerate(mesh.parent):
        at_a, at_b = frames.get(k, (between[k], np.eye(4)))
        joints.append(Joint(f"element {k + 1}", "elastic", f"body {a}", f"body {k + 1}", at_parent=at_a, at_child=at_b))
    motions = [Motion("hub.rz", 0.0, omega)]
    springs: list[CoordinateSpring] = []
    for joint in mesh.joints:
        for (name, _), stiffness in zip(SCREWS["elastic"], joint.stiffness.tolist(), strict=True):
            coordinate = f"element {joint.link + 1}.{name}"
            if np.isinf(stiffness):
                motions.append(Motion(coordinate, 0.0))
            elif stiffness:
                springs.append(CoordinateSpring(coordinate, stiffness))
    return Mechanism(
        bodies=bodies,
        joints=tuple(joints),
        motions=tuple(motions),
        coordinate_springs=tuple(springs),
        beams=tuple(
            Beam(f"body {a}", f"body {k + 1}", single_element(mesh.beams, k), at_b=mesh.corner[k], axes_of="hub")
            for k, a in enumerate(mesh.parent)
            if k not in frames
        ),
        loads=tuple(Load(f"body {k}", f, "hub") for k, f in enumerate(mesh.force) if f.any()),
        gravity=gravity,
    )


def single_element(beams: Beams, k: int) -> Beams:
    """The k-th element as a batch of one."""
    inside = beams.points.element == k
    p = beams.points
    none = np.zeros(int(inside.sum()), dtype=np.intp)
    at = slice(k, k + 1)
    return Beams(
        law=part(beams.law, at),
        stiffness=beams.stiffness[at],
        points=Points(none, p.zeta0[inside], p.shape[inside], p.bubble[inside], p.mass[inside], p.force[inside]),
        preload=beams.preload[at],
        inner_preload=beams.inner_preload[at],
    )
