"""A turbine as a tree of joints with one coordinate each: tower, yaw, shaft, hub and blades, for codes that solve such trees.

What a beam consists of is the adapter's: a ``Chain``. This module places chains and bodies relative to each other from the
turbine's angles and distances, and has the kinematics of the tree, the weight that the tower carries, the generator, and the
motion of the stations. Nothing of core's elements, frames or reduction is used; the positions of joints are at rest.

Joints are numbered by strain as in ``core.blade``: 0, 1, 2 slide along x, y, z; 3, 4, 5 turn about them.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ...core.blade import clamped, straight
from ...core.modes import STATIONS
from ...core.rotor.turbine import Turbine
from ...core.space.spatial import rotation, skew

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]

SPIN, YAW = 5, 3
"""The shaft turns about its z axis, the nacelle about the tower's x axis."""

UP = np.array([1.0, 0.0, 0.0])

NEWTON = 50


@dataclass(frozen=True)
class Body:
    """Mass, kg, centre (3,), m, and moments of inertia about it (3, 3), kg m², in the axes of a link."""

    mass: float
    centre: Array
    moments: Array

    def moved(self, offset: Array, axes: Array) -> "Body":
        """The same body in a frame in which its own is at ``offset`` (3,) with ``axes`` (3, 3)."""
        return Body(self.mass, offset + axes @ self.centre, axes @ self.moments @ axes.T)


NOTHING = Body(0.0, np.zeros(3), np.zeros((3, 3)))


def joined(*bodies: Body) -> Body:
    """Bodies of one frame as one."""
    mass = sum(b.mass for b in bodies)
    if not mass:
        return NOTHING
    centre = np.sum([b.mass * b.centre for b in bodies], axis=0) / mass
    moments = np.zeros((3, 3))
    for b in bodies:
        arm = skew(b.centre - centre)
        moments += b.moments - b.mass * arm @ arm
    return Body(mass, centre, moments)


def of_matrix(inertia: Array) -> Body:
    """A body from its inertia (6, 6) about the origin, [[m, −m c×], [m c×, J]]."""
    mass = float(inertia[0, 0])
    if not mass:
        return Body(0.0, np.zeros(3), inertia[3:, 3:])
    first = inertia[[5, 3, 4], [1, 2, 0]]  # m c× has −m c_z at (0, 1) … : rows 3 … 5 of the lower block
    centre = first / mass
    return Body(mass, centre, inertia[3:, 3:] + mass * skew(centre) @ skew(centre))


@dataclass(frozen=True)
class Chain:
    """A beam as joints in series, in the axes of what carries it.

    Attributes:
        strain: (n,) kind of each joint.
        stiffness: (n, n) of the joints.
        offset, axes: (n, 3) m, (n, 3, 3) of each joint in the link before; of the first in the carrier.
        bodies: (n) on the links behind the joints.
        root: what moves with the carrier.
        base: (3,) position of the beam's root in the carrier, m.
        nodes: (e,) links that hold the points whose motion is the beam's.
        reach: (e, 3) these points in their links, m.
        arc: (e,) their arc lengths, m.
        tip: (3,), (3, 3) position and axes of the beam's end in the last link.
    """

    strain: Index
    stiffness: Array
    offset: Array
    axes: Array
    bodies: tuple[Body, ...]
    root: Body
    base: Array
    nodes: Index
    reach: Array
    arc: Array
    tip: tuple[Array, Array]


def outside(turbine: Turbine) -> str | None:
    """What of a turbine cannot be placed here: a bent, twisted or sprung tower, blades on hinges or with kinks; or None."""
    tower, blade = turbine.tower, turbine.blade
    if not turbine.support.rigid:
        return "the tower is held by springs"
    if not (straight(tower) and clamped(tower)) or tower.twist.any():
        return "the tower is not straight, without twist and clamped"
    if not clamped(blade):
        return "the blades are not clamped to the hub"
    if blade.kinks:
        return f"a kink at {blade.kinks[0]:g} m: elements end at equal distances"
    return None


@dataclass(frozen=True)
class TurbineTree:
    """The tree of a turbine.

    Attributes:
        turbine: as given.
        strain, parent: (n,) kind of each joint and the link that carries it; −1 is the ground.
        offset, axes: (n, 3), (n, 3, 3) of each joint in its parent.
        bodies: (n) on the links.
        stiffness: (n, n).
        tower: indices of the tower's joints, and the yaw joint if there is one.
        nacelle, spin, hub: links; the spin's coordinate is the azimuth.
        blades: (N, b) joints of the blades.
        rotor: hub and undeformed blades in the axes of the spin's link.
        chains: of tower and blade.
    """

    turbine: Turbine
    strain: Index
    parent: Index
    offset: Array
    axes: Array
    bodies: tuple[Body, ...]
    stiffness: Array
    tower: Index
    nacelle: int
    spin: int
    hub: int
    blades: Index
    rotor: Body
    chains: tuple[Chain, Chain]

    @property
    def shaft(self) -> tuple[int, ...]:
        """The joint of the hub's angle behind the spin, if there is one."""
        return (self.hub,) if self.hub != self.spin else ()


def build(turbine: Turbine, tower: Chain, blade: Chain) -> TurbineTree:
    """Place the parts of a turbine."""
    strain, parent = list(tower.strain), list(range(-1, len(tower.strain) - 1))
    offset, axes = list(tower.offset), list(tower.axes)
    bodies = list(tower.bodies)
    springs = [tower.stiffness]

    def add(kind: int, on: int, at: Array, turned: Array, spring: float, body: Body = NOTHING) -> int:
        strain.append(kind)
        parent.append(on)
        offset.append(at)
        axes.append(turned)
        bodies.append(body)
        springs.append(np.array([[spring]]))
        return len(strain) - 1

    at, turned = tower.tip
    on = len(strain) - 1
    nacelle = of_matrix(turbine.nacelle)
    if np.isfinite(turbine.yaw):
        on, at, turned = add(YAW, on, at, turned, turbine.yaw, nacelle), np.zeros(3), np.eye(3)
    else:
        bodies[on] = joined(bodies[on], nacelle.moved(at, turned))
    pose, drive = turbine.shaft, turbine.drivetrain
    spin = hub = add(SPIN, on, at + turned @ pose[:3, 3], turned @ pose[:3, :3], 0.0)
    carried = range(spin)
    if drive.free or np.isfinite(drive.stiffness):
        locked = 0.0 if drive.free else drive.stiffness
        hub = add(SPIN, spin, np.zeros(3), np.eye(3), locked)
    rest = _undeformed(blade)
    roots, whole, joints = [], [], []
    for k in range(turbine.blades):
        turn = rotation(2, np.array(2.0 * np.pi * k / turbine.blades))
        roots.append(blade.root.moved(np.zeros(3), turn))
        whole.append(joined(blade.root, rest).moved(np.zeros(3), turn))
        first = len(strain)
        joints.append(np.arange(first, first + len(blade.strain)))
        strain += list(blade.strain)
        parent += [hub, *range(first, first + len(blade.strain) - 1)]
        offset += [turn @ blade.offset[0], *blade.offset[1:]]
        axes += [turn @ blade.axes[0], *blade.axes[1:]]
        bodies += list(blade.bodies)
        springs.append(blade.stiffness)
    own = of_matrix(turbine.hub)
    bodies[hub] = joined(own, *roots)
    size = sum(len(s) for s in springs)
    stiffness, start = np.zeros((size, size)), 0
    for part in springs:
        stiffness[start : start + len(part), start : start + len(part)] = part
        start += len(part)
    return TurbineTree(
        turbine=turbine,
        strain=np.array(strain),
        parent=np.array(parent),
        offset=np.array(offset),
        axes=np.array(axes),
        bodies=tuple(bodies),
        stiffness=stiffness,
        tower=np.array(carried),
        nacelle=on,
        spin=spin,
        hub=hub,
        blades=np.array(joints),
        rotor=joined(own, *whole),
        chains=(tower, blade),
    )


def _undeformed(chain: Chain) -> Body:
    """All links of a chain in the axes of its carrier, its joints at zero."""
    R, p, out = np.eye(3), np.zeros(3), []
    for at, turned, body in zip(chain.offset, chain.axes, chain.bodies, strict=True):
        p = p + R @ at
        R = R @ turned
        out.append(body.moved(p, R))
    return joined(*out)


@dataclass(frozen=True)
class Placed:
    """The tree at one configuration: ``axes`` (n, 3, 3) and ``origin`` (n, 3) of the links, ``along`` (n, 3) of the joints."""

    axes: Array
    origin: Array
    along: Array


def placed(tree: TurbineTree, q: Array) -> Placed:
    """The links at the coordinates q (n,)."""
    n = len(q)
    R, p, along = np.zeros((n, 3, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    for k, (kind, on) in enumerate(zip(tree.strain, tree.parent, strict=True)):
        A, o = (R[on], p[on]) if on >= 0 else (np.eye(3), np.zeros(3))
        p[k] = o + A @ tree.offset[k]
        R[k] = A @ tree.axes[k]
        along[k] = R[k][:, kind % 3]
        if kind < 3:
            p[k] = p[k] + along[k] * q[k]
        else:
            R[k] = R[k] @ rotation(int(kind) % 3, q[k])
    return Placed(R, p, along)


def carriers(tree: TurbineTree, link: int) -> list[int]:
    """The joints that move a link, from the ground outwards."""
    out = []
    while link >= 0:
        out.append(link)
        link = int(tree.parent[link])
    return out[::-1]


def jacobian(tree: TurbineTree, at: Placed, link: int, point: Array) -> Array:
    """(6, n) velocity of a point (3,) of a link and its angular velocity by the rates of the joints, in the ground's axes."""
    out = np.zeros((6, len(tree.strain)))
    where = at.origin[link] + at.axes[link] @ point
    for k in carriers(tree, link):
        turns = tree.strain[k] >= 3
        out[:3, k] = np.cross(at.along[k], where - at.origin[k]) if turns else at.along[k]
        out[3:, k] = at.along[k] if turns else 0.0
    return out


def standing(tree: TurbineTree) -> tuple[Array, Array]:
    """Coordinates (t,) of the tower under the weight of all that it carries, and the stiffness (t, t) of that weight.

    Newton's method on the gradient of the potential Σ m g h; the rotor is rigid and carried by the nacelle.
    """
    t, gravity = tree.tower, tree.turbine.gravity
    q = np.zeros(len(tree.strain))
    elastic = tree.stiffness[np.ix_(t, t)]
    for _ in range(NEWTON):
        force, stiffness = _weight(tree, q)
        step = np.linalg.solve(elastic + gravity * stiffness, -(elastic @ q[t] + gravity * force))
        q[t] += step
        if np.abs(step).max() < 1e-13:
            break
    return q[t], gravity * _weight(tree, q)[1]


def _weight(tree: TurbineTree, q: Array) -> tuple[Array, Array]:
    """Gradient (t,) and Hessian (t, t) of Σ m h over the tower's joints: ∂²p/∂q_i∂q_j = a_i × ∂p/∂q_j, i before j."""
    at, t = placed(tree, q), len(tree.tower)
    gradient, hessian = np.zeros(t), np.zeros((t, t))
    turns = tree.strain[:t] >= 3
    for link, body in [*((k, tree.bodies[k]) for k in range(t)), (tree.spin, tree.rotor)]:
        if not body.mass:
            continue
        J = jacobian(tree, at, link, body.centre)[:3, :t]
        gradient += body.mass * UP @ J
        swept = body.mass * np.einsum("a,iaj->ij", UP, np.cross(at.along[:t, None], J.T[None]).swapaxes(1, 2))
        upper = np.triu(swept * turns[:, None] * (np.abs(J).max(0) > 0))
        hessian += upper + np.triu(upper, 1).T
    return gradient, hessian


def with_generator(tree: TurbineTree, q: Array, M: Array, C: Array, K: Array) -> tuple[Array, Array, Array]:
    """The equations (n, n) with the generator and the shaft's spring, without the prescribed azimuth.

    A generator that is free behind a shaft's spring has a coordinate of its own, which is the last.
    """
    drive, n = tree.turbine.drivetrain, len(q)
    at = placed(tree, q)
    own = drive.free and np.isfinite(drive.stiffness)
    size = n + own
    out = [np.zeros((size, size)) for _ in range(3)]
    for total, part in zip(out, (M, C, K), strict=True):
        total[:n, :n] = part
    rotating = np.zeros(size)
    rotating[:n] = at.along[tree.spin] @ jacobian(tree, at, tree.nacelle, np.zeros(3))[3:]
    if drive.free:
        rotating[n if own else tree.hub] += drive.gear_ratio
    out[0] += drive.generator * np.outer(rotating, rotating)
    if own:
        out[2][np.ix_([tree.hub, n], [tree.hub, n])] += drive.stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])
    free = np.delete(np.arange(size), tree.spin)
    M, C, K = (part[np.ix_(free, free)] for part in out)
    return M, C, K


def shapes(tree: TurbineTree, q: Array, x: Complex) -> Complex:
    """(m, 21 (1 + N), 4) motion of the stations in shapes x (n, m) of the joints at azimuth 0; see ``core.rotor.stations``."""
    at, turbine = placed(tree, q), tree.turbine
    tower, blade = tree.chains
    still = np.zeros((6, x.shape[1]), np.complex128)
    out = [_along(still, [jacobian(tree, at, int(k), r) @ x for k, r in zip(tower.nodes, tower.reach, strict=True)],
                  tower, np.eye(3), turbine.tower.length)]  # fmt: skip
    for k, joints in enumerate(tree.blades):
        turn = rotation(2, np.array(2.0 * np.pi * k / turbine.blades))
        root = jacobian(tree, at, tree.hub, turn @ blade.base) @ x
        nodes = [jacobian(tree, at, int(joints[link]), r) @ x for link, r in zip(blade.nodes, blade.reach, strict=True)]
        out.append(_along(root, nodes, blade, at.axes[tree.spin] @ turn, turbine.blade.length))
    return np.concatenate(out, axis=1)


def _along(root: Complex, nodes: Sequence[Complex], chain: Chain, axes: Array, length: float) -> Complex:
    """(m, 21, 4): cubic splines through the motion (6, m) of a chain's root and nodes, in the given axes."""
    motion = np.array([root, *nodes])
    local = np.concatenate([axes.T @ motion[:, :3], (axes[:, 0] @ motion[:, 3:])[:, None]], axis=1)
    return CubicSpline(np.concatenate([[0.0], chain.arc]), local)(STATIONS * length).transpose(2, 0, 1)
