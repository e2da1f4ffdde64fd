"""Weak forms for scikit-fem of a straight, twisted, stretched and rotating Kirchhoff beam, linearised.

The beam is extensible and shear-free, its material linear in the stretch and curvatures per unit of unstrained length:
``N = EA e``, ``M = EI κ``, ``M₁ = GJ κ₁`` (S. S. Antman, *Nonlinear Problems of Elasticity*, 2005, ch. 8). The steady
state is straight: stretched by ``g = 1 + U'``, and its sections rotated about x by their propeller moment. A small
motion displaces the line by u, v, w along x, y, z and rotates the sections by p about it. With ``α = v'/g`` and ``β =
w'/g`` the smallest rotation that brings x onto the displaced tangent is ``(0, −β, α)``. In the rotated axes, to second order,

    e = U' + u' + g (α² + β²)/2,   κ = steady + (p' − (αβ' − βα')/2, −β', α'),
    ω = (Ωβ + ṗ − (αβ̇ − βα̇)/2, −Ωαβ/2 − β̇, Ω (1 − β²/2) + α̇)

are stretch, curvature and angular velocity. With the sections' stiffness and inertia in axes y, z (which p rotates) the
Lagrangian gives the forms below. About an equilibrium the second-order definition of p is immaterial.

Arguments: trial functions u, v, w, p, test functions ending in ``_``, and q with the values at the quadrature points:
``g``, ``g_s`` its derivative; ``EA``, ``GJ``, ``EI_yy``, ``EI_zz``, ``EI_yz``, ``tension``, ``torque`` for the elastic
form; ``mass`` and the inertia matrix's entries ``J_xx``, ``J_yy``, ``J_zz``, ``J_yz`` for the other three. All SI.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def rotated(about_y: Array, about_z: Array, angle: Array) -> tuple[Array, Array, Array]:
    """Entries yy, zz, yz of a diagonal 2×2 matrix whose axes are rotated by ``angle`` about x."""
    c, s = np.cos(angle), np.sin(angle)
    return about_y * c**2 + about_z * s**2, about_y * s**2 + about_z * c**2, (about_y - about_z) * s * c


def slope(f: Any, q: Any) -> Any:
    """α of v, or β of w."""
    return f.grad[0] / q.g


def slope_s(f: Any, q: Any) -> Any:
    """α' of v, or β' of w, per unit of unstrained length."""
    return (f.hess[0, 0] - slope(f, q) * q.g_s) / q.g


def elastic(u: Any, v: Any, w: Any, p: Any, u_: Any, v_: Any, w_: Any, p_: Any, q: Any) -> Any:
    """Second variation of ``(EA e² + GJ κ₁² + EI κ²)/2``, including the steady tension and torque."""
    a, b, a_, b_ = (slope(f, q) for f in (v, w, v_, w_))
    a_s, b_s, a_s_, b_s_ = (slope_s(f, q) for f in (v, w, v_, w_))
    return (
        q.EA * u.grad[0] * u_.grad[0]
        + q.tension * q.g * (a * a_ + b * b_)
        + q.EI_yy * b_s * b_s_
        + q.EI_zz * a_s * a_s_
        - q.EI_yz * (a_s * b_s_ + b_s * a_s_)
        + q.GJ * p.grad[0] * p_.grad[0]
        - q.torque * (a * b_s_ - b * a_s_ + a_ * b_s - b_ * a_s) / 2
    )


def inertia(u: Any, v: Any, w: Any, p: Any, u_: Any, v_: Any, w_: Any, p_: Any, q: Any) -> Any:
    """Mass form: the part of the kinetic energy that is quadratic in the rates."""
    a, b, a_, b_ = (slope(f, q) for f in (v, w, v_, w_))
    return (
        q.mass * (u * u_ + v * v_ + w * w_)
        + q.J_xx * p * p_
        + q.J_yy * b * b_
        + q.J_zz * a * a_
        - q.J_yz * (a * b_ + b * a_)
    )


def gyroscopic(u: Any, v: Any, w: Any, p: Any, u_: Any, v_: Any, w_: Any, p_: Any, q: Any) -> Any:
    """Gyroscopic form over Ω, from the part linear in the rates: Coriolis forces and gyroscopic moments; skew."""
    a, b, a_, b_ = (slope(f, q) for f in (v, w, v_, w_))
    return (
        2 * q.mass * (u * v_ - v * u_) + (q.J_xx + q.J_yy - q.J_zz) * (b * p_ - p * b_) + 2 * q.J_yz * (p * a_ - a * p_)
    )


def centrifugal(u: Any, v: Any, w: Any, p: Any, u_: Any, v_: Any, w_: Any, p_: Any, q: Any) -> Any:
    """Centrifugal form over Ω², from the part without rates: spin softening and the stiffness of the propeller moment."""
    a, b, a_, b_ = (slope(f, q) for f in (v, w, v_, w_))
    return (
        q.mass * (u * u_ + v * v_)
        + (q.J_xx - q.J_zz) * b * b_
        - q.J_yz * (a * b_ + b * a_) / 2
        + (q.J_yy - q.J_zz) * p * p_
    )


def spring(u: Any, u_: Any, q: Any) -> Any:
    """k u' u_': axial or torsional stiffness."""
    return q.k * u.grad[0] * u_.grad[0]


def bedding(u: Any, u_: Any, q: Any) -> Any:
    """k u u_: distributed springs or mass."""
    return q.k * u * u_


def load(u_: Any, q: Any) -> Any:
    """k u_: distributed load."""
    return q.k * u_
