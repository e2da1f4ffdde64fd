"""Rigid motions one at a time, compiled; ``spatial`` has the conventions, and the same for batches.

A twist (v, w) is the dual vector w + εv, ε² = 0, and a function of its ``ad`` is that function of the cross-product matrix W of
w, continued to dual numbers: with f(W) = 1 + α W + β W², α and β power series in z = w·w, its matrix is ``[[P, Q], [0, P]]``,
P = f(W) and Q the derivative of P as w moves along v. So derivatives of the tangents need no more than those of α and β.
(Selig, *Geometric Fundamentals of Robotics*, 2005, ch. 7 and 9.) Results go into the last argument.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.special import bernoulli, factorial

from ..compiled import clear, compiled

Array = NDArray[np.float64]

_TERMS = 30  # less two for the second derivatives: (π/2π)^(2·28) = 1e-17, enough for the inverse tangent at a half turn
_SMALL = 1e-18


def _with_slopes(c: Array) -> Array:
    """(terms, 3) coefficients of a power series in z, and of its first and second derivatives."""
    n = np.arange(len(c) - 2)
    return np.stack([c[:-2], (n + 1) * c[1:-1], (n + 1) * (n + 2) * c[2:]], axis=-1)


_N = np.arange(_TERMS)
_BERNOULLI = bernoulli(2 * _TERMS + 2)
# sin φ/φ, (1 − cos φ)/φ², (φ − sin φ)/φ³ with φ² = z
_EXP = np.stack([(-1.0) ** _N / factorial(2 * _N + order + 1) for order in range(3)], axis=-1)
# α and β of the tangent, which are the last two of these, and of its inverse: −1/2, (1 − (φ/2) cot(φ/2))/φ²
_TANGENT = np.stack([_with_slopes(_EXP[:, 1]), _with_slopes(_EXP[:, 2])])
_INVERSE = np.stack(
    [
        _with_slopes(np.where(_N == 0, -0.5, 0.0)),
        _with_slopes((-1.0) ** _N * _BERNOULLI[2 * _N + 2] / factorial(2 * _N + 2)),
    ]
)


@compiled
def _sums(table: Array, z: float) -> tuple[float, float, float]:
    """Sums of three power series in z with coefficients in the columns of ``table``, to rounding."""
    a = b = c = 0.0
    power = 1.0
    for k in range(len(table)):
        da, db, dc = table[k, 0] * power, table[k, 1] * power, table[k, 2] * power
        a, b, c = a + da, b + db, c + dc
        if k > 1 and max(abs(da), abs(db), abs(dc)) < _SMALL:
            break
        power *= z
    return a, b, c


@compiled
def _dot(a: Array, b: Array) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def put_skew(x: float, y: float, z: float, i: int, j: int, out: Array) -> None:
    """The cross-product matrix of (x, y, z) at row i, column j of ``out``."""
    out[i, j] = out[i + 1, j + 1] = out[i + 2, j + 2] = 0.0
    out[i + 2, j + 1], out[i + 1, j + 2] = x, -x
    out[i, j + 2], out[i + 2, j] = y, -y
    out[i + 1, j], out[i, j + 1] = z, -z


@compiled
def ad(twist: Array, out: Array) -> None:
    """``ad(a) b = a × b`` (6, 6)."""
    clear(out)
    put_skew(twist[3], twist[4], twist[5], 0, 0, out)
    put_skew(twist[3], twist[4], twist[5], 3, 3, out)
    put_skew(twist[0], twist[1], twist[2], 0, 3, out)


@compiled
def cross(wrench: Array, out: Array) -> None:
    """``ad(a)ᵀ f = cross(f) a`` (6, 6)."""
    clear(out)
    put_skew(wrench[0], wrench[1], wrench[2], 0, 3, out)
    put_skew(wrench[0], wrench[1], wrench[2], 3, 0, out)
    put_skew(wrench[3], wrench[4], wrench[5], 3, 3, out)


@compiled
def adjoint(pose: Array, out: Array) -> None:
    """Adjoint (6, 6) of a pose (4, 4)."""
    x, y, z = pose[0, 3], pose[1, 3], pose[2, 3]
    clear(out)
    for j in range(3):
        a, b, c = pose[0, j], pose[1, j], pose[2, j]
        out[0, j] = out[3, j + 3] = a
        out[1, j] = out[4, j + 3] = b
        out[2, j] = out[5, j + 3] = c
        out[0, j + 3], out[1, j + 3], out[2, j + 3] = y * c - z * b, z * a - x * c, x * b - y * a


@compiled
def inverse(pose: Array, out: Array) -> None:
    """Inverse pose (4, 4)."""
    for i in range(3):
        for j in range(3):
            out[i, j] = pose[j, i]
        out[i, 3] = -(pose[0, i] * pose[0, 3] + pose[1, i] * pose[1, 3] + pose[2, i] * pose[2, 3])
    out[3, 0] = out[3, 1] = out[3, 2] = 0.0
    out[3, 3] = 1.0


@compiled
def compose(a: Array, b: Array, out: Array) -> None:
    """The pose a b (4, 4)."""
    for i in range(4):
        for j in range(4):
            out[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j] + a[i, 3] * b[3, j]


@compiled
def exp(twist: Array, out: Array) -> None:
    """The pose (4, 4) reached by moving along a twist for unit time."""
    v, w = twist[:3], twist[3:]
    z, s = _dot(w, w), _dot(w, v)
    a, b, c = _sums(_EXP, z)
    put_skew(a * w[0], a * w[1], a * w[2], 0, 0, out)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        out[i, 3] = v[i] + b * (w[j] * v[k] - w[k] * v[j]) + c * (s * w[i] - z * v[i])
        for j in range(3):
            out[i, j] += b * w[i] * w[j]
        out[i, i] += 1.0 - b * z
        out[3, i] = 0.0
    out[3, 3] = 1.0


@compiled
def log(pose: Array, out: Array) -> None:
    """The twist (6,) whose exponential is the pose, with a rotation of at most half a turn, there in either sense.

    The rotation is cos φ 1 + sin φ N + (1 − cos φ) n nᵀ, N the cross-product matrix of the axis n: up to a quarter turn the
    axis follows from the skew part, beyond it from the largest column of n nᵀ, which does not vanish at half a turn.
    """
    v, w = out[:3], out[3:]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        w[i] = 0.5 * (pose[k, j] - pose[j, k])
    sine = np.sqrt(_dot(w, w))
    cosine = 0.5 * (pose[0, 0] + pose[1, 1] + pose[2, 2] - 1.0)
    angle = np.arctan2(sine, cosine)
    if cosine >= 0.0:
        scale = 1.0 if sine < 1e-8 else angle / sine
        for i in range(3):
            w[i] *= scale
    else:
        m = 0
        for i in range(1, 3):
            if pose[i, i] > pose[m, m]:
                m = i
        x, y, z = 0.5 * (pose[0, m] + pose[m, 0]), 0.5 * (pose[1, m] + pose[m, 1]), 0.5 * (pose[2, m] + pose[m, 2])
        if m == 0:
            x -= cosine
        elif m == 1:
            y -= cosine
        else:
            z -= cosine
        scale = angle / np.sqrt(x * x + y * y + z * z)
        if w[0] * x + w[1] * y + w[2] * z < 0.0:
            scale = -scale
        w[0], w[1], w[2] = scale * x, scale * y, scale * z
    z, s = _dot(w, w), w[0] * pose[0, 3] + w[1] * pose[1, 3] + w[2] * pose[2, 3]
    alpha, _, _ = _sums(_INVERSE[0], z)
    beta, _, _ = _sums(_INVERSE[1], z)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        w_cross_p = w[j] * pose[k, 3] - w[k] * pose[j, 3]
        v[i] = pose[i, 3] + alpha * w_cross_p + beta * (s * w[i] - z * pose[i, 3])


@compiled
def tangent(twist: Array, out: Array) -> None:
    """Left tangent (6, 6)."""
    _function(_TANGENT, twist, out)


@compiled
def tangent_inverse(twist: Array, out: Array) -> None:
    """Inverse of the left tangent (6, 6)."""
    _function(_INVERSE, twist, out)


@compiled
def _function(table: Array, twist: Array, out: Array) -> None:
    """P = 1 + α W + β W² and Q = α V + dα W + β (W V + V W) + dβ W², with W V = v wᵀ − (w·v) 1."""
    v, w = twist[:3], twist[3:]
    z, s = _dot(w, w), _dot(w, v)
    alpha, alpha1, _ = _sums(table[0], z)
    beta, beta1, _ = _sums(table[1], z)
    d_alpha, d_beta = 2.0 * s * alpha1, 2.0 * s * beta1
    put_skew(alpha * w[0], alpha * w[1], alpha * w[2], 0, 0, out)
    put_skew(alpha * v[0] + d_alpha * w[0], alpha * v[1] + d_alpha * w[1], alpha * v[2] + d_alpha * w[2], 0, 3, out)
    for i in range(3):
        for j in range(3):
            out[i, j] += beta * w[i] * w[j]
            out[i, 3 + j] += beta * (v[i] * w[j] + w[i] * v[j]) + d_beta * w[i] * w[j]
        out[i, i] += 1.0 - beta * z
        out[i, 3 + i] -= 2.0 * beta * s + d_beta * z
        for j in range(3):
            out[3 + i, j], out[3 + i, 3 + j] = 0.0, out[i, j]


@compiled
def tangent_transpose_derivative(twist: Array, wrench: Array, out: Array) -> None:
    """(6, 6) derivative of ``tangent(ζ)ᵀ f`` with respect to ζ at constant f."""
    _transpose_derivative(_TANGENT, twist, wrench, out)


@compiled
def tangent_inverse_transpose_derivative(twist: Array, wrench: Array, out: Array) -> None:
    """(6, 6) derivative of ``tangent_inverse(ζ)ᵀ f`` with respect to ζ at constant f."""
    _transpose_derivative(_INVERSE, twist, wrench, out)


@compiled
def _transpose_derivative(table: Array, twist: Array, wrench: Array, out: Array) -> None:
    """``[[0, D], [D, dD]]``, where D is the derivative of Pᵀf with respect to w, and dD D's as (w, f) moves along (v, h).

    With u = w × f, p = w·f and q = p w − z f: Pᵀf = f − α u + β q, so
    D = α f× − 2 α' u wᵀ + β (p 1 + w fᵀ − 2 f wᵀ) + 2 β' q wᵀ.
    """
    v, w, f, h = twist[:3], twist[3:], wrench[:3], wrench[3:]
    z, s = _dot(w, w), _dot(w, v)
    alpha, alpha1, alpha2 = _sums(table[0], z)
    beta, beta1, beta2 = _sums(table[1], z)
    d_alpha, d_alpha1, d_beta, d_beta1 = 2.0 * s * alpha1, 2.0 * s * alpha2, 2.0 * s * beta1, 2.0 * s * beta2
    p, dp = _dot(w, f), _dot(v, f) + _dot(w, h)
    clear(out)
    put_skew(alpha * f[0], alpha * f[1], alpha * f[2], 0, 3, out)
    put_skew(d_alpha * f[0] + alpha * h[0], d_alpha * f[1] + alpha * h[1], d_alpha * f[2] + alpha * h[2], 3, 3, out)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        u = w[j] * f[k] - w[k] * f[j]
        du = v[j] * f[k] - v[k] * f[j] + w[j] * h[k] - w[k] * h[j]
        q = p * w[i] - z * f[i]
        dq = p * v[i] + dp * w[i] - 2.0 * s * f[i] - z * h[i]
        by_w = 2.0 * (beta1 * q - alpha1 * u - beta * f[i])
        d_by_w = 2.0 * (d_beta1 * q + beta1 * dq - d_alpha1 * u - alpha1 * du - d_beta * f[i] - beta * h[i])
        out[i, 3 + i] += beta * p
        out[3 + i, 3 + i] += d_beta * p + beta * dp
        for j in range(3):
            out[i, 3 + j] += by_w * w[j] + beta * w[i] * f[j]
            out[3 + i, 3 + j] += d_by_w * w[j] + by_w * v[j]
            out[3 + i, 3 + j] += (d_beta * w[i] + beta * v[i]) * f[j] + beta * w[i] * h[j]
        for j in range(3):
            out[3 + i, j] = out[i, 3 + j]
