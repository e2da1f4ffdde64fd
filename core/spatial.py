"""Rigid motions in space: poses (SE(3)), twists and wrenches, always in batches.

A pose is a (..., 4, 4) homogeneous matrix; a twist is (..., 6), linear part first: the velocity of the body's point at the
frame's origin, then the angular velocity; a wrench is (..., 6), force first, then moment about the frame's origin.
The exponential's tangent and its inverse are functions of ``ad``, whose minimal polynomial is
``ad (ad² + φ²)² = 0`` (φ: angle of rotation), so each is a quartic in ``ad`` with coefficients that are power series
in φ² (Selig, *Geometric Fundamentals of Robotics*, 2005, ch. 7; Sonneville, Cardona, Brüls 2014, app. A).
"""

import math
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.special import bernoulli, factorial

Array = NDArray[np.float64]

Kind = Literal["exp", "log", "tangent", "inverse"]

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
    a, b, c = np.moveaxis(_series("exp", z), -1, 0)[..., None, None]
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
    left_inverse = np.eye(3) - 0.5 * s + _series("log", z)[..., None] * (s @ s)
    return np.concatenate([(left_inverse @ x[..., :3, 3:])[..., 0], w], axis=-1)


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
    c1, c2, c3, c4 = np.moveaxis(_series(kind, z), -1, 0)[:4, ..., None, None]
    a2 = a @ a
    return np.eye(6) + c1 * a + c2 * a2 + (c3 * a + c4 * a2) @ a2


def _transpose_derivative(kind: Kind, twist: Array, wrench: Array) -> Array:
    at = np.swapaxes(ad(twist), -1, -2)
    z = (twist[..., 3:] ** 2).sum(-1)
    f = [wrench]
    for _ in range(4):
        f.append((at @ f[-1][..., None])[..., 0])
    series = np.moveaxis(_series(kind, z), -1, 0)
    c, slopes = series[:4, ..., None, None], series[4:, ..., None]
    # d(adᵀᵏ f) = Σ_j adᵀʲ cross(adᵀᵏ⁻¹⁻ʲ f) dζ, gathered by Horner
    x = [cross(v) for v in f[:4]]
    out = c[3] * x[0]
    out = c[2] * x[0] + c[3] * x[1] + at @ out
    out = c[1] * x[0] + c[2] * x[1] + c[3] * x[2] + at @ out
    out = c[0] * x[0] + c[1] * x[1] + c[2] * x[2] + c[3] * x[3] + at @ out
    slope = (slopes * np.stack(f[1:])).sum(0)
    out[..., 3:] += 2.0 * slope[..., :, None] * twist[..., None, 3:]
    return out


def _series(kind: Kind, z: Array) -> Array:
    """(..., m) sums of the power series of ``_coefficients(kind)``, with as many terms as rounding accuracy needs."""
    table = _truncated(kind, math.frexp(float(np.max(z, initial=0.0)))[1])
    powers = np.ones((*np.shape(z), len(table)))
    powers[..., 1:] = np.asarray(z)[..., None]
    return np.cumprod(powers, axis=-1) @ table


@lru_cache
def _truncated(kind: Kind, exponent: int) -> Array:
    """(k, m) the coefficients that matter for arguments up to 2^exponent."""
    table = _coefficients(kind)
    size = np.abs(table).max(-1) * 2.0 ** (exponent * np.arange(len(table)))
    return table[: int(np.flatnonzero(size > 1e-18)[-1]) + 1]


@lru_cache
def _coefficients(kind: Kind) -> Array:
    """(terms, m) power series in φ²: a row for each power, a column for each series.

    ``exp``: sin φ/φ, (1 − cos φ)/φ², (φ − sin φ)/φ³. ``log``: (1 − (φ/2) cot(φ/2))/φ². ``tangent`` and ``inverse``: the
    coefficients of ad, ad², ad³, ad⁴, then their derivatives with respect to φ². With the function split as
    ``x o(x²) + e(x²)``, Hermite interpolation at the (double) eigenvalues ±iφ of ad and the simple eigenvalue 0 gives, term by
    term, c1 = Σ (1−k)(−1)^k o_k z^k, c3 = Σ k(−1)^(k−1) o_k z^(k−1), c2 = Σ (k−2)(−1)^k e_k z^(k−1),
    c4 = Σ (k−1)(−1)^k e_k z^(k−2).
    """
    n = np.arange(_TERMS)
    sign = (-1.0) ** n
    if kind == "exp":
        return np.stack([sign / factorial(2 * n + order + 1) for order in range(3)], axis=-1)
    b = bernoulli(2 * _TERMS)
    if kind == "log":
        return (sign * b[2 * n + 2] / factorial(2 * n + 2))[:-1, None]
    if kind == "tangent":  # (exp x − 1)/x
        even, odd = 1.0 / factorial(2 * n + 1), 1.0 / factorial(2 * n + 2)
    else:  # x/(exp x − 1)
        even, odd = b[2 * n] / factorial(2 * n), np.where(n == 0, -0.5, 0.0)
    c = np.zeros((_TERMS, 4))
    c[:, 0] = (1 - n) * sign * odd
    c[:-1, 1] = ((n - 2) * sign * even)[1:]
    c[:-1, 2] = (-n * sign * odd)[1:]
    c[:-2, 3] = ((n - 1) * sign * even)[2:]
    slope = np.zeros_like(c)
    slope[:-1] = n[1:, None] * c[1:]
    return np.hstack([c, slope])
