"""Gyroscopic eigenproblems K x + λ C x + λ² M x = 0, with K positive definite, M positive semi-definite, C skew.

Both solvers work on the inverse: with y = λ x, A = diag(K, M) and S = [[C, M], [−M, 0]], the operator A⁻¹S has eigenvalues
−1/λ, the lowest modes largest. S is skew in the plain product, A⁻¹S in A's, so the eigenvalues lie on the imaginary axis to
rounding, and M is never inverted: massless coordinates are condensed exactly, without a fudge.
(Meirovitch 1974; Lancaster 2013, *Stability of linear gyroscopic systems*.)
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from . import blocks
from .blocks import Factor, Tridiagonal

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Numbers = NDArray[Any]

_TOLERANCE = 1e-13


class UnstableError(ValueError):
    """The steady state has no positive definite stiffness: it is not a stable one to vibrate about."""


@dataclass(frozen=True)
class Eigen:
    """Frequencies (m,) rad/s ascending, and vectors (n, m) x with x e^{iωt}, scaled to x*Kx = 1."""

    frequencies: Array
    vectors: Complex


def gyroscopic(M: Array, C: Array, K: Array, count: int | None = None) -> Eigen:
    """All (or the ``count`` lowest) modes of dense matrices; massless coordinates give no modes.

    Raises:
        UnstableError: if K is not positive definite.
    """
    k, m = np.diagonal(K), np.diagonal(M)
    usual = np.median(k[m > 0] / m[m > 0]) if (m > 0).any() else 1.0
    if (k <= 1e-14 * usual * m).any():  # a coordinate that nothing holds, but for rounding
        raise _unstable()
    scale = 1.0 / np.sqrt(np.diagonal(K))  # coordinates of unlike units made alike
    M, C, K = (scale[:, None] * a * scale for a in (M, C, K))
    try:
        root = np.linalg.cholesky(K)
    except np.linalg.LinAlgError:
        raise _unstable() from None
    values, vectors = np.linalg.eigh(M)
    keep = values > 1e-14 * max(values[-1], 0.0)
    f = scipy.linalg.solve_triangular(root, vectors[:, keep] * np.sqrt(values[keep]), lower=True)
    g = scipy.linalg.solve_triangular(root, scipy.linalg.solve_triangular(root, C, lower=True).T, lower=True).T
    n, r = f.shape
    h = np.zeros((n + r, n + r), complex)  # i A⁻¹S in the basis (k⁻ᵀ x, Fᵀ y) with M = F Fᵀ
    h[:n, :n], h[:n, n:], h[n:, :n] = 1j * g, 1j * f, -1j * f.T
    wanted = r if count is None else min(count, r)
    mu, z = scipy.linalg.eigh(h, subset_by_index=[n + r - wanted, n + r - 1])
    order = np.argsort(-mu)
    x = scipy.linalg.solve_triangular(root.T, z[:n, order].conj(), lower=False)  # i A⁻¹S has 1/ω at λ = −iω
    found = _scaled(1.0 / mu[order], x, K)
    return Eigen(found.frequencies, scale[:, None] * found.vectors)


def lanczos(
    M: Tridiagonal, C: Tridiagonal, K: Tridiagonal, count: int, energy: Callable[[Numbers], Array] | None = None
) -> Eigen:
    """The ``count`` lowest modes of a chain: block Lanczos in the A product, one K-solve a step.

    Blocks of two find the double frequencies of symmetric blades; each basis vector is orthogonalised against all before.
    With ``energy``, x*Kx to full accuracy, the frequencies are taken from the gyroscopic Rayleigh quotient of the vectors,
    ``κ + iω x*Cx − ω² x*Mx = 0``, whose error is the square of theirs.

    Raises:
        UnstableError: if K is not positive definite.
    """
    n = K.size
    try:
        factor = blocks.cholesky(K)
    except np.linalg.LinAlgError:
        raise _unstable() from None
    ms, cs, ks = blocks.sparse(M), blocks.sparse(C), blocks.sparse(K)
    limit = min(2 * n, max(200, 8 * count))
    basis, dual = np.zeros((2 * n, limit + 2)), np.zeros((2 * n, limit + 2))  # V and A V, VᵀAV = 1
    projected = np.zeros((limit + 2, limit + 2))
    start = np.random.default_rng(1921).normal(size=(2 * n, 2))
    v, av = _step(factor, cs, start, ms @ _side_by_side(start))
    size, look = 0, 2 * count + 16
    while True:
        v, av, kept = _orthonormal(v, av, basis[:, :size], dual[:, :size])
        new = slice(size, size + kept)
        mass = ms @ _side_by_side(v)
        basis[:, new], dual[:n, new], dual[n:, new] = v, ks @ v[:n], mass[:, kept:]  # afresh: a recurrence would drift
        size += kept
        w, aw = _step(factor, cs, v, mass)
        projected[:size, new] = basis[:, :size].T @ aw
        exhausted = kept == 0 or size + 2 > limit
        if exhausted or size >= look:
            look = size + 12
            mu, z = np.linalg.eigh(1j * _skew(projected[:size, :size]))
            order = np.argsort(-mu)[: min(count, size // 2)]
            mu, z = mu[order], z[:, order]
            rest = w - basis[:, :size] @ projected[:size, new]
            a_rest = aw - dual[:, :size] @ projected[:size, new]
            norms = np.sqrt(np.maximum((rest * a_rest).sum(0), 0.0))
            if exhausted or (np.linalg.norm(norms[:, None] * np.abs(z[new]), axis=0) < _TOLERANCE * np.abs(mu)).all():
                break
        v, av = w, aw
    positive = mu > 1e-12 * mu.max()
    x = basis[:n, :size] @ z[:, positive].conj()  # i A⁻¹S has 1/ω at λ = −iω
    frequencies = 1.0 / mu[positive]
    if energy is not None:
        m = np.real((x.conj() * (ms @ x)).sum(0))
        half = -0.5 * np.imag((x.conj() * (cs @ x)).sum(0))
        kappa = energy(x)
        root = np.sqrt(half**2 + m * kappa)
        frequencies = kappa / (root - half)
        if (np.abs(frequencies * mu[positive] - 1.0) > 1e-2).any():
            raise ArithmeticError(
                "Lanczos lost its basis: frequencies and Rayleigh quotients disagree; ask for fewer modes"
            )
    return _scaled(frequencies, x, ks)


@dataclass(frozen=True)
class Damped:
    """Eigenvalues (m,) of one of each conjugate pair (and real ones), by modulus, and vectors (n, m)."""

    values: Complex
    vectors: Complex

    @property
    def frequencies(self) -> Array:
        """Undamped frequencies |λ|, rad/s."""
        return np.abs(self.values)

    @property
    def damping(self) -> Array:
        """Damping ratios −Re λ/|λ|; negative: the mode grows. Zero for a rigid mode."""
        size = np.abs(self.values)
        return np.where(size > 0, -self.values.real / np.where(size > 0, size, 1.0), 0.0)


def damped(M: Array, C: Array, K: Array, count: int | None = None) -> Damped:
    """Modes of any M, C, K by the QZ algorithm on the companion pencil, scaled; massless coordinates give none."""
    n = len(M)
    k, m = np.abs(np.diagonal(K)), np.diagonal(M)
    both = (k > 0) & (m > 0)
    time = 1.0 / np.sqrt(np.median(k[both] / m[both])) if both.any() else 1.0
    weight = k * time**2 + m
    unit = 1.0 / np.sqrt(np.where(weight > 0, weight, 1.0))  # coordinates of unlike units made alike, and time too
    M, C, K = (time**p * unit[:, None] * a * unit for p, a in ((0, M), (1, C), (2, K)))
    zero, one = np.zeros((n, n)), np.eye(n)
    a = np.block([[zero, one], [-K, -C]])
    b = np.block([[one, zero], [zero, M]])
    pair, z = cast(tuple[Complex, Complex], scipy.linalg.eig(a, b, homogeneous_eigvals=True))
    alpha, beta = pair
    finite = np.abs(beta) > 1e-12 * np.abs(alpha)
    values, x = alpha[finite] / beta[finite] / time, unit[:, None] * z[:n, finite]
    largest = np.abs(values).max(initial=0.0)
    one_of_each = values.imag >= -1e-12 * largest
    values, x = values[one_of_each], x[:, one_of_each]
    order = np.argsort(np.abs(values), kind="stable")[:count]
    return Damped(values[order], x[:, order])


def _skew(t: Array) -> Array:
    """The projection of a skew operator is skew; only its upper half was filled."""
    upper = np.triu(t, 1)
    return upper - upper.T


def _side_by_side(v: Array) -> Array:
    """(n, 2k) from x over y (2n, k)."""
    n = len(v) // 2
    return np.hstack([v[:n], v[n:]])


def _step(factor: Factor, cs: Any, v: Array, mass: Array) -> tuple[Array, Array]:
    """w = A⁻¹S v and A w = S v; ``mass`` is M x beside M y."""
    n, k = len(v) // 2, v.shape[1]
    x = v[:n]
    force = cs @ x + mass[:, k:]
    return np.concatenate([factor.solve(force), -x]), np.concatenate([force, -mass[:, :k]])


def _orthonormal(v: Array, av: Array, basis: Array, dual: Array) -> tuple[Array, Array, int]:
    """Make the columns orthonormal in the A product, to the basis and to each other; drop those that vanish."""
    before = np.abs((v * av).sum(0)).max()
    for _ in range(2):
        overlap = basis.T @ av
        v, av = v - basis @ overlap, av - dual @ overlap
    gram = v.T @ av
    value, turn = np.linalg.eigh(0.5 * (gram + gram.T))
    keep = value > 1e-20 * max(before, 1e-300)
    scale = turn[:, keep] / np.sqrt(value[keep])
    return v @ scale, av @ scale, int(keep.sum())


def _scaled(frequencies: Array, x: Numbers, K: Any) -> Eigen:
    energy = np.sqrt(np.maximum(np.real((x.conj() * (K @ x)).sum(0)), 1e-300))
    order = np.argsort(frequencies)
    return Eigen(frequencies[order], (x / energy)[:, order])


def _unstable() -> UnstableError:
    return UnstableError(
        "the stiffness about the steady state is not positive definite: at this speed the centrifugal force outgrows the "
        "stiffness; lower the speed, or check the stiffness and its units"
    )
