"""The lowest gyroscopic modes of a rotating mechanism: block Lanczos on the inverse problem of ``eigen``, then a count.

A⁻¹S is skew in the A product, A = diag(K, M), so the basis is orthonormal in that product, and A times the basis is stored too.
A step takes one solution with K and two products; with eight vectors in a block these take hardly longer than with one, and
double frequencies are found. The first block consists of random vectors after a step, or of random combinations of modes of a
similar problem. A count proves that no mode is missing. If it differs or the basis becomes long, the dense solver of ``eigen``
is used.
"""

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from . import eigen
from .eigen import Eigen
from .rotating import Rotating

Array = NDArray[np.float64]

_EXTRA = 4  # modes beyond those requested, to locate a gap
_WIDTH = 8  # vectors in a block
_FIRST_LOOK, _LOOK_EVERY = 26, 8  # vectors beyond three per mode at the first check of convergence; between checks
_LONGEST = 0.25  # longest basis, as a fraction of all vectors: beyond, the dense solver takes no longer
_VECTOR_TOLERANCE = 1e-8  # relative error of the vectors; that of the frequencies is its square
_NEIGHBOUR_TOLERANCE = 1e-3  # relative error of the vectors beyond those requested


def lowest(p: Rotating, count: int, near: Eigen | None = None) -> Eigen:
    """The ``count`` lowest modes (fewer if there are fewer); ``near``: modes of a similar problem, from which to start.

    Raises:
        EigenError: if LAPACK does not converge.
    """
    found = None
    if near and 2 * len(near.frequencies) >= _WIDTH:
        found = _lanczos(p, count, *_combined(p, near))
    if found is None:
        x, y = p.scale[:, None] * np.random.default_rng(1921).normal(size=(2, len(p), _WIDTH))
        found = _lanczos(p, count, *_step(p, x, p.inertia(y)))  # smooth
    if found is None:
        every = np.eye(len(p))
        (M, C), K = p.inertia_and_coriolis(every), p.stiffness(every)
        found = eigen.gyroscopic(0.5 * (M + M.T), 0.5 * (C - C.T), 0.5 * (K + K.T), count)
    return found


def _combined(p: Rotating, near: Eigen) -> tuple[Array, Array]:
    """Random combinations w = (x, y) (2n, w) of the motions of modes, and A w."""
    rng, f = np.random.default_rng(1950), near.frequencies
    weights = rng.normal(size=(len(f), _WIDTH)) + 1j * rng.normal(size=(len(f), _WIDTH))
    x, y = ((v @ weights).real for v in (near.vectors, 1j * f * near.vectors))
    return np.concatenate([x, y]), np.concatenate([p.stiffness(x), p.inertia(y)])


def _lanczos(p: Rotating, count: int, w: Array, dual_w: Array) -> Eigen | None:
    """The lowest modes from a basis that starts with vectors w = (x, y) (2n, w), given with A w; None without success."""
    n = len(p)
    more = count + _EXTRA
    limit, look = int(2 * n * _LONGEST), 3 * more + _FIRST_LOOK
    basis, dual = np.empty((limit + _WIDTH, 2 * n)), np.empty((limit + _WIDTH, 2 * n))
    projected, size = np.zeros((limit + _WIDTH, limit + _WIDTH)), 0
    while size < limit:
        if size:
            overlap, near = np.zeros((size, _WIDTH)), slice(max(size - 2 * _WIDTH, 0), size)
            overlap[near] = dual[near] @ w  # with the others there is none, but for rounding
            w -= basis[near].T @ overlap[near]
            again = dual[:size] @ w  # what rounding leaves
            w -= basis[:size].T @ again
            overlap += again
            dual_w -= dual[:size].T @ overlap
            projected[:size, size - _WIDTH : size] += overlap
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


def _step(p: Rotating, x: Array, My: Array) -> tuple[Array, Array]:
    """A⁻¹S of vectors (x, y) (2n, w), and A times the result, from x and M y."""
    Mx, Cx = p.inertia_and_coriolis(x)
    force = Cx + My
    return np.concatenate([p.solve(force), -x]), np.concatenate([force, -Mx])


def _proved(p: Rotating, parts: Array, count: int) -> Eigen | None:
    """The lowest ``count`` modes from vectors x = a + ib, given as (a, b) (n, 2m).

    None if the count of frequencies differs. The frequencies are the gyroscopic Rayleigh quotients
    ``κ + iω x*Cx − ω² x*Mx = 0`` (Lancaster 2013).
    """
    m = parts.shape[1] // 2
    a, b = parts[:, :m], parts[:, m:]
    (M, C), K = p.inertia_and_coriolis(parts), p.stiffness(parts)
    kappa, inertia = (np.einsum("im,im->m", parts, part).reshape(2, m).sum(0) for part in (K, M))
    half = -np.einsum("im,im->m", a, C[:, m:])  # ½ i x*Cx
    f = kappa / (np.sqrt(half**2 + inertia * kappa) - half)
    if not (np.isfinite(f).all() and (f > 0).all()):
        return None
    order = np.argsort(f)
    f, x = f[order], ((a + 1j * b) / np.sqrt(kappa))[:, order]
    gap = count - 1 + int(np.argmax(f[count:] / f[count - 1 : -1]))
    if p.below(float(np.sqrt(f[gap] * f[gap + 1]))) != gap + 1:
        return None
    return Eigen(f[:count], x[:, :count])
