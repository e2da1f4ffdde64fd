"""A blade's chain as a general mechanism: hub on a revolute, bodies joined by elastic connections (as in Park et al. 2010).

A joint at the root is an elastic connection too, without length, along the root's axes: its clamped coordinates are
prescribed as zero (Φᴹ), and its springs act on the others.
"""

import numpy as np

from ..element.beams import Beams, Points
from ..element.discretize import Chain
from ..element.measures import part
from ..mechanism.description import GROUND, Beam, Body, CoordinateSpring, Load, Mechanism, Motion
from ..mechanism.joints import SCREWS, Joint
from . import root_joint


def mechanism(chain: Chain, omega: float, gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mechanism:
    """Hub rotating at ``omega`` about z, node 0 fixed to it, every further node on an elastic connection.

    Args:
        chain: the blade, clamped or on a joint; its loads turn with the hub.
        omega: rotor speed, rad/s.
        gravity: (3,) m/s², in the hub's axes, which coincide with the ground's at this instant.
    """
    n, between = len(chain.nodes) - 1, chain.between
    bodies = (Body("hub"), *(Body(f"body {k}", chain.lumps[k]) for k in range(n + 1)))
    frames = np.broadcast_to(np.eye(4), (n, 4, 4)).copy()  # of the connections, in the bodies at both ends
    clamped: list[str] = []
    springs: list[CoordinateSpring] = []
    if chain.clamped.size:
        frames[0, :3, :3] = chain.root_axes
        names = [f"element 1.{name}" for name, _ in SCREWS["elastic"]]
        fixed = root_joint.clamped_freedoms(chain)
        clamped = [name for name, stays in zip(names, fixed, strict=True) if stays]
        springs = [
            CoordinateSpring(*one) for one in zip(names, root_joint.springs(chain).tolist(), strict=True) if one[1]
        ]
    joints = (
        Joint("hub", "revolute", GROUND, "hub"),
        Joint("root", "fixed", "hub", "body 0", at_parent=chain.nodes[0]),
        *(
            Joint(
                f"element {k + 1}",
                "elastic",
                f"body {k}",
                f"body {k + 1}",
                at_parent=between[k] @ frames[k],
                at_child=frames[k],
            )
            for k in range(n)
        ),
    )
    return Mechanism(
        bodies=bodies,
        joints=joints,
        motions=(Motion("hub.rz", 0.0, omega), *(Motion(name, 0.0) for name in clamped)),
        coordinate_springs=tuple(springs),
        beams=tuple(
            Beam(f"body {k}", f"body {k + 1}", one(chain.beams, k), at_b=chain.corner[k], axes_of="hub")
            for k in range(1 if chain.clamped.size else 0, n)
        ),
        loads=tuple(Load(f"body {k}", f, "hub") for k, f in enumerate(chain.force) if f.any()),
        gravity=gravity,
    )


def one(beams: Beams, k: int) -> Beams:
    """The k-th element as a batch of one."""
    mine = beams.points.element == k
    p = beams.points
    none = np.zeros(int(mine.sum()), dtype=np.intp)
    at = slice(k, k + 1)
    return Beams(
        law=part(beams.law, at),
        stiffness=beams.stiffness[at],
        points=Points(none, p.zeta0[mine], p.shape[mine], p.bubble[mine], p.mass[mine], p.force[mine]),
        preload=beams.preload[at],
        inner_preload=beams.inner_preload[at],
    )
