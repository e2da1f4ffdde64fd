"""Cardan angles (x, y, z), R = R_x(α) R_y(β) R_z(γ), compiled; what is (3, 3) goes into a larger matrix at a row and column."""

import numpy as np
from numpy.typing import NDArray

from .compiled import compiled

Array = NDArray[np.float64]


@compiled
def cardan(r: Array, out: Array) -> None:
    """Angles (3,) of a rotation, the first three rows and columns of ``r``."""
    out[0] = np.arctan2(-r[1, 2], r[2, 2])
    out[1] = np.arcsin(min(1.0, max(-1.0, r[0, 2])))
    out[2] = np.arctan2(-r[0, 1], r[0, 0])


@compiled
def cardan_rate(angles: Array, i: int, j: int, out: Array) -> None:
    """(α̇, β̇, γ̇) from the angular velocity in the fixed axes; ``out`` zero before."""
    sa, ca = np.sin(angles[0]), np.cos(angles[0])
    sb, cb = np.sin(angles[1]), np.cos(angles[1])
    out[i, j], out[i, j + 1], out[i, j + 2] = 1.0, sa * sb / cb, -ca * sb / cb
    out[i + 1, j + 1], out[i + 1, j + 2] = ca, sa
    out[i + 2, j + 1], out[i + 2, j + 2] = -sa / cb, ca / cb


@compiled
def cardan_rate_transpose_derivative(angles: Array, m: Array, i: int, j: int, out: Array) -> None:
    """Derivative of ``cardan_rate(θ)ᵀ m`` with respect to θ, m held; ``out`` zero before."""
    sa, ca = np.sin(angles[0]), np.cos(angles[0])
    sb, cb = np.sin(angles[1]), np.cos(angles[1])
    lever = (m[0] * sb - m[2]) / cb  # (Aᵀm)_y = sα lever + cα m1,  (Aᵀm)_z = −cα lever + sα m1
    slope = (m[0] - m[2] * sb) / cb**2  # ∂lever/∂β
    out[i + 1, j], out[i + 2, j] = ca * lever - sa * m[1], sa * lever + ca * m[1]
    out[i + 1, j + 1], out[i + 2, j + 1] = sa * slope, -ca * slope
