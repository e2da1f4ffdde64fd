"""A straight blade as rigid segments on elastic hinges: the links of a kinematic tree, for a code that takes one.

An element bends, twists, stretches and shears in one hinge, by its whole compliance and where the compliance in bending
has its centroid (the middle, if uniform); what lies between two hinges is a rigid body with the blade's own mass and
inertia. What lies before the first belongs to the hub. This is a lumped model of second order.

Sliding joints sit half on either side of the turning ones, so that a stretched hinge still turns at its middle
(all on one side would cost an order: the middle would be off by half the stretch).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION, Blade, mass_at, stiffness_at, twist_at
from ...core.space.spatial import rotation, skew

Array = NDArray[np.float64]
Index = NDArray[np.intp]

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
