"""The equations of a rotor of N equal blades on the non-rotating frame of its hub.

ξ_H is the twist of the non-rotating hub frame. Blade k sees it turned by −ψ_k, so that its motions are

    y_k = (q_k, ξ_k) = P(ψ_k) (q_0, q_c, q_s, …, ξ_H),

with the multi-blade coordinates of ``multiblade``. Summed over N ≥ 3 blades, Pᵀ(M P), Pᵀ(C P + 2Ω M P′) and
Pᵀ(K P + Ω C P′ + Ω² M P″) do not depend on ψ. They couple to the tower through ξ_H. The rotor's net wrench on the hub
vanishes: no gravity acts on the blades' own motions, only the rotor's weight on nacelle and tower.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..rotor import multiblade
from ..rotor.periodic import CONSTANT, PeriodicError
from ..space import spatial as sp
from .component import Component
from .turbine import Turbine

Array = NDArray[np.float64]

RZ = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])
"""Twist of a rotation about the rotor's axis."""


def rotor(turbine: Turbine, blade: Component, omega: float, psi: float) -> tuple[Array, Array, Array]:
    """M, C, K (nr + 6, nr + 6) of hub and blades over (multi-blade coordinates, ξ_H) at the azimuth ψ of blade 0."""
    n, r = turbine.blades, blade.size
    T, R = multiblade.transformation(psi, n), multiblade.rate(n)
    out = [np.zeros((n * r + 6, n * r + 6)) for _ in range(3)]
    for k in range(n):
        turns = turned_axes(psi + 2.0 * np.pi * k / n)
        P = []
        for order, rotation in enumerate(turns):
            part = np.zeros((r + 6, n * r + 6))
            part[:r, : n * r] = np.kron((T @ np.linalg.matrix_power(R, order))[k], np.eye(r))
            part[r:, n * r :] = rotation
            P.append(part)
        for total, part in zip(out, in_ground_frame(blade, omega, P), strict=True):
            total += part
    spin = omega * RZ
    momentum = turbine.hub @ spin
    out[0][-6:, -6:] += turbine.hub
    # a symmetric body that spins about its axis: δg = M ξ̈ + (Y ×* M − M Y × + M Y ×̄*) ξ̇, in the frame that does not spin
    out[1][-6:, -6:] += -sp.coadjoint(momentum)
    return out[0], out[1], out[2]


def in_ground_frame(blade: Component, omega: float, P: Sequence[Array]) -> tuple[Array, Array, Array]:
    """M, C, K of one blade over coordinates z with y = P(ψ) z; ``P``: P, P′ and P″ at an azimuth."""
    M = P[0].T @ blade.M @ P[0]
    C = P[0].T @ (blade.C @ P[0] + 2.0 * omega * blade.M @ P[1])
    K = P[0].T @ (blade.K @ P[0] + omega * blade.C @ P[1] + omega**2 * blade.M @ P[2])
    return M, C, K


def turned_axes(psi: float) -> tuple[Array, Array, Array]:
    """A (6, 6), the twist ξ_H in axes turned by ψ about z, and its first and second derivatives."""
    c, s = np.cos(psi), np.sin(psi)
    parts = (
        np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]),
        np.array([[-s, c, 0.0], [-c, -s, 0.0], [0.0, 0.0, 0.0]]),
        np.array([[-c, -s, 0.0], [s, -c, 0.0], [0.0, 0.0, 0.0]]),
    )
    first, second, third = (np.asarray(np.kron(np.eye(2), part), float) for part in parts)
    return first, second, third


def check_constant(first: tuple[Array, ...], second: tuple[Array, ...], rate: float) -> None:
    """Check that the rotor's equations are the same at two azimuths, for motions at ``rate``, rad/s; never averaged."""
    size = np.sqrt(sum(rate ** (2 - k) * np.abs(np.diagonal(part)) for k, part in enumerate(first)))
    for k, (a, b) in enumerate(zip(first, second, strict=True)):
        change = float((rate ** (2 - k) * np.abs(a - b) / np.outer(size, size)).max())
        if change > CONSTANT:
            raise PeriodicError(
                f"azimuth: the rotor's equations vary with it by {100 * change:.2g} %: the blades are not equal"
            )
