"""Products, factors and counts of a chain's matrices, element by element, against dense ones."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core.space import spatial as sp
from southwell.core.spectrum import completeness
from southwell.core.tree import elimination, matrices
from southwell.core.tree.pencil import ChainPencil
from southwell.tests.support.dense import dense

SIZES = [(1, 6), (2, 12), (7, 12), (7, 6)]
ROOTED = [(*size, 0) for size in SIZES] + [(*size, clamped) for size in SIZES[1:] for clamped in (2, 5)]


def random(n: int, d: int, clamped: int = 0) -> ChainPencil:
    """A chain with K > 0, M > 0 and C skew. If directions of node 1 are clamped, the first element is a massless joint."""
    rng = np.random.default_rng(n * d)
    a, M, C = rng.normal(size=(3, n, d + 6, d + 6))
    back, fixed = sp.adjoint(sp.exp(rng.normal(size=(n, 6)))), np.zeros((0, 0))
    K, M, C = a @ np.swapaxes(a, 1, 2) + np.eye(d + 6), M @ np.swapaxes(M, 1, 2), C - np.swapaxes(C, 1, 2)
    if clamped:
        basis = np.linalg.qr(rng.normal(size=(6, clamped)))[0]
        fixed = basis @ basis.T
        free = back[0] = np.eye(6) - fixed
        K[0, :12], K[0, 12:, :12], M[0], C[0] = 0.0, 0.0, 0.0, 0.0
        K[0, 6:12, 6:12] = free @ np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]) @ free
    return ChainPencil(np.zeros(n * d), M, C, K, back, fixed)


@pytest.mark.parametrize(("n", "d"), SIZES)
@pytest.mark.parametrize("vectors", [1, 2, 5])
def test_products_are_those_of_the_dense_matrix(n: int, d: int, vectors: int) -> None:
    p = random(n, d)
    x = np.random.default_rng(1).normal(size=(vectors, n * d))
    for matrix, sign in ((p.K, 1.0), (p.M, 1.0), (p.C, -1.0)):
        np.testing.assert_allclose(matrices.product(matrix, sign, p.back, x), x @ dense(p, matrix).T, atol=1e-10)


@pytest.mark.parametrize(("n", "d", "clamped"), ROOTED)
@pytest.mark.parametrize("vectors", [1, 2, 5])
def test_solutions_are_those_of_the_dense_matrix(n: int, d: int, clamped: int, vectors: int) -> None:
    p = random(n, d, clamped)
    p = replace(p, K=p.K + p.C)  # out of balance
    x = np.random.default_rng(1).normal(size=(vectors, n * d))
    expected = x @ np.linalg.pinv(dense(p, p.K), rcond=1e-12).T  # zero in clamped directions
    assert p.factor.positive
    elimination.solve(p.factor, x)
    np.testing.assert_allclose(x, expected, atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("least", [1.0, 1e-6, -1e-6, -1.0])
@pytest.mark.parametrize("clamped", [0, 2])
def test_the_factor_detects_a_positive_definite_matrix(least: float, clamped: int) -> None:
    """K − λM, which is zero at the lowest eigenvalue of the pair, with that eigenvalue shifted."""
    p = random(4, 12, clamped)
    K, M = (dense(p, matrix) for matrix in (p.K, p.M))
    lowest = 1.0 / np.linalg.eigvals(np.linalg.pinv(K, rcond=1e-12) @ M).real.max()
    shifted = replace(p, K=p.K - lowest * (1.0 - least) * p.M)
    assert shifted.factor.positive == (least > 0)


@pytest.mark.parametrize(("n", "d", "clamped"), ROOTED)
@pytest.mark.parametrize("omega", [0.0, 0.3, 1.0, 3.0, 10.0])
def test_the_count_is_that_of_the_dense_matrix(n: int, d: int, clamped: int, omega: float) -> None:
    p = random(n, d, clamped)
    K, C, M = (dense(p, matrix) for matrix in (p.K, p.C, p.M))
    signs = np.linalg.eigvalsh(K + 1j * omega * C - omega**2 * M)
    assert completeness.below(p, omega) == int((signs < -1e-9).sum())


def test_the_count_takes_only_the_symmetric_part_of_an_element() -> None:
    """The skew parts of the elements of a chain in balance add up to zero."""
    p = random(5, 12)
    skewed = replace(p, K=p.K + 3.0 * p.C)
    assert [completeness.below(skewed, s) for s in (0.3, 3.0)] == [completeness.below(p, s) for s in (0.3, 3.0)]


def test_a_singular_matrix_is_refused() -> None:
    p = random(3, 6)
    p.K[2] = 0.0
    with pytest.raises(np.linalg.LinAlgError, match="singular"):
        _ = p.factor


@pytest.mark.parametrize("n", [100, 10_000])
def test_solutions_of_a_straight_beam_keep_their_digits(n: int) -> None:
    """A cantilever under a load at its tip, P L³/3EI: n elements with the exact stiffness, K of a condition number of n⁴."""
    h, EI, back = 1.0 / n, 3.0, np.eye(6)
    back[1, 5], back[2, 4] = h, -h  # velocity at b of a rotation of a
    flexibility = np.diag([h, h**3 / (3 * EI), h**3 / (3 * EI), h, h / EI, h / EI])  # of a load at b
    flexibility[1, 5] = flexibility[5, 1] = h**2 / (2 * EI)
    flexibility[2, 4] = flexibility[4, 2] = -(h**2) / (2 * EI)
    K, load = np.zeros((n, 12, 12)), np.zeros((1, 6 * n))
    K[:, 6:, 6:] = back.T @ np.linalg.inv(flexibility) @ back  # on ρ, in the axes of a
    for k in range(n):  # a unit force at the tip
        load[0, 6 * k + 1], load[0, 6 * k + 5] = 1.0, (n - k) * h
    backs = np.tile(back, (n, 1, 1))
    elimination.solve(elimination.factor(K, backs, np.zeros((0, 0))), load)
    tip = matrices.twists(backs, load)[0, -1]
    assert tip[1] == pytest.approx(1.0 / (3.0 * EI), rel=1e-15 * n)
    assert tip[5] == pytest.approx(1.0 / (2.0 * EI), rel=1e-15 * n)
