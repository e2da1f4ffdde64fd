"""A blade as a mesh: rigid bodies at nodes along the blade, joined by beam elements."""

from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .. import curve
from ..blade import Blade, clamped
from ..modes import STATIONS
from ..sampling import mass_at
from ..space import spatial as sp
from ..space.inertia import transformed
from . import beams as bm
from . import sections
from .beams import Beams, Points
from .branches import attached, hub
from .measures import Measure, StrainLaw
from .mesh import Mesh
from .sections import StaticSolution

Array = NDArray[Any]
Mass = Literal["consistent", "half_end"]


def discretize(
    blade: Blade,
    elements: int | Array,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    load: Array | None = None,
    at: Array | None = None,
) -> Mesh:
    """Divide a blade into elements.

    Args:
        blade: the blade.
        elements: number of elements, of equal arc length apart from kinks (see ``divide``); or the arc lengths (n+1,) of
            their ends, m, including every kink.
        mass: ``consistent`` distributes the mass along the element (fourth order); ``half_end`` lumps each element's halves
            at its ends, as Park et al. 2010 do (second order).
        stiffness: strain measure, see ``measures``.
        load: (m, 3) steady force per length at the blade's stations, N/m, in the hub's axes, turning with them; linear between
            the stations.
        at: arc lengths of the sample points, m; those of ``modes.STATIONS`` by default.

    Raises:
        ValueError: fewer than one element, or a load that is not one row of three per station.
    """
    if isinstance(elements, np.ndarray):
        s = elements
        elements = len(s) - 1
    elif elements < 1:
        raise ValueError(f"elements: {elements}: a blade needs at least one element")
    else:
        s = divide(blade, elements)
        elements = len(s) - 1
    if load is not None and (load.shape != (len(blade.stations), 3) or not np.isfinite(load).all()):
        raise ValueError(
            f"load: shape {load.shape}: give three finite forces per length for each of {len(blade.stations)} stations"
        )
    if at is None:
        at = curve.on_kinks(STATIONS * blade.length, blade.kinks, curve.KINK_TOLERANCE * blade.length)
    seg = sections.integrate(blade, s, at)
    nodes, undeformed = seg.nodes, seg.undeformed
    corner = np.tile(np.eye(4), (elements, 1, 1))
    kinked = np.isin(s[1:], blade.kinks)
    corner[kinked] = sp.inverse(nodes[1:][kinked]) @ nodes[:-1][kinked] @ undeformed[kinked]
    lumps, force = np.zeros((elements + 1, 6, 6)), np.zeros((elements + 1, 3))
    if mass == "consistent":
        mass_inside = seg.weight[:, None, None] * mass_at(blade, seg.s)
        inside = bm.carried_points(undeformed, seg.element, seg.pose, seg.shape, seg.bubble, mass_inside)
        if load is not None:
            inside = replace(inside, force=seg.weight[:, None] * _at(blade, load, seg.s))
    else:
        inside = bm.NO_POINTS
        lumps += _half_end(blade, s)
        if load is not None:
            force += _half_end_force(blade, s, load)
    lumps[-1] += blade.tip_mass
    mesh = Mesh(
        nodes=nodes,
        lumps=lumps,
        beams=Beams(
            law=StrainLaw(stiffness, undeformed, seg.shortening, seg.mean, seg.slope),
            stiffness=bm.end_stiffness(stiffness, undeformed, np.linalg.inv(seg.flexibility)),
            points=inside,
            preload=np.zeros((elements, 6)),
            internal_preload=np.zeros((elements, 6)),
        ),
        samples=_samples(seg),
        scale=blade.length,
        force=force,
        corner=corner,
    )
    if clamped(blade):
        return mesh
    frame = sp.pose(sp.rotation(0, blade.twist[0]).T, np.zeros(3))  # the root's axes in those of the first section
    return attached(hub(mesh, nodes[0]), 0, mesh, frame, frame, blade.root)


MIN_SHARED = 16
"""Least number of elements to distribute among the pieces between kinks; finer meshes halve these elements."""


def divide(blade: Blade, elements: int) -> Array:
    """Arc lengths (n+1,) of the nodes, m: every kink is a node, and pieces have elements in proportion to their lengths.

    Each piece has at least one, so there may be more elements than requested. From twice ``MIN_SHARED`` on, twice as many
    elements are the same elements halved, so that refinement converges regularly.
    """
    if not blade.kinks:
        return np.linspace(0.0, blade.length, elements + 1)
    ends = np.array([0.0, *blade.kinks, blade.length])
    halved = 1
    while elements % (2 * halved) == 0 and elements >= 2 * MIN_SHARED * halved:
        halved *= 2
    number = halved * _shared_out(elements // halved, np.diff(ends))
    starts = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(ends[:-1], ends[1:], number, strict=True)]
    return np.concatenate([*starts, ends[-1:]])


def _shared_out(elements: int, lengths: Array) -> NDArray[np.intp]:
    """Number of elements of each piece (p,): one each; every further one goes to the piece with the longest elements."""
    number = np.ones(len(lengths), dtype=np.intp)
    for _ in range(elements - len(lengths)):
        number[np.argmax(lengths / number)] += 1
    return number


def _at(blade: Blade, values: Array, s: Array) -> Array:
    """Values (m, 3) at the stations, at arc lengths ``s``."""
    return np.stack([np.interp(s, blade.stations, column) for column in values.T], axis=-1)


def _half_end_force(blade: Blade, nodes: Array, load: Array) -> Array:
    """(n+1, 3): each node carries the load on the halves of its neighbouring elements."""
    node, s, weight = _halves(blade, nodes)
    out = np.zeros((len(nodes), 3))
    np.add.at(out, node, weight[:, None] * _at(blade, load, s))
    return out


def _half_end(blade: Blade, nodes: Array) -> Array:
    """(n+1, 6, 6): each node carries the halves of its neighbouring elements, moved to it along the span."""
    node, s, weight = _halves(blade, nodes)
    rotations = sp.inverse(sections.frames(blade, nodes))[node] @ sections.frames(blade, s)
    rotations[:, :3, 3] = 0.0
    lumps = np.zeros((len(nodes), 6, 6))
    np.add.at(lumps, node, weight[:, None, None] * transformed(mass_at(blade, s), rotations))
    return lumps


def _halves(blade: Blade, nodes: Array) -> tuple[NDArray[np.intp], Array, Array]:
    """Nearest node, arc length and weight, each (q,), of the Gauss points in the elements' halves."""
    middle = 0.5 * (nodes[1:] + nodes[:-1])
    points = sections.quadrature(blade, nodes, middle)
    node = points.element[:, None] + (points.s > middle[points.element][:, None])
    return node.ravel(), points.s.ravel(), points.weight.ravel()


def _samples(seg: StaticSolution) -> Points:
    zeros = np.zeros((len(seg.at_element), 6, 6))
    return bm.carried_points(seg.undeformed, seg.at_element, seg.at_pose, seg.at_shape, seg.at_bubble, zeros)
