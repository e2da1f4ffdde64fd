"""A blade as a chain: rigid bodies at nodes along the blade, joined by beam elements."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .. import curve
from ..blade import Blade, clamped, mass_at
from ..modes import STATIONS
from ..space import spatial as sp
from ..space.inertia import transformed
from . import beams as bm
from . import sections
from .beams import Beams, Points
from .measures import Measure, StrainLaw, even, joined
from .sections import StaticSolution

Array = NDArray[Any]
Mass = Literal["consistent", "half_end"]


@dataclass(frozen=True)
class Chain:
    """Nodes and elements of a blade; node 0 is clamped to the hub.

    Attributes:
        nodes: (n+1, 4, 4) undeformed poses in the hub's axes.
        lumps: (n+1, 6, 6) inertia of the rigid body at each node, in the node's axes.
        beams: the n elements, from node k to node k+1.
        samples: massless points at ``modes.STATIONS``, where mode shapes are evaluated.
        scale: the blade's length, m.
        force: (n+1, 3) steady loads on the nodes, N, in the hub's axes.
        corner: (n, 4, 4) pose of each element's end b in the frame of its node: the identity (the default), except at a kink,
            where the node has the frame of the section on the tip side.
        clamped: (6, 6) projector of node 1's twist, in the node's axes, on the directions that the root joint clamps; the
            first element then is that joint and has no length. Empty for a clamped root.
        root_axes: (3, 3) axes of the root joint, in those of the first section.
    """

    nodes: Array
    lumps: Array
    beams: Beams
    samples: Points
    scale: float
    force: Array
    corner: Array = field(default_factory=lambda: np.zeros((0, 4, 4)))
    clamped: Array = field(default_factory=lambda: np.zeros((0, 0)))
    root_axes: Array = field(default_factory=lambda: np.eye(3))

    def __post_init__(self) -> None:
        if not self.corner.size:
            object.__setattr__(self, "corner", np.tile(np.eye(4), (len(self.nodes) - 1, 1, 1)))

    @cached_property
    def between(self) -> Array:
        """(n, 4, 4) undeformed poses of nodes 1 … n, each in the frame of the previous node."""
        return self.beams.undeformed @ sp.inverse(self.corner)

    @property
    def elements(self) -> int:
        """Number of beam elements."""
        return len(self.beams.undeformed) - (1 if self.clamped.size else 0)


def discretize(
    blade: Blade,
    elements: int | Array,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    load: Array | None = None,
) -> Chain:
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
    at = curve.on_kinks(STATIONS * blade.length, blade.kinks, curve.SAME * blade.length)
    seg = sections.integrate(blade, s, at)
    nodes, undeformed = seg.nodes, seg.undeformed
    corner = np.tile(np.eye(4), (elements, 1, 1))
    kinked = np.isin(s[1:], blade.kinks)
    corner[kinked] = sp.inverse(nodes[1:][kinked]) @ nodes[:-1][kinked] @ undeformed[kinked]
    lumps, force = np.zeros((elements + 1, 6, 6)), np.zeros((elements + 1, 3))
    if mass == "consistent":
        mass_inside = seg.weight[:, None, None] * mass_at(blade, seg.s)
        inside = bm.riding(undeformed, seg.element, seg.pose, seg.shape, seg.bubble, mass_inside)
        if load is not None:
            inside = replace(inside, force=seg.weight[:, None] * _at(blade, load, seg.s))
    else:
        inside = bm.NO_POINTS
        lumps += _half_end(blade, s)
        if load is not None:
            force += _half_end_force(blade, s, load)
    lumps[-1] += blade.tip_mass
    chain = Chain(
        nodes=nodes,
        lumps=lumps,
        beams=Beams(
            law=StrainLaw(stiffness, undeformed, seg.shortening, seg.mean, seg.slope),
            stiffness=bm.end_stiffness(stiffness, undeformed, np.linalg.inv(seg.flexibility)),
            points=inside,
            preload=np.zeros((elements, 6)),
            inner_preload=np.zeros((elements, 6)),
        ),
        samples=_samples(seg),
        scale=blade.length,
        force=force,
        corner=corner,
    )
    return chain if clamped(blade) else _on_joint(chain, blade)


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
    inner = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(ends[:-1], ends[1:], number, strict=True)]
    return np.concatenate([*inner, ends[-1:]])


def _shared_out(elements: int, lengths: Array) -> NDArray[np.intp]:
    """Number of elements of each piece (p,): one each; every further one goes to the piece with the longest elements."""
    number = np.ones(len(lengths), dtype=np.intp)
    for _ in range(elements - len(lengths)):
        number[np.argmax(lengths / number)] += 1
    return number


def _on_joint(chain: Chain, blade: Blade) -> Chain:
    """The chain with the root's joint before its first element."""
    turn = np.kron(np.eye(2), sp.rotation(0, blade.twist[0]).T)  # from the root's axes to the first section's
    fixed = np.isinf(blade.root)
    b = chain.beams

    def before(new: Array, old: Array) -> Array:
        return np.concatenate([new, old])

    none = np.zeros((1, 6, 6))
    spring = turn @ np.diag(np.where(fixed, 0.0, blade.root)) @ turn.T
    beams = replace(
        b,
        law=joined([even(b.law.measure, np.eye(4)[None]), b.law]),
        stiffness=before(spring[None], b.stiffness),
        points=replace(b.points, element=b.points.element + 1),
        preload=before(none[:, 0], b.preload),
        inner_preload=before(none[:, 0], b.inner_preload),
    )
    return replace(
        chain,
        nodes=before(chain.nodes[:1], chain.nodes),
        lumps=before(none, chain.lumps),
        force=before(none[:, 0, :3], chain.force),
        beams=beams,
        corner=before(np.eye(4)[None], chain.corner),
        samples=replace(chain.samples, element=chain.samples.element + 1),
        clamped=turn @ np.diag(fixed.astype(float)) @ turn.T,
        root_axes=turn[:3, :3],
    )


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
    turn = sp.inverse(sections.frames(blade, nodes))[node] @ sections.frames(blade, s)
    turn[:, :3, 3] = 0.0
    lumps = np.zeros((len(nodes), 6, 6))
    np.add.at(lumps, node, weight[:, None, None] * transformed(mass_at(blade, s), turn))
    return lumps


def _halves(blade: Blade, nodes: Array) -> tuple[NDArray[np.intp], Array, Array]:
    """Nearest node, arc length and weight, each (q,), of the Gauss points in the elements' halves."""
    middle = 0.5 * (nodes[1:] + nodes[:-1])
    points = sections.quadrature(blade, nodes, middle)
    node = points.element[:, None] + (points.s > middle[points.element][:, None])
    return node.ravel(), points.s.ravel(), points.weight.ravel()


def _samples(seg: StaticSolution) -> Points:
    none = np.zeros((len(seg.at_element), 6, 6))
    return bm.riding(seg.undeformed, seg.at_element, seg.at_pose, seg.at_shape, seg.at_bubble, none)
