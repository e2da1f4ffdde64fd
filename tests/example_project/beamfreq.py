"""Straight rotating beams in bending, by cubic finite elements: a user's own solver, which does not import Southwell.

A beam has three arrays at equally spaced points from root to tip; its root is the distance ``hub`` from the rotor axis.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(5)
POINTS, WEIGHTS = (POINTS + 1) / 2, WEIGHTS / 2


@dataclass(frozen=True)
class Beam:
    """Length, m; hub, m; at points from root to tip: mass per length, kg/m, bending stiffness in and out of the plane, N m²."""

    length: float
    hub: float
    mass: np.ndarray
    in_plane: np.ndarray
    out_of_plane: np.ndarray


def frequencies(beam, omega, elements, count, stiffened=True):
    """The lowest frequencies, rad/s; the plane of each (0: of rotation, 1: out of it); deflections at 21 points.

    ``stiffened=False`` omits the stiffness due to the centrifugal force, a mistake that the tests must detect.
    """
    result = []
    for plane, bending in enumerate((beam.in_plane, beam.out_of_plane)):
        M, K = _matrices(beam, omega, elements, bending, stiffened)
        squares, vectors = eigh(K - (omega**2 * M if plane == 0 else 0), M)
        for square, vector in zip(squares, vectors.T, strict=True):
            if square > 0:
                result.append((np.sqrt(square), plane, _deflection(vector, elements, beam.length)))
    result.sort(key=lambda mode: mode[0])
    return [list(column) for column in zip(*result[:count], strict=True)]


def _matrices(beam, omega, elements, bending, stiffened):
    """Mass and stiffness of the beam with a clamped root."""
    h = beam.length / elements
    table = np.linspace(0, beam.length, len(beam.mass))
    M, K = np.zeros((2, 2 * elements + 2, 2 * elements + 2))
    for e in range(elements):
        at = slice(2 * e, 2 * e + 4)
        for point, weight in zip(POINTS, WEIGHTS * h, strict=True):
            s = (e + point) * h
            mass, stiffness = np.interp(s, table, beam.mass), np.interp(s, table, bending)
            value, slope, curvature = _cubics(point, h)
            M[at, at] += weight * mass * np.outer(value, value)
            K[at, at] += weight * stiffness * np.outer(curvature, curvature)
            if stiffened:
                K[at, at] += weight * _tension(beam, table, omega, s) * np.outer(slope, slope)
    return M[2:, 2:], K[2:, 2:]


def _tension(beam, table, omega, s):
    """Centrifugal force of the mass outboard of s; mass per length is linear between the points of the table."""
    ends = np.concatenate([[s], table[table > s]])
    half = np.diff(ends)[:, None] / 2
    x = (ends[:-1, None] + half) + half * (2 * POINTS - 1)
    return omega**2 * np.sum(2 * half * WEIGHTS * np.interp(x, table, beam.mass) * (beam.hub + x))


def _cubics(t, h):
    """Hermite's cubics at a fraction of an element: value, slope, curvature."""
    return (
        np.array([1 - 3 * t**2 + 2 * t**3, h * (t - 2 * t**2 + t**3), 3 * t**2 - 2 * t**3, h * (t**3 - t**2)]),
        np.array([6 * t**2 - 6 * t, h * (1 - 4 * t + 3 * t**2), 6 * t - 6 * t**2, h * (3 * t**2 - 2 * t)]) / h,
        np.array([12 * t - 6, h * (6 * t - 4), 6 - 12 * t, h * (6 * t - 2)]) / h**2,
    )


def _deflection(vector, elements, length):
    full = np.concatenate([[0.0, 0.0], vector])
    place = np.minimum(np.linspace(0, elements, 21), elements - 1e-9)
    return np.array([_cubics(p % 1, length / elements)[0] @ full[2 * int(p) :][:4] for p in place])
