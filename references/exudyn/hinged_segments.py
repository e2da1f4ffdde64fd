"""A blade as rigid segments on elastic hinges: the links of a kinematic tree.

Each element has one hinge with the element's whole compliance in bending, torsion, stretch and shear, at the centroid
of its bending compliance (the middle, if uniform). Between two hinges is a rigid body with the blade's mass and
inertia. The part before the first hinge belongs to the hub, or to the root joint, which slides along its axes x, y, z
and then rotates about them, where these are free. This is a lumped model of second order.

The hinge has the position and axes of its section, so the line may be curved. Its 6×6 compliance is the integral of the
sections' compliances, each rotated into the axes of the hinge, so strains may couple.

Elements end where properties have kinks (see ``reference_line.element_ends``). Steady tension T makes a boundary layer of
thickness √(EI/T) at a clamped root; the elements of a blade without kinks are shorter there.

All joints of a hinge except the last rotation are split in two halves, before and after it. A stretched hinge then
rotates at its middle, and the order of finite rotations does not matter. With all joints on one side the model would be
of first order.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from ...core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION, Blade, clamped
from ..sampling import mass_at, points, stiffness_at
from ..theories.reference_line import element_ends, frames, lumps, root_axes
from ..theories.spectral import intervals

Array = NDArray[np.float64]
Index = NDArray[np.intp]

SEGMENTS = "rigid segments on elastic hinges, both made by the adapter"
"""The theory of codes with these links, as named in ``Independence``."""

SLIDE, TURN = (AXIAL, SHEAR_Y, SHEAR_Z), (TORSION, BEND_Z, BEND_Y)


@dataclass(frozen=True)
class HingedSegments:
    """The links after the hub, in order, one joint each; undeformed, the frames of a joint differ by an offset, then a
    rotation.

    Attributes:
        strain: (n,) the strain that the joint allows (in ``core.blade``'s order of strains).
        stiffness: (n,) of each joint alone, N/m or N m.
        coupling: (n, n) sparse, stiffness between different joints of a hinge; no entries on the diagonal.
        offset, rotation: (n, 3) m, (n, 3, 3) from the previous link; for the first, from the hub's axes, coned.
        segment: (e,) the link that carries the segment, the last of each hinge.
        mass, centre, inertia: (e,), (e, 3), (e, 3, 3) of the segments, in their links' axes; inertia about the centre.
        ends: (k+1,) arc lengths of the ends of the k elements, m.
        reach: (e, 3) from a hinge to the end of its element, in the hinge's axes, m.
        start: arc length of the first hinge, or of the root joint, m; what is before it belongs to the hub.
    """

    strain: Index
    stiffness: Array
    coupling: sparse.csr_array
    offset: Array
    rotation: Array
    segment: Index
    mass: Array
    centre: Array
    inertia: Array
    ends: Array
    reach: Array
    start: float


INTERVALS = 12
"""A blade with more intervals between kinks has proportionally more elements."""

LAYER = 10.0
"""Distance from the root at which elements are twice as long as there, in thicknesses of the layer. Half of it, and twice,
need at most twice the elements."""


def hinge_segments(blade: Blade, elements: int, omega: float = 0.0, equal: bool = False) -> HingedSegments:
    """A blade at ``omega`` (rad/s) as a tree of at least ``elements`` elements, after the root joint if not clamped.

    With ``equal`` there are exactly as many, of equal length, whatever kinks the properties have: convergence is less regular.
    """
    ends = np.linspace(0.0, blade.length, elements + 1) if equal else _ends(blade, elements, omega)
    hinges = _hinges(blade, ends)
    position, axes = frames(blade, hinges)
    soft = np.isfinite(np.diagonal(blade.stiffness[0]))
    slide, rotations = [s for s in SLIDE if soft[s]], [s for s in TURN if soft[s]]
    hinge = np.array([*slide, *rotations, *rotations[-2::-1], *slide[::-1]])
    stiffness = list(_stiffness(blade, ends, axes, hinge))
    joints = [hinge] * (len(ends) - 1)
    reach = (np.swapaxes(axes, 1, 2) @ (frames(blade, ends[1:])[0] - position)[..., None])[..., 0]
    if not clamped(blade):
        free = np.flatnonzero(np.isfinite(blade.root))  # axes in ``JOINT``'s order, as strains are
        joints, stiffness = [free, *joints], [np.diag(blade.root[free]), *stiffness]
        hinges, reach = np.append(0.0, hinges), np.concatenate([np.zeros((1, 3)), reach])
        position = np.concatenate([frames(blade, hinges[:1])[0], position])
        axes = np.concatenate([root_axes(blade)[None], axes])
    count = np.array([len(joint) for joint in joints])
    first = np.cumsum(count) - count
    n = int(count.sum())
    to_previous = np.swapaxes(np.concatenate([np.eye(3)[None], axes[:-1]]), 1, 2)
    offset, joint_rotation = np.zeros((n, 3)), np.tile(np.eye(3), (n, 1, 1))
    offset[first] = (to_previous @ np.diff(position, axis=0, prepend=0.0)[..., None])[..., 0]
    joint_rotation[first] = to_previous @ axes
    mass, centre, inertia = lumps(blade, hinges, position, axes)
    full = sparse.csr_array(sparse.block_diag(stiffness))
    own: Array = full.diagonal().astype(float)
    coupling = full - sparse.diags_array(own)
    coupling.eliminate_zeros()
    return HingedSegments(
        strain=np.concatenate(joints),
        stiffness=own,
        coupling=coupling,
        offset=offset,
        rotation=joint_rotation,
        segment=first + count - 1,
        mass=mass,
        centre=centre,
        inertia=inertia,
        ends=ends,
        reach=reach,
        start=float(hinges[0]),
    )


def _ends(blade: Blade, elements: int, omega: float) -> Array:
    """(k+1,) ends of at least ``elements`` elements; their places at a speed are a fixed function of k, for the order."""
    ends = element_ends(blade, elements, INTERVALS)
    if not omega or not clamped(blade) or len(intervals(blade)) > 2:
        return ends
    s, weight = (part.ravel() for part in points(blade.stations, 3))
    mass = np.append(weight * mass_at(blade, s)[:, 0, 0], blade.tip_mass[0, 0])
    level = np.cos(blade.precone)
    tension = omega**2 * level * mass @ (blade.hub_radius + level * np.append(s, blade.length))
    bend = np.diagonal(blade.stiffness[0])[[BEND_Y, BEND_Z]].min()
    layer = LAYER * np.sqrt(bend / tension) / blade.length
    equal = np.linspace(0.0, 1.0, elements + 1)
    return blade.length * np.append(layer * np.expm1(equal[:-1] * np.log1p(1.0 / layer)), 1.0)


def _pieces(blade: Blade, ends: Array) -> Array:
    """(k+1,) ends of intervals for the quadrature of compliances: in none does a stiffness change by more than a fifth."""
    k = np.diagonal(blade.stiffness, axis1=1, axis2=2)[:, np.isfinite(blade.stiffness[0]).diagonal()]
    inside = [ends, blade.stations]
    for i, c in np.argwhere(k[1:] != k[:-1]):
        first, last = k[i, c], k[i + 1, c]
        sizes = np.geomspace(first, last, int(abs(np.log(last / first)) / np.log(1.2)) + 2)
        a, b = blade.stations[i : i + 2]
        inside.append(a + (b - a) * (sizes[1:-1] - first) / (last - first))
    return np.unique(np.concatenate(inside))


def _hinges(blade: Blade, ends: Array) -> Array:
    """(e,) arc lengths of the centroid of each element's bending compliance."""
    s, weight = (part.ravel() for part in points(_pieces(blade, ends), 3))
    bend = weight * (1.0 / np.diagonal(stiffness_at(blade, s), axis1=1, axis2=2)[:, [BEND_Y, BEND_Z]]).sum(1)
    element, total = np.searchsorted(ends, s) - 1, np.zeros((2, len(ends) - 1))
    np.add.at(total[0], element, bend)
    np.add.at(total[1], element, bend * s)
    return total[1] / total[0]


def _stiffness(blade: Blade, ends: Array, axes: Array, hinge: Index) -> Array:
    """(e, k, k) of the joints ``hinge`` of each element: the inverse of the compliance ``∫ R c Rᵀ ds`` of its sections.

    The two joints of a strain add up to it; their difference has the same stiffness.
    """
    s, weight = (part.ravel() for part in points(_pieces(blade, ends), 3))
    element = np.searchsorted(ends, s) - 1
    strains = np.unique(hinge)
    section = np.linalg.inv(stiffness_at(blade, s)[:, strains[:, None], strains])
    own = np.zeros((len(s), 6, 6))
    own[:, strains[:, None], strains] = section
    R = np.zeros((len(s), 6, 6))
    R[:, :3, :3] = R[:, 3:, 3:] = np.swapaxes(axes[element], 1, 2) @ frames(blade, s)[1]
    compliance = np.zeros((len(ends) - 1, 6, 6))
    np.add.at(compliance, element, weight[:, None, None] * (R @ own @ np.swapaxes(R, 1, 2)))
    stiffness = np.zeros_like(compliance)
    stiffness[:, strains[:, None], strains] = np.linalg.inv(compliance[:, strains[:, None], strains])
    first = np.array([k == list(hinge).index(strain) for k, strain in enumerate(hinge)])
    sign = np.where(first, 1.0, -1.0)
    same_hinge = (hinge[:, None] == hinge) & ((hinge == hinge[:, None]).sum(1) > 1)
    difference = sign[:, None] * sign * same_hinge
    out = stiffness[:, hinge[:, None], hinge]
    return out + difference * np.diagonal(out, axis1=1, axis2=2)[:, None, :]


def root_segment(blade: Blade, start: float) -> tuple[Array, Array, Array]:
    """Mass, centre (3,) and inertia about it (3, 3) of the part before the first hinge, in the hub's axes."""
    at = np.array([0.0, start])
    position, _ = frames(blade, at)
    mass, centre, inertia = lumps(blade, at, position, np.tile(np.eye(3), (2, 1, 1)))
    return mass[0], position[0] + centre[0], inertia[0]
