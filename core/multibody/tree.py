"""A mechanism's spanning tree, compiled to arrays: the topology, before any state."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..element.beams import Beams, Points
from ..element.measures import joined
from ..space import spatial as sp
from .joints import SCREWS, Joint, coordinate_names
from .mechanism import GROUND, Mechanism, MechanismError, check

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Batch:
    """Beams that are processed together: of one strain measure, with the same number of points with mass.

    Attributes:
        index: (e,) which of the mechanism's beams.
        ends: (e, 2) body indices, −1 for the ground.
        inner: (e,) the first of six internal coordinates, −1 if there are none.
        inside: (e,) row of the internal coordinates, after those of the bodies, −1 if there are none.
        beams: the elements.
        at_a, at_b: (e, 4, 4) poses of their end frames in the bodies.
        axes: (e,) index of the body in whose axes the loads on the points are given, −1 for the ground.
        damping: (e, 6, 6) forces conjugate to the strain, from its rate.
    """

    index: NDArray[np.intp]
    ends: NDArray[np.intp]
    inner: NDArray[np.intp]
    inside: NDArray[np.intp]
    beams: Beams
    at_a: Array
    at_b: Array
    axes: NDArray[np.intp]
    damping: Array


@dataclass(frozen=True)
class Groups:
    """Groups of coordinates that move the same rows of B: several of one joint, or of joints in series without mass between.

    Attributes:
        before: (g,) parent group of each, −1 for the ground; always a lower index.
        members: (g, k) coordinates of each group, padded with −1.
        row: (b + m,) the outermost group that moves each row of B, −1 for none.
        place: (n,) position of each coordinate in the flattened ``members``.
        of: (n,) group of each coordinate.
    """

    before: NDArray[np.intp]
    members: NDArray[np.intp]
    row: NDArray[np.intp]
    place: NDArray[np.intp]
    of: NDArray[np.intp]


def _groups(before: NDArray[np.intp], link: NDArray[np.intp], inner: NDArray[np.intp]) -> Groups:
    """Groups from each link's parent, the link that carries each row of B, and the first link of each beam's internal six."""
    n = len(before)
    on = before.copy()
    for j in inner:  # the internal coordinates of a beam move its one row together
        on[j + 1 : j + 6] = np.arange(j, j + 5)
    alone = np.bincount(on[on >= 0], minlength=n) == 1
    alone[link[link >= 0]] = False  # links that carry only one other link
    group, first, members = np.empty(n, np.intp), [], []
    for j in range(n):
        if on[j] >= 0 and alone[on[j]]:
            group[j] = group[on[j]]
            members[group[j]].append(j)
        else:
            group[j] = len(first)
            first.append(group[on[j]] if on[j] >= 0 else -1)
            members.append([j])
    most = max(map(len, members), default=0)
    padded = np.array([m + [-1] * (most - len(m)) for m in members], np.intp).reshape(len(first), most)
    place = np.empty(n, np.intp)
    place[padded[padded >= 0]] = np.flatnonzero(padded >= 0)
    return Groups(np.array(first, np.intp), padded, np.append(group, -1)[link], place, group)


@dataclass(frozen=True)
class Tree:
    """A mechanism's spanning tree as arrays, one link per coordinate.

    The internal coordinates of beams with mass come last, as links that move no body.

    Attributes:
        mechanism: the mechanism.
        coordinates: (n) names.
        before: (n,) parent link of each coordinate's link, −1 for the ground.
        fixed: (n, 4, 4) pose of the screw's frame in the parent link.
        screw: (n, 6) unit twist in that frame.
        bodies: (b) names, copies beyond cut joints last.
        link: (b,) link that carries each body, −1 for the ground.
        on_link: (b, 4, 4) pose of the body's frame in its link.
        inertia: (b, 6, 6) in the bodies' frames.
        welds: pairs (body, copy) of body indices that a cut joint welds together.
        weld_names: the cut joints' names.
        inner: (i,) the first of the six internal coordinates of each beam that has them.
        batches: the beams.
        above: (n, n) above[j, k]: link k is on the path from the ground to link j, or is j.
        beyond: (n, n) beyond[j, k] = 1: link j is a descendant of link k; else 0.
        carries: (b, n) carries[i, k]: coordinate k moves body i.
        groups: the coordinates that move the same rows of B.
    """

    mechanism: Mechanism
    coordinates: tuple[str, ...]
    before: NDArray[np.intp]
    fixed: Array
    screw: Array
    bodies: tuple[str, ...]
    link: NDArray[np.intp]
    on_link: Array
    inertia: Array
    welds: tuple[tuple[int, int], ...]
    weld_names: tuple[str, ...]
    inner: NDArray[np.intp]
    batches: tuple[Batch, ...]
    above: NDArray[np.bool_]
    beyond: Array
    carries: NDArray[np.bool_]
    groups: Groups

    @cached_property
    def _number(self) -> dict[str, int]:
        return {name: j for j, name in enumerate(self.coordinates)}

    def body(self, name: str) -> int:
        """Index of a body; −1 is the ground."""
        return -1 if name == GROUND else self.bodies.index(name)

    def coordinate(self, name: str) -> int:
        """Index of a coordinate.

        Raises:
            MechanismError: if no coordinate has that name.
        """
        if name not in self._number:
            raise MechanismError(f"coordinate {name!r} is unknown; there are {', '.join(self.coordinates)}")
        return self._number[name]


def compile_tree(mechanism: Mechanism) -> Tree:
    """Choose a spanning tree from the ground outwards, in the order the joints are given; the others become cut joints.

    Raises:
        MechanismError: names used twice or unknown, a body that no joint reaches, an impossible inertia.
    """
    check(mechanism)
    names = [b.name for b in mechanism.bodies]
    inertia = dict(zip(names, (b.inertia for b in mechanism.bodies), strict=True))
    place: dict[str, tuple[int, Array]] = {GROUND: (-1, np.eye(4))}
    before: list[int] = []
    fixed: list[Array] = []
    screw: list[Array] = []
    coordinates: list[str] = []

    def hang(joint: Joint, forward: bool) -> tuple[int, Array]:
        """Append the joint's screws, from the end that is already placed; return the link and pose of the other end."""
        near, far = (joint.at_parent, joint.at_child) if forward else (joint.at_child, joint.at_parent)
        link, pose = place[joint.parent if forward else joint.child]
        pose = pose @ near
        steps = list(zip(coordinate_names(joint), SCREWS[joint.kind], strict=True))
        for name, (_, s) in steps if forward else reversed(steps):
            before.append(link)
            fixed.append(pose)
            screw.append(s if forward else -s)
            coordinates.append(name)
            link, pose = len(before) - 1, np.eye(4)
        return link, pose @ sp.inverse(far)

    # Φ = [Φᴶ; Φᶜ; Φᴹ] = 0 (eq. 2): ``waiting`` joints of the tree Φᴶ, ``cuts`` Φᶜ; Φᴹ are the mechanism's motions
    waiting = [j for j in mechanism.joints if not j.cut]
    cuts = [j for j in mechanism.joints if j.cut]
    while True:
        ready = next((j for j in waiting if (j.parent in place) or (j.child in place)), None)
        if ready is None:
            break
        waiting.remove(ready)
        if ready.parent in place and ready.child in place:
            cuts.append(ready)
        elif ready.parent in place:
            place[ready.child] = hang(ready, True)
        else:
            place[ready.parent] = hang(ready, False)
    unreached = [n for n in names if n not in place]
    if unreached:
        raise MechanismError(
            f"body {unreached[0]!r}: no joint connects it to the ground; add one (a free joint if it floats)"
        )
    bodies, welds = list(names), []
    inertias = [inertia[n] for n in names]
    links = [place[n] for n in names]
    for joint in cuts:
        links.append(hang(joint, True))
        inertias.append(np.zeros((6, 6)))
        bodies.append(f"{joint.child} beyond {joint.name}")
        welds.append((names.index(joint.child) if joint.child != GROUND else -1, len(bodies) - 1))
    inner = []
    for i, beam in enumerate(mechanism.beams):
        inner.append(len(before) if beam.beams.inner else -1)
        for j in range(beam.beams.inner):
            before.append(-1)
            fixed.append(np.eye(4))
            screw.append(np.zeros(6))
            coordinates.append(f"beam {i + 1}.{j + 1}")
    n = len(before)
    above = np.zeros((n, n), bool)
    for j in range(n):
        if before[j] >= 0:
            above[j] = above[before[j]]
        above[j, j] = True
    link, on = (np.array(x, dtype=np.intp) for x in ([k for k, _ in links], before))
    inside = np.array([j for j in inner if j >= 0], dtype=np.intp)
    _check_axes(
        mechanism,
        {
            name: [coordinates[j] for j in np.flatnonzero(above[k])]
            for name, k in zip(bodies, link, strict=True)
            if k >= 0
        },
    )
    return Tree(
        mechanism=mechanism,
        coordinates=tuple(coordinates),
        before=on,
        fixed=np.array(fixed).reshape(n, 4, 4),
        screw=np.array(screw).reshape(n, 6),
        bodies=tuple(bodies),
        link=link,
        on_link=np.array([x for _, x in links]),
        inertia=np.array(inertias),
        welds=tuple(welds),
        weld_names=tuple(j.name for j in cuts),
        inner=inside,
        batches=_batches(mechanism, inner, {name: k for k, name in enumerate(bodies)}),
        above=above,
        beyond=above.astype(float) - np.eye(n),
        carries=np.vstack([above, np.zeros((1, n), bool)])[link],
        groups=_groups(on, np.append(link, inside + 5), inside),
    )


def _check_axes(mechanism: Mechanism, moved_by: dict[str, list[str]]) -> None:
    """Check that loads turn with axes of prescribed motion: those of a vibrating body would make them follower forces."""
    given = {m.coordinate for m in mechanism.motions if m.prescribed}
    axes = {f.axes_of for f in mechanism.loads} | {b.axes_of for b in mechanism.beams if b.beams.points.force.any()}
    for name in sorted(axes):
        free = [c for c in moved_by.get(name, []) if c not in given]
        if free:
            raise MechanismError(
                f"load in the axes of {name!r}: coordinate {free[0]!r} moves that body freely: prescribe it, or give the "
                "load in the axes of the ground or of a body whose motion is prescribed"
            )


def _batches(mechanism: Mechanism, inner: list[int], bodies: dict[str, int]) -> tuple[Batch, ...]:
    """Beams in batches of one kind; ``inner``: the first internal coordinate of each beam, or −1."""
    rows = np.where(np.array(inner, dtype=np.intp) >= 0, len(bodies) + np.cumsum(np.array(inner) >= 0) - 1, -1)
    by_kind: dict[tuple[str, int], list[int]] = {}
    for k, beam in enumerate(mechanism.beams):
        by_kind.setdefault((beam.beams.law.measure, len(beam.beams.points.element)), []).append(k)
    out = []
    for index in by_kind.values():
        some = [mechanism.beams[k] for k in index]
        ends = [[bodies.get(b.body_a, -1), bodies.get(b.body_b, -1)] for b in some]
        out.append(
            Batch(
                index=np.array(index, dtype=np.intp),
                ends=np.array(ends, dtype=np.intp),
                inner=np.array([inner[k] for k in index], dtype=np.intp),
                inside=rows[index],
                beams=_together([b.beams for b in some]),
                at_a=np.array([b.at_a for b in some]),
                at_b=np.array([b.at_b for b in some]),
                axes=np.array([bodies.get(b.axes_of, -1) for b in some], dtype=np.intp),
                damping=np.array([b.damping for b in some]),
            )
        )
    return tuple(out)


def _together(some: list[Beams]) -> Beams:
    """Single elements as one batch."""

    def each(name: str) -> Array:
        return np.concatenate([getattr(b, name) for b in some])

    parts = [b.points for b in some]
    points = Points(
        element=np.repeat(np.arange(len(some)), [len(p.element) for p in parts]),
        zeta0=np.concatenate([p.zeta0 for p in parts]),
        shape=np.concatenate([p.shape for p in parts]),
        bubble=np.concatenate([p.bubble for p in parts]),
        mass=np.concatenate([p.mass for p in parts]),
        force=np.concatenate([p.force for p in parts]),
    )
    names = ("stiffness", "preload", "inner_preload")
    return Beams(joined([b.law for b in some]), points=points, **{name: each(name) for name in names})
