"""A frame of straight Timoshenko elements by the direct stiffness method, at rest: independent of the mechanism solver."""

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

Array = NDArray[np.float64]


def cross(v: Array) -> Array:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def element(start: Array, end: Array, second: Array, K: Array, M: Array) -> tuple[Array, Array]:
    """Stiffness and lumped mass (12, 12) in global axes: forces, then moments, at ``start``; the same at ``end``."""
    step = end - start
    length = float(np.linalg.norm(step))
    axis = step / length
    R = np.kron(np.eye(2), np.stack([axis, second, np.cross(axis, second)], axis=1))
    flexibility = np.linalg.inv(R @ K @ R.T)
    points, weights = np.polynomial.legendre.leggauss(2)  # moments are linear along the element: exact
    F = np.zeros((6, 6))
    for p, w in zip(points, weights, strict=True):
        carry = np.eye(6)
        carry[3:, :3] = cross((0.5 - 0.5 * p) * step)  # a force at the end has this moment at the point
        F += 0.5 * length * w * carry.T @ flexibility @ carry
    carry = np.eye(6)
    carry[3:, :3] = cross(step)
    H = np.hstack([-carry.T, np.eye(6)])  # motion of the end less what the start's carries along
    mass = np.zeros((12, 12))
    mass[:6, :6] = mass[6:, 6:] = 0.5 * length * R @ M @ R.T
    return H.T @ np.linalg.inv(F) @ H, mass


def frequencies(elements: list[tuple[int, int, Array, Array]], held: dict[int, list[int]], count: int) -> Array:
    """Lowest ``count`` natural frequencies (rad/s) of elements (node, node, K, M) whose nodes have some components held."""
    nodes = 1 + max(max(a, b) for a, b, _, _ in elements)
    K, M = np.zeros((6 * nodes, 6 * nodes)), np.zeros((6 * nodes, 6 * nodes))
    for a, b, k, m in elements:
        at = np.r_[6 * a : 6 * a + 6, 6 * b : 6 * b + 6]
        K[np.ix_(at, at)] += k
        M[np.ix_(at, at)] += m
    free = np.setdiff1d(np.arange(6 * nodes), [6 * n + c for n, parts in held.items() for c in parts])
    K, M = (a[np.ix_(free, free)] for a in (K, M))
    return np.sqrt(np.asarray(scipy.linalg.eigvalsh(K, M, subset_by_index=[0, count - 1]), float))
