"""Exact static solution of the elements between a blade's nodes, by integrating the flexibility of its sections.

Clamp frame a and load frame b by a wrench w (at a's origin, in a's axes). The section at s carries ``Ad(F_s)ᵀ w``, and its
strain moves everything beyond it, so the twist of the section at s is

    ρ(s) = f(s) w,   f(s) = ∫ Ad(F) c Ad(F)ᵀ ds   from a to s,

for any coupling, taper, twist or curvature. The element's stiffness is f(b)⁻¹ and its shape functions f(s) f(b)⁻¹. Six bubble
functions describe the effect of loads between the nodes: the element clamped at both ends under uniform loads along its
sections' axes. They are orthogonal to the shape functions in energy and make axial, torsional and shear motion as accurate as
bending. Integrals use Gauss quadrature between the stations (properties are linear there), and f(s) the collocation matrix of
the same points. The inverse of a linear stiffness is not a polynomial: intervals are divided where refinement would not
resolve it.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from .. import curve
from ..blade import AXIAL, BEND_Y, BEND_Z, TORSION, Blade, straight
from ..sampling import stiffness_at, twist_at
from ..space import gauss
from ..space import spatial as sp

Array = NDArray[np.float64]
Index = NDArray[np.intp]

GAUSS = 3
_LARGE = 30.0  # an interval is divided if a stiffness changes by more than this factor in it
_PIECE = 1.05  # the largest factor in a part: the inverse is integrated to 1e-11 there; also for a short interval
_STEP = 1e-2  # an interval up to this fraction of the blade's length is short: refinement may not divide it
_MANY = 200  # with more stations than this, every interval counts as short
RIGID_AXIAL = 1e-8  # compliance of a rigid axial strain, as a fraction of L²/EI: a beam 10⁴ times longer than thick
RIGID_TORSION = 1e-6  # compliance of a rigid torsion, as a fraction of 1/EI


def root(blade: Blade) -> Array:
    """Pose (4, 4) of the root in the hub's axes: precone about −y, then the hub radius along x, then pitch about x."""
    cone, pitch = sp.rotation(1, np.array(-blade.precone)), sp.rotation(0, np.array(blade.pitch))
    return sp.pose(cone @ pitch, cone @ np.array([blade.hub_radius, 0.0, 0.0]))


def frames(blade: Blade, s: Array, *, root_side: bool = False) -> Array:
    """Undeformed poses (k, 4, 4) of the sections at ``s`` (m), in the hub's axes: x tangent, y and z rotated by the twist.

    At a kink, ``root_side`` gives the section on its root side, otherwise the one on its tip side.
    """
    twist_rotation = sp.rotation(0, twist_at(blade, s))
    if straight(blade):
        local = sp.pose(twist_rotation, np.outer(s, [1.0, 0.0, 0.0]))
    else:
        position, t = curve.at(blade.stations, blade.curve, blade.kinks, s, root_side=root_side)
        t /= np.linalg.norm(t, axis=1, keepdims=True)
        w = sp.skew(np.cross([1.0, 0.0, 0.0], t))
        swing = np.eye(3) + w + w @ w / (1.0 + t[:, 0])[:, None, None]
        local = sp.pose(swing @ twist_rotation, position)
    return root(blade) @ local


def compliance(blade: Blade, s: Array) -> Array:
    """Section compliance (k, 6, 6): zero for rigid shear, almost zero for rigid axial and torsional strain."""
    k = stiffness_at(blade, s)
    soft = np.flatnonzero(np.isfinite(k).all(axis=(0, 2)))
    out = np.zeros_like(k)
    out[:, soft[:, None], soft] = np.linalg.inv(k[:, soft[:, None], soft])
    bend = np.minimum(out[:, BEND_Y, BEND_Y], out[:, BEND_Z, BEND_Z])
    if AXIAL not in soft:
        out[:, AXIAL, AXIAL] = RIGID_AXIAL * blade.length**2 * bend
    if TORSION not in soft:
        out[:, TORSION, TORSION] = RIGID_TORSION * bend
    return out


def softened(blade: Blade) -> Blade | None:
    """Copy of the blade with twice the compliance of rigid axial and torsional strains; None if neither is rigid."""
    rigid = [i for i in (AXIAL, TORSION) if np.isinf(blade.stiffness[:, i, i]).any()]
    if not rigid:
        return None
    stiffness = blade.stiffness.copy()
    stiffness[:, rigid, rigid] = 0.5 / compliance(blade, blade.stations)[:, rigid, rigid]
    return replace(blade, stiffness=stiffness)


@dataclass(frozen=True)
class StaticSolution:
    """Gauss points of all elements, in order along the blade, and the elements' static solutions.

    Attributes:
        element: (q,) index of the element that contains each point.
        s, weight: (q,) arc length and quadrature weight, m.
        pose: (q, 4, 4) undeformed pose in the frame of the element's first node.
        flexibility: (n, 6, 6) f(b) of each element.
        shape: (q, 6, 6) twist of the point from the twist of b: f(s) f(b)⁻¹.
        bubble: (q, 6, 6) twist of the points under uniform loads, both ends clamped, scaled to unit stiffness; a load that
            causes no motion has a zero column.
        at_element, at_pose, at_shape, at_bubble: (m,), (m, 4, 4), (m, 6, 6), (m, 6, 6) the same at the requested arc lengths.
        nodes: (n+1, 4, 4) undeformed poses of the nodes in the hub's axes; at a kink, of the section on the tip side.
        undeformed: (n, 4, 4) undeformed pose of each element's end section in the frame of its first node.
        shortening: (n, 6, 6) G: δᵀGδ is the shortening ½∫(|y′|² − |Γ|²) of the static shape, with transverse displacement y and
            Reissner's shear strain Γ (shear alone does not shorten), less that in the logarithmic strain δ of the ends.
        mean, slope: (n, 6, 6), (n, 6, 12) A and B of ``measures``.
    """

    element: Index
    s: Array
    weight: Array
    pose: Array
    flexibility: Array
    shape: Array
    bubble: Array
    at_element: Index
    at_pose: Array
    at_shape: Array
    at_bubble: Array
    nodes: Array
    undeformed: Array
    shortening: Array
    mean: Array
    slope: Array


@dataclass(frozen=True)
class Quadrature:
    """Gauss points between the nodes.

    Attributes:
        start, length: (i,) arc length where each interval begins, and its length, m; no interval contains a station.
        element: (i,) index of the element that contains it.
        s, weight: (i, ``GAUSS``) arc length and weight of its points, m.
    """

    start: Array
    length: Array
    element: Index
    s: Array
    weight: Array


def quadrature(blade: Blade, nodes: Array, breaks: Array | None = None) -> Quadrature:
    """Gauss points between the arc lengths ``nodes`` (n+1,), m.

    Intervals also end at stations, at ``breaks`` (m), and where the stiffness has changed by a large factor.
    """
    ends = np.unique(np.concatenate([nodes, blade.stations, _between(blade), [] if breaks is None else breaks]))
    ends = ends[np.append(True, np.diff(ends) > 1e-12 * blade.length)]
    h = np.diff(ends)
    element = np.searchsorted(nodes, ends[:-1] + 0.5 * h, side="right") - 1
    return Quadrature(ends[:-1], h, element, *gauss.between(ends, GAUSS))


def _between(blade: Blade) -> Array:
    """Arc lengths (m,) that divide the intervals between stations in which a stiffness changes by a large factor.

    From a matrix K₀ to K₁ the stiffness is ``K₀ + t (K₁ − K₀)``. Along the eigenvectors of K₁ relative to K₀, with eigenvalues
    μ, it grows like ``1 + t (μ − 1)``, so that its inverse has poles at ``t = 1/(1 − μ)`` only. With a pole near an end, halved
    elements are similar to the ones before: three points would have the same error at every refinement.
    """
    soft = np.flatnonzero(np.isfinite(blade.stiffness).all(axis=(0, 2)))
    k, s = blade.stiffness[:, soft[:, None], soft], blade.stations
    root = np.linalg.cholesky(k[:-1])
    growth = np.linalg.eigvalsh(np.linalg.solve(root, np.swapaxes(np.linalg.solve(root, k[1:]), 1, 2))) - 1.0
    change = np.exp(np.abs(np.log1p(growth)).max(1, initial=0.0))
    fixed = (np.diff(s) <= _STEP * blade.length) | (len(s) > _MANY)
    inserted = []
    for i in np.flatnonzero(change > np.where(fixed, _PIECE, _LARGE)):
        for t in _pieces(float(growth[i].max()), float(growth[i].min())):
            inserted.append(s[i] + t * (s[i + 1] - s[i]))
    return np.array(inserted)


def _pieces(fastest: float, slowest: float) -> Iterator[float]:
    """Where to divide 0 < t < 1, so that no ``1 + t g`` with g between these values changes by more than ``_PIECE``."""
    nearest_pole = (
        1.0 / fastest if fastest > 0.0 else np.inf
    )  # distances of the nearest poles from the interval's start
    next_pole = -1.0 / slowest if slowest < 0.0 else np.inf
    t = 0.0
    while (t := t + min((_PIECE - 1.0) * (nearest_pole + t), (1.0 - 1.0 / _PIECE) * (next_pole - t))) < 1.0:
        yield t


def integrate(blade: Blade, nodes: Array, at: Array | None = None) -> StaticSolution:
    """Integrate the flexibility between the arc lengths ``nodes`` (n+1,), and up to the arc lengths ``at`` (m,), m.

    Every kink must be a node: the end frames of an element are those of its end sections, on the element's side.
    """
    points = quadrature(blade, nodes)
    h, element, s = points.length, points.element, points.s
    _, b, a = collocation(GAUSS)
    at = np.zeros(0) if at is None else at
    interval = np.clip(np.searchsorted(points.start, at, side="right") - 1, 0, None)
    until = partial_weights(GAUSS, (at - points.start[interval]) / h[interval])
    n = len(nodes) - 1
    poses, inside, at_points = np.split(frames(blade, np.concatenate([nodes, s.ravel(), at])), [n + 1, n + 1 + s.size])
    ends = frames(blade, nodes[1:], root_side=True) if blade.kinks else poses[1:]
    to_first = sp.inverse(poses[:-1])
    pose = to_first[element][:, None] @ inside.reshape(*s.shape, 4, 4)
    undeformed = to_first @ ends
    lever = sp.adjoint(pose)
    soft = compliance(blade, s.ravel()).reshape(*s.shape, 6, 6)
    compliances = lever @ soft @ np.swapaxes(lever, -1, -2)
    start = np.searchsorted(element, np.arange(n))

    def weighted_sums(weights: Array, values: Array) -> Array:
        """Weighted sums over the Gauss points of each interval, times its length: (i, w, k, l)."""
        sums = weights @ values.reshape(len(values), GAUSS, -1)
        return h[:, None, None, None] * sums.reshape(len(values), len(weights), *values.shape[2:])

    def element_integral(values: Array) -> Array:
        """Integral over each element."""
        return np.add.reduceat(weighted_sums(b[None], values)[:, 0], start, axis=0)

    def running(values: Array) -> tuple[Array, Array, Array]:
        """Integral from the element's start to its Gauss points and to the points ``at``, and over the whole element."""
        parts = weighted_sums(b[None], values)[:, 0]
        before = np.cumsum(parts, axis=0) - parts
        before -= before[start][element]
        up_to_at = before[interval] + np.einsum("m,mq,mqkl->mkl", h[interval], until, values[interval])
        return before[:, None] + weighted_sums(a, values), up_to_at, np.add.reduceat(parts, start, axis=0)

    within, up_to_at, flexibility = running(compliances)
    stiffness = np.linalg.inv(flexibility)
    q, at_element = np.repeat(element, GAUSS), element[interval]
    shape, at_shape = within.reshape(-1, 6, 6) @ stiffness[q], up_to_at @ stiffness[at_element]
    size = np.repeat(np.array([1.0, float(np.mean(np.diff(nodes)))]), 3)
    to_section = sp.adjoint(sp.inverse(pose))
    load = np.swapaxes(to_section, -1, -2) * size  # unit loads of the sections, as wrenches at a
    nearer, _, total = running(load)
    carried = total[element][:, None] - nearer  # beyond each point
    compliant, up_to_at, tip = running(compliances @ carried)
    bubble = compliant.reshape(-1, 6, 6) - shape @ tip[q]
    at_bubble = up_to_at - at_shape @ tip[at_element]
    work = element_integral(np.swapaxes(load, -1, -2) @ bubble.reshape(load.shape))
    unit = _unit_stiffness(work)
    local = soft @ np.swapaxes(lever, -1, -2)  # the sections' strain from a wrench at a
    loaded = (local @ (carried - (stiffness @ tip)[element][:, None])) @ unit[element][:, None]
    last = sp.log(undeformed)
    of_ends = sp.tangent(last)  # the twist of b from δ
    strain = local @ (stiffness @ of_ends)[element][:, None]
    rotation = shape.reshape(compliances.shape)[..., 3:, :] @ of_ends[element][:, None]
    length = np.diff(nodes)[element][:, None, None]
    part = (s - nodes[element][:, None])[..., None] / length
    bow = _bow(to_section, part, length, last[element][:, None], strain, rotation)
    uneven = 12.0 * (part[..., None] - 0.5) * np.concatenate([strain, loaded], axis=-1)
    return StaticSolution(
        element=q,
        s=s.ravel(),
        weight=points.weight.ravel(),
        pose=pose.reshape(-1, 4, 4),
        flexibility=flexibility,
        shape=shape,
        bubble=bubble @ unit[q],
        at_element=at_element,
        at_pose=to_first[at_element] @ at_points,
        at_shape=at_shape,
        at_bubble=at_bubble @ unit[at_element],
        nodes=poses,
        undeformed=undeformed,
        shortening=element_integral(bow),
        mean=element_integral(strain),
        slope=element_integral(uneven),
    )


def _bow(to_section: Array, part: Array, length: Array, last: Array, strain: Array, rotations: Array) -> Array:
    """Integrand (i, q, 6, 6) of G of ``measures`` at the Gauss points.

    Args:
        to_section: (i, q, 6, 6) from twists in the element's frame to those of the sections, in their axes.
        part: (i, q, 1) fraction of the element's length before the points.
        length: (i, 1, 1) of the elements, m.
        last: (i, 1, 6) logarithm of the undeformed elements.
        strain, rotations: (i, q, 6, 6), (i, q, 3, 6) the sections' strains, and their rotations in the element's axes, from δ.
    """
    along = part * last
    uniform = to_section[..., 1:3, :] @ (sp.adjoint(sp.exp(along)) / length[..., None])  # the helicoid's shear strain
    turning = part[..., None] * sp.tangent(along)[..., 3:, :]
    tilt = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]) @ to_section[..., :3, :3]  # θ_z and −θ_y of a rotation θ
    displaced = strain[..., 1:3, :] + tilt @ rotations  # y′ = Γ_y + θ_z, z′ = Γ_z − θ_y
    helicoid = uniform + tilt @ turning
    shear = np.eye(6)[1:3] / length[..., None]  # of the helicoid
    return 0.5 * (_squared(displaced) - _squared(strain[..., 1:3, :]) - _squared(helicoid) + _squared(shear))


def _squared(slope: Array) -> Array:
    return np.swapaxes(slope, -1, -2) @ slope


def _unit_stiffness(work: Array) -> Array:
    """(n, 6, 6) T with Tᵀ work T = 1 over the loads that do work, zero columns for those that do none."""
    value, vector = np.linalg.eigh(0.5 * (work + np.swapaxes(work, -1, -2)))
    active = value > 1e-9 * value[:, -1:]
    return vector * np.where(active, 1.0 / np.sqrt(np.where(active, value, 1.0)), 0.0)[:, None, :]


@lru_cache
def collocation(n: int) -> tuple[Array, Array, Array]:
    """Gauss points c and weights b on [0, 1], and the matrix ∫₀^{c_q} ℓ_j of their Lagrange polynomials."""
    c, b = gauss.rule(n)
    return c, b, _up_to(c, c)


def partial_weights(n: int, x: Array) -> Array:
    """(m, n) weights of the n Gauss points on [0, 1] for the integrals from 0 to x (m,)."""
    return _up_to(collocation(n)[0], x)


def _up_to(c: Array, x: Array) -> Array:
    powers = np.arange(len(c))
    return (x[:, None] ** (powers + 1) / (powers + 1)) @ np.linalg.inv(c[:, None] ** powers)
