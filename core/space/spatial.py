"""Rigid-body motions in batches: poses (SE(3)), twists and wrenches; ``rigid.hpp`` has the formulae.

A pose is a (..., 4, 4) homogeneous matrix. A twist is (..., 6), linear part first: the velocity (m/s) of the body's point at
the frame's origin, then the angular velocity (rad/s). A wrench is (..., 6): the force (N), then the moment (N m) about the
frame's origin. (J. M. Selig, *Geometric Fundamentals of Robotics*, 2005, ch. 4 and 7.)
"""

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels

Array = NDArray[np.float64]


def skew(a: Array) -> Array:
    """Cross-product matrices (..., 3, 3) of vectors (..., 3)."""
    return kernels.skew(a)


def pose(rotation: Array, position: Array) -> Array:
    """Poses (..., 4, 4) from rotations (..., 3, 3) and positions (..., 3)."""
    shape = np.broadcast_shapes(rotation.shape[:-2], position.shape[:-1])
    out = np.zeros((*shape, 4, 4))
    out[..., :3, :3] = rotation
    out[..., :3, 3] = position
    out[..., 3, 3] = 1.0
    return out


def inverse(x: Array) -> Array:
    """Inverse poses (..., 4, 4)."""
    return kernels.inverse(x)


def adjoint(x: Array) -> Array:
    """(..., 6, 6): transforms twists from the frame at a pose to the reference frame; its transpose, wrenches back."""
    return kernels.adjoint(x)


def ad(twist: Array) -> Array:
    """(..., 6, 6) with ``ad(a) b = a × b`` for twists; ``a ×* f = −ad(a)ᵀ f`` for wrenches."""
    return kernels.ad(twist)


def coadjoint(wrench: Array) -> Array:
    """(..., 6, 6) with ``ad(a)ᵀ f = coadjoint(f) a``."""
    return kernels.coadjoint(wrench)


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
    """Poses (..., 4, 4) reached by moving along constant twists (..., 6) for unit time."""
    return kernels.exp(twist)


def log(x: Array) -> Array:
    """Twists (..., 6) whose exponentials are the poses (..., 4, 4); rotations of at most half a turn."""
    return kernels.log(x)


def tangent(twist: Array) -> Array:
    """Left tangent (..., 6, 6): ``d exp(ζ) = (tangent(ζ) dζ)^ exp(ζ)``."""
    return kernels.tangent(twist)


def tangent_inverse(twist: Array) -> Array:
    """Inverse of the left tangent (..., 6, 6)."""
    return kernels.tangent_inverse(twist)
