"""The lowest gyroscopic modes of a mesh, by block Lanczos on the inverse problem of ``eigen``: one K-solve per step.

A⁻¹S is skew in the A product, A = diag(K, M), so in exact arithmetic the result of a step overlaps only with its own block
and the preceding one. Overlaps due to rounding are removed by repeated orthogonalisation against the whole basis. Blocks of
two vectors find the double frequencies of symmetric blades, wider ones the multiple frequencies of equal branches. (Lanczos
1950; Golub and Underwood 1977; Parlett, *The Symmetric Eigenvalue Problem*, 1998, ch. 13.)
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.linalg import eigh
from numpy.typing import NDArray

from ..compiled import kernels
from ..tree.elimination import solve
from ..tree.links import allowed, product
from ..tree.pencil import TreePencil
from . import completeness, eigen
from .eigen import Eigen

Array = NDArray[np.float64]

_VECTOR_TOLERANCE = 1e-9  # relative error of the vectors; that of the frequencies is its square
_MAX_SOLVE_ERROR = (
    1e-4  # relative error of a solution with K above which K is dominated by rounding error; usual are 1e-12
)
_FIRST_LOOK, _LOOK_EVERY = 13, 12  # numbers of vectors, for each of a block, before the first check; between checks
_FIRST_LOOK_WARM, _LOOK_EVERY_WARM = 14, 2  # the same, starting from the modes of a similar pencil
_CLUSTER = 0.02  # relative width of a cluster of modes that do not converge
_EXTRA_MODES = 4  # modes beyond those requested, to locate a gap
MAX_WIDTH = 8
"""Largest number of vectors in a block; see ``krylov.hpp``."""


class EigensolverError(ArithmeticError):
    """The eigensolver failed: whether the blade is stable is not known."""


@dataclass(frozen=True)
class Start:
    """Start of the basis for a similar pencil.

    Attributes:
        vectors: (w, 2n) combinations of the lowest modes, the width of a block.
        size: number of vectors of the basis at which convergence is first checked.
    """

    vectors: Array
    size: int


@dataclass(frozen=True)
class Lowest(Eigen):
    """The lowest modes, and the start for a similar pencil."""

    start: Start


def lanczos(p: TreePencil, count: int, warm_start: Start | None = None) -> Lowest:
    """The ``count`` lowest modes of a tree about a state where K is symmetric.

    With ``warm_start``, the ``start`` of a similar pencil, the basis is about a fifth smaller; but a mode that is orthogonal to
    all of that pencil's is not found, and ``completeness`` reports it as missing.

    The frequencies follow from the gyroscopic Rayleigh quotient of the vectors, ``κ + iω x*Cx − ω² x*Mx = 0``, whose error is
    the square of that of the vectors (Lancaster 2013).

    Raises:
        UnstableError: if K is not positive definite.
        EigensolverError: if the basis is full before the modes have converged, or K is dominated by rounding error.
        MissedModesError: if a mode is missing; see ``completeness``.
    """
    width = len(warm_start.vectors) if warm_start else _width(p)
    while True:
        try:
            return _lowest(p, count, warm_start, width)
        except completeness.MissedModesError:  # of a frequency with more modes than a block has vectors
            if warm_start or width >= MAX_WIDTH:
                raise
            width = min(2 * width, MAX_WIDTH)


def _lowest(p: TreePencil, count: int, warm_start: Start | None, width: int) -> Lowest:
    """``lanczos`` with this number of vectors in a block."""
    a = _operator(p)
    w = _start_vectors(p, a, warm_start, width)
    ritz = _converged(a, w, count, warm_start.size if warm_start else None)
    z = ritz.vectors.T
    x = np.stack([z.real, -z.imag], axis=1).reshape(2 * len(z), -1) @ ritz.basis[:, : w.shape[1] // 2]
    x = x.reshape(len(z), 2, -1)  # conjugate: i A⁻¹S has 1/ω at λ = −iω
    frequencies, kappa = _quotients(p, x)
    if not (np.abs(frequencies * ritz.values - 1.0) < 1e-2).all():
        raise EigensolverError("Lanczos failed: eigenvalues and Rayleigh quotients disagree; request fewer modes")
    order = np.argsort(frequencies)
    completeness.check_complete(p, frequencies[order], 1.0 / ritz.next_values)
    x = x[order] / np.sqrt(np.maximum(kappa[order], 1e-300))[:, None, None]
    combined = (_phases(len(w), len(z)) @ z).real @ ritz.basis
    start = Start(combined, len(ritz.basis) if warm_start else 3 * count + _FIRST_LOOK_WARM)
    return Lowest(frequencies[order], (x[:, 0] + 1j * x[:, 1]).T, start)


def _operator(p: TreePencil) -> kernels.Operator:
    try:
        factor = p.factor
    except np.linalg.LinAlgError:
        raise eigen.unstable() from None
    return kernels.Operator(
        p.M, p.C, p.K, p.links.arrays, factor.flexibility, factor.transfer, factor.reaction, *_massive(p)
    )


def _start_vectors(p: TreePencil, a: kernels.Operator, warm_start: Start | None, width: int) -> Array:
    """The first block (w, 2n) of the basis.

    Raises:
        UnstableError: if K is not positive definite.
        EigensolverError: if K is dominated by rounding error.
    """
    n = len(p.residual)
    w = _start(width, 2 * n).copy() if warm_start is None else warm_start.vectors.copy()
    y = w[:, n:].copy()
    y = allowed(p.links, y)
    a.keep_massive(y)
    w[:, n:] = y
    error = solve_error(p, w)
    if not error < _MAX_SOLVE_ERROR:
        unstable = "" if p.factor.positive else "not positive definite: the steady state is unstable; or it is "
        raise EigensolverError(
            f"the stiffness of {len(p.K)} elements is {unstable}dominated by rounding error (of {error:.1e} in a solution): "
            "use fewer elements, or check units"
        )
    if not p.factor.positive:
        raise eigen.unstable()
    return a.forward(w) if warm_start is None else w


@dataclass(frozen=True)
class _Ritz:
    """The largest eigenvalues of i A⁻¹S, 1/ω, and their vectors in a basis of s vectors.

    Attributes:
        basis: (s, 2n).
        values: (m,) ascending, positive.
        vectors: (s, m).
        next_values: (k,) positive ones below ``values``.
    """

    basis: Array
    values: Array
    vectors: NDArray[np.complex128]
    next_values: Array


def _converged(a: kernels.Operator, w: Array, count: int, first_look: int | None) -> _Ritz:
    """Extend the basis until ``count`` modes have converged; ``first_look``: see ``Start.size``.

    Raises:
        EigensolverError: if the basis is full before, or there is no mode.
    """
    limit, width = min(w.shape[1], max(200, 8 * count)), len(w)
    look, interval = (first_look, _LOOK_EVERY_WARM) if first_look else (3 * count + _FIRST_LOOK * width, _LOOK_EVERY)
    basis, projected = np.empty((limit + width, w.shape[1])), np.zeros((look + width, look + width))
    size, last_step = 0, 0
    while True:
        gram, size, last_step, exhausted = a.extend(w, basis, projected, size, last_step, look)
        w = w[: len(gram)]
        if not size:
            raise EigensolverError("implausible stiffness-to-mass ratio: check the units of both")
        requested, available = min(count, size // 2), min(count + _EXTRA_MODES, size // 2)
        mu, z = eigh(1j * projected[:size, :size], "U")  # of i times the skew matrix with this upper triangle
        mu, next_values, z = mu[size - requested :], mu[size - available : size - requested], z[:, size - requested :]
        last = z[last_step:]
        error = np.sqrt(np.maximum(np.diagonal(gram), 0.0) @ (last.real**2 + last.imag**2)) / np.abs(mu)
        if exhausted or (error < _VECTOR_TOLERANCE).all():
            break
        look = size + interval
        projected = np.pad(projected, (0, look + width - len(projected)))
    smallest = 1e-12 * mu.max(initial=0.0)
    positive = mu > smallest
    if not positive.any() or not np.isfinite(mu).all():
        raise EigensolverError("Lanczos found no mode: the stiffness is nearly singular; check units")
    if error[positive].max() > 1e-6:
        unresolved = 1.0 / mu[positive & (error > 1e-6)]
        lowest, highest = unresolved.min(), unresolved.max()
        if highest < (1.0 + _CLUSTER) * lowest:
            below = int((1.0 / mu[positive] < lowest).sum())
            request = f", or request at most {below} mode{'s' * (below > 1)}" if below else ""
            raise EigensolverError(
                f"more modes than can be told apart lie between {lowest:.6g} and {highest:.6g} rad/s, as they do without "
                f"torsional or bending stiffness: check GJ and EI{request}"
            )
        raise EigensolverError(
            f"{count} modes did not converge in a basis of {size} vectors: request another number of modes"
        )
    return _Ritz(basis[:size], mu[positive], z[:, positive], next_values[next_values > smallest])


def _massive(p: TreePencil) -> tuple[Array, Array]:
    """Projectors of the nodes' twists on directions with mass, and Ad, of lumped masses; see ``krylov.hpp``."""
    if p.M.shape[1] > 12:
        return np.zeros((0, 6, 6)), np.zeros((0, 6, 6))
    links = p.links
    lever = np.asarray(np.linalg.inv(links.to_child), dtype=np.float64)
    on_b = p.M[:, 6:12, 6:12]  # of a node at a tip, in the axes of end a; those of the others are on ξ_a
    lumps = np.zeros((len(lever) + 1, 6, 6))
    np.add.at(lumps, links.parent, p.M[:, :6, :6] - on_b)
    lumps[1:] += np.swapaxes(lever, 1, 2) @ on_b @ lever
    inertia = np.diagonal(lumps, axis1=1, axis2=2)
    # in these units all inertias are 1, whatever the units of mass and length
    unit = 1.0 / np.sqrt(np.where(inertia > 0, inertia, 1.0))
    scaled = unit[:, :, None] * lumps * unit[:, None, :]
    massive = unit[:, :, None] * (np.linalg.pinv(scaled, hermitian=True) @ scaled) / unit[:, None, :]
    for k in np.flatnonzero(links.clamped_directions.any(axis=(1, 2))):  # a joint's ends move together
        massive[[links.parent[k], k + 1]] = np.eye(6)
    return massive[1:], lever


def frequencies_of(p: TreePencil, vectors: NDArray[np.complex128]) -> Array:
    """(m,) frequencies by the gyroscopic Rayleigh quotient of vectors (n, m)."""
    x = np.ascontiguousarray(np.stack([vectors.real.T, vectors.imag.T], axis=1))
    return _quotients(p, x)[0]


@np.errstate(divide="ignore", over="ignore", invalid="ignore")  # non-finite values are rejected
def _quotients(p: TreePencil, x: Array) -> tuple[Array, Array]:
    """Frequencies (m,) by the gyroscopic Rayleigh quotient, and κ = x*Kx, of x (m, 2, n) by real and imaginary parts."""
    m, n = len(x), x.shape[2]
    rows = x.reshape(2 * m, n)
    kappa, inertia = ((rows * product(a, 1.0, p.links, rows)).reshape(m, -1).sum(1) for a in (p.K, p.M))  # x*Kx, x*Mx
    coriolis = (x[:, 1] * product(p.C, -1.0, p.links, np.ascontiguousarray(x[:, 0]))).sum(1)  # ½i x*Cx, as C is skew
    root = np.sqrt(np.maximum(coriolis**2 + inertia * kappa, 0.0))  # κ of a free joint is rounding
    return kappa / (root - coriolis), kappa


@np.errstate(divide="ignore", over="ignore", invalid="ignore")  # as in ``_quotients``
def solve_error(p: TreePencil, v: Array) -> float:
    """Relative error of the solution x = K⁻¹ M v in the energy norm, for the first row of v (k, 2n)."""
    n = v.shape[1] // 2
    force = product(p.M, 1.0, p.links, v[:1, :n])
    x = force.copy()
    solve(p.factor, x)
    residual = force - product(p.K, 1.0, p.links, x)
    correction = residual.copy()
    solve(p.factor, correction)
    return float(np.sqrt(abs((residual * correction).sum() / (force * x).sum())))


def _width(p: TreePencil) -> int:
    """Number of vectors in a block: one more than the tree has tips, at most ``MAX_WIDTH``."""
    tips = len(p.links.parent) - len(np.unique(p.links.parent[p.links.parent > 0]))
    return min(1 + tips, MAX_WIDTH)


@lru_cache(maxsize=4)
def _start(width: int, size: int) -> Array:
    """Random start vectors (width, size), the same in every run."""
    return np.random.default_rng(1921).normal(size=(width, size))


@lru_cache(maxsize=16)
def _phases(width: int, modes: int) -> NDArray[np.complex128]:
    """Random coefficients (width, modes) of modes in start vectors, the same in every run."""
    rng = np.random.default_rng(1950)
    return rng.normal(size=(width, modes)) + 1j * rng.normal(size=(width, modes))
