"""States of BeamDyn's nodes: whether they are in the frame that turns with the blade.

BeamDyn linearises in a frozen frame, the root's at this instant. Its Jacobian then lacks the Coriolis terms, which a
rotating frame has: the accelerations of a node contain −2 ω × v, whatever the beam is.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.space.spatial import skew
from .sets import AzimuthSet

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NodeTriplet:
    """Indices of the three displacements of a node in X, Y, Z, and of their rates."""

    blade: int
    node: int
    motion: str
    displacements: tuple[int, ...]
    rates: tuple[int, ...]


def triplets(azimuth_set: AzimuthSet) -> tuple[NodeTriplet, ...]:
    """All triplets of translations and rotations."""
    rate_of = dict(azimuth_set.pairs)
    indices: dict[tuple[int, int, str], dict[int, int]] = {}
    for i, state in enumerate(azimuth_set.states):
        if state.module == "BD" and state.blade and not state.rate and i in rate_of and (at := state.direction):
            indices.setdefault((state.blade, at[2], at[0]), {})[at[1]] = i
    return tuple(
        NodeTriplet(blade, node, motion, tuple(axes[k] for k in range(3)), tuple(rate_of[axes[k]] for k in range(3)))
        for (blade, node, motion), axes in indices.items()
        if len(axes) == 3
    )


def coriolis_content(azimuth_set: AzimuthSet) -> float | None:
    """Coriolis terms of the translations relative to those of a rotating frame: 1 in a rotating frame, 0 in a frozen one.

    In A, the rate of a node's displacement in Y acts on its acceleration in Z by −2 Ω, and in Z on Y by 2 Ω. The mean over
    nodes, blades and azimuths of their difference, over 4 Ω; damping and gravity contribute equal parts with opposite
    signs. None without nodes or rotation.
    """
    omega = azimuth_set.omega
    nodes = [t for t in triplets(azimuth_set) if t.motion == "translational"]
    if not nodes or abs(omega) < 1e-3:
        return None
    terms = [azimuth_set.A[:, t.rates[1], t.rates[2]] - azimuth_set.A[:, t.rates[2], t.rates[1]] for t in nodes]
    return float(np.mean(terms) / (4 * omega))


def angular_velocities(azimuth_set: AzimuthSet) -> dict[int, Array]:
    """Angular velocity of each blade in its own axes, rad/s (azimuth, axis): that of its nodes nearest the root."""
    out: dict[int, Array] = {}
    rotations = sorted((t for t in triplets(azimuth_set) if t.motion == "rotational"), key=lambda t: t.node)
    for t in rotations:
        out.setdefault(t.blade, azimuth_set.values[:, list(t.rates)])
    return out


def rotated(azimuth_set: AzimuthSet, A: Array) -> Array:
    """State matrices with the nodes' states in the rotating frame, from those in the frozen frame.

    The states of a triplet are q, q̇ in the rotating frame and q, v = q̇ + ω × q in the frozen one, hence
    A_r = S A S⁻¹ + diag(−ω̃), S = [[1, 0], [−ω̃, 1]] (OpenFAST pull request 3400).
    """
    omega = angular_velocities(azimuth_set)
    out = np.empty_like(A)
    for k in range(len(A)):
        S, turning = np.eye(len(azimuth_set.states)), np.zeros_like(A[k])
        for t in triplets(azimuth_set):
            cross = skew(omega[t.blade][k])
            S[np.ix_(t.rates, t.displacements)] = -cross
            turning[np.ix_(t.displacements, t.displacements)] = -cross
            turning[np.ix_(t.rates, t.rates)] = -cross
        out[k] = np.linalg.solve(S.T, (S @ A[k]).T).T + turning
    return out
