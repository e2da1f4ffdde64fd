"""Rigid motions in space: poses (SE(3)), twists and wrenches, always in batches.

A pose is a (..., 4, 4) homogeneous matrix; a twist is (..., 6), linear part first: the velocity of the body's point at the
frame's origin, then the angular velocity; a wrench is (..., 6), force first, then moment about the frame's origin.
The exponential's tangent and its inverse are functions of ``ad``, whose minimal polynomial is
``ad (ad² + φ²)² = 0`` (φ: angle of rotation), so each is a quartic in ``ad`` with coefficients that are power series
in φ² (Selig, *Geometric Fundamentals of Robotics*, 2005, ch. 7; Sonneville, Cardona, Brüls 2014, app. A).
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..compiled import compiled
from . import rigid

Array = NDArray[np.float64]


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
    return _each(_exp, (4, 4), twist)


def log(x: Array) -> Array:
    """Twists (..., 6) whose exponential is the pose; rotations of at most half a turn."""
    return _each(_log, (6,), x)


def tangent(twist: Array) -> Array:
    """Left tangent (..., 6, 6): ``d exp(ζ) = (tangent(ζ) dζ)^ exp(ζ)``."""
    return _each(_tangent, (6, 6), twist)


def tangent_inverse(twist: Array) -> Array:
    """Inverse of the left tangent."""
    return _each(_tangent_inverse, (6, 6), twist)


def _each(loop: Callable[[Array, Array], None], shape: tuple[int, ...], given: Array) -> Array:
    """What ``loop`` puts into (k, *shape) from the k items of ``given``, as many leading axes as they have."""
    item = (4, 4) if given.shape[-1] == 4 else (6,)
    out = np.empty((*given.shape[: given.ndim - len(item)], *shape))
    loop(np.ascontiguousarray(given, dtype=float).reshape(-1, *item), out.reshape(-1, *shape))
    return out


@compiled
def _exp(twists: Array, out: Array) -> None:
    for k in range(len(twists)):
        rigid.exp(twists[k], out[k])


@compiled
def _log(poses: Array, out: Array) -> None:
    for k in range(len(poses)):
        rigid.log(poses[k], out[k])


@compiled
def _tangent(twists: Array, out: Array) -> None:
    for k in range(len(twists)):
        rigid.tangent(twists[k], out[k])


@compiled
def _tangent_inverse(twists: Array, out: Array) -> None:
    for k in range(len(twists)):
        rigid.tangent_inverse(twists[k], out[k])
