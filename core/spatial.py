"""Rigid motions in space: poses (SE(3)), twists and wrenches, always in batches.

A pose is a (..., 4, 4) homogeneous matrix; a twist is (..., 6), linear part first: the velocity of the body's point at the
frame's origin, then the angular velocity; a wrench is (..., 6), force first, then moment about the frame's origin.
The exponential's tangent and its inverse are functions of ``ad``, whose minimal polynomial is
``ad (ad² + φ²)² = 0`` (φ: angle of rotation), so each is a quartic in ``ad`` with coefficients that are power series
in φ² (Selig, *Geometric Fundamentals of Robotics*, 2005, ch. 7; Sonneville, Cardona, Brüls 2014, app. A).
"""

from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.special import bernoulli, factorial

Array = NDArray[np.float64]

_TERMS = 26  # (π/2π)^(2·26) = 2e-16: enough for the inverse tangent at a half turn


def skew(a: Array) -> Array:
    """Cross-product matrices (..., 3, 3) of vectors (..., 3)."""
    out = np.zeros((*a.shape, 3))
    out[..., 2, 1] = a[..., 0]
    out[..., 1, 2] = -a[..., 0]
    out[..., 0, 2] = a[..., 1]
    out[..., 2, 0] = -a[..., 1]
    out[..., 1, 0] = a[..., 2]
    out[..., 0, 1] = -a[..., 2]
    return out


def pose(rotation: Array, position: Array) -> Array:
    """Poses (..., 4, 4) from rotations (..., 3, 3) and positions (..., 3)."""
    shape = np.broadcast_shapes(rotation.shape[:-2], position.shape[:-1])
    out = np.zeros((*shape, 4, 4))
    out[..., :3, :3] = rotation
    out[..., :3, 3] = position
    out[..., 3, 3] = 1.0
    return out


def inverse(x: Array) -> Array:
    """Inverse poses."""
    rt = np.swapaxes(x[..., :3, :3], -1, -2)
    return pose(rt, -(rt @ x[..., :3, 3:])[..., 0])


def adjoint(x: Array) -> Array:
    """(..., 6, 6): a twist in the pose's own frame to the frame it is given in; its transpose brings wrenches back."""
    r = x[..., :3, :3]
    out = np.zeros((*x.shape[:-2], 6, 6))
    out[..., :3, :3] = r
    out[..., 3:, 3:] = r
    out[..., :3, 3:] = skew(x[..., :3, 3]) @ r
    return out


def ad(twist: Array) -> Array:
    """(..., 6, 6) with ``ad(a) b = a × b`` for twists; ``a ×* f = −ad(a)ᵀ f`` for wrenches."""
    out = np.zeros((*twist.shape, 6))
    w = skew(twist[..., 3:])
    out[..., :3, :3] = w
    out[..., 3:, 3:] = w
    out[..., :3, 3:] = skew(twist[..., :3])
    return out


def cross(wrench: Array) -> Array:
    """(..., 6, 6) symmetric-in-role partner of ``ad``: ``ad(a)ᵀ f = cross(f) a``."""
    out = np.zeros((*wrench.shape, 6))
    f = skew(wrench[..., :3])
    out[..., :3, 3:] = f
    out[..., 3:, :3] = f
    out[..., 3:, 3:] = skew(wrench[..., 3:])
    return out


def rotation(axis: int, angle: Array) -> Array:
    """Rotations (..., 3, 3) about a coordinate axis."""
    out = np.zeros((*np.shape(angle), 3, 3))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out[..., axis, axis] = 1.0
    out[..., i, i] = out[..., j, j] = np.cos(angle)
    out[..., j, i] = np.sin(angle)
    out[..., i, j] = -out[..., j, i]
    return out


def exp(twist: Array) -> Array:
    """Poses reached by moving along constant twists for unit time."""
    w = skew(twist[..., 3:])
    z = (twist[..., 3:] ** 2).sum(-1)
    a, b, c = (_power_series(_exp_series(k), z)[..., None, None] for k in range(3))
    w2 = w @ w
    left = np.eye(3) + b * w + c * w2
    return pose(np.eye(3) + a * w + b * w2, (left @ twist[..., :3, None])[..., 0])


def log(x: Array) -> Array:
    """Twists (..., 6) whose exponential is the pose; rotations of less than half a turn."""
    r = x[..., :3, :3]
    d = r - np.swapaxes(r, -1, -2)
    axis = 0.5 * np.stack([d[..., 2, 1], d[..., 0, 2], d[..., 1, 0]], axis=-1)
    sine = np.sqrt((axis**2).sum(-1))
    angle = np.arctan2(sine, 0.5 * (np.trace(r, axis1=-2, axis2=-1) - 1.0))
    w = axis * np.where(sine < 1e-8, 1.0, angle / np.where(sine < 1e-8, 1.0, sine))[..., None]
    z = (w**2).sum(-1)
    s = skew(w)
    left_inverse = np.eye(3) - 0.5 * s + _power_series(_inverse_series3(), z)[..., None, None] * (s @ s)
    return np.concatenate([(left_inverse @ x[..., :3, 3:])[..., 0], w], axis=-1)


Kind = Literal["tangent", "inverse"]


def tangent(twist: Array) -> Array:
    """Left tangent (..., 6, 6): ``d exp(ζ) = (tangent(ζ) dζ)^ exp(ζ)``."""
    return _quartic("tangent", twist)


def tangent_inverse(twist: Array) -> Array:
    """Inverse of the left tangent."""
    return _quartic("inverse", twist)


def tangent_transpose_derivative(twist: Array, wrench: Array) -> Array:
    """(..., 6, 6): derivative of ``tangent(ζ)ᵀ f`` with respect to ζ, f held."""
    return _transpose_derivative("tangent", twist, wrench)


def tangent_inverse_transpose_derivative(twist: Array, wrench: Array) -> Array:
    """(..., 6, 6): derivative of ``tangent_inverse(ζ)ᵀ f`` with respect to ζ, f held."""
    return _transpose_derivative("inverse", twist, wrench)


def _quartic(kind: Kind, twist: Array) -> Array:
    a = ad(twist)
    z = (twist[..., 3:] ** 2).sum(-1)
    c1, c2, c3, c4 = (_power_series(s, z)[..., None, None] for s in _coefficients(kind))
    a2 = a @ a
    return np.eye(6) + c1 * a + c2 * a2 + (c3 * a + c4 * a2) @ a2


def _transpose_derivative(kind: Kind, twist: Array, wrench: Array) -> Array:
    at = np.swapaxes(ad(twist), -1, -2)
    z = (twist[..., 3:] ** 2).sum(-1)
    f = [wrench]
    for _ in range(4):
        f.append((at @ f[-1][..., None])[..., 0])
    series = _coefficients(kind)
    c = [_power_series(s, z)[..., None, None] for s in series]
    # d(adᵀᵏ f) = Σ_j adᵀʲ cross(adᵀᵏ⁻¹⁻ʲ f) dζ, gathered by Horner
    x = [cross(v) for v in f[:4]]
    out = c[3] * x[0]
    out = c[2] * x[0] + c[3] * x[1] + at @ out
    out = c[1] * x[0] + c[2] * x[1] + c[3] * x[2] + at @ out
    out = c[0] * x[0] + c[1] * x[1] + c[2] * x[2] + c[3] * x[3] + at @ out
    slope = np.zeros_like(wrench)
    for s, v in zip(series, f[1:], strict=True):
        slope = slope + _power_series(_derivative(s), z)[..., None] * v
    out[..., 3:] += 2.0 * slope[..., :, None] * twist[..., None, 3:]
    return out


def _power_series(coefficients: tuple[float, ...], z: Array) -> Array:
    """Σ c_k z^k, with as many terms as the largest argument needs for rounding accuracy."""
    largest = float(np.max(z, initial=0.0))
    n = len(coefficients)
    while n > 1 and abs(coefficients[n - 1]) * largest ** (n - 1) < 1e-18:
        n -= 1
    out = np.full(np.shape(z), coefficients[n - 1])
    for c in coefficients[n - 2 :: -1] if n > 1 else ():
        out = out * z + c
    return out


@lru_cache
def _derivative(coefficients: tuple[float, ...]) -> tuple[float, ...]:
    return (*(k * c for k, c in enumerate(coefficients) if k), 0.0)


@lru_cache
def _exp_series(order: int) -> tuple[float, ...]:
    """sin φ/φ, (1 − cos φ)/φ², (φ − sin φ)/φ³ in powers of φ²."""
    return tuple(float((-1.0) ** k / factorial(2 * k + order + 1)) for k in range(_TERMS))


@lru_cache
def _inverse_series3() -> tuple[float, ...]:
    """(1 − (φ/2) cot(φ/2))/φ² in powers of φ²."""
    b = bernoulli(2 * _TERMS)
    return tuple(float(-((-1.0) ** (k + 1)) * b[2 * k + 2] / factorial(2 * k + 2)) for k in range(_TERMS - 1))


@lru_cache
def _coefficients(kind: Kind) -> tuple[tuple[float, ...], ...]:
    """Power series in φ² of the coefficients of ad, ad², ad³, ad⁴.

    With the function split as ``x o(x²) + e(x²)``, Hermite interpolation at the (double) eigenvalues ±iφ of ad and the
    simple eigenvalue 0 gives, term by term, c1 = Σ (1−k)(−1)^k o_k z^k, c3 = Σ k(−1)^(k−1) o_k z^(k−1),
    c2 = Σ (k−2)(−1)^k e_k z^(k−1), c4 = Σ (k−1)(−1)^k e_k z^(k−2).
    """
    n = np.arange(_TERMS)
    if kind == "tangent":  # (exp x − 1)/x
        even, odd = 1.0 / factorial(2 * n + 1), 1.0 / factorial(2 * n + 2)
    else:  # x/(exp x − 1)
        even, odd = bernoulli(2 * _TERMS)[2 * n] / factorial(2 * n), np.where(n == 0, -0.5, 0.0)
    sign = (-1.0) ** n
    c1 = (1 - n) * sign * odd
    c2 = ((n - 2) * sign * even)[1:]
    c3 = (-n * sign * odd)[1:]
    c4 = ((n - 1) * sign * even)[2:]
    return tuple(tuple(float(v) for v in c) for c in (c1, c2, c3, c4))
