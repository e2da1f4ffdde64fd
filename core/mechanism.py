"""A mechanism: bodies, joints (tree and cut), prescribed motion, force elements, gravity. Any of them, not only a blade.

Poses, twists and inertias follow ``core.spatial``. Loops are closed by cutting a joint: its child is reached twice, once
through the tree and once through a massless copy beyond the cut joint, and the two are welded. One kind of constraint (six
equations Φᶜ, the joint's own coordinates kept) then serves a cut joint of every kind (Park et al. 2010, eq. 2).
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import spatial as sp
from .beams import Beams
from .joints import SCREWS, Joint, coordinate_names

Array = NDArray[np.float64]

GROUND = "ground"


class MechanismError(ValueError):
    """A mechanism that cannot be: the message names the element, the value, the likely cause and the remedy."""


@dataclass(frozen=True)
class Body:
    """A rigid body with its 6×6 inertia about its own frame's origin (see ``inertia``)."""

    name: str
    inertia: Array = field(default_factory=lambda: np.zeros((6, 6)))


def inertia(mass: float, moments: ArrayLike = 0.0, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Inertia (6, 6) of a rigid body about its frame's origin.

    Args:
        mass: kg.
        moments: about the centre of mass, kg m²: one number, three principal ones, or a (3, 3) tensor.
        centre: (3,) centre of mass, m.
    """
    m = np.asarray(moments, float)
    tensor = m if m.ndim == 2 else np.eye(3) * m
    out = np.zeros((6, 6))
    out[:3, :3] = mass * np.eye(3)
    out[3:, 3:] = tensor
    shift = sp.adjoint(sp.inverse(sp.pose(np.eye(3), np.asarray(centre, float))))
    return shift.T @ out @ shift


@dataclass(frozen=True)
class Motion:
    """Motion of one coordinate in the steady state: position, rate and acceleration at the instant looked at.

    A ``held`` coordinate is prescribed (Φᴹ): it takes no part in vibration. One that is not held has this rate in the
    steady state but moves freely about it: a rotor whose speed nobody governs, a spinning top.
    """

    coordinate: str
    position: float | None = None
    rate: float = 0.0
    acceleration: float = 0.0
    held: bool = True


@dataclass(frozen=True)
class CoordinateSpring:
    """A spring and damper on one joint coordinate: torque or force ``stiffness (q − rest) + damping q̇``."""

    coordinate: str
    stiffness: float = 0.0
    damping: float = 0.0
    rest: float = 0.0


@dataclass(frozen=True)
class Spring:
    """A spring and damper between points of two bodies: tension ``stiffness (length − rest) + damping × its rate``."""

    body_a: str
    body_b: str
    point_a: Array
    point_b: Array
    stiffness: float = 0.0
    damping: float = 0.0
    rest: float = 0.0


@dataclass(frozen=True)
class Beam:
    """A batch of one beam or bushing between the frames of two bodies; see ``beams.Beams``. ``damping`` as stiffness."""

    body_a: str
    body_b: str
    beams: Beams
    damping: Array = field(default_factory=lambda: np.zeros((6, 6)))
    at_a: Array = field(default_factory=lambda: np.eye(4))
    at_b: Array = field(default_factory=lambda: np.eye(4))


@dataclass(frozen=True)
class Mechanism:
    """What a mechanism is made of; ``compile_tree`` makes it ready to solve."""

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    motions: tuple[Motion, ...] = ()
    coordinate_springs: tuple[CoordinateSpring, ...] = ()
    springs: tuple[Spring, ...] = ()
    beams: tuple[Beam, ...] = ()
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Tree:
    """A mechanism's spanning tree as arrays, one link a coordinate.

    The internal coordinates of beams with mass come last, as links that move nothing.

    Attributes:
        mechanism: where it comes from.
        coordinates: (n) names.
        before: (n,) the link each coordinate's link hangs on, −1 for the ground.
        fixed: (n, 4, 4) pose of the screw's frame in that link.
        screw: (n, 6) unit twist in that frame.
        bodies: (b) names, copies beyond cut joints last.
        link: (b,) link each body rides on, −1 for the ground.
        on_link: (b, 4, 4) pose of the body's frame in its link.
        inertia: (b, 6, 6) in the bodies' own frames.
        welds: pairs (body, copy) of body indices that a cut joint makes one.
        weld_names: the cut joints' names.
        inner: for each beam the first of its six internal coordinates, −1 if it has none.
        above: (n, n) above[j, k]: link k lies on the way from the ground to link j, or is j.
        carries: (b, n) carries[i, k]: coordinate k moves body i.
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
    inner: tuple[int, ...]
    above: NDArray[np.bool_]
    carries: NDArray[np.bool_]

    def body(self, name: str) -> int:
        """Index of a body; −1 is the ground."""
        return -1 if name == GROUND else self.bodies.index(name)

    def coordinate(self, name: str) -> int:
        """Index of a coordinate.

        Raises:
            MechanismError: if there is none of that name.
        """
        if name not in self.coordinates:
            raise MechanismError(f"coordinate {name!r}: no joint has it; there are {', '.join(self.coordinates)}")
        return self.coordinates.index(name)


def compile_tree(mechanism: Mechanism) -> Tree:
    """Choose a spanning tree from the ground outwards, in the order the joints are given; the rest become cut joints.

    Raises:
        MechanismError: names used twice or unknown, a body no joint reaches, an inertia that is not one.
    """
    _check(mechanism)
    names = [b.name for b in mechanism.bodies]
    own = dict(zip(names, (b.inertia for b in mechanism.bodies), strict=True))
    place: dict[str, tuple[int, Array]] = {GROUND: (-1, np.eye(4))}
    before: list[int] = []
    fixed: list[Array] = []
    screw: list[Array] = []
    coordinates: list[str] = []

    def hang(joint: Joint, forward: bool) -> tuple[int, Array]:
        """Lay the joint's screws from whichever end is placed; return where its other end sits."""
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
    lost = [n for n in names if n not in place]
    if lost:
        raise MechanismError(
            f"body {lost[0]!r}: no joint leads to it from the ground; add one (a free joint if it is loose)"
        )
    bodies, welds = list(names), []
    inertias = [own[n] for n in names]
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
    link = np.array([k for k, _ in links], dtype=np.intp)
    return Tree(
        mechanism=mechanism,
        coordinates=tuple(coordinates),
        before=np.array(before, dtype=np.intp),
        fixed=np.array(fixed).reshape(n, 4, 4),
        screw=np.array(screw).reshape(n, 6),
        bodies=tuple(bodies),
        link=link,
        on_link=np.array([x for _, x in links]),
        inertia=np.array(inertias),
        welds=tuple(welds),
        weld_names=tuple(j.name for j in cuts),
        inner=tuple(inner),
        above=above,
        carries=np.vstack([above, np.zeros((1, n), bool)])[link],
    )


def _check(m: Mechanism) -> None:
    names = [b.name for b in m.bodies]
    for what, given in (("body", names), ("joint", [j.name for j in m.joints])):
        twice = sorted({n for n in given if given.count(n) > 1})
        if twice:
            raise MechanismError(f"{what} {twice[0]!r}: given twice; names must be unique")
    if GROUND in names:
        raise MechanismError("body 'ground': the name of the inertial frame; choose another")
    known = {GROUND, *names}
    used = [(f"joint {j.name!r}", n) for j in m.joints for n in (j.parent, j.child)]
    used += [("spring", n) for s in m.springs for n in (s.body_a, s.body_b)]
    used += [("beam", n) for b in m.beams for n in (b.body_a, b.body_b)]
    for what, name in used:
        if name not in known:
            raise MechanismError(f"{what}: body {name!r} is unknown; there are {', '.join(sorted(known))}")
    for j in m.joints:
        if j.kind not in SCREWS:
            raise MechanismError(f"joint {j.name!r}: kind {j.kind!r} is unknown; there are {', '.join(SCREWS)}")
        if j.parent == j.child:
            raise MechanismError(f"joint {j.name!r}: parent and child are both {j.parent!r}")
    for b in m.bodies:
        if b.inertia.shape != (6, 6) or not np.isfinite(b.inertia).all() or not np.allclose(b.inertia, b.inertia.T):
            raise MechanismError(
                f"body {b.name!r}: its inertia must be a finite symmetric 6×6 matrix; build it with inertia()"
            )
        if np.linalg.eigvalsh(b.inertia)[0] < -1e-9 * max(np.abs(b.inertia).max(), 1e-300):
            raise MechanismError(
                f"body {b.name!r}: its inertia is not positive: negative mass or moments about the wrong point?"
            )
