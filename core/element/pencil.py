"""Residual, M, C and K of beam elements, compiled: see ``beams`` for the theory."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import (
    add_transposed_product,
    apply,
    clear,
    compiled,
    congruence,
    inner,
    product,
    transposed_apply,
)
from ..space import rigid
from . import inertia, measures
from .corotational import StrainLawArrays

Array = NDArray[np.float64]


class BeamArrays(NamedTuple):
    """``beams.Beams`` as contiguous arrays for compiled code."""

    law: StrainLawArrays
    stiffness: Array
    preload: Array
    inner_preload: Array
    zeta0: Array
    shape: Array
    bubble: Array
    mass: Array
    force: Array


class _Sums(NamedTuple):
    """One element's force (18,) and matrices (18, 18) on (ξ_a, ρ, β), and the force (6,) conjugate to η."""

    f: Array
    M: Array
    C: Array
    K: Array
    on_eta: Array


@compiled
def assemble(
    beams: BeamArrays,
    cardan: bool | None,
    fixed: bool | None,
    x: Array,
    beta: Array,
    frame: Array,
    fall: Array,
    axes: Array,
    geometric: bool,
    residual: Array,
    M: Array,
    C: Array,
    remainder: Array,
    spring: Array,
) -> None:
    """Residual (n, d), M, C, ``remainder`` (n, d, d) and spring (n, 6, 6) of ``beams.OnStrain``.

    ``cardan`` is that of ``measures``; ``fixed`` is None without loads on the points and without components that stay fixed.
    Numba does not compile the branches that None excludes.
    """
    eta, back = np.empty(6), np.empty((6, 6))
    sums = _Sums(np.empty(18), np.empty((18, 18)), np.empty((18, 18)), np.empty((18, 18)), np.empty(6))
    for k in range(len(x)):
        rigid.log(x[k], eta)
        rigid.tangent_inverse(eta, back)
        for i in range(18):
            sums.f[i] = 0.0
        for i in range(6):
            sums.on_eta[i] = 0.0
        for matrix in (sums.M, sums.C, sums.K, spring[k]):
            clear(matrix)
        if len(beams.mass):
            _add_inertia(beams, fixed, k, eta, back, beta[k], frame[k], fall[k], axes[k], geometric, sums, spring[k])
            for i in range(6):
                sums.f[12 + i] += beams.inner_preload[k, i] + beta[k, i]
                sums.K[12 + i, 12 + i] += 1.0
        _add_elastic(beams, cardan, k, x[k], eta, back, beta[k], geometric, sums, spring[k])
        d = residual.shape[1]
        for i in range(d):
            residual[k, i] = sums.f[i]
            for j in range(d):
                M[k, i, j], C[k, i, j], remainder[k, i, j] = sums.M[i, j], sums.C[i, j], sums.K[i, j]


@compiled
def _add_elastic(
    beams: BeamArrays,
    cardan: bool | None,
    k: int,
    x: Array,
    eta: Array,
    back: Array,
    beta: Array,
    geometric: bool,
    sums: _Sums,
    spring: Array,
) -> None:
    """Add the elastic force on (ρ, β) and its material and geometric stiffness; the part on ρ alone goes to ``spring``."""
    strain, s = np.empty(6), np.empty(6)
    rate, J, undo = np.empty((6, 12)), np.empty((6, 12)), np.empty((6, 6))
    measures.strains(beams.law, cardan, k, x, eta, back, beta, strain, rate, J, undo)
    apply(beams.stiffness[k], strain, s)
    for i in range(6):
        s[i] += beams.preload[k, i]
    work, K = np.empty((6, 12)), np.empty((12, 12))
    congruence(rate, beams.stiffness[k], work, K)
    if geometric:
        measures.add_curvature(beams.law, cardan, k, eta, back, J, undo, rate, strain, s, sums.on_eta, K)
    force = np.empty(12)
    transposed_apply(rate, s, force)
    for i in range(12):
        sums.f[6 + i] += force[i]
    _split(K, spring, sums.K)
    if geometric:  # −ρ ×* (wrench on b), on b alone
        crossed = np.empty((6, 6))
        rigid.cross(sums.f[6:12], crossed)
        for i in range(6):
            for j in range(6):
                sums.K[i, 6 + j] += crossed[i, j]
                sums.K[6 + i, 6 + j] += crossed[i, j]


@compiled
def _add_inertia(
    beams: BeamArrays,
    fixed: bool | None,
    k: int,
    eta: Array,
    back: Array,
    beta: Array,
    frame: Array,
    fall: Array,
    axes: Array,
    geometric: bool,
    sums: _Sums,
    spring: Array,
) -> None:
    """Add the inertia of the points: a wrench g at a point with twist ξ_a + H (ρ, β) acts as g on ξ_a and as Hᵀ g on (ρ, β).

    All wrenches are about a's origin in a's axes, where all points of an element are carried at the same twist.
    """
    per = len(beams.mass) // len(beams.stiffness)
    change, zeta, g, push, on_zeta = np.empty(6), np.empty(6), np.empty(6), np.zeros(3), np.empty(6)
    from_point, pose, to_point = np.empty((4, 4)), np.empty((4, 4)), np.empty((6, 6))
    T, D = np.empty((6, 6)), np.empty((6, 6))
    M, C, K, work = np.empty((6, 6)), np.empty((6, 6)), np.empty((6, 6)), np.empty((6, 6))
    slope, bent, H, turn = np.empty((6, 12)), np.empty((6, 12)), np.empty((6, 12)), np.empty((6, 6))
    U, by_U, curvature = np.empty((6, 18)), np.empty((6, 18)), np.zeros((12, 12))
    rigid.ad(frame, turn)
    for i in range(6):
        change[i] = eta[i] - beams.law.eta[k, i]
    for p in range(per):
        point = per * k + p
        if fixed is None and beams.mass[point, 0, 0] == 0.0:
            continue  # a copy that ``beams.alike`` added
        shape = beams.shape[point]
        ride(beams.zeta0[point], shape, beams.bubble[point], change, back, beta, zeta, slope, T, H)
        rigid.exp(zeta, from_point)
        rigid.inverse(from_point, pose)
        rigid.adjoint(pose, to_point)
        congruence(to_point, beams.mass[point], work, M)
        inertia.carry(M, frame, turn, fall, g, C, K)
        if fixed is not None:
            for i in range(3):
                push[i] = 0.0
                for j in range(3):
                    for m in range(3):
                        push[i] += pose[i, j] * axes[j, m] * beams.force[point, m]
            _hold_components(to_point, from_point, push, geometric, g, K)
        for i in range(6):
            sums.f[i] += g[i]
            for j in range(12):
                sums.f[6 + j] += H[i, j] * g[i]
        _put_twist(H, U)
        product(M, U, by_U)
        _add_on_twists(H, by_U, sums.M)
        product(C, U, by_U)
        _add_on_twists(H, by_U, sums.C)
        product(K, U, by_U)
        if geometric:
            # D_a g = D_point g − cross(g) H (ρ, β), and ∂(Hᵀg)/∂(ρ, β) is a spring between the ends and β, H = T(ζ) ∂ζ/∂(ρ, β)
            rigid.cross(g, work)
            product(work, H, bent)
            for i in range(6):
                for j in range(12):
                    by_U[i, 6 + j] -= bent[i, j]
            transposed_apply(T, g, on_zeta)
            for i in range(6):
                for j in range(6):
                    sums.on_eta[j] += shape[i, j] * on_zeta[i]
            rigid.tangent_transpose_derivative(zeta, g, D)
            product(D, slope, bent)
            add_transposed_product(slope, bent, curvature)
        _add_on_twists(H, by_U, sums.K)
    if geometric:
        _split(curvature, spring, sums.K)


@inner
def _add_on_twists(H: Array, by_U: Array, out: Array) -> None:
    """Add Uᵀ M U to ``out`` (18, 18), for the twist U = (1, H) of a point from (ξ_a, ρ, β) and ``by_U`` = M U (6, 18)."""
    for i in range(by_U.shape[0]):
        for j in range(by_U.shape[1]):
            out[i, j] += by_U[i, j]
    add_transposed_product(H, by_U, out)


@compiled
def ride(
    zeta0: Array,
    shape: Array,
    bubble: Array,
    change: Array,
    back: Array,
    beta: Array,
    zeta: Array,
    slope: Array,
    T: Array,
    H: Array,
) -> None:
    """Position of a point of ``beams.Points`` in a's frame and its derivative: ζ = ζ₀ + L (η − η₀) + bubble β.

    From η − η₀ (6,), ``back`` (6, 6) = ``tangent_inverse(η)`` and β (6,): ζ (6,), its slope (6, 12), ``tangent(ζ)`` (6, 6), and
    H (6, 12), the product of these two.
    """
    for i in range(6):
        zeta[i] = zeta0[i]
        for j in range(6):
            zeta[i] += shape[i, j] * change[j] + bubble[i, j] * beta[j]
            slope[i, 6 + j] = bubble[i, j]
    product(shape, back, slope)
    rigid.tangent(zeta, T)
    product(T, slope, H)


@compiled
def _put_twist(H: Array, out: Array) -> None:
    """(1, H) (6, 18): a point's twist from (ξ_a, ρ, β)."""
    for i in range(6):
        for j in range(6):
            out[i, j] = 0.0
        out[i, i] = 1.0
        for j in range(12):
            out[i, 6 + j] = H[i, j]


@compiled
def _split(k: Array, spring: Array, remainder: Array) -> None:
    """Add a stiffness (12, 12) on (ρ, β): its ρ block to ``spring`` (6, 6), the other blocks to ``remainder`` (18, 18)."""
    for i in range(12):
        for j in range(12):
            if i < 6 and j < 6:
                spring[i, j] += k[i, j]
            else:
                remainder[6 + i, 6 + j] += k[i, j]


@compiled
def _hold_components(to_point: Array, pose: Array, push: Array, follow: bool, g: Array, K: Array) -> None:
    """Apply ``inertia.hold_components``, in the axes and at the origin of the point ``pose``, to g and K at a."""
    from_point = np.empty((6, 6))
    rigid.adjoint(pose, from_point)
    here, more, work, at_a = np.empty(6), np.zeros((6, 6)), np.empty((6, 6)), np.empty((6, 6))
    transposed_apply(from_point, g, here)
    inertia.hold_components(here, push, follow, more)
    transposed_apply(to_point, here, g)
    congruence(to_point, more, work, at_a)
    for i in range(6):
        for j in range(6):
            K[i, j] += at_a[i, j]
