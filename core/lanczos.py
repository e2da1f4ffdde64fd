"""The lowest gyroscopic modes of a chain, by block Lanczos on the inverse problem of ``eigen``: one K-solve a step.

A⁻¹S is skew in the A product, A = diag(K, M), so a step's result overlaps with its own and the preceding block only, but for
rounding; what rounding adds is taken out against the whole basis, again until next to nothing of it is left. Blocks of two
find the double frequencies of symmetric blades. (Lanczos 1950; Golub and Underwood 1977; Parlett, *The Symmetric Eigenvalue
Problem*, 1998, ch. 13.)
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs

from . import blocks, eigen
from .blocks import Factor, Tridiagonal
from .eigen import Eigen

Array = NDArray[np.float64]
Numbers = NDArray[Any]

(_syev,) = get_lapack_funcs(("syev",), dtype=np.float64)

_TOLERANCE = 1e-9  # of the vectors, relative; frequencies have its square
_CLEAR, _PASSES = 1e-8, 3  # overlap with the basis that is let be, and how often to take it out
_SOLVED, _REFINEMENTS = 1e-8, 4  # relative error of a solution with K that is let be, and the most steps to get there
_FIRST, _EVERY = 26, 12  # when to look whether the modes are there


def lanczos(
    M: Tridiagonal, C: Tridiagonal, K: Tridiagonal, count: int, stiffness: Callable[[Numbers], Numbers]
) -> Eigen:
    """The ``count`` lowest modes of a chain.

    ``stiffness`` gives K x (n, k) to full accuracy where the assembled K loses digits to cancellation, as it does with many
    elements: solutions are refined with it as often as it takes. The frequencies are those of the vectors' gyroscopic Rayleigh
    quotient, ``κ + iω x*Cx − ω² x*Mx = 0``, whose error is the square of theirs.

    Raises:
        UnstableError: if K is not positive definite.
        ArithmeticError: if the basis is full before the modes are there.
    """
    try:
        factor = blocks.cholesky(K)
    except np.linalg.LinAlgError:
        raise eigen.unstable() from None
    n = K.size
    stiff, moving, mass = blocks.rows(K), np.concatenate([blocks.rows(C), blocks.rows(M)], axis=1), blocks.rows(M)

    def forward(v: Array) -> tuple[Array, Array]:
        """w = A⁻¹S v and A w = S v."""
        cx, mx = _products(moving, v[:n], 2)
        force = cx + _products(mass, v[n:])[0]
        x = factor.solve(force)
        for _ in range(refinements):
            x += factor.solve(force - stiffness(x))
        return np.concatenate([x, -v[:n]]), np.concatenate([force, -mx])

    def dual(w: Array) -> Array:
        """A w."""
        (mass_y,) = _products(mass, w[n:])
        return np.concatenate([stiffness(w[:n]) if refinements else _products(stiff, w[:n])[0], mass_y])

    start = np.random.default_rng(1921).normal(size=(2 * n, 2))
    refinements = _refinements(factor, stiffness, _products(mass, start[:n])[0])
    limit = min(2 * n, max(200, 8 * count))
    basis, projected = np.zeros((limit + 2, 2 * n)), np.zeros((limit + 2, limit + 2))
    w, _ = forward(forward(start)[0])  # smooth
    size, before, last, look = 0, 0, slice(0, 0), 3 * count + _FIRST
    while True:
        w, overlap, gram = _against(dual, w, basis[:size])
        if size:
            projected[:size, last] += overlap
        value, turn, _ = _syev(gram)
        keep = value > 1e-20 * max(value[-1], np.abs(overlap).max(initial=0.0) ** 2, 1e-300)
        exhausted = not keep.any() or size + 2 > limit
        if exhausted and not size:
            raise ArithmeticError("stiffness and mass are out of all proportion: check their units")
        if exhausted or size >= look:
            look = size + _EVERY
            upper = np.triu(projected[:size, :size], 1)
            mu, z = np.linalg.eigh(1j * (upper - upper.T))
            order = np.argsort(-mu)[: min(count, size // 2)]
            mu, z = mu[order], z[:, order]
            left = np.sqrt(np.maximum(np.diagonal(gram), 0.0))
            error = np.linalg.norm(left[:, None] * np.abs(z[last]), axis=0) / np.abs(mu)
            if exhausted or (error < _TOLERANCE).all():
                break
        v = w @ (turn[:, keep] / np.sqrt(value[keep]))
        new = slice(size, size + v.shape[1])
        basis[new] = v.T
        w, force = forward(v)
        near = slice(before, new.stop)
        projected[near, new] = basis[near] @ force
        w -= basis[near].T @ projected[near, new]
        before, last, size = size, new, new.stop
    positive = mu > 1e-12 * mu.max(initial=0.0)
    if not positive.any() or not np.isfinite(mu).all():
        raise ArithmeticError("Lanczos found no mode: the stiffness is all but singular")
    if error[positive].max() > 1e-6:
        raise ArithmeticError(f"Lanczos did not find {count} modes in a basis of {size}: ask for fewer modes")
    x = basis[:size, :n].T @ z[:, positive].conj()  # i A⁻¹S has 1/ω at λ = −iω
    parts = np.ascontiguousarray(x).view(np.float64)  # real and imaginary parts side by side
    kx, cx, mx = (y.view(np.complex128) for y in (stiffness(parts), *_products(moving, parts, 2)))
    kappa, m = (np.real((x.conj() * y).sum(0)) for y in (kx, mx))
    half = -0.5 * np.imag((x.conj() * cx).sum(0))
    frequencies = kappa / (np.sqrt(np.maximum(half**2 + m * kappa, 0.0)) - half)  # of a loose joint κ is rounding
    if not (np.abs(frequencies * mu[positive] - 1.0) < 1e-2).all():
        raise ArithmeticError(
            "Lanczos lost its basis: frequencies and Rayleigh quotients disagree; ask for fewer modes"
        )
    return eigen.scaled(frequencies, x, kx)


def _refinements(factor: Factor, stiffness: Callable[[Numbers], Numbers], force: Array) -> int:
    """How many steps of iterative refinement bring a solution to the accuracy wanted, in the norm of its energy."""
    x = factor.solve(force)
    left = force - stiffness(x)
    noise = float(np.sqrt(np.abs((left * factor.solve(left)).sum() / (force * x).sum())))
    for steps in range(_REFINEMENTS):
        if noise ** (steps + 1) < _SOLVED:
            return steps
    return _REFINEMENTS


def _products(rows: Array, x: Numbers, matrices: int = 1) -> list[Numbers]:
    """Products with x (n, k) of several matrices whose rows stand above each other."""
    product = blocks.times(rows, x)
    d = product.shape[1] // matrices
    return [product[:, i * d : i * d + d].reshape(x.shape) for i in range(matrices)]


def _against(dual: Callable[[Array], Array], w: Array, basis: Array) -> tuple[Array, Array, Array]:
    """w made orthogonal to the basis in the A product, what was taken out, and its Gram matrix (k, k)."""
    taken = np.zeros((len(basis), w.shape[1]))
    for _ in range(_PASSES):
        aw = dual(w)
        overlap = basis @ aw
        w = w - basis.T @ overlap
        taken += overlap
        gram = w.T @ aw
        if np.abs(overlap).max(initial=0.0) <= _CLEAR * np.sqrt(max(np.diagonal(gram).min(), 0.0)):
            break
    return w, taken, gram
