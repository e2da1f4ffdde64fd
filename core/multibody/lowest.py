"""The lowest gyroscopic modes of dense matrices: block Lanczos on the inverse problem of ``eigen``, then a count.

A⁻¹S is skew in the A product, A = diag(K, M), so the basis is orthonormal in that product, and A times the basis is stored too.
A step takes one solution with K and two products; with eight vectors in a block these take hardly longer than with one, and
double frequencies are found.
The first block consists of random vectors, or of random combinations of modes of a similar problem. A count proves that no
mode is missing: H(ω) = K + iωC − ω²M has as many negative eigenvalues as there are frequencies below ω (Sylvester's law of
inertia). If the count differs or the basis becomes long, the dense solver of ``eigen`` is used.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.linalg import lapack

from .. import eigen
from ..eigen import Eigen

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

_LAPACK: Any = lapack

_EXTRA = 4  # modes beyond those requested, to locate a gap
_WIDTH = 8  # vectors in a block
_FIRST_LOOK, _LOOK_EVERY = 26, 8  # vectors beyond three per mode at the first check of convergence; between checks
_LONGEST = 0.25  # longest basis, as a fraction of all vectors: beyond, the dense solver takes no longer
_VECTOR_TOLERANCE = 1e-8  # relative error of the vectors; that of the frequencies is its square
_NEIGHBOUR_TOLERANCE = 1e-3  # relative error of the vectors beyond those requested
_PANEL = 64  # rows of LAPACK's blocks


@dataclass(frozen=True)
class Definite:
    """M, C, K (n, n) with coordinates scaled by ``scale`` (n,), and L of K = L Lᵀ, the lower half of ``root`` (n, n)."""

    M: Array
    C: Array
    K: Array
    scale: Array
    root: Array

    def solve(self, force: Array) -> Array:
        """K⁻¹ f for f (n,) or (n, k), in scaled coordinates."""
        return _LAPACK.dpotrs(self.root, force, lower=1)[0]

    def displacement(self, force: Array) -> Array:
        """K⁻¹ f (n,) in the units of the coordinates before scaling."""
        return self.scale * self.solve(self.scale * force)


def definite(M: Array, C: Array, K: Array) -> Definite:
    """Scale and factor the symmetric parts of M and K and the skew part of C.

    Raises:
        UnstableError: if K is not positive definite.
        EigenError: if an entry is not finite.
    """
    scale = eigen.scaling(M, C, K)
    half = np.outer(0.5 * scale, scale)
    M, C, K = M + M.T, C - C.T, K + K.T
    for a in (M, C, K):
        a *= half
    root, info = _LAPACK.dpotrf(K.T, lower=1, clean=0)  # the transpose has the order that LAPACK needs
    if info:
        raise eigen.unstable()
    return Definite(M, C, K, scale, root)


def lowest(p: Definite, count: int, near: Eigen | None = None) -> Eigen:
    """The ``count`` lowest modes (fewer if there are fewer); ``near``: modes of a similar problem, from which to start.

    Raises:
        EigenError: if LAPACK does not converge.
    """
    n, found = len(p.K), None
    if near and 2 * len(near.frequencies) >= _WIDTH:
        found = _lanczos(p, count, *_combined(p, near))
    if found is None:
        x, y = np.random.default_rng(1921).normal(size=(2, n, _WIDTH))
        found = _lanczos(p, count, *_step(p, x, p.M @ y))  # smooth
    if found is None:
        found = eigen.gyroscopic(p.M, p.C, p.K, count)
    return Eigen(found.frequencies, p.scale[:, None] * found.vectors)


def _combined(p: Definite, near: Eigen) -> tuple[Array, Array]:
    """Random combinations w (2n, w) of the motions of modes, and A w."""
    rng = np.random.default_rng(1950)
    weights = rng.normal(size=(len(near.frequencies), _WIDTH)) + 1j * rng.normal(size=(len(near.frequencies), _WIDTH))
    x = near.vectors / p.scale[:, None]
    x, y = ((v @ weights).real for v in (x, 1j * near.frequencies * x))
    return np.concatenate([x, y]), np.concatenate([p.K @ x, p.M @ y])


def _lanczos(p: Definite, count: int, w: Array, dual_w: Array) -> Eigen | None:
    """The lowest modes from a basis that starts with vectors w = (x, y) (2n, w), given with A w; None without success."""
    n = len(p.K)
    more = count + _EXTRA
    limit, look = int(2 * n * _LONGEST), 3 * more + _FIRST_LOOK
    basis, dual = np.empty((limit + _WIDTH, 2 * n)), np.empty((limit + _WIDTH, 2 * n))
    projected, size = np.zeros((limit + _WIDTH, limit + _WIDTH)), 0
    while size < limit:
        for _ in range(2 if size else 0):  # orthogonalised twice; the second time for rounding
            overlap = dual[:size] @ w
            projected[:size, size - _WIDTH : size] += overlap
            w -= basis[:size].T @ overlap
            dual_w -= dual[:size].T @ overlap
        gram = w.T @ dual_w
        gram = 0.5 * (gram + gram.T)
        if size >= look:
            upper = np.triu(projected[:size, :size])  # of a skew matrix; only its upper half is used
            mu, z = scipy.linalg.eigh(1j * (upper - upper.T), subset_by_index=[size - more, size - 1])
            last = z[-_WIDTH:]
            error = np.sqrt(np.abs(np.einsum("im,ij,jm->m", last.conj(), gram, last))) / np.abs(mu)
            if (error < np.repeat([_NEIGHBOUR_TOLERANCE, _VECTOR_TOLERANCE], [_EXTRA, count])).all():
                z = z[:, ::-1].conj()  # i A⁻¹S has 1/ω at λ = −iω
                return _proved(p, basis[:size, :n].T @ np.hstack([z.real, z.imag]), count)
            look = size + _LOOK_EVERY
        value, axes = np.linalg.eigh(gram)
        if not value[0] > 1e-20 * value[-1] > 0.0:  # fewer vectors than a block, or none, are left
            return None
        turn = axes / np.sqrt(value)
        new = slice(size, size + _WIDTH)
        basis[new], dual[new] = (w @ turn).T, (dual_w @ turn).T
        w, dual_w = _step(p, basis[new, :n].T, dual[new, n:].T)
        size += _WIDTH
    return None


def _step(p: Definite, x: Array, My: Array) -> tuple[Array, Array]:
    """A⁻¹S of vectors (x, y) (2n, w), and A times the result, from x and M y."""
    force = p.C @ x + My
    return np.concatenate([p.solve(force), -x]), np.concatenate([force, -(p.M @ x)])


def _proved(p: Definite, parts: Array, count: int) -> Eigen | None:
    """The lowest ``count`` modes from vectors x = a + ib, given as (a, b) (n, 2m).

    None if H has another number of negative eigenvalues. The frequencies are the gyroscopic Rayleigh quotients
    ``κ + iω x*Cx − ω² x*Mx = 0`` (Lancaster 2013).
    """
    m = parts.shape[1] // 2
    a, b = parts[:, :m], parts[:, m:]
    kappa, inertia = (np.einsum("im,im->m", parts, F @ parts).reshape(2, m).sum(0) for F in (p.K, p.M))
    half = -np.einsum("im,im->m", a, p.C @ b)  # ½ i x*Cx
    f = kappa / (np.sqrt(half**2 + inertia * kappa) - half)
    if not (np.isfinite(f).all() and (f > 0).all()):
        return None
    order = np.argsort(f)
    f, x = f[order], ((a + 1j * b) / np.sqrt(kappa))[:, order]
    gap = count - 1 + int(np.argmax(f[count:] / f[count - 1 : -1]))
    omega = float(np.sqrt(f[gap] * f[gap + 1]))
    H = np.empty(p.K.shape, complex)
    H.real, H.imag = p.K - omega**2 * p.M, omega * p.C
    if _negative(H) != gap + 1:
        return None
    return Eigen(f[:count], x[:, :count])


def _negative(H: Complex) -> int:
    """Number of negative eigenvalues of a Hermitian matrix, which is overwritten, from the pivots of its LDLᴴ factorisation.

    A pivot of two rows has one negative eigenvalue (Bunch and Kaufman 1977).
    """
    factors, pivots, info = _LAPACK.zhetrf(H.T, lwork=_PANEL * len(H), overwrite_a=True)
    if info < 0:
        raise eigen.EigenError(f"eigenvalues: LDLᴴ factorisation: argument {-info}")
    single = pivots > 0
    return int((np.real(np.diagonal(factors))[single] < 0.0).sum()) + int((~single).sum()) // 2
