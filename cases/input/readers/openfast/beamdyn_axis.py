"""BeamDyn's reference curve: natural cubic splines through key points, arc length, and the sections' orientation."""

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .....core.space import gauss
from .....core.space.spatial import skew

Array = NDArray[np.float64]


TURN, FINE = np.radians(1.0), 65
"""Limit on the rotation of the tangent between two stations, and points per interval (also the most divisions)."""


class Axis(NamedTuple):
    """A reference curve in BeamDyn's axes: splines in z of x, y and twist (degrees), and z at arc lengths."""

    spline: CubicSpline
    z: Array
    arc: Array

    def at(self, s: Array) -> Array:
        """z at arc lengths ``s``: Newton's method from linear interpolation."""
        z = np.interp(s, self.arc, self.z)
        for _ in range(8):
            z = np.clip(z - (_arc(self, z) - s) / _speed(self.spline, z), self.z[0], self.z[-1])
        return z

    def points(self, z: Array) -> Array:
        """The curve's points (n, 3) at ``z`` (n,), in the axes of ``core.blade``."""
        x, y, _ = self.spline(z).T
        return np.stack([z, -y, x], axis=1)


def line(length: float) -> Axis:
    """A straight, untwisted axis."""
    z = np.array([0.0, length])
    return measured(CubicSpline(z, np.zeros((2, 3)), bc_type="natural"), z)


def measured(spline: CubicSpline, z: Array) -> Axis:
    """The axis of splines through key points at ``z``, its arc length by Gauss quadrature."""
    bare = Axis(spline, z, np.zeros(len(z)))
    lengths = [_piece(bare.spline, a, b) for a, b in itertools.pairwise(z)]
    return bare._replace(arc=np.concatenate([[0.0], np.cumsum(lengths)]))


def _speed(spline: CubicSpline, z: Array) -> Array:
    slope = spline(z, 1)[..., :2]
    return np.sqrt(1 + (slope**2).sum(-1))


def _piece(spline: CubicSpline, a: float, b: float) -> float:
    x, w = gauss.rule(12)
    # 1 apart, so that a straight curve keeps every digit
    return (b - a) + float((b - a) * w @ (_speed(spline, a + (b - a) * x) - 1))


def _arc(axis: Axis, z: Array) -> Array:
    k = np.clip(np.searchsorted(axis.z, z, side="right") - 1, 0, len(axis.z) - 2)
    return np.array([axis.arc[i] + _piece(axis.spline, float(axis.z[i]), float(b)) for i, b in zip(k, z, strict=True)])


def resolved(axis: Axis, s: Array) -> Array:
    """The arc lengths ``s`` (n,), with more inserted where the curve bends by more than ``TURN``, for core's spline."""
    fine = (s[:-1, None] + np.diff(s)[:, None] * np.linspace(0, 1, FINE)).ravel()
    t = _tangents(axis, np.interp(fine, axis.arc, axis.z)).reshape(-1, FINE, 3)
    bend = np.linalg.norm(np.diff(t, axis=1), axis=2).sum(1)
    pieces = np.clip(np.ceil(bend / TURN), 1, FINE).astype(int)
    points = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(s[:-1], s[1:], pieces, strict=True)]
    return np.concatenate([*points, s[-1:]])


def _tangents(axis: Axis, z: Array) -> Array:
    slope = axis.spline(z, 1)
    t = np.stack([np.ones_like(z), -slope[:, 1], slope[:, 0]], axis=1)
    return t / np.linalg.norm(t, axis=1, keepdims=True)


def _swing(t: Array) -> Array:
    """Smallest rotations (n, 3, 3) from x to the tangents."""
    w = skew(np.cross([1.0, 0.0, 0.0], t))
    return np.eye(3) + w + w @ w / (1.0 + t[:, 0])[:, None, None]


def roll(axis: Axis, z: Array) -> Array:
    """Angle (n,) from the untwisted section axes of ``core.blade`` to BeamDyn's, whose x has no y-component."""
    t = _tangents(axis, z)
    beamdyn_y = np.stack([-t[:, 2], np.zeros_like(z), t[:, 0]], axis=1) / np.hypot(t[:, 0], t[:, 2])[:, None]
    y, zz = np.einsum("nij,ni->jn", _swing(t), beamdyn_y)[1:]
    return np.arctan2(-y, zz)
