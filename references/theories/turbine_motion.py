"""Kinematics of a turbine's tree: places of its links, their velocities, the generator, and the motion of the stations."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ...core.modes import STATIONS
from ...core.space.spatial import rotation
from .turbine_tree import Chain, TurbineTree

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Placed:
    """The tree at one configuration: ``axes`` (n, 3, 3) and ``origin`` (n, 3) of the links, ``along`` (n, 3) of the joints."""

    axes: Array
    origin: Array
    along: Array


def placed(tree: TurbineTree, q: Array) -> Placed:
    """The links at the coordinates q (n,)."""
    n = len(q)
    R, p, along = np.zeros((n, 3, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    for k, (kind, on) in enumerate(zip(tree.strain, tree.parent, strict=True)):
        A, o = (R[on], p[on]) if on >= 0 else (np.eye(3), np.zeros(3))
        p[k] = o + A @ tree.offset[k]
        R[k] = A @ tree.axes[k]
        along[k] = R[k][:, kind % 3]
        if kind < 3:
            p[k] = p[k] + along[k] * q[k]
        else:
            R[k] = R[k] @ rotation(int(kind) % 3, q[k])
    return Placed(R, p, along)


def carriers(tree: TurbineTree, link: int) -> list[int]:
    """The joints that move a link, from the ground outwards."""
    out = []
    while link >= 0:
        out.append(link)
        link = int(tree.parent[link])
    return out[::-1]


def jacobian(tree: TurbineTree, at: Placed, link: int, point: Array) -> Array:
    """(6, n) velocity of a point (3,) of a link and its angular velocity by the rates of the joints, in the ground's axes."""
    out = np.zeros((6, len(tree.strain)))
    where = at.origin[link] + at.axes[link] @ point
    for k in carriers(tree, link):
        turns = tree.strain[k] >= 3
        out[:3, k] = np.cross(at.along[k], where - at.origin[k]) if turns else at.along[k]
        out[3:, k] = at.along[k] if turns else 0.0
    return out


def with_generator(tree: TurbineTree, q: Array, M: Array, C: Array, K: Array) -> tuple[Array, Array, Array]:
    """The equations (n, n) with the base's inertia, the generator and the shaft's spring, without the prescribed azimuth.

    A generator that is free behind a shaft's spring has a coordinate of its own, which is the last.
    """
    drive, n = tree.turbine.drivetrain, len(q)
    at = placed(tree, q)
    own = drive.free and np.isfinite(drive.stiffness)
    size = n + own
    out = [np.zeros((size, size)) for _ in range(3)]
    for total, part in zip(out, (M, C, K), strict=True):
        total[:n, :n] = part
    rotating = np.zeros(size)
    rotating[:n] = at.along[tree.spin] @ jacobian(tree, at, tree.nacelle, np.zeros(3))[3:]
    if drive.free:
        rotating[n if own else tree.hub] += drive.gear_ratio
    if tree.foot and tree.turbine.support.mass is not None:
        jacobian_of_foot = jacobian(tree, at, tree.foot - 1, np.zeros(3))
        out[0][:n, :n] += jacobian_of_foot.T @ tree.turbine.support.mass @ jacobian_of_foot
    out[0] += drive.generator * np.outer(rotating, rotating)
    if own:
        out[2][np.ix_([tree.hub, n], [tree.hub, n])] += drive.stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])
    free = np.delete(np.arange(size), tree.spin)
    M, C, K = (part[np.ix_(free, free)] for part in out)
    return M, C, K


def shapes(tree: TurbineTree, q: Array, x: Complex) -> Complex:
    """(m, 21 (1 + N), 4) motion of the stations of ``core.turbine.stations`` in shapes x (n, m) of the joints, azimuth 0."""
    at, turbine = placed(tree, q), tree.turbine
    tower, blade = tree.chains
    foot = jacobian(tree, at, tree.foot - 1, np.zeros(3)) @ x if tree.foot else np.zeros((6, x.shape[1]), np.complex128)
    out = [_along(foot, [jacobian(tree, at, int(k), r) @ x for k, r in zip(tower.nodes, tower.reach, strict=True)],
                  tower, np.eye(3), turbine.tower.length)]  # fmt: skip
    for k, joints in enumerate(tree.blades):
        rotation_matrix = rotation(2, np.array(2.0 * np.pi * k / turbine.blades))
        root = jacobian(tree, at, tree.hub, rotation_matrix @ blade.base) @ x
        nodes = [jacobian(tree, at, int(joints[link]), r) @ x for link, r in zip(blade.nodes, blade.reach, strict=True)]
        out.append(_along(root, nodes, blade, at.axes[tree.spin] @ rotation_matrix, turbine.blade.length))
    return np.concatenate(out, axis=1)


def _along(root: Complex, nodes: Sequence[Complex], chain: Chain, axes: Array, length: float) -> Complex:
    """(m, 21, 4): cubic splines through the motion (6, m) of a chain's root and nodes, in the given axes."""
    motion = np.array([root, *nodes])
    local = np.concatenate([axes.T @ motion[:, :3], (axes[:, 0] @ motion[:, 3:])[:, None]], axis=1)
    return CubicSpline(np.concatenate([[0.0], chain.arc]), local)(STATIONS * length).transpose(2, 0, 1)
