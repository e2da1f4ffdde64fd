"""A blade's chain as a general mechanism: hub on a revolute, bodies joined by elastic connections."""

import numpy as np
from numpy.typing import NDArray

from ..element.beams import Beams, Points
from ..element.discretize import Chain
from ..element.measures import part
from ..multibody.joints import Joint
from ..multibody.mechanism import GROUND, Beam, Body, Mechanism, Motion

Array = NDArray[np.float64]


def mechanism(chain: Chain, omega: float, gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mechanism:
    """Hub turning at ``omega`` about z, node 0 fixed to it, every further node on an elastic connection (Park 2010, sec. 3).

    Raises:
        ValueError: a chain with loads or a joint at its root, which have no place here yet.
    """
    if chain.force.any() or chain.beams.points.force.any() or chain.held.size:
        raise ValueError(
            "chain: loads, or a joint at the root: only clamped chains under their own weight are rebuilt here"
        )
    n = len(chain.nodes) - 1
    bodies = (Body("hub"), *(Body(f"body {k}", chain.lumps[k]) for k in range(n + 1)))
    joints = (
        Joint("hub", "revolute", GROUND, "hub"),
        Joint("root", "fixed", "hub", "body 0", at_parent=chain.nodes[0]),
        *(
            Joint(f"element {k + 1}", "elastic", f"body {k}", f"body {k + 1}", at_parent=chain.beams.rest[k])
            for k in range(n)
        ),
    )
    beams = tuple(Beam(f"body {k}", f"body {k + 1}", one(chain.beams, k)) for k in range(n))
    return Mechanism(bodies, joints, (Motion("hub.rz", 0.0, omega),), beams=beams, gravity=gravity)


def one(beams: Beams, k: int) -> Beams:
    """The k-th element alone."""
    mine = beams.points.element == k
    p = beams.points
    none = np.zeros(int(mine.sum()), dtype=np.intp)
    at = slice(k, k + 1)
    return Beams(
        law=part(beams.law, at),
        stiffness=beams.stiffness[at],
        points=Points(none, p.rest[mine], p.shape[mine], p.bubble[mine], p.mass[mine], p.force[mine]),
        preload=beams.preload[at],
        inner_preload=beams.inner_preload[at],
    )
