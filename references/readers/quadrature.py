"""Mass, first moments, inertia about the rotor's axis and tip flexibility of a blade, by quadrature of its stations.

Properties are linear between stations and the reference curve is a cubic spline of the arc length, as the description of a
blade says; sections are rotated from the blade's axes by the smallest angle to the tangent, then by the twist.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from .stations import Stations

Array = NDArray[np.float64]

POINTS = np.polynomial.legendre.leggauss(64)
"""Points and weights in each interval between stations. A compliance is the inverse of a linear stiffness, which near the tip
may fall by a factor of a hundred from one station to the next."""


@dataclass(frozen=True)
class Mounted:
    """Stations on a hub.

    Attributes:
        stations: the stations.
        hub_radius: from the hub's centre to the root along the coned axis, m.
        precone: of the blade's axis towards the rotor's axis, rad.
        pitch: of the whole blade, rad.
        kinks: arc lengths between which the curve is smooth, m.
    """

    stations: Stations
    hub_radius: float
    precone: float
    pitch: float
    kinks: tuple[float, ...] = ()


def weigh(blade: Mounted, tip: Array, start: float = 0.0, rotary: bool = True) -> tuple[float, Array, float]:
    """Mass (kg), first moments (3,) (kg m) and inertia about the rotor's axis (kg m²), about the hub's centre.

    Args:
        blade: the stations on their hub.
        tip: (6, 6) inertia of a rigid body at the tip, in the tip section's axes.
        start: arc length at which to begin, m.
        rotary: whether sections have moments of inertia about their mass centres.
    """
    mass, first, second = moments(blade, tip, start, rotary)
    return mass, first, float(second[0, 0] + second[1, 1])


def moments(blade: Mounted, tip: Array, start: float = 0.0, rotary: bool = True) -> tuple[float, Array, Array]:
    """Mass, first moments (3,) and ∫ r rᵀ dm (3, 3), kg m², about the hub's centre; arguments as for ``weigh``."""
    s, weight = _points(blade.stations.s, start)
    bodies = np.concatenate([weight[:, None, None] * linear(blade.stations.s, blade.stations.mass, s), tip[None]])
    position, axes = placed(blade, np.append(s, blade.stations.s[-1]))
    return _sum(bodies, axes, position, rotary)


def bend(blade: Mounted) -> Array:
    """Flexibility (6, 6) of the tip of a clamped blade: displacements and rotations by unit forces and moments there.

    The axes are those of the hub; m/N, rad/N and rad/(N m). The virtual work of a section is Bᵀ C B with the strains B due to
    a unit load at the tip.
    """
    s, weight = _points(blade.stations.s, 0.0)
    position, axes = placed(blade, np.append(s, blade.stations.s[-1]))
    stiffness = blade.stations.stiffness
    soft = np.flatnonzero(np.isfinite(np.diagonal(stiffness, axis1=1, axis2=2)).all(axis=0))
    compliance = np.linalg.inv(linear(blade.stations.s, stiffness[:, soft[:, None], soft], s))
    arm = position[-1] - position[:-1]
    unit_loads = np.zeros((6, len(s), 2, 3))
    for load, (force, moment) in zip(unit_loads, np.eye(6).reshape(6, 2, 3), strict=True):
        load[:, 0], load[:, 1] = force, moment + np.cross(arm, force)
    loads = np.einsum("nji,lnkj->lnki", axes[:-1], unit_loads).reshape(6, len(s), 6)[:, :, soft]
    return np.einsum("n,lni,nij,mnj->lm", weight, loads, compliance, loads, optimize=True)


def _points(stations: Array, start: float) -> tuple[Array, Array]:
    """Arc lengths and weights, m, from ``start`` to the tip."""
    cuts = np.unique(np.append(stations[stations > start], start))
    x, w = POINTS
    half_length = 0.5 * np.diff(cuts)[:, None]
    return (cuts[:-1, None] + half_length * (1 + x)).ravel(), (half_length * w).ravel()


def linear(stations: Array, values: Array, s: Array) -> Array:
    """Values (n, …) at the stations, linear between them, at arc lengths ``s`` (k,)."""
    k = np.clip(np.searchsorted(stations, s, side="right") - 1, 0, len(stations) - 2)
    t = ((s - stations[k]) / (stations[k + 1] - stations[k])).reshape(-1, *(1,) * (values.ndim - 1))
    return values[k] + t * (values[k + 1] - values[k])


def placed(blade: Mounted, s: Array) -> tuple[Array, Array]:
    """Positions (k, 3) from the hub's centre and axes (k, 3, 3) of sections, in the hub's axes."""
    position, tangent = _curve(blade.stations, blade.kinks, s)
    across = np.cross([1.0, 0.0, 0.0], tangent)
    sine = np.linalg.norm(across, axis=1)
    vector = across * np.divide(np.arctan2(sine, tangent[:, 0]), sine, out=np.ones_like(sine), where=sine > 0)[:, None]
    twist = Rotation.from_rotvec(np.outer(np.interp(s, blade.stations.s, blade.stations.twist), [1.0, 0.0, 0.0]))
    cone = Rotation.from_rotvec([0.0, -blade.precone, 0.0])
    mounted = cone * Rotation.from_rotvec([blade.pitch, 0.0, 0.0])
    axes = (mounted * Rotation.from_rotvec(vector) * twist).as_matrix()
    return cone.apply([blade.hub_radius, 0.0, 0.0]) + mounted.apply(position), axes


def _curve(blade: Stations, kinks: tuple[float, ...], s: Array) -> tuple[Array, Array]:
    """Points and unit tangents (k, 3) at arc lengths, each piece between kinks by its own spline."""
    ends = np.array([blade.s[0], *kinks, blade.s[-1]])
    piece = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, len(ends) - 2)
    position, slope = np.empty((len(s), 3)), np.empty((len(s), 3))
    for k in np.unique(piece):
        own = (blade.s >= ends[k]) & (blade.s <= ends[k + 1])
        spline = make_interp_spline(blade.s[own], blade.curve[own], k=min(3, int(own.sum()) - 1))
        position[piece == k], slope[piece == k] = spline(s[piece == k]), spline(s[piece == k], nu=1)
    return position, slope / np.linalg.norm(slope, axis=1, keepdims=True)


def _sum(bodies: Array, axes: Array, position: Array, rotary: bool) -> tuple[float, Array, Array]:
    """Mass, first moments and ∫ r rᵀ dm of bodies with inertia (n, 6, 6) in axes (n, 3, 3) about points p (n, 3).

    With the first moments c and S = ∫ r rᵀ dm about p, ∫ r rᵀ dm = m p pᵀ + p cᵀ + c pᵀ + S.
    """
    m = bodies[:, 0, 0]
    own = np.stack([bodies[:, 2, 4] * -1, -bodies[:, 0, 5], bodies[:, 0, 4]], axis=1)  # m times the centre
    first = np.einsum("nij,nj->ni", axes, own)
    J = bodies[:, 3:, 3:]
    second = 0.5 * np.trace(J, axis1=1, axis2=2)[:, None, None] * np.eye(3) - J
    if not rotary:  # point masses at the mass centres; the tip's body keeps its moments of inertia
        point = own[:-1, :, None] * own[:-1, None, :]
        second[:-1] = np.divide(point, m[:-1, None, None], out=np.zeros_like(point), where=m[:-1, None, None] > 0)
    S = axes @ second @ np.swapaxes(axes, 1, 2)
    crossed = position.T @ first
    second = (position.T * m) @ position + crossed + crossed.T + S.sum(axis=0)
    return float(m.sum()), first.sum(0) + m @ position, second
