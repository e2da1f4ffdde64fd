"""What the equations of Park et al. (2010) take as given: the tree of bodies and joints, its poses, M and Q.

A ``Mechanism`` comes in. With the solver this shares the description, with the inertia of the bodies, and the force law of an
element with its tangent (``element.measures``). Arrays are complex, and leading axes ``...`` are complex steps
(``space.complex_step``). Velocities are twists at the ground's origin, in its axes; wrenches likewise.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple, get_args

import numpy as np

from .element.measures import Measure, StrainLaw, joined, response
from .mechanism.description import GROUND, Mechanism, MechanismError, check_mechanism
from .mechanism.joints import SCREWS, Joint, coordinate_names
from .space import complex_step as cs
from .space import spatial as sp

Array = np.ndarray[Any, Any]


class Branch(NamedTuple):
    """A joint of the tree, from body ``inboard`` (−1: the ground) to body ``outboard``, with its coordinates and frames."""

    inboard: int
    outboard: int
    own: list[int]
    at_near: Array
    from_far: Array


class Elements(NamedTuple):
    """Massless elements of one strain measure, between the frames ``at_a`` and ``at_b`` of bodies a and b."""

    law: StrainLaw
    stiffness: Array
    preload: Array
    damping: Array
    a: Array
    b: Array
    at_a: Array
    at_b: Array


@dataclass(frozen=True)
class Tree:
    """A mechanism with b bodies, copies beyond cut joints last, and n coordinates.

    Attributes:
        mechanism: the description.
        bodies: index of each body by name; −1 is the ground.
        coordinates: (n) names.
        branches: joints of the tree, from the ground outwards.
        cuts: a body and its copy, for each cut joint.
        screw: (n, 6) unit twist of each coordinate, in its joint's frame.
        inertia: (b, 6, 6) in the bodies' frames.
        moves_body: (b, n) 1: the coordinate moves the body; else 0.
        moves_screw: (n, n) 1: the coordinate of the column moves the screw of the row; else 0.
        elements: the elements by strain measure.
    """

    mechanism: Mechanism
    bodies: dict[str, int]
    coordinates: list[str]
    branches: list[Branch]
    cuts: list[tuple[int, int]]
    screw: Array
    inertia: Array
    moves_body: Array
    moves_screw: Array
    elements: list[Elements]

    def motions(self) -> tuple[list[int], Array]:
        """Prescribed coordinates (m), and their rates and accelerations (m, 2)."""
        prescribed = [m for m in self.mechanism.motions if m.prescribed]
        rates = np.array([(m.rate, m.acceleration) for m in prescribed]).reshape(-1, 2)
        return [self.coordinates.index(m.coordinate) for m in prescribed], rates


def tree(mechanism: Mechanism) -> Tree:
    """The joints of the tree in the order given; a cut joint leads to a massless copy of its child.

    Raises:
        MechanismError: an invalid mechanism, a body that no joint reaches, an element with mass.
    """
    check_mechanism(mechanism)
    b = len(mechanism.bodies)
    bodies = {GROUND: -1, **{body.name: k for k, body in enumerate(mechanism.bodies)}}
    branches, coordinates, screw = [], [], []

    def hang(joint: Joint, forward: bool, outboard: int) -> None:
        way = 1 if forward else -1
        inboard, at_near, at_far = (
            bodies[(joint.parent, joint.child)[1 - forward]],
            *(joint.at_parent, joint.at_child)[::way],
        )
        own = [len(coordinates) + k for k in range(len(SCREWS[joint.kind]))]
        branches.append(Branch(inboard, outboard, own, at_near, sp.inverse(at_far)))
        coordinates.extend(coordinate_names(joint)[::way])
        screw.extend(way * s for _, s in SCREWS[joint.kind][::way])

    placed_bodies = {GROUND}
    waiting, cuts = [j for j in mechanism.joints if not j.cut], [j for j in mechanism.joints if j.cut]
    while joint := next((j for j in waiting if j.parent in placed_bodies or j.child in placed_bodies), None):
        waiting.remove(joint)
        if joint.parent in placed_bodies and joint.child in placed_bodies:
            cuts.append(joint)
        else:
            forward = joint.parent in placed_bodies
            new = joint.child if forward else joint.parent
            hang(joint, forward, bodies[new])
            placed_bodies.add(new)
    if missing := sorted(bodies.keys() - placed_bodies):
        raise MechanismError(
            f"body {missing[0]!r}: no joint connects it to the ground; add one (a free joint if it floats)"
        )
    for k, joint in enumerate(cuts):
        hang(joint, True, b + k)
    moves_body, moves_screw = (
        np.zeros((b + len(cuts) + 1, len(screw))),
        np.zeros((len(screw), len(screw))),
    )  # the ground last
    for inboard, outboard, own, _, _ in branches:
        moves_body[outboard] = moves_body[inboard]
        for k in own:
            moves_screw[k] = moves_body[outboard]
            moves_body[outboard, k] = 1.0
    return Tree(
        mechanism=mechanism,
        bodies=bodies,
        coordinates=coordinates,
        branches=branches,
        cuts=[(bodies[joint.child], b + k) for k, joint in enumerate(cuts)],
        screw=np.array(screw).reshape(-1, 6),
        inertia=np.array([*(body.inertia for body in mechanism.bodies), *np.zeros((len(cuts), 6, 6))]),
        moves_body=moves_body[:-1],
        moves_screw=moves_screw,
        elements=[x for m in get_args(Measure) if (x := _elements(mechanism, bodies, m))],
    )


def _elements(mechanism: Mechanism, bodies: dict[str, int], measure: Measure) -> Elements | None:
    beams = [x for x in mechanism.beams if x.beams.law.measure == measure]
    if not beams:
        return None
    for x in beams:
        if x.beams.internal_count:
            raise MechanismError(f"beam {x.body_a!r}–{x.body_b!r}: it has mass inside: lump the mass at its ends")
    return Elements(
        law=joined([x.beams.law for x in beams]),
        stiffness=np.concatenate([x.beams.stiffness for x in beams]),
        preload=np.concatenate([x.beams.preload for x in beams]),
        damping=np.array([x.damping for x in beams]),
        a=np.array([bodies[x.body_a] for x in beams]),
        b=np.array([bodies[x.body_b] for x in beams]),
        at_a=np.array([x.at_a for x in beams]),
        at_b=np.array([x.at_b for x in beams]),
    )


def poses(t: Tree, q: Array) -> tuple[Array, Array]:
    """Z: poses (..., b + 1, 4, 4) of the bodies, the ground last; and the screws J (..., 6, n) of the coordinates."""
    steps = cs.exp(t.screw, q)
    X, frames = np.zeros((*q.shape[:-1], len(t.inertia) + 1, 4, 4), complex), np.zeros(steps.shape, complex)
    X[..., -1, :, :] = np.eye(4)
    for inboard, outboard, own, at_near, from_far in t.branches:
        x = X[..., inboard, :, :] @ at_near
        for k in own:
            frames[..., k, :, :] = x
            x = x @ steps[..., k, :, :]
        X[..., outboard, :, :] = x @ from_far
    return X, np.ascontiguousarray(cs.transposed(cs.times(cs.adjoint(frames), t.screw)))


def inertia(t: Tree, X: Array) -> Array:
    """M: its diagonal blocks (..., b, 6, 6)."""
    to_body = cs.adjoint(cs.inverse(X[..., :-1, :, :]))
    return cs.transposed(to_body) @ t.inertia @ to_body


def by_bodies(M: Array, Y: Array) -> Array:
    """M Y (..., 6 b) from the blocks of M."""
    return cs.times(M, Y.reshape(*Y.shape[:-1], -1, 6)).reshape(Y.shape)


def forces(t: Tree, X: Array, Y: Array, M: Array) -> Array:
    """Q (..., 6 b): gravity, gyroscopic and centrifugal forces, elements, springs and loads."""
    Y = Y.reshape(*Y.shape[:-1], -1, 6)
    turning = cs.times(cs.transposed(cs.ad(Y)), cs.times(M, Y))  # −Y ×* M Y
    weight = cs.times(M, np.append(t.mechanism.gravity, np.zeros(3)))
    Q, Y = (
        np.concatenate([a, np.zeros((*a.shape[:-2], 1, 6))], axis=-2) for a in (turning + weight, Y)
    )  # the ground last
    for e in t.elements:
        Xa, Xb = X[..., e.a, :, :] @ e.at_a, X[..., e.b, :, :] @ e.at_b
        to_a = cs.adjoint(cs.inverse(Xa))
        rate = cs.times(to_a, Y[..., e.b, :] - Y[..., e.a, :])
        on_b = cs.times(cs.transposed(to_a), -_wrench(e, cs.inverse(Xa) @ Xb, rate))
        for k, (a, b) in enumerate(zip(e.a, e.b, strict=True)):
            Q[..., b, :] += on_b[..., k, :]
            Q[..., a, :] -= on_b[..., k, :]
    for s in t.mechanism.springs:
        ends = [(t.bodies[name], point) for name, point in ((s.body_a, s.point_a), (s.body_b, s.point_b))]
        pa, pb = (cs.times(X[..., k, :3, :3], point) + X[..., k, :3, 3] for k, point in ends)
        va, vb = (Y[..., k, :3] + np.cross(Y[..., k, 3:], p) for (k, _), p in zip(ends, (pa, pb), strict=True))
        length = np.sqrt(((pb - pa) ** 2).sum(-1, keepdims=True))
        n = (pb - pa) / length
        tension = s.stiffness * (length - s.free_length) + s.damping * (n * (vb - va)).sum(-1, keepdims=True)
        Q[..., ends[0][0], :] += _at(pa, tension * n)
        Q[..., ends[1][0], :] -= _at(pb, tension * n)
    for load in t.mechanism.loads:
        k, axes = t.bodies[load.body], t.bodies[load.axes_of]
        Q[..., k, :] += _at(X[..., k, :3, 3], cs.times(X[..., axes, :3, :3], load.force))
    return Q[..., :-1, :].reshape(*Q.shape[:-2], -1)


def _at(point: Array, force: Array) -> Array:
    return np.concatenate([force, np.cross(point, force)], axis=-1)


def _wrench(e: Elements, x: Array, rate: Array) -> Array:
    """Eᵀ s (..., e, 6) at relative poses x (..., e, 4, 4), whose real parts are one state, and relative twists ``rate``."""
    real, beta = x[(0,) * (x.ndim - 3)].real, np.zeros((len(e.a), 0))
    at_rest = response(e.law, real, beta)
    E = at_rest.rate[..., :6]
    s = cs.times(e.stiffness, at_rest.strain) + e.preload
    tangent = cs.transposed(E) @ e.stiffness @ E + response(e.law, real, beta, s).curvature[:, :6, :6]
    damper = cs.transposed(E) @ e.damping @ E
    return cs.times(cs.transposed(E), s) + 1j * cs.times(tangent, cs.variation(x)) + cs.times(damper, rate)


def joint_springs(t: Tree, q: Array, v: Array) -> tuple[list[int], Array]:
    """Coordinates (s) with a spring or damper, and the forces (..., s) on them."""
    springs = t.mechanism.coordinate_springs
    on = [t.coordinates.index(s.coordinate) for s in springs]
    stiffness, damping, neutral = np.array([(s.stiffness, s.damping, s.neutral) for s in springs]).reshape(-1, 3).T
    return on, -stiffness * (q[..., on] - neutral) - damping * v[..., on]
