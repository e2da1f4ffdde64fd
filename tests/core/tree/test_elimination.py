"""Products, factors and counts of a tree's matrices, element by element, against dense ones."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core.space import spatial as sp
from southwell.core.spectrum import completeness
from southwell.core.tree import elimination
from southwell.core.tree.links import Links, allowed, gathered, product, twists
from southwell.core.tree.pencil import TreePencil
from southwell.tests.support.dense import dense, to_twists


def random(n: int, d: int, tree: str = "chain", joints: tuple[int, ...] = ()) -> TreePencil:
    """A tree with K > 0, M > 0 and C skew; the given links are massless joints that clamp two to five directions."""
    rng = np.random.default_rng(n * d)
    a, M, C = rng.normal(size=(3, n, d + 6, d + 6))
    to_child, clamped = sp.adjoint(sp.exp(rng.normal(size=(n, 6)))), np.zeros((n if joints else 0, 6, 6))
    K, M, C = a @ np.swapaxes(a, 1, 2) + np.eye(d + 6), M @ np.swapaxes(M, 1, 2), C - np.swapaxes(C, 1, 2)
    for k in joints:
        basis = np.linalg.qr(rng.normal(size=(6, int(rng.integers(2, 6)))))[0]
        clamped[k] = basis @ basis.T
        free = np.eye(6) - clamped[k]
        K[k, :12], K[k, 12:, :12], M[k], C[k] = 0.0, 0.0, 0.0, 0.0
        K[k, 6:12, 6:12] = free @ np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]) @ free
    parents = {
        "chain": np.arange(n),
        "bushy": np.array([int(rng.integers(0, k + 1)) for k in range(n)]),
        "star": np.array([0 if k % 4 == 0 else k for k in range(n)]),  # branches of four links
    }
    return TreePencil(np.zeros(n * d), M, C, K, Links(parents[tree].astype(np.int64), to_child, clamped))


CASES = [(n, d, "chain", ()) for n, d in ((1, 6), (2, 12), (7, 12), (7, 6))]
CASES += [(2, 12, "chain", (0,)), (7, 12, "chain", (0,)), (7, 6, "chain", (0, 3)), (7, 12, "chain", (2, 6))]
CASES += [(9, 12, "bushy", ()), (9, 6, "bushy", (1, 4)), (12, 12, "star", ()), (12, 12, "star", (0, 5, 10))]


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("vectors", [1, 2, 5])
def test_products_are_those_of_the_dense_matrix(case, vectors: int) -> None:
    p = random(*case)
    x = allowed(p.links, np.random.default_rng(1).normal(size=(vectors, len(p.residual))))
    for matrix, sign in ((p.K, 1.0), (p.M, 1.0), (p.C, -1.0)):
        projected = allowed(p.links, product(matrix, sign, p.links, x))
        np.testing.assert_allclose(projected, x @ dense(p, matrix).T, atol=1e-10)


@pytest.mark.parametrize("case", CASES)
def test_wrenches_are_gathered_by_the_transpose_of_the_velocity_transformation(case) -> None:
    p = random(*case)
    n, d = len(p.links.parent), len(p.residual) // len(p.links.parent)
    g = np.random.default_rng(2).normal(size=(n + 1, 6))
    load = np.zeros((n, d))
    load[:, :6] = g[1:]
    collected = gathered(p.links, np.zeros((n, d + 6)), g).ravel()
    np.testing.assert_allclose(collected, to_twists(p, d).T @ load.ravel(), atol=1e-10)  # Bᵀ


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("vectors", [1, 2, 5])
def test_solutions_are_those_of_the_dense_matrix(case, vectors: int) -> None:
    p = random(*case)
    p = replace(p, K=p.K + p.C)  # out of balance
    x = np.random.default_rng(1).normal(size=(vectors, len(p.residual)))
    expected = x @ np.linalg.pinv(dense(p, p.K), rcond=1e-12).T  # zero in clamped directions
    assert p.factor.positive
    elimination.solve(p.factor, x)
    np.testing.assert_allclose(x, expected, atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("least", [1.0, 1e-6, -1e-6, -1.0])
@pytest.mark.parametrize("case", [(4, 12, "chain", ()), (4, 12, "chain", (0,)), (6, 12, "bushy", (2,))])
def test_the_factor_detects_a_positive_definite_matrix(least: float, case) -> None:
    """K − λM, which is zero at the lowest eigenvalue of the pair, with that eigenvalue shifted."""
    p = random(*case)
    K, M = (dense(p, matrix) for matrix in (p.K, p.M))
    lowest = 1.0 / np.linalg.eigvals(np.linalg.pinv(K, rcond=1e-12) @ M).real.max()
    shifted = replace(p, K=p.K - lowest * (1.0 - least) * p.M)
    assert shifted.factor.positive == (least > 0)


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("omega", [0.0, 0.3, 1.0, 3.0, 10.0])
def test_the_count_is_that_of_the_dense_matrix(case, omega: float) -> None:
    p = random(*case)
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
    links = Links(np.arange(n, dtype=np.int64), np.tile(back, (n, 1, 1)), np.zeros((0, 6, 6)))
    elimination.solve(elimination.factor(K, links), load)
    tip = twists(links, load)[0, -1]
    assert tip[1] == pytest.approx(1.0 / (3.0 * EI), rel=1e-15 * n)
    assert tip[5] == pytest.approx(1.0 / (2.0 * EI), rel=1e-15 * n)
