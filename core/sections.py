"""From a blade's sections to the elements between its nodes: exact static solution by integrated flexibility.

Clamp frame a and load frame b by a wrench w (at a's origin, in a's axes): the section at s carries ``Ad(F_s)ᵀ w``, strains by
its compliance, and turns and moves all beyond it, so the twist of the section at s is

    ρ(s) = f(s) w,   f(s) = ∫ Ad(F) c Ad(F)ᵀ ds   from a to s,

for any coupling, taper, twist or curvature. The element's stiffness is f(b)⁻¹ and its shape functions f(s) f(b)⁻¹. Gauss
quadrature between the stations (properties are linear there), with the collocation matrix of the same points for f(s).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from . import spatial as sp
from .blade import AXIAL, BEND_Y, BEND_Z, TORSION, Blade, stiffness_at, straight, twist_at

Array = NDArray[np.float64]
Index = NDArray[np.intp]

GAUSS = 3
RIGID_AXIAL = 1e-8  # compliance kept by a rigid axial strain, of L²/EI: a beam 10⁴ times longer than thick
RIGID_TORSION = 1e-6  # compliance kept by a rigid torsion, of 1/EI


def root(blade: Blade) -> Array:
    """Pose (4, 4) of the clamped root in the hub's axes: precone about −y, then along the blade, then pitch about x."""
    cone, pitch = sp.rotation(1, np.array(-blade.precone)), sp.rotation(0, np.array(blade.pitch))
    return sp.pose(cone @ pitch, cone @ np.array([blade.hub_radius, 0.0, 0.0]))


def frames(blade: Blade, s: Array) -> Array:
    """Rest poses (k, 4, 4) of the sections at arc lengths ``s``, in the hub's axes; x tangent, y and z turned by the twist."""
    turn = sp.rotation(0, twist_at(blade, s))
    if straight(blade):
        local = sp.pose(turn, np.outer(s, [1.0, 0.0, 0.0]))
    else:
        curve = CubicSpline(blade.stations, blade.curve)
        t = curve(s, 1)
        t /= np.linalg.norm(t, axis=1, keepdims=True)
        w = sp.skew(np.cross([1.0, 0.0, 0.0], t))
        swing = np.eye(3) + w + w @ w / (1.0 + t[:, 0])[:, None, None]
        local = sp.pose(swing @ turn, curve(s))
    return root(blade) @ local


def compliance(blade: Blade, s: Array) -> Array:
    """Section compliance (k, 6, 6); rigid shears have none, rigid axial and torsional strains next to none."""
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


@dataclass(frozen=True)
class Segments:
    """Gauss points of all elements, in order along the blade, and the elements' static solutions.

    Attributes:
        element: (q,) which element each point lies in.
        s, weight: (q,) arc length and quadrature weight, m.
        pose: (q, 4, 4) rest pose in the frame of the element's first node.
        flexibility: (n, 6, 6) f(b) of each element.
        shape: (q, 6, 6) twist of the point from the twist of b: f(s) f(b)⁻¹.
        break_s: (m,) all ends of quadrature intervals that begin in an element.
        break_element, break_shape: (m,), (m, 6, 6) the same at those.
    """

    element: Index
    s: Array
    weight: Array
    pose: Array
    flexibility: Array
    shape: Array
    break_s: Array
    break_element: Index
    break_shape: Array


def integrate(blade: Blade, nodes: Array, breaks: Array | None = None) -> Segments:
    """Integrate the flexibility between ``nodes`` (n+1,) of arc length, stopping at stations and at ``breaks`` too."""
    ends = np.unique(np.concatenate([nodes, blade.stations, [] if breaks is None else breaks]))
    keep = np.append(True, np.diff(ends) > 1e-12 * blade.length)
    ends = ends[keep]
    c, b, a = collocation(GAUSS)
    h = np.diff(ends)
    element = np.searchsorted(nodes, ends[:-1] + 0.5 * h, side="right") - 1
    s = ends[:-1, None] + h[:, None] * c
    first = frames(blade, nodes[:-1])
    pose = sp.inverse(first)[element][:, None] @ frames(blade, s.ravel()).reshape(*s.shape, 4, 4)
    lever = sp.adjoint(pose)
    turn = lever @ compliance(blade, s.ravel()).reshape(*s.shape, 6, 6) @ np.swapaxes(lever, -1, -2)
    whole = h[:, None, None] * np.einsum("j,ijkl->ikl", b, turn)
    start = np.searchsorted(element, np.arange(len(nodes) - 1))
    flexibility = np.add.reduceat(whole, start, axis=0)
    before = np.cumsum(whole, axis=0) - whole
    before -= before[start][element]
    within = before[:, None] + h[:, None, None, None] * np.einsum("qj,ijkl->iqkl", a, turn)
    stiffness = np.linalg.inv(flexibility)
    q = np.repeat(element, GAUSS)
    return Segments(
        element=q,
        s=s.ravel(),
        weight=(h[:, None] * b).ravel(),
        pose=pose.reshape(-1, 4, 4),
        flexibility=flexibility,
        shape=within.reshape(-1, 6, 6) @ stiffness[q],
        break_s=ends[:-1],
        break_element=element,
        break_shape=before @ stiffness[element],
    )


def collocation(n: int) -> tuple[Array, Array, Array]:
    """Gauss points c and weights b on [0, 1], and the matrix ∫₀^{c_q} ℓ_j of their Lagrange polynomials."""
    x, w = np.polynomial.legendre.leggauss(n)
    c = 0.5 * (x + 1.0)
    powers = np.arange(n)
    vandermonde = c[:, None] ** powers
    integrals = c[:, None] ** (powers + 1) / (powers + 1)
    return c, 0.5 * w, integrals @ np.linalg.inv(vandermonde)
