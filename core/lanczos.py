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

from . import blocks, eigen
from .blocks import Tridiagonal
from .eigen import Eigen

Array = NDArray[np.float64]
Numbers = NDArray[Any]

_TOLERANCE = 1e-9  # of the vectors, relative; frequencies have its square
_CLEAR, _PASSES = 1e-8, 3  # overlap with the basis that is let be, and how often to take it out
_FIRST, _EVERY = 26, 12  # when to look whether the modes are there


def lanczos(
    M: Tridiagonal, C: Tridiagonal, K: Tridiagonal, count: int, energy: Callable[[Numbers], Array] | None = None
) -> Eigen:
    """The ``count`` lowest modes of a chain.

    With ``energy``, x*Kx to full accuracy, the frequencies are taken from the gyroscopic Rayleigh quotient of the vectors,
    ``κ + iω x*Cx − ω² x*Mx = 0``, whose error is the square of theirs.

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
        return np.concatenate([factor.solve(force), -v[:n]]), np.concatenate([force, -mx])

    def dual(w: Array) -> Array:
        """A w."""
        return np.concatenate([*_products(stiff, w[:n]), *_products(mass, w[n:])])

    limit = min(2 * n, max(200, 8 * count))
    basis, projected = np.zeros((limit + 2, 2 * n)), np.zeros((limit + 2, limit + 2))
    w, _ = forward(forward(np.random.default_rng(1921).normal(size=(2 * n, 2)))[0])  # smooth
    size, before, last, look = 0, 0, slice(0, 0), 3 * count + _FIRST
    while True:
        w, overlap, gram = _against(dual, w, basis[:size])
        if size:
            projected[:size, last] += overlap
        value, turn = np.linalg.eigh(0.5 * (gram + gram.T))
        keep = value > 1e-20 * max(value[-1], np.abs(overlap).max(initial=0.0) ** 2, 1e-300)
        exhausted = not keep.any() or size + 2 > limit
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
    positive = mu > 1e-12 * mu.max()
    if error[positive].max() > 1e-6:
        raise ArithmeticError(f"Lanczos did not find {count} modes in a basis of {size}: ask for fewer modes")
    x = basis[:size, :n].T @ z[:, positive].conj()  # i A⁻¹S has 1/ω at λ = −iω
    (kx,), (cx, mx) = _products(stiff, x), _products(moving, x, 2)
    frequencies = 1.0 / mu[positive]
    if energy is not None:
        m, half, kappa = np.real((x.conj() * mx).sum(0)), -0.5 * np.imag((x.conj() * cx).sum(0)), energy(x)
        frequencies = kappa / (np.sqrt(half**2 + m * kappa) - half)
        if (np.abs(frequencies * mu[positive] - 1.0) > 1e-2).any():
            raise ArithmeticError(
                "Lanczos lost its basis: frequencies and Rayleigh quotients disagree; ask for fewer modes"
            )
    return eigen.scaled(frequencies, x, kx)


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
