"""Rigid-body motions of complex arrays, for differentiation by complex steps; see ``spatial`` for real arrays.

The derivative of an analytic f along d is ``Im f(x + i h d)/h`` for a tiny h, exact to rounding (Squire and Trapp, SIAM
Review 40, 1998, 110). Transposes are not conjugated.
"""

from typing import Any

import numpy as np

from . import spatial as sp

Array = np.ndarray[Any, Any]

STEP = 1e-40
"""h: its square vanishes beside 1."""


def times(a: Array, x: Array) -> Array:
    """Products (..., m) of matrices (..., m, n) and vectors (..., n)."""
    return (a @ x[..., None])[..., 0]


def solved(a: Array, x: Array) -> Array:
    """Solutions (..., m) of systems with matrices (..., m, m) and right sides (..., m)."""
    return np.linalg.solve(a, x[..., None])[..., 0]


def left_inverse(a: Array) -> Array:
    """(..., n, m) with ``left_inverse(a) a = 1`` for matrices (..., m, n) of rank n."""
    real = np.linalg.pinv(a.real)
    return real - 1j * real @ a.imag @ real


def transposed(a: Array) -> Array:
    """Matrices (..., n, m) from (..., m, n)."""
    return np.swapaxes(a, -1, -2)


def skew(a: Array) -> Array:
    """Cross-product matrices (..., 3, 3) of vectors (..., 3)."""
    out = np.zeros((*a.shape[:-1], 3, 3), a.dtype)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., i, j], out[..., j, i] = -a[..., k], a[..., k]
    return out


def inverse(x: Array) -> Array:
    """Inverse poses (..., 4, 4)."""
    out = np.zeros(x.shape, x.dtype)
    out[..., :3, :3] = rotation = transposed(x[..., :3, :3])
    out[..., :3, 3] = -times(rotation, x[..., :3, 3])
    out[..., 3, 3] = 1.0
    return out


def adjoint(x: Array) -> Array:
    """(..., 6, 6): transforms twists from the poses' frames to the frame that the poses (..., 4, 4) are given in."""
    out = np.zeros((*x.shape[:-2], 6, 6), x.dtype)
    out[..., :3, :3] = out[..., 3:, 3:] = x[..., :3, :3]
    out[..., :3, 3:] = skew(x[..., :3, 3]) @ x[..., :3, :3]
    return out


def ad(twist: Array) -> Array:
    """(..., 6, 6) with ``ad(a) b = a × b`` for twists."""
    out = np.zeros((*twist.shape[:-1], 6, 6), twist.dtype)
    out[..., :3, :3] = out[..., 3:, 3:] = skew(twist[..., 3:])
    out[..., :3, 3:] = skew(twist[..., :3])
    return out


def exp(screw: Array, q: Array) -> Array:
    """Poses (..., n, 4, 4) reached along real unit twists (n, 6) by complex coordinates (..., n)."""
    hat = np.zeros((len(screw), 4, 4))
    hat[:, :3, :3], hat[:, :3, 3] = skew(screw[:, 3:]), screw[:, :3]
    return sp.exp(screw * q.real[..., None]) @ (np.eye(4) + 1j * q.imag[..., None, None] * hat)


def variation(x: Array) -> Array:
    """Imaginary part of poses (..., 4, 4) as twists (..., 6) ρ, ``Im x = ρ^ Re x``."""
    hat = x.imag @ inverse(x.real)
    return np.concatenate([hat[..., :3, 3], hat[..., (2, 0, 1), (1, 2, 0)]], axis=-1)
