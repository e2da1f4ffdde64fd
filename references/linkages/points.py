"""Frames on the links of a Pinocchio model, and functions of two of them with gradient and Hessian over the
coordinates.

The closure of a loop, the length of a spring and the work of a load are such functions. Their Hessians follow from
Pinocchio's time variation of a frame's Jacobian, which is linear in the velocity: at the k-th unit velocity it is the
derivative of the Jacobian by the k-th coordinate. No finite differences are used.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Frame:
    """One frame at one configuration of n coordinates, in the ground's axes.

    Attributes:
        r: (3,) its origin, m.
        R: (3, 3) its axes, in columns.
        V, W: (3, n) Jacobians of the origin's velocity and of the angular velocity.
        V1, W1: (n, 3, n) their derivatives by each coordinate.
    """

    r: Array
    R: Array
    V: Array
    W: Array
    V1: Array
    W1: Array


@dataclass(frozen=True)
class Function:
    """A function of the coordinates: its value, gradient (n,) and Hessian (n, n), ``hessian[:, k]`` by coordinate k."""

    value: float
    gradient: Array
    hessian: Array


def frames(pin: Any, model: Any, data: Any, q: Array, ids: Sequence[int]) -> list[Frame]:
    """Frames of a model by index at coordinates q (n,)."""
    axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    n = len(q)
    slopes = np.zeros((n, len(ids), 6, n))
    for k, unit in enumerate(np.eye(n)):
        pin.computeJointJacobiansTimeVariation(model, data, q, unit)
        pin.updateFramePlacements(model, data)
        for column, i in enumerate(ids):
            slopes[k, column] = np.reshape(pin.getFrameJacobianTimeVariation(model, data, i, axes), (6, n))
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    out = []
    for column, i in enumerate(ids):
        J = np.reshape(
            pin.getFrameJacobian(model, data, i, axes), (6, n)
        ).copy()  # with one coordinate it is one-dimensional
        pose, dJ = data.oMf[i], slopes[:, column]
        out.append(Frame(np.array(pose.translation), np.array(pose.rotation), J[:3], J[3:], dJ[:, :3], dJ[:, 3:]))
    return out


def apart(p: Frame, c: Frame, axis: Array) -> Function:
    """Distance of origin c from origin p along an axis (3,) of the ground."""
    return Function(float(axis @ (c.r - p.r)), (c.V - p.V).T @ axis, by(c.V1 - p.V1, axis))


def between(p: Frame, a: Array, c: Frame, b: Array) -> Function:
    """Product of two directions, a (3,) of frame p and b (3,) of frame c: 0 where they are perpendicular."""
    u, v = p.R @ a, c.R @ b
    du, dv = np.cross(p.W, u, axis=0), np.cross(c.W, v, axis=0)
    normal, slope = np.cross(u, v), np.cross(du, v, axis=0) + np.cross(u, dv, axis=0)
    return Function(float(u @ v), (p.W - c.W).T @ normal, by(p.W1 - c.W1, normal) + (p.W - c.W).T @ slope)


def along(p: Frame, a: Array, c: Frame) -> Function:
    """Distance of origin c from origin p along a direction a (3,) of frame p."""
    u, d, V = p.R @ a, c.r - p.r, c.V - p.V
    du = np.cross(p.W, u, axis=0)
    arm = np.cross(u, d)
    slope = np.cross(du, d, axis=0) + np.cross(u, V, axis=0)
    gradient = p.W.T @ arm + V.T @ u
    return Function(float(u @ d), gradient, by(p.W1, arm) + p.W.T @ slope + by(c.V1 - p.V1, u) + V.T @ du)


def distance(p: Frame, c: Frame) -> Function:
    """Distance between origins p and c, which must not coincide."""
    d, V = c.r - p.r, c.V - p.V
    length = float(np.linalg.norm(d))
    u = d / length
    du = (V - np.outer(u, u @ V)) / length
    return Function(length, V.T @ u, by(c.V1 - p.V1, u) + V.T @ du)


def by(slopes: Array, vector: Array) -> Array:
    """(n, n) derivative of ``J.T @ vector`` from the derivatives (n, 3, n) of a Jacobian J; column k by coordinate k."""
    return np.einsum("kij,i->jk", slopes, vector)
