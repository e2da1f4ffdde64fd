"""Rigid-body motions in batches: poses (SE(3)), twists and wrenches; ``rigid`` has the compiled formulae.

A pose is a (..., 4, 4) homogeneous matrix. A twist is (..., 6), linear part first: the velocity (m/s) of the body's point at
the frame's origin, then the angular velocity (rad/s). A wrench is (..., 6): the force (N), then the moment (N m) about the
frame's origin. (J. M. Selig, *Geometric Fundamentals of Robotics*, 2005, ch. 4 and 7.)
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..compiled import compiled
from . import rigid

Array = NDArray[np.float64]


def skew(a: Array) -> Array:
    """Cross-product matrices (..., 3, 3) of vectors (..., 3)."""
    return _each(_skew, (3, 3), a, (3,))


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
    return _each(_inverse, (4, 4), x, (4, 4))


def adjoint(x: Array) -> Array:
    """(..., 6, 6): transforms twists from the pose's frame to the frame it is given in; its transpose, wrenches back."""
    return _each(_adjoint, (6, 6), x, (4, 4))


def ad(twist: Array) -> Array:
    """(..., 6, 6) with ``ad(a) b = a × b`` for twists; ``a ×* f = −ad(a)ᵀ f`` for wrenches."""
    return _each(_ad, (6, 6), twist)


def cross(wrench: Array) -> Array:
    """(..., 6, 6) with ``ad(a)ᵀ f = cross(f) a``."""
    return _each(_cross, (6, 6), wrench)


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
    return _each(_exp, (4, 4), twist)


def log(x: Array) -> Array:
    """Twists (..., 6) whose exponentials are the poses (..., 4, 4); rotations of at most half a turn."""
    return _each(_log, (6,), x, (4, 4))


def tangent(twist: Array) -> Array:
    """Left tangent (..., 6, 6): ``d exp(ζ) = (tangent(ζ) dζ)^ exp(ζ)``."""
    return _each(_tangent, (6, 6), twist)


def tangent_inverse(twist: Array) -> Array:
    """Inverse of the left tangent (..., 6, 6)."""
    return _each(_tangent_inverse, (6, 6), twist)


def _each(
    loop: Callable[[Array, Array], None], shape: tuple[int, ...], given: Array, item: tuple[int, ...] = (6,)
) -> Array:
    """(..., *shape) from ``given`` (..., *item), by a compiled loop over one leading axis."""
    out = np.empty((*given.shape[: given.ndim - len(item)], *shape))
    loop(np.ascontiguousarray(given, dtype=float).reshape(-1, *item), out.reshape(-1, *shape))
    return out


@compiled
def _skew(vectors: Array, out: Array) -> None:
    for k in range(len(vectors)):
        rigid.put_skew(vectors[k, 0], vectors[k, 1], vectors[k, 2], 0, 0, out[k])


@compiled
def _inverse(poses: Array, out: Array) -> None:
    for k in range(len(poses)):
        rigid.inverse(poses[k], out[k])


@compiled
def _adjoint(poses: Array, out: Array) -> None:
    for k in range(len(poses)):
        rigid.adjoint(poses[k], out[k])


@compiled
def _ad(twists: Array, out: Array) -> None:
    for k in range(len(twists)):
        rigid.ad(twists[k], out[k])


@compiled
def _cross(wrenches: Array, out: Array) -> None:
    for k in range(len(wrenches)):
        rigid.cross(wrenches[k], out[k])


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
