"""The compiled body-fixed strain measure of one element: displacement and Cardan angles in the axes of frame a.

The angles are (x, y, z), R = R_x(α) R_y(β) R_z(γ).
"""

import numpy as np
from numpy.typing import NDArray

from ..compiled import clear, compiled, product, transposed_product
from ..space import rigid

Array = NDArray[np.float64]


@compiled
def strains(undeformed: Array, x: Array, strain: Array, rate: Array) -> None:
    """ε (6,) and E (6, 12), zero for β, of an element with poses ``undeformed`` and ``x`` (4, 4)."""
    y, back = np.empty((4, 4)), np.empty((4, 4))
    rigid.inverse(undeformed, back)
    rigid.compose(back, x, y)
    angles, turn = np.empty(3), np.zeros((6, 6))
    _angles(y, angles)
    for i in range(3):
        strain[i], strain[3 + i] = y[i, 3], angles[i]
        turn[i, i] = 1.0
    rigid.put_skew(-y[0, 3], -y[1, 3], -y[2, 3], 0, 3, turn)
    _rate(angles, 3, 3, turn)
    local = np.empty((6, 6))
    rigid.adjoint(back, local)  # brings ρ to the undeformed frame
    clear(rate)
    product(turn, local, rate)


@compiled
def add_curvature(
    undeformed: Array, eta: Array, back: Array, rate: Array, strain: Array, s: Array, on_eta: Array, out: Array
) -> None:
    """Add the geometric stiffness (12, 12) of forces ``s`` and ``on_eta`` (6,) to ``out``."""
    turn, inverse, local, work = np.zeros((6, 6)), np.empty((4, 4)), np.empty((6, 6)), np.empty((6, 12))
    rigid.put_skew(-s[0], -s[1], -s[2], 3, 0, turn)
    _rate_transpose_derivative(strain[3:], s[3:], 3, 3, turn)
    rigid.inverse(undeformed, inverse)
    rigid.adjoint(inverse, local)
    product(turn, rate, work)
    transposed_product(local, work, turn)
    for i in range(6):
        for j in range(6):
            out[i, j] += turn[i, j]
    add_tangent_variation(eta, on_eta, back, out)


@compiled
def add_tangent_variation(eta: Array, conjugate: Array, back: Array, out: Array) -> None:
    """Add ∂(tangent⁻ᵀ(η) f)/∂ρ of a constant force f conjugate to η to the ρ block (6, 6) of ``out``."""
    rigid_turn, part = np.empty((6, 6)), np.empty((6, 6))
    rigid.tangent_inverse_transpose_derivative(eta, conjugate, rigid_turn)
    product(rigid_turn, back, part)
    for i in range(6):
        for j in range(6):
            out[i, j] += part[i, j]


@compiled
def _angles(r: Array, out: Array) -> None:
    """Angles (3,) of a rotation, the first three rows and columns of ``r``."""
    out[0] = np.arctan2(-r[1, 2], r[2, 2])
    out[1] = np.arcsin(min(1.0, max(-1.0, r[0, 2])))
    out[2] = np.arctan2(-r[0, 1], r[0, 0])


@compiled
def _rate(angles: Array, i: int, j: int, out: Array) -> None:
    """(α̇, β̇, γ̇) from the angular velocity in the fixed axes; ``out`` must be zero."""
    sa, ca = np.sin(angles[0]), np.cos(angles[0])
    sb, cb = np.sin(angles[1]), np.cos(angles[1])
    out[i, j], out[i, j + 1], out[i, j + 2] = 1.0, sa * sb / cb, -ca * sb / cb
    out[i + 1, j + 1], out[i + 1, j + 2] = ca, sa
    out[i + 2, j + 1], out[i + 2, j + 2] = -sa / cb, ca / cb


@compiled
def _rate_transpose_derivative(angles: Array, m: Array, i: int, j: int, out: Array) -> None:
    """Derivative of ``_rate(θ)ᵀ m`` with respect to θ at constant m; ``out`` must be zero."""
    sa, ca = np.sin(angles[0]), np.cos(angles[0])
    sb, cb = np.sin(angles[1]), np.cos(angles[1])
    lever = (m[0] * sb - m[2]) / cb  # (Aᵀm)_y = sα lever + cα m1,  (Aᵀm)_z = −cα lever + sα m1
    slope = (m[0] - m[2] * sb) / cb**2  # ∂lever/∂β
    out[i + 1, j], out[i + 2, j] = ca * lever - sa * m[1], sa * lever + ca * m[1]
    out[i + 1, j + 1], out[i + 2, j + 1] = sa * slope, -ca * slope
