"""Elastic elements between two frames a and b: a strain measure of their relative pose, and its energy ½ εᵀKε.

Variations are twists seen from a snapshot of frame a: with ``X = X_a⁻¹ X_b`` and ``dX = ρ^ X``, ρ = ξ_b − ξ_a, the energy
gives the wrench ``w = Eᵀ s`` on b (and −w on a), where ``E = ∂ε/∂ρ`` and ``s = K ε + preload``; its derivative with respect
to ρ is ``Eᵀ K E + ∂(Eᵀ s)/∂ρ``: material and geometric stiffness, both analytic.

Two measures:

* ``corotational``: ε = δ + (δᵀGδ) x̂ with δ = log X − log X₀, the helicoidal strain of a frame moving from a to b (Sonneville,
  Cardona, Brüls 2014, sec. 4). Bending into an arc stretches nothing by itself; G adds the shortening by what the static shape
  deviates from the arc, which makes the tension's stiffening that of the cubic beam element;
* ``parent``: displacement and Cardan angles (x, y, z) of b from its rest pose, in axes fixed in a. Linear in the parent's
  body frame, as Park et al. 2010 have it: no geometric stiffness inside the element.
"""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from . import spatial as sp

Array = NDArray[np.float64]
Measure = Literal["corotational", "parent"]


def strain(measure: Measure, rest: Array, shortening: Array, x: Array) -> Array:
    """Strains (n, 6) of relative poses ``x`` (n, 4, 4) from the rest poses ``rest``; ``shortening`` is G (n, 6, 6)."""
    if measure == "corotational":
        delta = sp.log(x) - sp.log(rest)
        out = delta.copy()
        out[..., 0] += (delta * (shortening @ delta[..., None])[..., 0]).sum(-1)
        return out
    y = sp.inverse(rest) @ x
    return np.concatenate([y[..., :3, 3], _cardan(y[..., :3, :3])], axis=-1)


def strain_rate(measure: Measure, rest: Array, shortening: Array, x: Array) -> Array:
    """E = ∂ε/∂ρ (n, 6, 6)."""
    if measure == "corotational":
        eta = sp.log(x)
        E = sp.tangent_inverse(eta)
        slope = 2.0 * (shortening @ (eta - sp.log(rest))[..., None])[..., 0]
        E[..., 0, :] += (slope[..., None, :] @ E)[..., 0, :]
        return E
    local, rate = _parent(rest, x)[1:]
    return rate @ local


def wrench_derivative(measure: Measure, rest: Array, shortening: Array, x: Array, s: Array) -> Array:
    """∂(Eᵀ s)/∂ρ (n, 6, 6), s held: the geometric stiffness."""
    if measure == "corotational":
        eta = sp.log(x)
        E = sp.tangent_inverse(eta)
        bow = 2.0 * s[..., :1, None] * shortening
        conjugate = s + (bow @ (eta - sp.log(rest))[..., None])[..., 0]
        return (sp.tangent_inverse_transpose_derivative(eta, conjugate) + np.swapaxes(E, -1, -2) @ bow) @ E
    z, local, rate = _parent(rest, x)
    curvature = np.zeros((*s.shape, 6))
    curvature[..., 3:, :3] = -sp.skew(s[..., :3])
    curvature[..., 3:, 3:] = _cardan_rate_transpose_derivative(z[..., 3:], s[..., 3:])
    return np.swapaxes(local, -1, -2) @ curvature @ rate @ local


def _parent(rest: Array, x: Array) -> tuple[Array, Array, Array]:
    """Coordinates z, the twist ρ brought to the rest frame, and ∂z/∂(twist in the rest frame)."""
    z = strain("parent", rest, np.zeros((6, 6)), x)
    rate = np.zeros((*z.shape, 6))
    rate[..., :3, :3] = np.eye(3)
    rate[..., :3, 3:] = -sp.skew(z[..., :3])
    rate[..., 3:, 3:] = _cardan_rate(z[..., 3:])
    return z, sp.adjoint(sp.inverse(rest)), rate


def _cardan(r: Array) -> Array:
    """Angles of R = R_x(α) R_y(β) R_z(γ)."""
    return np.stack(
        [
            np.arctan2(-r[..., 1, 2], r[..., 2, 2]),
            np.arcsin(np.clip(r[..., 0, 2], -1.0, 1.0)),
            np.arctan2(-r[..., 0, 1], r[..., 0, 0]),
        ],
        axis=-1,
    )


def _cardan_rate(angles: Array) -> Array:
    """(α̇, β̇, γ̇) from the angular velocity in the fixed axes."""
    sa, ca = np.sin(angles[..., 0]), np.cos(angles[..., 0])
    sb, cb = np.sin(angles[..., 1]), np.cos(angles[..., 1])
    out = np.zeros((*angles.shape, 3))
    out[..., 0, 0] = 1.0
    out[..., 0, 1], out[..., 0, 2] = sa * sb / cb, -ca * sb / cb
    out[..., 1, 1], out[..., 1, 2] = ca, sa
    out[..., 2, 1], out[..., 2, 2] = -sa / cb, ca / cb
    return out


def _cardan_rate_transpose_derivative(angles: Array, m: Array) -> Array:
    """Derivative of ``_cardan_rate(θ)ᵀ m`` with respect to θ, m held."""
    sa, ca = np.sin(angles[..., 0]), np.cos(angles[..., 0])
    sb, cb = np.sin(angles[..., 1]), np.cos(angles[..., 1])
    m0, m1, m2 = m[..., 0], m[..., 1], m[..., 2]
    out = np.zeros((*angles.shape, 3))
    lever = (m0 * sb - m2) / cb  # (Aᵀm)_y = sα lever + cα m1,  (Aᵀm)_z = −cα lever + sα m1
    slope = (m0 - m2 * sb) / cb**2  # ∂lever/∂β
    out[..., 1, 0], out[..., 2, 0] = ca * lever - sa * m1, sa * lever + ca * m1
    out[..., 1, 1], out[..., 2, 1] = sa * slope, -ca * slope
    return out
