"""A blade as a chain: rigid bodies at nodes along the blade, joined by beam elements."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import beams as bm
from . import sections
from . import spatial as sp
from .beams import Beams, Points
from .blade import Blade, mass_at
from .elements import Measure
from .inertia import moved
from .modes import STATIONS

Array = NDArray[Any]
Mass = Literal["consistent", "half_end"]


@dataclass(frozen=True)
class Chain:
    """Nodes and elements of a blade; node 0 is clamped to the hub.

    Attributes:
        nodes: (n+1, 4, 4) rest poses in the hub's axes.
        lumps: (n+1, 6, 6) inertia of the rigid body at each node, in its own axes.
        beams: the n elements, from node k to node k+1.
        samples: where mode shapes are read, at ``modes.STATIONS``; massless.
        scale: the blade's length, m.
    """

    nodes: Array
    lumps: Array
    beams: Beams
    samples: Points
    scale: float


def discretize(blade: Blade, elements: int, mass: Mass = "consistent", stiffness: Measure = "corotational") -> Chain:
    """Divide a blade into ``elements`` of equal arc length.

    Args:
        blade: the blade.
        elements: how many.
        mass: ``consistent`` keeps the mass where it is (fourth order); ``half_end`` lumps each element's halves at its
            ends, as Park et al. 2010 do (second order).
        stiffness: strain measure, see ``elements``.

    Raises:
        ValueError: if there is not at least one element.
    """
    if elements < 1:
        raise ValueError(f"elements: {elements}: a blade needs at least one element")
    s = np.linspace(0.0, blade.length, elements + 1)
    seg = sections.integrate(blade, s)
    nodes = sections.frames(blade, s)
    rest = sp.inverse(nodes[:-1]) @ nodes[1:]
    lumps = np.zeros((elements + 1, 6, 6))
    if mass == "consistent":
        mass_inside = seg.weight[:, None, None] * mass_at(blade, seg.s)
        inside = bm.riding(rest, seg.element, seg.pose, seg.shape, seg.bubble, mass_inside)
        inside = bm.alike(inside, elements)
    else:
        inside = bm.NO_POINTS
        lumps += _half_end(blade, s)
    lumps[-1] += blade.tip_mass
    return Chain(
        nodes=nodes,
        lumps=lumps,
        beams=Beams(
            measure=stiffness,
            rest=rest,
            stiffness=bm.end_stiffness(stiffness, rest, np.linalg.inv(seg.flexibility)),
            shortening=seg.shortening,
            points=inside,
            preload=np.zeros((elements, 6)),
            inner_preload=np.zeros((elements, 6)),
        ),
        samples=_samples(blade, s, nodes, rest),
        scale=blade.length,
    )


def _half_end(blade: Blade, nodes: Array) -> Array:
    """(n+1, 6, 6): each node carries the halves of its neighbouring elements, moved to it along the span."""
    middle = 0.5 * (nodes[1:] + nodes[:-1])
    seg = sections.integrate(blade, nodes, middle)
    node = seg.element + (seg.s > middle[seg.element])
    turn = sp.inverse(sections.frames(blade, nodes))[node] @ sections.frames(blade, seg.s)
    turn[:, :3, 3] = 0.0
    lumps = np.zeros((len(nodes), 6, 6))
    np.add.at(lumps, node, seg.weight[:, None, None] * moved(mass_at(blade, seg.s), turn))
    return lumps


def _samples(blade: Blade, nodes_s: Array, nodes: Array, rest: Array) -> Points:
    at = STATIONS * blade.length
    seg = sections.integrate(blade, nodes_s, at)
    k = np.searchsorted(seg.break_s, at[:-1] - 1e-9 * blade.length)
    element = np.append(seg.break_element[k], len(rest) - 1)
    shape = np.concatenate([seg.break_shape[k], np.eye(6)[None]])
    bubble = np.concatenate([seg.break_bubble[k], np.zeros((1, 6, 6))])
    pose = sp.inverse(nodes[:-1])[element] @ sections.frames(blade, at)
    return bm.riding(rest, element, pose, shape, bubble, np.zeros((len(at), 6, 6)))
