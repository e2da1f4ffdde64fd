"""The rank of matrices, and solutions of least norm."""

import numpy as np
import pytest

from southwell.core import rank


@pytest.mark.parametrize("least", [1.0, 1e-4, 1e-8, 1e-10, 0.0])
def test_motions_without_stiffness_are_the_null_space(least: float) -> None:
    rng = np.random.default_rng(3)
    u, v = (np.linalg.qr(rng.normal(size=(12, 12)))[0] for _ in range(2))
    A = (u * np.array([*[1.0] * 11, least])) @ v
    ranking = rank.ranked(A)
    assert ranking.null.shape[1] == (least < rank.TOLERANCE) == ranking.left_null.shape[1]
    b = A @ np.arange(12.0)
    np.testing.assert_allclose(A @ ranking.solve(b), b, atol=1e-6)


@pytest.mark.parametrize(("least", "rank_"), [(1e-10, 12), (1e-18, 11)])
def test_a_small_singular_value_is_zero_only_if_errors_explain_it(least: float, rank_: int) -> None:
    """A long chain of soft elements is ill-conditioned, and yet has no rigid motion."""
    rng = np.random.default_rng(3)
    u, v = (np.linalg.qr(rng.normal(size=(12, 12)))[0] for _ in range(2))
    A = (u * np.array([*[1.0] * 11, least])) @ v
    assert rank.ranked(A, error=np.full(12, 1e-8)).rank == rank_
    assert rank.ranked(A, error=np.full(12, 1e-4)).rank == 11  # a stiffness of 1e-8 may be rounding
    ranking = rank.ranked(A, error=np.full(12, 1e-8))
    np.testing.assert_allclose(A @ ranking.null, 0.0, atol=1e-15)
    np.testing.assert_allclose(ranking.left_null.T @ A, 0.0, atol=1e-15)


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_the_rank_does_not_depend_on_the_unit(unit: float) -> None:
    for least, expected in ((10 * rank.TOLERANCE, 2), (0.1 * rank.TOLERANCE, 1)):
        assert rank.ranked(unit * np.diag([1.0, least])).rank == expected


def test_null_spaces_are_those_of_the_matrix_in_its_own_units() -> None:
    A = np.array([[1e3, 2e3, 3e3], [2.0, 4.0, 6.0], [1e-3, 0.0, 1e-3]])
    ranking = rank.ranked(A, np.array([1e3, 1.0, 1e-3]), np.array([1.0, 2.0, 0.5]))
    assert ranking.rank == 2
    np.testing.assert_allclose(A @ ranking.null, 0.0, atol=1e-12)
    np.testing.assert_allclose(ranking.left_null.T @ A, 0.0, atol=1e-12)


def test_of_equal_columns_the_last_is_a_pivot() -> None:
    chosen, others = rank.pivots(np.array([[1.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]]))
    assert (chosen.tolist(), others.tolist()) == ([2, 3], [0, 1])
