"""The lowest gyroscopic modes of a chain, by block Lanczos on the inverse problem of ``eigen``: one K-solve per step.

A⁻¹S is skew in the A product, A = diag(K, M), so in exact arithmetic the result of a step overlaps only with its own block
and the preceding one. Overlaps due to rounding are removed by repeated orthogonalisation against the whole basis. Blocks of two
vectors find the double frequencies of symmetric blades. (Lanczos 1950; Golub and Underwood 1977; Parlett, *The Symmetric
Eigenvalue Problem*, 1998, ch. 13.)
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from .. import eigen
from ..eigen import Eigen
from . import blocks, completeness, strained
from .blocks import Factor, Transposed
from .krylov import Operator, extend, forward
from .pencil import ChainPencil
from .strained import Strained

Array = NDArray[np.float64]

_VECTOR_TOLERANCE = 1e-9  # relative error of the vectors; that of the frequencies is its square
_SOLVE_TOLERANCE, _MAX_REFINEMENTS = 1e-8, 20  # relative error of a solution with K; refinement steps to reach it
_MAX_SOLVE_ERROR = 0.3  # error of a solution without refinement above which K is lost to rounding
_MAX_COUNT_ERROR = 1e-4  # error of a solution above which a wrong count or a negative pivot is due to rounding
_FIRST_LOOK, _LOOK_EVERY = 26, 12  # numbers of vectors between checks of convergence
_FIRST_LOOK_NEAR, _LOOK_EVERY_NEAR = 18, 4  # the same, starting from the modes of a similar pencil
_EXTRA_MODES = 4  # modes beyond those requested, to locate a gap


class EigensolverError(ArithmeticError):
    """The eigensolver failed: whether the blade is stable is not known."""


@dataclass(frozen=True)
class Start:
    """Start of the basis for a similar pencil.

    Attributes:
        vectors: (2, 2n) combinations of the lowest modes and a few more.
        size: number of vectors of the basis at which convergence is first checked.
    """

    vectors: Array
    size: int


@dataclass(frozen=True)
class Lowest(Eigen):
    """The lowest modes, and the start for a similar pencil."""

    start: Start


def lanczos(p: ChainPencil, count: int, near: Start | None = None) -> Lowest:
    """The ``count`` lowest modes of a chain about a state where K is symmetric.

    With ``near``, the ``start`` of a similar pencil, the basis is about a fifth smaller; but a mode that is orthogonal to all
    of that pencil's is not found, and ``completeness`` reports it as missing.

    With many elements the assembled K loses digits to cancellation; solutions are then refined iteratively with products
    from the element strains. The frequencies follow from the gyroscopic Rayleigh quotient of the vectors,
    ``κ + iω x*Cx − ω² x*Mx = 0``, whose error is the square of that of the vectors (Lancaster 2013).

    Raises:
        UnstableError: if K is not positive definite.
        EigensolverError: if the basis is full before the modes have converged, or K is lost to rounding.
        MissedModesError: if a mode is missing; see ``completeness``.
    """
    try:
        factor = p.factor
    except np.linalg.LinAlgError:
        raise eigen.unstable() from None
    n, exact = p.K.size, p.strained
    M, C, K = (blocks.transposed(t) for t in (p.M, p.C, p.K))
    w = _start(2 * n)
    lost = solve_error(factor, exact, M, w)
    if not lost < (_MAX_SOLVE_ERROR if factor.positive else _MAX_COUNT_ERROR):
        raise _lost_to_rounding(len(K.diagonal), lost)
    if not factor.positive:
        raise eigen.unstable()
    refinements = _refinements(lost)
    a = Operator(M, C, K, factor, exact, refinements)
    w = forward(a, w)[0] if near is None else near.vectors.copy()  # smooth
    limit = min(2 * n, max(200, 8 * count))
    basis, projected = np.empty((limit + 2, 2 * n)), np.zeros((limit + 2, limit + 2))
    size, before = 0, 0
    look, every = (3 * count + _FIRST_LOOK, _LOOK_EVERY) if near is None else (near.size, _LOOK_EVERY_NEAR)
    while True:
        w, gram, size, before, exhausted = extend(a, w, basis, projected, size, before, look)
        if not size:
            raise EigensolverError("implausible stiffness-to-mass ratio: check the units of both")
        look = size + every
        wanted, more = min(count, size // 2), min(count + _EXTRA_MODES, size // 2)
        mu, z = eigh(_hermitian(projected[:size, :size]), subset_by_index=[size - more, size - 1], check_finite=False)
        every_z, beyond, mu, z = z, mu[: more - wanted], mu[more - wanted :], z[:, more - wanted :]
        last = z[before:]
        error = np.sqrt(np.maximum(np.diagonal(gram), 0.0) @ (last.real**2 + last.imag**2)) / np.abs(mu)
        if exhausted or (error < _VECTOR_TOLERANCE).all():
            break
    positive = mu > 1e-12 * mu.max(initial=0.0)
    if not positive.any() or not np.isfinite(mu).all():
        raise EigensolverError("Lanczos found no mode: the stiffness is nearly singular; check units")
    if error[positive].max() > 1e-6:
        raise EigensolverError(f"Lanczos did not find {count} modes in a basis of {size}: request fewer modes")
    z = z[:, positive].T
    x = np.stack([z.real, -z.imag], axis=1).reshape(-1, size) @ basis[:size, :n]  # i A⁻¹S has 1/ω at λ = −iω
    x = x.reshape(len(z), 2, n)
    frequencies, kappa = _quotients(M, C, exact, x)
    if not (np.abs(frequencies * mu[positive] - 1.0) < 1e-2).all():
        raise EigensolverError("Lanczos failed: eigenvalues and Rayleigh quotients disagree; request fewer modes")
    order = np.argsort(frequencies)
    try:
        completeness.check(p, frequencies[order], 1.0 / beyond[beyond > 1e-12 * mu.max()], lost)
    except completeness.MissedModesError as error:
        if lost > _MAX_COUNT_ERROR:  # the count uses the assembled K, which is rounded
            raise _lost_to_rounding(len(K.diagonal), lost) from error
        raise
    x = x[order] / np.sqrt(np.maximum(kappa[order], 1e-300))[:, None, None]
    start = Start(
        (_phases(every_z.shape[1]) @ every_z.T).real @ basis[:size],
        3 * count + _FIRST_LOOK_NEAR if near is None else size,
    )
    return Lowest(frequencies[order], np.ascontiguousarray(x.transpose(2, 0, 1)).view(np.complex128)[..., 0], start)


def _lost_to_rounding(elements: int, error: float) -> EigensolverError:
    return EigensolverError(
        f"the stiffness of {elements} elements is lost to rounding (relative error of a solution {error:.1e}): use "
        "fewer elements, or check units"
    )


def frequencies_of(p: ChainPencil, vectors: NDArray[np.complex128]) -> Array:
    """(m,) frequencies by the gyroscopic Rayleigh quotient of vectors (n, m)."""
    x = np.ascontiguousarray(np.stack([vectors.real.T, vectors.imag.T], axis=1))
    return _quotients(blocks.transposed(p.M), blocks.transposed(p.C), p.strained, x)[0]


def _quotients(M: Transposed, C: Transposed, K: Strained, x: Array) -> tuple[Array, Array]:
    """Frequencies (m,) by the gyroscopic Rayleigh quotient, and κ = x*Kx, of x (m, 2, n) by real and imaginary parts."""
    rows = x.reshape(-1, x.shape[2])
    Kx, Cx, Mx = np.empty_like(x), np.empty_like(x), np.empty_like(x)
    strained.times(K, rows, Kx.reshape(rows.shape))
    blocks.times(C, rows, Cx.reshape(rows.shape))
    blocks.times(M, rows, Mx.reshape(rows.shape))
    kappa, inertia = np.einsum("mpi,mpi->m", x, Kx), np.einsum("mpi,mpi->m", x, Mx)
    half = 0.5 * (np.einsum("mi,mi->m", x[:, 1], Cx[:, 0]) - np.einsum("mi,mi->m", x[:, 0], Cx[:, 1]))  # ½ i x*Cx
    return kappa / (np.sqrt(np.maximum(half**2 + inertia * kappa, 0.0)) - half), kappa  # κ of a free joint is rounding


def solve_error(factor: Factor, exact: Strained, M: Transposed, v: Array) -> float:
    """Relative error of the solution x = K⁻¹ M v in the energy norm, for the first row of v (k, 2n)."""
    force, back = np.empty((2, 1, v.shape[1] // 2))
    blocks.times(M, v[:1], force)
    x = force.copy()
    blocks.solve(factor, x)
    strained.times(exact, x, back)
    left = force - back
    more = left.copy()
    blocks.solve(factor, more)
    return float(np.sqrt(abs((left * more).sum() / (force * x).sum())))


def _hermitian(projected: Array) -> NDArray[np.complex128]:
    """i times the skew matrix with the upper triangle of ``projected``."""
    upper, out = np.triu(projected, 1), np.zeros(projected.shape, np.complex128)
    out.imag = upper - upper.T
    return out


@lru_cache(maxsize=4)
def _start(size: int) -> Array:
    """Two random start vectors (2, size), the same in every run."""
    return np.random.default_rng(1921).normal(size=(2, size))


@lru_cache(maxsize=16)
def _phases(modes: int) -> NDArray[np.complex128]:
    """Random coefficients (2, modes) of modes in start vectors, the same in every run."""
    rng = np.random.default_rng(1950)
    return rng.normal(size=(2, modes)) + 1j * rng.normal(size=(2, modes))


def _refinements(solve_error: float) -> int:
    """Number of refinement steps that reduce the error of a solution to the tolerance."""
    for steps in range(_MAX_REFINEMENTS):
        if solve_error ** (steps + 1) < _SOLVE_TOLERANCE:
            return steps
    return _MAX_REFINEMENTS
