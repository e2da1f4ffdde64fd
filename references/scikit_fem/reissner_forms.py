"""Weak forms of a geometrically exact beam that rotates with its hub, about any state; see
docs/geometrically-exact-beam.md.

Reissner's beam (E. Reissner, Studies in Applied Mathematics 52 (1973) 87–95; J. C. Simo, Comput. Methods Appl. Mech.
Eng. 49 (1985) 55–70): a section at arc length s has the position r(s) and the axes Λ(s), and the strains, per unit of
arc length and in its axes,

    Γ = Λᵀ r′ − Λ₀ᵀ r₀′,    κ = ax(Λᵀ Λ′ − Λ₀ᵀ Λ₀′).

A small motion is ``r → r + w``, ``Λ → exp(φ×) Λ``, with w and φ in axes that rotate with the hub. To second order

    Λ δΓ = (w′ + r′ × φ) − φ × w′ + ½ φ × (φ × r′),    Λ δκ = φ′ − ½ φ × φ′,    δx = w + φ × y + ½ φ × (φ × y)

with y = Λ ξ the position of a particle relative to r. The forms follow from virtual work, ``∫ σ·δε ds = −∫ δx·a dm``
with d'Alembert's acceleration ``a = ẍ + 2 Ω × ẋ + Ω × (Ω × x)`` of the particles at ``x = r + y``.

This module computes the coefficients of the forms at the quadrature points, (…, e, q) for scikit-fem. Local quantities
are q = (w, φ), or z = (w, φ, w′, φ′); section forces σ = (n, m) are in the section's axes.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PERMUTATION = np.zeros((3, 3, 3))
PERMUTATION[[0, 1, 2], [1, 2, 0], [2, 0, 1]] = 1.0
PERMUTATION[[0, 2, 1], [2, 1, 0], [1, 0, 2]] = -1.0

CROSS = -PERMUTATION.transpose(2, 0, 1)
"""(3, 3, 3): ``CROSS[k] @ v`` is e_k × v."""

SPIN = CROSS[2]
"""Ω × per unit of speed: the rotor's axis is z."""

OUT_OF_AXIS = np.diag([1.0, 1.0, 0.0])
"""−Ω × (Ω × ·) per unit of speed squared."""

MOVE = np.zeros((6, 3, 4))
MOVE[:3, :, 3] = np.eye(3)
MOVE[3:, :, :3] = CROSS
"""``MOVE[a] @ (y, 1)`` is the displacement of a particle by coordinate a of q, to first order."""

MOVE_TWICE = np.zeros((6, 6, 3, 4))
MOVE_TWICE[3:, 3:, :, :3] = 0.5 * (np.einsum("aij,bjk->abik", CROSS, CROSS) + np.einsum("bij,ajk->abik", CROSS, CROSS))
"""To second order: ½ φ × (φ × y) is half of ``φ_a φ_b MOVE_TWICE[a, b] @ (y, 1)``."""

INERTIA = np.einsum("ail,bij->abjl", MOVE, MOVE)
GYROSCOPIC = 2.0 * np.einsum("ail,ik,bkj->abjl", MOVE, SPIN, MOVE)
CENTRIFUGAL = np.einsum("ail,ik,bkj->abjl", MOVE, OUT_OF_AXIS, MOVE)
FORCE = np.einsum("il,alj->aij", OUT_OF_AXIS, MOVE)
FORCE_TWICE = np.einsum("il,ablj->abij", OUT_OF_AXIS, MOVE_TWICE)
"""Factors of the moments in the forms below, which are sums over the last two indices."""


def skew(v: Array) -> Array:
    """(…, 3, 3) with ``skew(v) @ u = v × u``."""
    return np.einsum("...k,kij->...ij", v, CROSS)


def for_fem(coefficients: Array, trailing: int) -> Array:
    """Coefficients (e, q, …) with ``trailing`` dimensions after e, q, in scikit-fem's order (…, e, q), also in memory."""
    return np.ascontiguousarray(np.moveaxis(coefficients, range(-trailing, 0), range(trailing)))


def strain_rate(slope: Array, axes: Array) -> Array:
    """(e, q, 6, 12) the strain's first variation by z: ``Λᵀ (w′ + r′ × φ)`` and ``Λᵀ φ′``."""
    out = np.zeros((*slope.shape[:-1], 6, 12))
    to_section = np.swapaxes(axes, -1, -2)
    out[..., :3, 3:6] = to_section @ skew(slope)
    out[..., :3, 6:9] = out[..., 3:, 9:] = to_section
    return out


def geometric(slope: Array, axes: Array, force: Array) -> Array:
    """(e, q, 12, 12) the second variation of the strain by z, times the section forces ``force`` (e, q, 6)."""
    n, m = ((axes @ part[..., None])[..., 0] for part in (force[..., :3], force[..., 3:]))
    out = np.zeros((*slope.shape[:-1], 12, 12))
    product = n[..., :, None] * slope[..., None, :]
    tension = np.trace(product, axis1=-2, axis2=-1)[..., None, None]
    out[..., 3:6, 3:6] = 0.5 * (product + np.swapaxes(product, -1, -2)) - tension * np.eye(3)  # n · ½ φ × (φ × r′)
    out[..., 3:6, 6:9] = skew(n)  # −n · φ × w′
    out[..., 3:6, 9:12] = 0.5 * skew(m)  # −m · ½ φ × φ′
    out[..., 6:12, 3:6] = np.swapaxes(out[..., 3:6, 6:12], -1, -2)
    return out


def inertia(moments: Array) -> Array:
    """(e, q, 6, 6) ``∫ δx · ẍ dm`` from ``moments`` (e, q, 4, 4), ∫ Y Yᵀ dm in the hub's axes."""
    return _sum(moments, INERTIA)


def gyroscopic(moments: Array) -> Array:
    """(e, q, 6, 6) ``∫ δx · 2 Ω × ẋ dm`` per unit of speed: skew."""
    return _sum(moments, GYROSCOPIC)


def centrifugal_force(position: Array, moments: Array) -> Array:
    """(e, q, 6) ``−∫ δx · Ω × (Ω × x) dm`` per unit of speed squared."""
    return _sum(_position(position) @ moments, FORCE)


def centrifugal(position: Array, moments: Array) -> Array:
    """(e, q, 6, 6) minus the derivative of ``centrifugal_force`` by the motion, from first and second order of δx;
    symmetric."""
    return -_sum(moments, CENTRIFUGAL) - _sum(_position(position) @ moments, FORCE_TWICE)


def _sum(moments: Array, factors: Array) -> Array:
    return np.tensordot(moments, factors, ((-2, -1), (-2, -1)))


def _position(position: Array) -> Array:
    """(…, 3, 4) F with ``x = F (y, 1)``."""
    return np.concatenate([np.broadcast_to(np.eye(3), (*position.shape, 3)), position[..., None]], axis=-1)


def exponential(phi: Array) -> Array:
    """(…, 3, 3) rotation by the vector φ (O. Rodrigues, 1840)."""
    angle = np.linalg.norm(phi, axis=-1)[..., None, None]
    cross = skew(phi)
    return np.eye(3) + np.sinc(angle / np.pi) * cross + 0.5 * np.sinc(angle / (2 * np.pi)) ** 2 * cross @ cross


def bending_rate(phi: Array, rate: Array) -> Array:
    """(…, 3) ax(exp(−φ×) exp(φ×)′) of ``rate`` = φ′: the curvature that a rotation by φ adds, in the axes before it."""
    angle = np.linalg.norm(phi, axis=-1)[..., None]
    small = angle < 1e-2
    safe = np.where(small, 1.0, angle)
    third = np.where(small, 1 / 6 - angle**2 / 120 + angle**4 / 5040, (safe - np.sin(safe)) / safe**3)
    once = np.cross(phi, rate)
    return rate - 0.5 * np.sinc(angle / (2 * np.pi)) ** 2 * once + third * np.cross(phi, once)


def local(u: Any) -> Any:
    """z (12, e, q) of a field q."""
    return np.concatenate([u, u.grad[:, 0]])


def quadratic(u: Any, v: Any, w: Any) -> Any:
    """Bilinear form with coefficients on q."""
    return _product(v, w.on, u)


def quadratic_local(u: Any, v: Any, w: Any) -> Any:
    """Bilinear form with coefficients on z."""
    return _product(local(v), w.on, local(u))


def mixed(u: Any, v: Any, w: Any) -> Any:
    """Bilinear form of a field of section forces v with z of a field u."""
    return _product(v, w.on, local(u))


def _product(first: Any, matrix: Array, second: Any) -> Any:
    return np.einsum("i...,i...", first, np.einsum("ij...,j...->i...", matrix, second))


def linear(v: Any, w: Any) -> Any:
    """Linear form with coefficients on q, or on section forces."""
    return np.einsum("i...,i...", w.on, v)
