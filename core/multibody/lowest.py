"""The lowest gyroscopic modes of dense matrices: block Lanczos on the inverse problem of ``eigen``, then a count.

A⁻¹S is skew in the A product, A = diag(K, M). With K = L Lᵀ and u = Lᵀ x, for which that product is Euclidean, a step takes
four matrix products. Blocks of two vectors find the double frequencies of symmetric blades. A count proves that no mode is
missing: H(ω) = K + iωC − ω²M has as many negative eigenvalues as there are frequencies below ω (Sylvester's law of inertia).
If the count differs or the basis becomes long, the dense solver of ``eigen`` is used.
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
_FIRST_LOOK, _LOOK_EVERY = 26, 8  # vectors beyond three per mode at the first check of convergence; between checks
_LONGEST = 0.25  # longest basis, as a fraction of all vectors: beyond, the dense solver takes no longer
_VECTOR_TOLERANCE = 1e-8  # relative error of the vectors; that of the frequencies is its square
_NEIGHBOUR_TOLERANCE = 1e-3  # relative error of the vectors beyond those requested
_PANEL = 64  # rows of LAPACK's blocks


@dataclass(frozen=True)
class Definite:
    """M, C, K (n, n) with coordinates scaled by ``scale`` (n,), and L⁻¹ (n, n) of K = L Lᵀ."""

    M: Array
    C: Array
    K: Array
    scale: Array
    inverse: Array

    def solve(self, force: Array) -> Array:
        """K⁻¹ f (n,) in the units of the coordinates before scaling."""
        return self.scale * (self.inverse.T @ (self.inverse @ (self.scale * force)))


def definite(M: Array, C: Array, K: Array) -> Definite:
    """Scale and factor; C skew, M and K symmetric.

    Raises:
        UnstableError: if K is not positive definite.
        EigenError: if an entry is not finite.
    """
    scale = eigen.scaling(M, C, K)
    M, C, K = (scale[:, None] * a * scale for a in (M, C, K))
    root, info = _LAPACK.dpotrf(K, lower=1)
    if info:
        raise eigen.unstable()
    return Definite(M, C, K, scale, _LAPACK.dtrtri(root, lower=1)[0])


def lowest(p: Definite, count: int) -> Eigen:
    """The ``count`` lowest modes; fewer if there are fewer.

    Raises:
        EigenError: if LAPACK does not converge.
    """
    found = _lanczos(p, count)
    if found is None:
        found = eigen.gyroscopic(p.M, p.C, p.K, count)
    return Eigen(found.frequencies, p.scale[:, None] * found.vectors)


def _lanczos(p: Definite, count: int) -> Eigen | None:
    n = len(p.K)
    more = count + _EXTRA
    limit, look = int(2 * n * _LONGEST), 3 * more + _FIRST_LOOK
    w, Mw = _step(p, *np.random.default_rng(1921).normal(size=(2, n, 2)))  # smooth
    basis, dual = np.empty((limit + 2, 2 * n)), np.empty((limit + 2, 2 * n))
    projected, size = np.zeros((limit + 2, limit + 2)), 0
    while size < limit:
        for _ in range(2 if size else 0):  # orthogonalised twice; the second time for rounding
            overlap = dual[:size] @ w
            projected[:size, size - 2 : size] += overlap
            w -= basis[:size].T @ overlap
            Mw -= dual[:size, n:].T @ overlap
        gram = w[:n].T @ w[:n] + w[n:].T @ Mw
        if size >= look:
            upper = np.triu(projected[:size, :size])  # of a skew matrix; only its upper half is used
            mu, z = scipy.linalg.eigh(1j * (upper - upper.T), subset_by_index=[size - more, size - 1])
            last = z[-2:]
            error = np.sqrt(np.abs(np.einsum("im,ij,jm->m", last.conj(), gram, last))) / np.abs(mu)
            if (error < np.repeat([_NEIGHBOUR_TOLERANCE, _VECTOR_TOLERANCE], [_EXTRA, count])).all():
                return _proved(p, basis[:size, :n].T @ z[:, ::-1].conj(), count)
            look = size + _LOOK_EVERY
        value, axes = np.linalg.eigh(0.5 * (gram + gram.T))
        if not value[0] > 1e-20 * value[1] > 0.0:  # fewer vectors than two, or none, are left
            return None
        turn = axes / np.sqrt(value)
        basis[size : size + 2] = (w @ turn).T
        dual[size : size + 2, :n], dual[size : size + 2, n:] = basis[size : size + 2, :n], (Mw @ turn).T
        w, Mw = _step(p, basis[size : size + 2, :n].T, dual[size : size + 2, n:].T)
        size += 2
    return None


def _step(p: Definite, u: Array, My: Array) -> tuple[Array, Array]:
    """A⁻¹S of (u, y) (2n, 2), and M times its second half."""
    x = p.inverse.T @ u
    here = p.inverse @ (p.C @ x + My)
    return np.concatenate([here, -x]), -(p.M @ x)


def _proved(p: Definite, u: Complex, count: int) -> Eigen | None:
    """The lowest ``count`` modes from vectors u (n, m); None if their number is not that of the negative eigenvalues of H.

    The frequencies are the gyroscopic Rayleigh quotients ``κ + iω x*Cx − ω² x*Mx = 0`` (Lancaster 2013).
    """
    x = p.inverse.T @ u
    kappa, inertia, half = (np.einsum("im,im->m", x.conj(), y) for y in (p.K @ x, p.M @ x, 0.5j * (p.C @ x)))
    kappa, inertia, half = kappa.real, inertia.real, half.real
    f = kappa / (np.sqrt(half**2 + inertia * kappa) - half)
    if not (np.isfinite(f).all() and (f > 0).all()):
        return None
    order = np.argsort(f)
    f, x = f[order], x[:, order] / np.sqrt(kappa[order])
    gap = count - 1 + int(np.argmax(f[count:] / f[count - 1 : -1]))
    omega = float(np.sqrt(f[gap] * f[gap + 1]))
    if _negative(p.K + (1j * omega) * p.C - omega**2 * p.M) != gap + 1:
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
