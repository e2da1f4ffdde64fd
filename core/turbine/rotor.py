"""The equations of a rotor of N equal blades on the non-rotating frame of its hub.

ξ_H is the twist of the non-rotating hub frame. Blade k sees it turned by −ψ_k, so that its motions are

    y_k = (q_k, ξ_k) = P(ψ_k) (q_0, q_c, q_s, …, ξ_H),

with the multi-blade coordinates of ``multiblade``. Summed over N ≥ 3 blades, Pᵀ(M P), Pᵀ(C P + 2Ω M P′) and
Pᵀ(K P + Ω C P′ + Ω² M P″) do not depend on ψ; those of two blades, which may teeter on the shaft, do. They couple to the tower
through ξ_H. The rotor's net wrench on the hub vanishes: no gravity acts on the blades' own motions, only the rotor's weight on
nacelle and tower.
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
    """M, C, K (nr + 6 + h, …) of hub and blades over (multi-blade coordinates, ξ_H, h angles of the hinge) at the azimuth ψ."""
    n, r, hinge = turbine.blades, blade.size, turbine.hinge
    size = n * r + 6 + hinge.shape[1]
    T, R = multiblade.transformation(psi, n), multiblade.rate(n)
    parts = [in_ground_frame(spinning(turbine.hub, omega), omega, _hub_motion(psi, 0.0, hinge, n * r))]
    for k in range(n):
        angle = 2.0 * np.pi * k / n
        P = []
        for order, of_root in enumerate(_hub_motion(psi, angle, hinge, n * r)):
            own = np.zeros((r, size))
            own[:, : n * r] = np.kron((T @ np.linalg.matrix_power(R, order))[k], np.eye(r))
            P.append(np.concatenate([own, of_root]))
        parts.append(in_ground_frame((blade.M, blade.C, blade.K), omega, P))
    M, C, K = (np.sum(part, axis=0) for part in zip(*parts, strict=True))
    return M, C, K


def _hub_motion(psi: float, angle: float, hinge: Array, before: int) -> list[Array]:
    """(6, nr + 6 + h) twist of the hub in its axes turned by an angle from blade 0, and its derivatives with respect to ψ."""
    out = []
    for order, rotation in enumerate(turned_axes(psi + angle)):
        on_hinge = turned_axes(angle)[0] @ hinge if order == 0 else np.zeros_like(hinge)
        out.append(np.concatenate([np.zeros((6, before)), rotation, on_hinge], axis=1))
    return out


def spinning(inertia: Array, omega: float) -> tuple[Array, Array, Array]:
    """M, C, K (6, 6) over the twist, in its axes, of a body that spins about its z axis, a central principal one.

    With Y = Y₀ + ξ̇ + Y₀ × ξ, g = M Ẏ + Y ×* M Y.
    """
    spin = sp.ad(omega * RZ)
    turning = -spin.T @ inertia - sp.coadjoint(inertia @ (omega * RZ))
    return inertia, inertia @ spin + turning, turning @ spin


def in_ground_frame(own: tuple[Array, Array, Array], omega: float, P: Sequence[Array]) -> tuple[Array, Array, Array]:
    """M, C, K over coordinates z with y = P(ψ) z from those over y of a part that turns; ``P``: P, P′ and P″ at an azimuth."""
    M, C, K = own
    return (
        P[0].T @ M @ P[0],
        P[0].T @ (C @ P[0] + 2.0 * omega * M @ P[1]),
        P[0].T @ (K @ P[0] + omega * C @ P[1] + omega**2 * M @ P[2]),
    )


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
