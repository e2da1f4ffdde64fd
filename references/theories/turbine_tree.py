"""A turbine as a tree of joints with one coordinate each: tower, yaw, shaft, hub and blades, for codes that solve such trees.

What a beam consists of is the adapter's: a ``Chain``. This module places chains and bodies relative to each other from the
turbine's angles and distances; ``turbine_motion`` has the kinematics of the tree. Nothing of core's elements, frames or
reduction is used; the positions of joints are at rest.

Joints are numbered by strain as in ``core.blade``: 0, 1, 2 slide along x, y, z; 3, 4, 5 turn about them.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.blade import clamped, straight
from ...core.space.spatial import rotation, skew
from ...core.turbine.tower import Support
from ...core.turbine.turbine import Turbine
from ..protocol.fingerprint import Fingerprint, of_turbine

Array = NDArray[np.float64]
Index = NDArray[np.intp]

PLACING = "the adapters' tree of a turbine"
"""What codes that use it share: the places of the bodies, the generator, and the motion of the stations."""

SPIN, YAW = 5, 3
"""The shaft turns about its z axis, the nacelle about the tower's x axis."""


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
    """The reason why a turbine is not supported: a bent, twisted or sprung tower, blades on hinges or with kinks; or None."""
    tower, blade = turbine.tower, turbine.blade
    if turbine.support.springs or turbine.support.soil is not None:
        return "springs along the tower"
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
        chains: of tower, whose first joints are those of its base, and blade.
        foot: number of joints of the base.
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
    foot: int = 0

    @property
    def shaft(self) -> tuple[int, ...]:
        """The joint of the hub's angle behind the spin, if there is one."""
        return (self.hub,) if self.hub != self.spin else ()


def build(turbine: Turbine, tower: Chain, blade: Chain) -> TurbineTree:
    """Place the parts of a turbine."""
    foot = len(turbine.support.free)
    if foot:
        tower = on_springs(tower, turbine.support)
    strain, parent = list(tower.strain), list(range(-1, len(tower.strain) - 1))
    offset, axes = list(tower.offset), list(tower.axes)
    bodies = list(tower.bodies)
    springs = [tower.stiffness]

    def add(kind: int, on: int, at: Array, rotation_in_parent: Array, spring: float, body: Body = NOTHING) -> int:
        strain.append(kind)
        parent.append(on)
        offset.append(at)
        axes.append(rotation_in_parent)
        bodies.append(body)
        springs.append(np.array([[spring]]))
        return len(strain) - 1

    at, rotation_in_parent = tower.tip
    on = len(strain) - 1
    nacelle = of_matrix(turbine.nacelle)
    if np.isfinite(turbine.yaw):
        on, at, rotation_in_parent = add(YAW, on, at, rotation_in_parent, turbine.yaw, nacelle), np.zeros(3), np.eye(3)
    else:
        bodies[on] = joined(bodies[on], nacelle.moved(at, rotation_in_parent))
    pose, drive = turbine.shaft, turbine.drivetrain
    spin = hub = add(SPIN, on, at + rotation_in_parent @ pose[:3, 3], rotation_in_parent @ pose[:3, :3], 0.0)
    carried = range(spin)
    if drive.free or np.isfinite(drive.stiffness):
        locked = 0.0 if drive.free else drive.stiffness
        hub = add(SPIN, spin, np.zeros(3), np.eye(3), locked)
    undeformed = _undeformed(blade)
    roots, blade_bodies, joints = [], [], []
    for k in range(turbine.blades):
        rotation_matrix = rotation(2, np.array(2.0 * np.pi * k / turbine.blades))
        roots.append(blade.root.moved(np.zeros(3), rotation_matrix))
        blade_bodies.append(joined(blade.root, undeformed).moved(np.zeros(3), rotation_matrix))
        first = len(strain)
        joints.append(np.arange(first, first + len(blade.strain)))
        strain += list(blade.strain)
        parent += [hub, *range(first, first + len(blade.strain) - 1)]
        offset += [rotation_matrix @ blade.offset[0], *blade.offset[1:]]
        axes += [rotation_matrix @ blade.axes[0], *blade.axes[1:]]
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
        rotor=joined(own, *blade_bodies),
        chains=(tower, blade),
        foot=foot,
    )


def weighed(tree: TurbineTree, M: Array, elements: int) -> Fingerprint:
    """The inertia in a mass matrix (n, n) of a tree at rest on a base that moves in all directions, see ``floating``."""
    return of_turbine(M[:6, :6], float(M[tree.spin, tree.spin]), elements)


def floating(turbine: Turbine) -> Turbine:
    """The turbine on a base that moves in all directions."""
    return replace(turbine, support=Support(np.eye(6)))


def on_springs(tower: Chain, support: Support) -> Chain:
    """A tower on joints along and about the ground's axes, with the stiffness of its base."""
    assert support.base is not None
    foot = support.free
    count, size = len(foot), len(foot) + len(tower.strain)
    stiffness = np.zeros((size, size))
    stiffness[:count, :count] = support.base[np.ix_(foot, foot)]
    stiffness[count:, count:] = tower.stiffness
    return replace(
        tower,
        strain=np.concatenate([foot, tower.strain]),
        stiffness=stiffness,
        offset=np.concatenate([np.zeros((count, 3)), tower.offset]),
        axes=np.concatenate([np.tile(np.eye(3), (count, 1, 1)), tower.axes]),
        bodies=(*[NOTHING] * (count - 1), tower.root, *tower.bodies),
        nodes=tower.nodes + count,
    )


def _undeformed(chain: Chain) -> Body:
    """All links of a chain in the axes of its carrier, its joints at zero."""
    R, p, out = np.eye(3), np.zeros(3), []
    for at, rotation_in_parent, body in zip(chain.offset, chain.axes, chain.bodies, strict=True):
        p = p + R @ at
        R = R @ rotation_in_parent
        out.append(body.moved(p, R))
    return joined(*out)
