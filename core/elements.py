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

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from . import spatial as sp

Array = NDArray[np.float64]
Measure = Literal["corotational", "parent"]


@dataclass(frozen=True)
class Response:
    """What an element's relative pose gives.

    Attributes:
        strain: (n, 6) ε.
        rate: (n, 6, 6) E = ∂ε/∂ρ.
        curvature: from the force s (n, 6) conjugate to ε, and one (n, 6) conjugate to η = log X, the derivative (n, 6, 6) with
            respect to ρ of the wrench they make, both held: the geometric stiffness.
    """

    strain: Array
    rate: Array
    curvature: Callable[[Array, Array], Array]


def response(measure: Measure, rest: Array, shortening: Array, x: Array, eta: Array, back: Array) -> Response:
    """Strain of relative poses ``x`` (n, 4, 4) from the rest poses ``rest``, and its derivatives.

    Args:
        measure: of strain, see the module.
        rest: (n, 4, 4) poses without strain.
        shortening: (n, 6, 6) G of the corotational measure.
        x: (n, 4, 4) relative poses.
        eta: (n, 6) their logarithms.
        back: (n, 6, 6) ``tangent_inverse(eta)``.
    """
    return (_corotational if measure == "corotational" else _from_parent)(rest, shortening, x, eta, back)


def strain_rate(measure: Measure, rest: Array, shortening: Array, x: Array) -> Array:
    """E = ∂ε/∂ρ (n, 6, 6) alone; arguments as for ``response``."""
    eta = sp.log(x)
    return response(measure, rest, shortening, x, eta, sp.tangent_inverse(eta)).rate


def _corotational(rest: Array, shortening: Array, x: Array, eta: Array, back: Array) -> Response:
    delta = eta - sp.log(rest)
    slope = (shortening @ delta[..., None])[..., 0]
    strain, rate = delta.copy(), back.copy()
    strain[..., 0] += (delta * slope).sum(-1)
    rate[..., 0, :] += 2.0 * (slope[..., None, :] @ back)[..., 0, :]

    def curvature(s: Array, on_eta: Array) -> Array:
        bow = 2.0 * s[..., :1, None] * shortening
        conjugate = s + on_eta + 2.0 * s[..., :1] * slope
        return (sp.tangent_inverse_transpose_derivative(eta, conjugate) + np.swapaxes(back, -1, -2) @ bow) @ back

    return Response(strain, rate, curvature)


def _from_parent(rest: Array, shortening: Array, x: Array, eta: Array, back: Array) -> Response:
    y = sp.inverse(rest) @ x
    strain = np.concatenate([y[..., :3, 3], _cardan(y[..., :3, :3])], axis=-1)
    local = sp.adjoint(sp.inverse(rest))  # brings ρ to the rest frame
    rate = np.zeros((*strain.shape, 6))
    rate[..., :3, :3] = np.eye(3)
    rate[..., :3, 3:] = -sp.skew(strain[..., :3])
    rate[..., 3:, 3:] = _cardan_rate(strain[..., 3:])

    def curvature(s: Array, on_eta: Array) -> Array:
        turn = np.zeros((*s.shape, 6))
        turn[..., 3:, :3] = -sp.skew(s[..., :3])
        turn[..., 3:, 3:] = _cardan_rate_transpose_derivative(strain[..., 3:], s[..., 3:])
        out = np.swapaxes(local, -1, -2) @ turn @ rate @ local
        return out + sp.tangent_inverse_transpose_derivative(eta, on_eta) @ back if on_eta.any() else out

    return Response(strain, rate @ local, curvature)


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
