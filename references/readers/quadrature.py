"""Mass, first moments and inertia about the rotor's axis of a blade, by quadrature of its stations.

Properties are linear between stations and the reference curve is a cubic spline of the arc length, as the description of a
blade says; sections are rotated from the blade's axes by the smallest angle to the tangent, then by the twist.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from .stations import Stations

Array = NDArray[np.float64]

POINTS = np.polynomial.legendre.leggauss(5)
"""Points and weights in each interval between stations."""


def weigh(
    blade: Stations,
    hub_radius: float,
    precone: float,
    pitch: float,
    tip: Array,
    *,
    kinks: tuple[float, ...] = (),
    start: float = 0.0,
    rotary: bool = True,
) -> tuple[float, Array, float]:
    """Mass (kg), first moments (3,) (kg m) and inertia about the rotor's axis (kg m²), about the hub's centre.

    Args:
        blade: the stations.
        hub_radius: from the hub's centre to the root along the coned axis, m.
        precone: of the blade's axis towards the rotor's axis, rad.
        pitch: of the whole blade, rad.
        tip: (6, 6) inertia of a rigid body at the tip, in the tip section's axes.
        kinks: arc lengths between which the curve is smooth, m.
        start: arc length at which to begin, m.
        rotary: whether sections have moments of inertia about their mass centres.
    """
    cuts = np.unique(np.append(blade.s[blade.s > start], start))
    x, w = POINTS
    half = 0.5 * np.diff(cuts)[:, None]
    s = (cuts[:-1, None] + half * (1 + x)).ravel()
    weight = (half * w).ravel()
    section = np.moveaxis(
        np.array([[np.interp(s, blade.s, blade.mass[:, i, j]) for j in range(6)] for i in range(6)]), 2, 0
    )
    bodies = np.concatenate([weight[:, None, None] * section, tip[None]])
    at = np.append(s, blade.s[-1])
    place, tangent = _curve(blade, kinks, at)
    across = np.cross([1.0, 0.0, 0.0], tangent)
    sine = np.linalg.norm(across, axis=1)
    vector = across * np.divide(np.arctan2(sine, tangent[:, 0]), sine, out=np.ones_like(sine), where=sine > 0)[:, None]
    turn = Rotation.from_rotvec(np.outer(np.interp(at, blade.s, blade.twist), [1.0, 0.0, 0.0]))
    mounted = Rotation.from_rotvec([0.0, -precone, 0.0]) * Rotation.from_rotvec([pitch, 0.0, 0.0])
    axes = (mounted * Rotation.from_rotvec(vector) * turn).as_matrix()
    root = Rotation.from_rotvec([0.0, -precone, 0.0]).apply([hub_radius, 0.0, 0.0])
    return _sum(bodies, axes, root + mounted.apply(place), rotary)


def _curve(blade: Stations, kinks: tuple[float, ...], s: Array) -> tuple[Array, Array]:
    """Points and unit tangents (k, 3) at arc lengths, each piece between kinks by its own spline."""
    ends = np.array([blade.s[0], *kinks, blade.s[-1]])
    piece = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, len(ends) - 2)
    place, slope = np.empty((len(s), 3)), np.empty((len(s), 3))
    for k in np.unique(piece):
        own = (blade.s >= ends[k]) & (blade.s <= ends[k + 1])
        spline = make_interp_spline(blade.s[own], blade.curve[own], k=min(3, int(own.sum()) - 1))
        place[piece == k], slope[piece == k] = spline(s[piece == k]), spline(s[piece == k], nu=1)
    return place, slope / np.linalg.norm(slope, axis=1, keepdims=True)


def _sum(bodies: Array, axes: Array, place: Array, rotary: bool) -> tuple[float, Array, float]:
    """Of bodies with inertia (n, 6, 6) in axes (n, 3, 3) about points (n, 3): ∫ r rᵀ dm is W = m p pᵀ + p cᵀ + c pᵀ + S."""
    m = bodies[:, 0, 0]
    own = np.stack([bodies[:, 2, 4] * -1, -bodies[:, 0, 5], bodies[:, 0, 4]], axis=1)  # m times the centre
    first = np.einsum("nij,nj->ni", axes, own)
    J = bodies[:, 3:, 3:]
    second = 0.5 * np.trace(J, axis1=1, axis2=2)[:, None, None] * np.eye(3) - J
    if not rotary:  # point masses at the mass centres; the tip's body keeps its moments of inertia
        point = own[:-1, :, None] * own[:-1, None, :]
        second[:-1] = np.divide(point, m[:-1, None, None], out=np.zeros_like(point), where=m[:-1, None, None] > 0)
    S = axes @ second @ np.swapaxes(axes, 1, 2)
    squares = [m * place[:, k] ** 2 + 2 * place[:, k] * first[:, k] + S[:, k, k] for k in (0, 1)]
    total = first.sum(0) + m @ place
    return float(m.sum()), total, float(sum(part.sum() for part in squares))
