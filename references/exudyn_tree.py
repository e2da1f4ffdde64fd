"""Exudyn's kinematic tree: rigid segments on elastic hinges, in relative coordinates.

An element bends, twists, stretches and shears in one hinge, by its whole compliance and where the compliance in bending
has its centroid (the middle, if uniform); what lies between two hinges is a rigid body with the blade's own mass and
inertia. What lies before the first belongs to the hub. This is a lumped model of second order. Exudyn's recursive
equations of motion (R. Featherstone, *Rigid Body Dynamics Algorithms*, 2008) make the large motions, hence the steady
tension's stiffening, and all inertia forces.

Sliding joints sit half on either side of the turning ones, so that a stretched hinge still turns at its middle
(all on one side would cost an order: the middle would be off by half the stretch).

Where the blade has no moments of inertia the segments have none about their own line, and torsion has no modes: M and C
vanish there, and a semi-definite M is all the eigenproblem asks for.
"""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..core.blade import (
    AXIAL,
    BEND_Y,
    BEND_Z,
    SHEAR_Y,
    SHEAR_Z,
    TORSION,
    Blade,
    coupled,
    mass_at,
    stiffness_at,
    straight,
    twist_at,
)
from ..core.model import FULL
from ..core.modes import STATIONS, Modes
from ..core.spatial import rotation, skew
from . import exudyn_system as ex
from .interface import CodeError, Shares
from .quadratic import gyroscopic_modes

Array = NDArray[np.float64]
Index = NDArray[np.intp]

JOINT = ("PrismaticX", "PrismaticY", "PrismaticZ", "RevoluteX", "RevoluteY", "RevoluteZ")
"""Exudyn's joint for each strain; also axis 0, 1, 2, 0, 1, 2."""

SLIDE, TURN = (AXIAL, SHEAR_Y, SHEAR_Z), (TORSION, BEND_Z, BEND_Y)


@dataclass(frozen=True)
class Tree:
    """The links after the hub, a joint each, in order; the frames of a joint at rest differ by an offset, then a turn.

    Attributes:
        strain: (n,) what the joint lets happen (``core.blade``'s order of strains).
        stiffness: (n,) N/m or N m.
        offset, turn: (n, 3), (n, 3, 3) from the link before; from the hub's axes, coned, for the first.
        segment: (e,) the link that carries the segment, the last of each hinge.
        mass, centre, inertia: (e,), (e, 3), (e, 3, 3) of the segments, in their links' axes; inertia about the centre.
        reach: (e,) distance from a hinge to the end of its element, m.
    """

    strain: Index
    stiffness: Array
    offset: Array
    turn: Array
    segment: Index
    mass: Array
    centre: Array
    inertia: Array
    reach: Array


class ExudynTree:
    """See the module; straight blades with twist, taper, shear, precone, pitch and tip mass."""

    name = "exudyn-tree"
    title = "Exudyn, kinematic tree"
    shares: Shares = "nothing"
    model = FULL
    levels = (24, 48, 96)
    order = 2
    hint = ex.HINT

    def version(self) -> str | None:
        """Version of Exudyn."""
        return ex.version()

    def unsupported(self, blade: Blade) -> str | None:
        """A reason if the sections couple, or the blade is curved or rigid in bending."""
        if coupled(blade):
            return "sections couple (off-diagonal entries): the hinges' joints have a spring each"
        if not straight(blade):
            return "prebend or sweep: the hinges are laid along a straight line"
        if np.isinf(blade.stiffness[:, [BEND_Y, BEND_Z], [BEND_Y, BEND_Z]]).any():
            return "rigid in bending: a hinge without joints"
        return None

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.Code``.

        Raises:
            CodeError: an unsupported blade, or no stable steady state at this speed.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")
        begun = time.perf_counter()
        tree = plant(blade, elements)
        M, C, K, q = linearize(tree, omega)
        frequencies, vectors = gyroscopic_modes(M, C, K, count)
        shapes = _shapes(blade, tree, q, vectors)
        return Modes(omega, frequencies, shapes, elements, seconds=time.perf_counter() - begun)


def plant(blade: Blade, elements: int) -> Tree:
    """A blade as a tree of ``elements`` equal elements."""
    ends = np.linspace(0.0, blade.length, elements + 1)
    hinges, stiff = _hinges(blade, ends)
    slide = [strain for strain in SLIDE if np.isfinite(stiff[0, strain])]
    turn = [strain for strain in TURN if np.isfinite(stiff[0, strain])]
    hinge = np.array([*slide, *turn, *slide[::-1]])
    n = len(hinge)
    offset, axes = np.zeros((elements, n, 3)), np.tile(np.eye(3), (elements, n, 1, 1))
    offset[:, 0, 0] = np.diff(hinges, prepend=-blade.hub_radius)
    cone = rotation(1, np.array(-blade.precone))
    offset[0, 0] = cone @ offset[0, 0]
    axes[:, 0] = rotation(0, np.diff(twist_at(blade, hinges), prepend=-blade.pitch))
    axes[0, 0] = cone @ axes[0, 0]
    mass, centre, inertia = _segments(blade, hinges)
    return Tree(
        strain=np.tile(hinge, elements),
        stiffness=(stiff[:, hinge] * np.where(np.isin(hinge, slide), 2.0, 1.0)).ravel(),
        offset=offset.reshape(-1, 3),
        turn=axes.reshape(-1, 3, 3),
        segment=np.arange(1, elements + 1) * n - 1,
        mass=mass,
        centre=centre,
        inertia=inertia,
        reach=ends[1:] - hinges,
    )


def linearize(tree: Tree, omega: float) -> tuple[Array, Array, Array, Array]:
    """M, C, K (n, n) about the steady state at ``omega``, and the joints' coordinates (n,) there.

    The hub is a turning link whose angle is held and whose rate is given; being prescribed, it has no row.
    """
    exu, _container, mbs = ex.system()
    items, n = exu.itemInterface, len(tree.strain) + 1
    mass, centre, inertia = np.zeros(n), np.zeros((n, 3)), np.zeros((n, 3, 3))
    carrier = tree.segment + 1
    mass[carrier], centre[carrier], inertia[carrier] = tree.mass, tree.centre, tree.inertia
    zero = np.zeros(n)
    node = mbs.AddNode(
        items.NodeGenericODE2(
            numberOfODE2Coordinates=n,
            referenceCoordinates=zero,
            initialCoordinates=zero,
            initialCoordinates_t=np.append(omega, zero[1:]),
        )
    )
    mbs.AddObject(
        items.ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[getattr(exu.JointType, JOINT[strain]) for strain in (BEND_Z, *tree.strain)],
            linkParents=np.arange(-1, n - 1),
            jointTransformations=exu.Matrix3DList([np.eye(3), *tree.turn]),
            jointOffsets=exu.Vector3DList([np.zeros(3), *tree.offset]),
            linkMasses=mass,
            linkCOMs=exu.Vector3DList(list(centre)),
            linkInertiasCOM=exu.Matrix3DList(list(inertia)),
            jointPControlVector=np.append(0.0, tree.stiffness),
            jointDControlVector=zero,
            jointPositionOffsetVector=zero,
            jointVelocityOffsetVector=zero,
        )
    )
    ex.hold(exu, mbs, node, [0])
    mbs.Assemble()
    if omega:
        ex.settle(exu, mbs, omega)
    M, C, K = (matrix[1:, 1:] for matrix in ex.linearized(exu, mbs))
    return M, C, K, np.array(mbs.systemData.GetODE2Coordinates(configuration=exu.ConfigurationType.Initial))[1:]


def jacobian(tree: Tree, q: Array, point: Array) -> Array:
    """(e, 6, n): velocity of the point at ``point`` (m) along each segment and its angular velocity, per joint rate.

    In the axes of the first link's parent, with the joints at ``q`` (n,).
    """
    n = len(q)
    to = np.repeat(point, np.diff(tree.segment, prepend=-1))
    R, p = np.eye(3), np.zeros(3)
    axis, origin, where = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    for k, strain in enumerate(tree.strain):
        p = p + R @ tree.offset[k]
        R = R @ tree.turn[k]
        axis[k], origin[k] = R[:, strain % 3], p
        if strain in SLIDE:
            p = p + axis[k] * q[k]
        else:
            R = R @ rotation(strain % 3, q[k])
        where[k] = p + R[:, 0] * to[k]
    turns = np.isin(tree.strain, TURN)[:, None]
    out = np.zeros((len(tree.segment), 6, n))
    for row, k in zip(out, tree.segment, strict=True):
        inner = slice(0, k + 1)
        swept = np.where(turns[inner], np.cross(axis[inner], where[k] - origin[inner]), axis[inner])
        row[:3, inner], row[3:, inner] = swept.T, np.where(turns[inner], axis[inner], 0.0).T
    return out


def _shapes(blade: Blade, tree: Tree, q: Array, vectors: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """(m, 21, 4) at the common stations: a spline through the elements' ends, level at the root across the blade."""
    moved = jacobian(tree, q, tree.reach)[:, :4] @ vectors
    cone = rotation(1, np.array(-blade.precone))
    moved[:, :3] = cone.T @ moved[:, :3]
    ends = np.concatenate([np.zeros((1, *moved.shape[1:])), moved])
    s = np.linspace(0.0, blade.length, len(ends))
    along = CubicSpline(s, ends[:, [0, 3]])(STATIONS * blade.length)
    level: Any = ((1, np.zeros_like(ends[0, 1:3])), "not-a-knot")
    across = CubicSpline(s, ends[:, 1:3], bc_type=level)(STATIONS * blade.length)
    shapes = np.stack([along[:, 0], across[:, 0], across[:, 1], along[:, 1]], axis=1)
    shapes[:, :3] = cone @ shapes[:, :3]
    return shapes.transpose(2, 0, 1)


def _hinges(blade: Blade, ends: Array) -> tuple[Array, Array]:
    """Where each element's bending compliance has its centroid (e,), and its stiffness as a whole (e, 6), ``1/∫ ds/k``."""
    s, weight = _gauss(np.union1d(ends, blade.stations))
    compliance = weight[:, None] / np.diagonal(stiffness_at(blade, s), axis1=1, axis2=2)
    element = np.searchsorted(ends, s) - 1
    total, moment = np.zeros((len(ends) - 1, 6)), np.zeros((len(ends) - 1, 6))
    np.add.at(total, element, compliance)
    np.add.at(moment, element, compliance * s[:, None])
    bend = [BEND_Y, BEND_Z]
    with np.errstate(divide="ignore"):
        return moment[:, bend].sum(1) / total[:, bend].sum(1), 1 / total


def _segments(blade: Blade, hinges: Array) -> tuple[Array, Array, Array]:
    """Mass (e,), centre (e, 3) and inertia about it (e, 3, 3) of what each hinge carries up to the next, or the tip."""
    s, weight = _gauss(np.union1d(np.append(hinges, blade.length), blade.stations[blade.stations > hinges[0]]))
    body = np.concatenate([weight[:, None, None] * mass_at(blade, s), blade.tip_mass[None]])
    s = np.append(s, blade.length)
    hinge = np.searchsorted(hinges, s) - 1
    turn = rotation(0, twist_at(blade, s) - twist_at(blade, hinges)[hinge])
    m, lever = body[:, 0, 0], skew(np.outer(s - hinges[hinge], [1.0, 0.0, 0.0]))
    offset = turn @ -body[:, :3, 3:] @ np.swapaxes(turn, 1, 2)  # momentum m (v + ω × c) makes the block -m [c]×
    first = offset + m[:, None, None] * lever
    second = turn @ body[:, 3:, 3:] @ np.swapaxes(turn, 1, 2) - first @ lever - lever @ offset
    sums = [np.zeros((len(hinges), *part.shape[1:])) for part in (m, first, second)]
    for total, part in zip(sums, (m, first, second), strict=True):
        np.add.at(total, hinge, part)
    mass, first, second = sums
    centre = first / mass[:, None, None]
    return mass, centre[:, [2, 0, 1], [1, 2, 0]], second + mass[:, None, None] * centre @ centre


def _gauss(ends: Array) -> tuple[Array, Array]:
    """Points and weights of three-point Gauss quadrature on each interval between ``ends``."""
    x, w = np.polynomial.legendre.leggauss(3)
    half = 0.5 * np.diff(ends)[:, None]
    return (ends[:-1, None] + half * (x + 1.0)).ravel(), (half * w).ravel()


CODE = ExudynTree()
