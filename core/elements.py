"""Elastic elements between two frames a and b: a strain measure of their relative pose, and its energy ½ εᵀKε.

Variations are twists seen from a snapshot of frame a: with ``X = X_a⁻¹ X_b`` and ``dX = ρ^ X``, ρ = ξ_b − ξ_a, the energy
gives the wrench ``w = Eᵀ s`` on b (and −w on a), where ``E = ∂ε/∂ρ`` and ``s = K ε + preload``; its derivative with respect
to ρ is ``Eᵀ K E + ∂(Eᵀ s)/∂ρ``: material and geometric stiffness, both analytic.

Two measures:

* ``corotational``: δ = log X − log X₀ is the helicoidal strain of a frame moving from a to b (Sonneville, Cardona, Brüls 2014,
  sec. 4), which is the strain where that does not vary along the element: bending into an arc stretches nothing by itself.
  Where it does vary, by the static shape that belongs to δ and by the internal coordinates β, two terms are added. Magnus'
  expansion of X′ = X ξ gives log X = ∫ξ + (1/12) ad(∫ξ) ξ′L², so the strain solves ``ε + (1/12) ad(A δ) B (ε, β) = δ``, A and
  B taking its integral and its slope from it: a stretched element is longer for its bending too. And the axial strain gains
  δᵀGδ, the shortening by what the static shape deviates from the helicoid, which makes the tension's stiffening that of the
  cubic beam element. Both are of the square of the element's length; with them it is of fourth order about any steady state;
* ``parent``: displacement and Cardan angles (x, y, z) of b from its rest pose, in axes fixed in a. Linear in the parent's
  body frame, as Park et al. 2010 have it: no geometric stiffness inside the element.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from . import spatial as sp

Array = NDArray[np.float64]
Measure = Literal["corotational", "parent"]


@dataclass(frozen=True)
class Law:
    """How n elements measure strain.

    Attributes:
        measure: see the module.
        rest: (n, 4, 4) relative poses without strain.
        shortening: (n, 6, 6) G, see ``sections``; of the corotational measure, as what follows.
        mean: (n, 6, 6) A: A δ is the strain's integral over the element, of the static shape that δ belongs to.
        slope: (n, 6, 12) B: B (δ, β) is its slope along the element, times the length squared.
        eta: (n, 6) logarithm of ``rest``.
    """

    measure: Measure
    rest: Array
    shortening: Array
    mean: Array
    slope: Array
    eta: Array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "eta", sp.log(self.rest))


def even(measure: Measure, rest: Array) -> Law:
    """Elements whose strain is the same all along: bushings, and elements known by their ends only."""
    n = len(rest)
    return Law(measure, rest, np.zeros((n, 6, 6)), np.zeros((n, 6, 6)), np.zeros((n, 6, 12)))


def joined(laws: Sequence[Law]) -> Law:
    """One law for the elements of several, all of one measure."""
    return Law(laws[0].measure, *(np.concatenate([getattr(law, name) for law in laws]) for name in _ARRAYS))


def part(law: Law, at: slice) -> Law:
    """The law of some of the elements."""
    return Law(law.measure, *(getattr(law, name)[at] for name in _ARRAYS))


_NOT_AXIAL = np.diag([0.0, 1.0, 1.0, 1.0, 1.0, 1.0])  # G has all of the axial strain's part of Magnus' term, but β's
_ARRAYS = ("rest", "shortening", "mean", "slope")


@dataclass(frozen=True)
class Response:
    """What an element's relative pose, and its internal coordinates β, give.

    Attributes:
        strain: (n, 6) ε.
        rate: (n, 6, 12) E = ∂ε/∂(ρ, β).
        curvature: from the force s (n, 6) conjugate to ε, and one (n, 6) conjugate to η = log X, the derivative (n, 12, 12)
            with respect to (ρ, β) of what they make on them, both held: the geometric stiffness.
    """

    strain: Array
    rate: Array
    curvature: Callable[[Array, Array], Array]


def response(law: Law, x: Array, eta: Array, back: Array, beta: Array) -> Response:
    """Strain of relative poses ``x`` (n, 4, 4) with β (n, 6), and its derivatives.

    ``eta`` (n, 6) is the poses' logarithm, and ``back`` (n, 6, 6) ``tangent_inverse(eta)``.
    """
    return (_corotational if law.measure == "corotational" else _from_parent)(law, x, eta, back, beta)


def strain_rate(law: Law, x: Array, beta: Array) -> Array:
    """E = ∂ε/∂ρ (n, 6, 6) alone; arguments as for ``response``, β (n, 0) if there is none."""
    eta = sp.log(x)
    return response(law, x, eta, sp.tangent_inverse(eta), inner(law, beta)).rate[..., :6]


def inner(law: Law, beta: Array) -> Array:
    """β (n, 6), zero where elements have none (n, 0)."""
    return beta if beta.shape[1] else np.zeros((len(law.rest), 6))


def _corotational(law: Law, x: Array, eta: Array, back: Array, beta: Array) -> Response:
    delta = eta - law.eta
    A, B, inner = law.mean, law.slope[..., :6], law.slope[..., 6:]
    bow = (law.shortening @ delta[..., None])[..., 0]
    across = sp.ad((A @ delta[..., None])[..., 0]) / 12.0
    by_beta = -across @ inner  # of r, where (1 + ad(A δ) B_δ/12) ε = r
    r = delta + (by_beta @ beta[..., None])[..., 0]
    r[..., 0] += (delta * bow).sum(-1)
    undo = np.linalg.inv(np.eye(6) + _NOT_AXIAL @ across @ B)
    strain = (undo @ r[..., None])[..., 0]
    slope, inner_slope = ((m @ v[..., None])[..., 0] for m, v in ((B, strain), (inner, beta)))
    by_delta = np.eye(6) + (_NOT_AXIAL @ sp.ad(slope) + sp.ad(inner_slope)) @ A / 12.0
    by_delta[..., 0, :] += 2.0 * bow
    J = undo @ np.concatenate([by_delta, by_beta], axis=-1)

    def curvature(s: Array, on_eta: Array) -> Array:
        force = (np.swapaxes(undo, -1, -2) @ s[..., None])[..., 0]
        conjugate = (np.swapaxes(J[..., :6], -1, -2) @ s[..., None])[..., 0] + on_eta
        turned = -np.swapaxes(A, -1, -2) / 12.0
        out = np.zeros((len(s), 12, 12))
        out[:, :6] = turned @ (np.swapaxes(sp.cross(force @ _NOT_AXIAL), -1, -2) @ B @ J)
        out[:, :6, 6:] += turned @ np.swapaxes(sp.cross(force), -1, -2) @ inner
        out = out + np.swapaxes(out, -1, -2)
        out[:, :6, :6] += 2.0 * force[..., :1, None] * law.shortening
        out[:, :6] = np.swapaxes(back, -1, -2) @ out[:, :6]
        out[:, :6, :6] += sp.tangent_inverse_transpose_derivative(eta, conjugate)
        out[..., :6] = out[..., :6] @ back
        return out

    rate = J.copy()
    rate[..., :6] = J[..., :6] @ back
    return Response(strain, rate, curvature)


def _from_parent(law: Law, x: Array, eta: Array, back: Array, beta: Array) -> Response:
    y = sp.inverse(law.rest) @ x
    strain = np.concatenate([y[..., :3, 3], _cardan(y[..., :3, :3])], axis=-1)
    local = sp.adjoint(sp.inverse(law.rest))  # brings ρ to the rest frame
    rate = np.zeros((*strain.shape, 6))
    rate[..., :3, :3] = np.eye(3)
    rate[..., :3, 3:] = -sp.skew(strain[..., :3])
    rate[..., 3:, 3:] = _cardan_rate(strain[..., 3:])

    def curvature(s: Array, on_eta: Array) -> Array:
        turn = np.zeros((*s.shape, 6))
        turn[..., 3:, :3] = -sp.skew(s[..., :3])
        turn[..., 3:, 3:] = _cardan_rate_transpose_derivative(strain[..., 3:], s[..., 3:])
        out = np.zeros((len(s), 12, 12))
        out[:, :6, :6] = np.swapaxes(local, -1, -2) @ turn @ rate @ local
        if on_eta.any():
            out[:, :6, :6] += sp.tangent_inverse_transpose_derivative(eta, on_eta) @ back
        return out

    return Response(strain, np.concatenate([rate @ local, np.zeros_like(rate)], axis=-1), curvature)


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
