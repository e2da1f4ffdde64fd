"""Gyroscopic eigenproblems K x + λ C x + λ² M x = 0, with K positive definite, M positive semi-definite, C skew.

The dense solver here and ``lanczos`` work on the inverse: with y = λ x, A = diag(K, M) and S = [[C, M], [−M, 0]], the
operator A⁻¹S has eigenvalues −1/λ, the largest for the lowest modes. S is skew, and A⁻¹S is skew in the A product, so the
eigenvalues lie on the imaginary axis to rounding. M is never inverted: massless coordinates are condensed exactly.
(Meirovitch 1974; Lancaster 2013, *Stability of linear gyroscopic systems*.)
"""

from dataclasses import dataclass
from typing import cast

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..rank import TOLERANCE

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


MASSLESS = 1e-14
"""A motion whose mass is below this fraction of the largest, in scaled coordinates, counts as massless."""


class UnstableError(ValueError):
    """The stiffness about the steady state is not positive definite: the steady state is unstable."""


class EigenError(RuntimeError):
    """The eigenvalue solver failed: stability and frequencies are unknown."""


@dataclass(frozen=True)
class Eigen:
    """Frequencies (m,) rad/s ascending, and vectors (n, m) x with x e^{iωt}, scaled to x*Kx = 1."""

    frequencies: Array
    vectors: Complex


def gyroscopic(M: Array, C: Array, K: Array, count: int | None = None) -> Eigen:
    """All (or the ``count`` lowest) modes of dense matrices (n, n); massless coordinates give no modes.

    Raises:
        UnstableError: if K is not positive definite.
        EigenError: if LAPACK does not converge, or an entry is not finite.
    """
    scale = scaling(M, C, K)
    M, C, K = (scale[:, None] * a * scale for a in (M, C, K))
    check_finite(M, C, K)
    try:
        root = np.linalg.cholesky(K)
    except np.linalg.LinAlgError:
        raise unstable() from None
    values, vectors = np.linalg.eigh(M)
    with_mass = values > MASSLESS * max(values[-1], 0.0)
    f = scipy.linalg.solve_triangular(root, vectors[:, with_mass] * np.sqrt(values[with_mass]), lower=True)
    g = scipy.linalg.solve_triangular(root, scipy.linalg.solve_triangular(root, C, lower=True).T, lower=True).T
    n, r = f.shape
    h = np.zeros((n + r, n + r), complex)  # i A⁻¹S in the basis (k⁻ᵀ x, Fᵀ y) with M = F Fᵀ
    h[:n, :n], h[:n, n:], h[n:, :n] = 1j * g, 1j * f, -1j * f.T
    requested = r if count is None else min(count, r)
    if not requested:
        return Eigen(np.zeros(0), np.zeros((n, 0), np.complex128))
    try:
        mu, z = scipy.linalg.eigh(h, subset_by_index=[n + r - requested, n + r - 1])
    except np.linalg.LinAlgError as error:
        raise _failed(error) from error
    order = np.argsort(-mu)
    x = scipy.linalg.solve_triangular(root.T, z[:n, order].conj(), lower=False)  # i A⁻¹S has 1/ω at λ = −iω
    energy = np.sqrt(np.maximum(np.real((x.conj() * (K @ x)).sum(0)), 1e-300))
    return Eigen(1.0 / mu[order], scale[:, None] * x / energy)


def scaling(M: Array, C: Array, K: Array) -> Array:
    """Scale factors (n,) that give every coordinate, whatever its unit, a stiffness of one.

    Raises:
        UnstableError: if a coordinate has no stiffness, apart from rounding.
        EigenError: if an entry is not finite.
    """
    check_finite(M, C, K)
    k = np.diagonal(K)
    check_stiffness(k, np.diagonal(M))
    return 1.0 / np.sqrt(k)


def check_stiffness(k: Array, m: Array) -> None:
    """Check that coordinates with stiffness k and mass m (n,), the diagonals of K and M, have a stiffness.

    Raises:
        UnstableError: if one has none, apart from rounding.
    """
    usual = np.median(k[m > 0] / m[m > 0]) if (m > 0).any() else 1.0
    if (k <= 1e-14 * usual * m).any():
        raise unstable()


@dataclass(frozen=True)
class Damped:
    """Eigenvalues (m,), 1/s, by modulus: one of each conjugate pair, and real ones; and vectors (n, m)."""

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


def damped(M: Array, C: Array, K: Array, count: int | None = None, rigid: tuple[Array, Array] | None = None) -> Damped:
    """Modes of general M, C, K by the QZ algorithm on the scaled companion pencil; massless coordinates give none.

    A massless motion x, M x = 0, has no velocity unknown in the pencil. With one, its infinite eigenvalue would be double,
    and rounding would split it into two huge finite ones; a simple one is found as infinite. With a damper, the motion has
    one real mode.

    A rigid motion x, K x = 0, has a double eigenvalue 0 that rounding splits into a pair of opposite sign. With Wᵀ K = 0 all
    other modes satisfy ``Wᵀ (C + λ M) x = 0``; these equations replace those along W. Each rigid motion is then one mode
    with λ = 0.

    Args:
        M: (n, n) mass.
        C: (n, n) gyroscopic and damping matrix.
        K: (n, n) stiffness.
        count: number of modes, from the lowest; all by default.
        rigid: bases (n, d) of the null space of K, and of its left null space W.

    Raises:
        EigenError: if LAPACK does not converge, or an entry is not finite.
    """
    check_finite(M, C, K)
    n = len(M)
    Z, W = rigid or (np.zeros((n, 0)), np.zeros((n, 0)))
    k, m = np.abs(np.diagonal(K)), np.diagonal(M)
    usable = (k > 0) & (m > 0)
    time = 1.0 / np.sqrt(np.median(k[usable] / m[usable])) if usable.any() else 1.0
    weight = k * time**2 + m
    unit = 1.0 / np.sqrt(np.where(weight > 0, weight, 1.0))  # scales coordinates of different units; time is scaled too
    M, C, K = (time**p * unit[:, None] * a * unit for p, a in ((0, M), (1, C), (2, K)))
    d = W.shape[1]
    w = np.linalg.qr(W / unit[:, None])[0].T
    rows = np.arange(n)
    if d:
        rows = cast(tuple[Array, NDArray[np.intp]], scipy.linalg.qr(w, mode="r", pivoting=True))[1][d:]
    massive, massless = _by_mass(M)
    r, s = massive.shape[1], massless.shape[1]  # x = massive p + massless q, and y = λ p; M x λ² = λ M massive y
    zeros, identity = np.zeros((d, n + r)), np.eye(r)
    # d equations along W replace d of the n; the others are unchanged, so that stiff and soft ones are not mixed
    a = np.block(
        [
            [np.zeros((r, n)), identity],
            [-w @ C @ massive, -w @ C @ massless, -w @ M @ massive],
            [-K[rows] @ massive, -K[rows] @ massless, -C[rows] @ massive],
        ]
    )
    b = np.block(
        [[identity, np.zeros((r, s + r))], [zeros], [np.zeros((n - d, r)), C[rows] @ massless, M[rows] @ massive]]
    )
    try:
        pair, z = cast(tuple[Complex, Complex], scipy.linalg.eig(a, b, homogeneous_eigvals=True))
    except np.linalg.LinAlgError as error:
        raise _failed(error) from error
    alpha, beta = pair
    finite = np.abs(beta) > 1e-12 * np.abs(alpha)
    finite[np.argsort(np.abs(beta) / np.maximum(np.abs(alpha), 1e-300))[:d]] = False  # b has d rows of zeros
    values, x = alpha[finite] / beta[finite], unit[:, None] * (massive @ z[:r, finite] + massless @ z[r:n, finite])
    order = np.argsort(np.abs(values), kind="stable")
    twice = int((np.abs(values[order[:d]]) < TOLERANCE).sum())  # second zeros of double eigenvalues
    values, x = values[order[twice:]] / time, x[:, order[twice:]]
    one_of_each = values.imag >= 0.0  # LAPACK's conjugates of a real pencil are exact
    values = np.concatenate([np.zeros(d, np.complex128), values[one_of_each]])[:count]
    return Damped(values, np.hstack([Z.astype(np.complex128), x[:, one_of_each]])[:, :count])


def _by_mass(M: Array) -> tuple[Array, Array]:
    """Bases (n, r) and (n, n − r) of the motions with and without mass; the unit matrix if all have mass."""
    values, vectors = np.linalg.eigh(M)
    massless = values <= MASSLESS * values[-1]
    return (vectors[:, ~massless], vectors[:, massless]) if massless.any() else (np.eye(len(M)), np.zeros((len(M), 0)))


def check_finite(*matrices: Array) -> None:
    """Raise ``EigenError`` if an entry is not finite."""
    if not all(np.isfinite(a).all() for a in matrices):
        raise EigenError(
            "eigenvalues: the matrices are not finite: an implausibly large mass, stiffness or speed; check units"
        )


def _failed(error: Exception) -> EigenError:
    return EigenError(f"eigenvalues: LAPACK did not converge ({error}): check the units for implausible magnitudes")


def unstable() -> UnstableError:
    """The error to raise if K is not positive definite."""
    return UnstableError(
        "the stiffness about the steady state is not positive definite: the state is unstable in this discretisation: use more "
        "elements, or check stiffness and loads"
    )
