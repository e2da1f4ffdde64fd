"""Gyroscopic eigenproblems K x + λ C x + λ² M x = 0, with K positive definite, M positive semi-definite, C skew.

Both solvers work on the inverse: with y = λ x, A = diag(K, M) and S = [[C, M], [−M, 0]], the operator A⁻¹S has eigenvalues
−1/λ, the lowest modes largest. S is skew in the plain product, A⁻¹S in A's, so the eigenvalues lie on the imaginary axis to
rounding, and M is never inverted: massless coordinates are condensed exactly, without a fudge.
(Meirovitch 1974; Lancaster 2013, *Stability of linear gyroscopic systems*.)
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from . import blocks
from .blocks import Tridiagonal

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

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
    try:
        k = np.linalg.cholesky(K)
    except np.linalg.LinAlgError:
        raise _unstable() from None
    values, vectors = np.linalg.eigh(M)
    keep = values > 1e-14 * max(values[-1], 0.0)
    f = scipy.linalg.solve_triangular(k, vectors[:, keep] * np.sqrt(values[keep]), lower=True)
    g = scipy.linalg.solve_triangular(k, scipy.linalg.solve_triangular(k, C, lower=True).T, lower=True).T
    n, r = f.shape
    h = np.zeros((n + r, n + r), complex)  # i A⁻¹S in the basis (k⁻ᵀ x, Fᵀ y) with M = F Fᵀ
    h[:n, :n], h[:n, n:], h[n:, :n] = 1j * g, 1j * f, -1j * f.T
    wanted = r if count is None else min(count, r)
    mu, z = scipy.linalg.eigh(h, subset_by_index=[n + r - wanted, n + r - 1])
    order = np.argsort(-mu)
    x = scipy.linalg.solve_triangular(k.T, z[:n, order], lower=False)
    return _scaled(1.0 / mu[order], x, K)


def lanczos(M: Tridiagonal, C: Tridiagonal, K: Tridiagonal, count: int) -> Eigen:
    """The ``count`` lowest modes of a chain: block Lanczos in the A product, one K-solve a step.

    Blocks of two find the double frequencies of symmetric blades; each basis vector is orthogonalised against all before.

    Raises:
        UnstableError: if K is not positive definite.
    """
    n = K.size
    try:
        factor = blocks.cholesky(K)
    except np.linalg.LinAlgError:
        raise _unstable() from None
    ms, cs, ks = blocks.sparse(M), blocks.sparse(C), blocks.sparse(K)

    def product(v: Array) -> Array:  # A v
        return np.concatenate([ks @ v[:n], ms @ v[n:]])

    def apply(v: Array) -> Array:  # A⁻¹S v
        return np.concatenate([factor.solve(cs @ v[:n] + ms @ v[n:]), -v[:n]])

    rank = n + int((np.abs(blocks.dense(M)).sum(0) > 0).sum()) if n < 200 else 2 * n
    limit = min(rank, max(200, 8 * count))
    v = apply(np.random.default_rng(1921).normal(size=(2 * n, 2)))
    basis, dual = np.zeros((2 * n, limit + 2)), np.zeros((2 * n, limit + 2))
    projected = np.zeros((limit + 2, limit + 2))
    size = 0
    while True:
        v, kept = _orthonormal(v, product, basis[:, :size], dual[:, :size])
        new = slice(size, size + kept)
        basis[:, new], dual[:, new] = v, product(v)
        size += kept
        w = apply(v)
        projected[:size, new] = dual[:, :size].T @ w
        t = projected[:size, :size]
        done = kept == 0 or size + 2 > limit
        if done or (size >= 2 * count + 4 and size % 8 < 2):
            mu, z = np.linalg.eigh(1j * _skew(t))
            order = np.argsort(-mu)[: min(count, size // 2)]
            mu, z = mu[order], z[:, order]
            rest = w - basis[:, :size] @ (dual[:, :size].T @ w)
            error = (
                np.linalg.norm(_norms(rest, product)[:, None] * np.abs(z[new]), axis=0) if kept else np.zeros(len(mu))
            )
            if done or (error < _TOLERANCE * np.abs(mu)).all():
                break
        v = w
    positive = mu > 1e-12 * mu.max()
    x = basis[:n, :size] @ z[:, positive]
    return _scaled(1.0 / mu[positive], x, ks)


def _skew(t: Array) -> Array:
    """The projection of a skew operator is skew; only its upper half was filled."""
    upper = np.triu(t, 1)
    return upper - upper.T


def _norms(v: Array, product) -> Array:  # noqa: ANN001
    return np.sqrt(np.maximum((v * product(v)).sum(0), 0.0))


def _orthonormal(v: Array, product, basis: Array, dual: Array) -> tuple[Array, int]:  # noqa: ANN001
    """Make the columns orthonormal in the A product, to the basis and to each other; drop those that vanish."""
    before = _norms(v, product)
    for _ in range(2):
        v = v - basis @ (dual.T @ v)
    gram = v.T @ product(v)
    value, turn = np.linalg.eigh(0.5 * (gram + gram.T))
    keep = value > 1e-20 * max(before.max() ** 2, 1e-300)
    v = v @ (turn[:, keep] / np.sqrt(value[keep]))
    v = v - basis @ (dual.T @ v)
    gram = v.T @ product(v)
    return v @ np.linalg.inv(np.linalg.cholesky(0.5 * (gram + gram.T))).T if keep.any() else v, int(keep.sum())


def _scaled(frequencies: Array, x: Complex, K) -> Eigen:  # noqa: ANN001
    energy = np.sqrt(np.maximum(np.real((x.conj() * (K @ x)).sum(0)), 1e-300))
    order = np.argsort(frequencies)
    return Eigen(frequencies[order], (x / energy)[:, order])


def _unstable() -> UnstableError:
    return UnstableError(
        "the stiffness about the steady state is not positive definite: at this speed the centrifugal force outgrows the "
        "stiffness; lower the speed, or check the stiffness and its units"
    )
