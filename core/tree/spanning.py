"""From a mechanism to its spanning tree: which joints span it, which close loops, and the order of the coordinates."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..element.beams import Beams, Points
from ..element.measures import joined
from ..mechanism.description import GROUND, Mechanism, MechanismError, check_mechanism
from ..mechanism.joints import SCREWS, Joint, coordinate_names
from ..space import spatial as sp
from .topology import Batch, Tree

Array = NDArray[np.float64]
Index = NDArray[np.intp]


def compile_tree(mechanism: Mechanism) -> Tree:
    """Choose a spanning tree from the ground outwards, in the order the joints are given; the others become cut joints.

    Raises:
        MechanismError: names used twice or unknown, a body that no joint reaches, an impossible inertia.
    """
    check_mechanism(mechanism)
    coordinates = _Coordinates()
    # Φ = [Φᴶ; Φᶜ; Φᴹ] = 0 (eq. 2): joints of the tree, ``cuts``, and the mechanism's motions
    placement, cuts = _spanned(mechanism, coordinates)
    names = [b.name for b in mechanism.bodies]
    # each cut joint leads to a massless copy of its child, which is welded to the child
    copies = [_hang(joint, True, placement, coordinates) for joint in cuts]
    originals = [-1 if joint.child == GROUND else names.index(joint.child) for joint in cuts]
    bodies = (*names, *(f"{joint.child} beyond {joint.name}" for joint in cuts))
    inertia = [*(b.inertia for b in mechanism.bodies), *np.zeros((len(cuts), 6, 6))]
    links = [*(placement[name] for name in names), *copies]
    first = [_add_internal(coordinates, k, beam.beams.internal_count) for k, beam in enumerate(mechanism.beams)]
    n = len(coordinates.names)
    parent, internal = (
        np.array(coordinates.parent, dtype=np.intp),
        np.array([j for j in first if j >= 0], dtype=np.intp),
    )
    link = np.array([k for k, _ in links], dtype=np.intp)
    tree = Tree(
        mechanism=mechanism,
        coordinates=tuple(coordinates.names),
        parent=parent,
        fixed=np.array(coordinates.fixed).reshape(n, 4, 4),
        screw=np.array(coordinates.screw).reshape(n, 6),
        bodies=bodies,
        link=link,
        on_link=np.array([pose for _, pose in links]),
        inertia=np.array(inertia),
        welds=tuple(zip(originals, range(len(names), len(bodies)), strict=True)),
        weld_names=tuple(j.name for j in cuts),
        first_internal=internal,
        batches=_batches(mechanism, first, {name: k for k, name in enumerate(bodies)}),
    )
    _check_axes(tree)
    return tree


@dataclass
class _Coordinates:
    """Coordinates while a tree is built; fields as in ``Tree``."""

    names: list[str] = field(default_factory=list)
    parent: list[int] = field(default_factory=list)
    fixed: list[Array] = field(default_factory=list)
    screw: list[Array] = field(default_factory=list)

    def add(self, name: str, parent: int, fixed: Array, screw: Array) -> int:
        """Add a coordinate; return the number of the link that it moves."""
        self.names.append(name)
        self.parent.append(parent)
        self.fixed.append(fixed)
        self.screw.append(screw)
        return len(self.names) - 1


Placement = tuple[int, Array]
"""A link, −1 for the ground, and a pose on it."""


def _spanned(mechanism: Mechanism, coordinates: _Coordinates) -> tuple[dict[str, Placement], list[Joint]]:
    """The place of every body and the cut joints; the tree's coordinates are added."""
    placement: dict[str, Placement] = {GROUND: (-1, np.eye(4))}
    waiting = [j for j in mechanism.joints if not j.cut]
    cuts = [j for j in mechanism.joints if j.cut]
    while ready := next((j for j in waiting if j.parent in placement or j.child in placement), None):
        waiting.remove(ready)
        if ready.parent in placement and ready.child in placement:
            cuts.append(ready)
        elif ready.parent in placement:
            placement[ready.child] = _hang(ready, True, placement, coordinates)
        else:
            placement[ready.parent] = _hang(ready, False, placement, coordinates)
    for body in mechanism.bodies:
        if body.name not in placement:
            raise MechanismError(
                f"body {body.name!r}: no joint connects it to the ground; add one (a free joint if it floats)"
            )
    return placement, cuts


def _hang(joint: Joint, forward: bool, placement: Mapping[str, Placement], coordinates: _Coordinates) -> Placement:
    """Add the joint's coordinates, from the end that is already placed; return the place of the other end."""
    near_frame, far_frame = (joint.at_parent, joint.at_child) if forward else (joint.at_child, joint.at_parent)
    link, pose = placement[joint.parent if forward else joint.child]
    pose = pose @ near_frame
    steps = list(zip(coordinate_names(joint), SCREWS[joint.kind], strict=True))
    for name, (_, screw) in steps if forward else reversed(steps):
        link, pose = coordinates.add(name, link, pose, screw if forward else -screw), np.eye(4)
    return link, pose @ sp.inverse(far_frame)


def _add_internal(coordinates: _Coordinates, beam: int, count: int) -> int:
    """Add the internal coordinates of a beam; return the first, or −1 without any."""
    names = [f"beam {beam + 1}.{j + 1}" for j in range(count)]
    return min((coordinates.add(name, -1, np.eye(4), np.zeros(6)) for name in names), default=-1)


def _check_axes(tree: Tree) -> None:
    """Check that loads turn with axes of prescribed motion: those of a vibrating body would make them follower forces."""
    mechanism = tree.mechanism
    prescribed = {m.coordinate for m in mechanism.motions if m.prescribed}
    axes = {f.axes_of for f in mechanism.loads} | {b.axes_of for b in mechanism.beams if b.beams.points.force.any()}
    for name in sorted(axes - {GROUND}):
        moved_by = [tree.coordinates[j] for j in np.flatnonzero(tree.moves_body[tree.body(name)])]
        free = [coordinate for coordinate in moved_by if coordinate not in prescribed]
        if free:
            raise MechanismError(
                f"load in the axes of {name!r}: coordinate {free[0]!r} moves that body freely: prescribe it, or give the "
                "load in the axes of the ground or of a body whose motion is prescribed"
            )


def _batches(mechanism: Mechanism, first: list[int], bodies: dict[str, int]) -> tuple[Batch, ...]:
    """Beams in batches of one kind; ``first``: the first internal coordinate of each beam, or −1."""
    rows = np.where(np.array(first, dtype=np.intp) >= 0, len(bodies) + np.cumsum(np.array(first) >= 0) - 1, -1)
    by_kind: dict[tuple[str, int], list[int]] = {}
    for k, beam in enumerate(mechanism.beams):
        by_kind.setdefault((beam.beams.law.measure, beam.beams.internal_count), []).append(k)
    out = []
    for index in by_kind.values():
        single_beams = [mechanism.beams[k] for k in index]
        ends = [[bodies.get(b.body_a, -1), bodies.get(b.body_b, -1)] for b in single_beams]
        out.append(
            Batch(
                index=np.array(index, dtype=np.intp),
                ends=np.array(ends, dtype=np.intp),
                first_internal=np.array([first[k] for k in index], dtype=np.intp),
                internal_row=rows[index],
                beams=_together([b.beams for b in single_beams]),
                at_a=np.array([b.at_a for b in single_beams]),
                at_b=np.array([b.at_b for b in single_beams]),
                axes=np.array([bodies.get(b.axes_of, -1) for b in single_beams], dtype=np.intp),
                damping=np.array([b.damping for b in single_beams]),
            )
        )
    return tuple(out)


def _together(single_beams: list[Beams]) -> Beams:
    """Single elements as one batch."""

    def concatenated(name: str) -> Array:
        return np.concatenate([getattr(b, name) for b in single_beams])

    parts = [b.points for b in single_beams]
    points = Points(
        element=np.repeat(np.arange(len(single_beams)), [len(p.element) for p in parts]),
        zeta0=np.concatenate([p.zeta0 for p in parts]),
        shape=np.concatenate([p.shape for p in parts]),
        bubble=np.concatenate([p.bubble for p in parts]),
        mass=np.concatenate([p.mass for p in parts]),
        force=np.concatenate([p.force for p in parts]),
    )
    names = ("stiffness", "preload", "internal_preload")
    return Beams(joined([b.law for b in single_beams]), points=points, **{name: concatenated(name) for name in names})
