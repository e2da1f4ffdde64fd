"""A blade's reference line for finite elements: positions, tangents, section axes, and moments of the sections' mass.

The data of ``core.blade.Blade`` are evaluated independently of core. Shared with core is only the description: a cubic
spline of the arc length through the stations of each piece between kinks, sections rotated about the tangent by the
twist, properties linear between stations (``references.sampling``).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from ...core.blade import Blade, straight
from ...core.space.spatial import skew
from ..sampling import mass_at, points, stiffness_at, twist_at
from .spectral import intervals

Array = NDArray[np.float64]

JUMP = 1e-4
"""Relative to the length: stations closer than this are the two sides of a jump, with a single element between them."""


@dataclass(frozen=True)
class ReferenceLine:
    """Points on the reference line, in axes that rotate with the hub; leading dimensions (elements, points).

    Attributes:
        position: (…, 3) m, from the hub's centre.
        slope: (…, 3) derivative of ``position`` by the arc length.
        axes: (…, 3, 3) the section's axes, in columns.
    """

    position: Array
    slope: Array
    axes: Array


def root_axes(blade: Blade) -> Array:
    """(3, 3) the blade's axes at the root, in columns: with precone and pitch, without twist."""
    cone, pitch = Rotation.from_euler("y", -blade.precone), Rotation.from_euler("x", blade.pitch)
    return (cone * pitch).as_matrix()


def line(blade: Blade, s: Array) -> ReferenceLine:
    """The line at arc lengths ``s`` (e, q), m; each row lies within one piece between kinks.

    The section's x axis is the tangent t. Its axes are the blade's, rotated by the smallest rotation that brings x onto
    t, whose axis and sine are x × t, and then about t by the twist.
    """
    root = root_axes(blade)
    position, slope = np.empty((*s.shape, 3)), np.empty((*s.shape, 3))
    ends = np.array([0.0, *blade.kinks, blade.length])
    piece = np.searchsorted(ends[1:-1], s.mean(1))
    for k in np.unique(piece):
        inside = (blade.stations >= ends[k]) & (blade.stations <= ends[k + 1])
        points = blade.stations[inside], blade.curve[inside]
        spline = make_interp_spline(*points, k=min(3, inside.sum() - 1))
        position[piece == k], slope[piece == k] = spline(s[piece == k]), spline.derivative()(s[piece == k])
    tangent = slope.reshape(-1, 3) / np.linalg.norm(slope.reshape(-1, 3), axis=1, keepdims=True)
    across = np.cross([1.0, 0.0, 0.0], tangent)
    sine = np.linalg.norm(across, axis=1, keepdims=True)
    angle = np.arctan2(sine, tangent[:, :1])
    swing = Rotation.from_rotvec(across * np.where(sine > 0, angle / np.where(sine > 0, sine, 1.0), 1.0))
    twist_rotation = Rotation.from_rotvec(np.outer(twist_at(blade, s.ravel()), [1.0, 0.0, 0.0]))
    axes = (swing * twist_rotation).as_matrix().reshape(*s.shape, 3, 3)
    hub = root @ [blade.hub_radius, 0.0, 0.0]
    return ReferenceLine(hub + position @ root.T, slope @ root.T, root @ axes)


def frames(blade: Blade, s: Array) -> tuple[Array, Array]:
    """Positions (k, 3) and axes (k, 3, 3) of sections, in the hub's axes."""
    at = line(blade, s[:, None])
    return at.position[:, 0], at.axes[:, 0]


def moments(mass: Array) -> Array:
    """(…, 4, 4) ``∫ Y Yᵀ dm`` with Y = (y, 1), y from the reference point, of bodies with inertia ``mass`` (…, 6, 6).

    Momentum is ``m (v − c × ω)`` and the inertia matrix ``J = ∫ (|y|² − y yᵀ) dm``, hence ``∫ y yᵀ dm = ½ tr(J) − J``.
    """
    J, moment = mass[..., 3:, 3:], mass[..., :3, 3:]
    out = np.zeros((*mass.shape[:-2], 4, 4))
    out[..., :3, :3] = 0.5 * np.trace(J, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - J
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., i, 3] = out[..., 3, i] = 0.5 * (moment[..., j, k] - moment[..., k, j])
    out[..., 3, 3] = np.trace(mass[..., :3, :3], axis1=-2, axis2=-1) / 3.0
    return out


def lumps(blade: Blade, begins: Array, position: Array, axes: Array) -> tuple[Array, Array, Array]:
    """Mass (e,), centre (e, 3) and inertia about it (e, 3, 3) of the segment from each beginning to the next, or to the tip.

    They are in frames at ``position`` (e, 3) with ``axes`` (e, 3, 3); ``begins`` (e,) are arc lengths. The tip mass is in them.
    """
    ends = np.union1d(np.append(begins, blade.length), blade.stations[blade.stations > begins[0]])
    s, weight = (part.ravel() for part in points(ends, 3))
    body = np.concatenate([weight[:, None, None] * mass_at(blade, s), blade.tip_mass[None]])
    s = np.append(s, blade.length)
    hinge = np.searchsorted(begins, s) - 1
    centres, section = frames(blade, s)
    to_hinge = np.swapaxes(axes[hinge], 1, 2)
    to_hinge_axes, lever = to_hinge @ section, skew((to_hinge @ (centres - position[hinge])[..., None])[..., 0])
    to_section_axes = np.swapaxes(to_hinge_axes, 1, 2)
    m = body[:, 0, 0]
    offset = to_hinge_axes @ -body[:, :3, 3:] @ to_section_axes  # momentum m (v + ω × c) makes the block -m [c]×
    first = offset + m[:, None, None] * lever
    second = to_hinge_axes @ body[:, 3:, 3:] @ to_section_axes - first @ lever - lever @ offset
    sums = [np.zeros((len(begins), *part.shape[1:])) for part in (m, first, second)]
    for total, part in zip(sums, (m, first, second), strict=True):
        np.add.at(total, hinge, part)
    mass, first, second = sums
    centre = first / mass[:, None, None]
    return mass, centre[:, [2, 0, 1], [1, 2, 0]], second + mass[:, None, None] * centre @ centre


def element_ends(blade: Blade, elements: int, limit: int, step_elements: bool = True) -> Array:
    """Arc lengths (n+1,) of the ends of at least ``elements`` elements; see ``grading`` for uncoupled blades.

    Every interval between two kinks of a property or of the line is divided into the same number of elements, so that
    each element is smooth and the order of convergence is preserved. A blade with more than ``limit`` intervals has
    proportionally more elements, so that refinements stay distinct. A step of a property is one element at every refinement,
    unless it is so soft that this would be inaccurate. Without ``step_elements`` it is the end of the element before it.
    """
    ends, wide = _intervals(blade)
    pieces = np.where(wide, -(-elements // min(int(wide.sum()), limit)), 1)
    parts = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(ends[:-1], ends[1:], pieces, strict=True)]
    needed = [part for part, divided in zip(parts, wide, strict=True) if divided or step_elements]
    return np.concatenate([[0.0], np.concatenate(needed)[1:], ends[-1:]])


def steps(blade: Blade) -> int:
    """Number of elements of ``element_ends`` that are not divided; the others' size is in proportion to their number."""
    return int((~_intervals(blade)[1]).sum())


def _intervals(blade: Blade) -> tuple[Array, NDArray[np.bool_]]:
    """Ends (k+1,) of the intervals between kinks, and which (k,) are no steps."""
    ends = intervals(blade) if straight(blade) else blade.stations
    return ends, (np.diff(ends) > JUMP * blade.length) | ~_flat(blade, ends)


def _flat(blade: Blade, ends: Array) -> NDArray[np.bool_]:
    """Which intervals (k,) have a compliance that three Gauss points integrate, to a millionth of the blade's.

    The stiffness k is linear between the stations, and ``∫ ds/k = h ln(k₁/k₀)/(k₁ − k₀)``.
    """
    k = np.diagonal(stiffness_at(blade, ends), axis1=1, axis2=2)
    first, last = k[:-1, np.isfinite(k[0])], k[1:, np.isfinite(k[0])]
    h, (x,), (w,) = np.diff(ends)[:, None], *points([0.0, 1.0], 3)
    growth = last / first - 1.0
    exact = h / first * np.divide(np.log1p(growth), growth, out=np.ones_like(growth), where=growth != 0.0)
    computed = h * (w / (first[..., None] + (last - first)[..., None] * x)).sum(-1)
    return (np.abs(computed - exact) < 1e-6 * exact.sum(0)).all(1)
