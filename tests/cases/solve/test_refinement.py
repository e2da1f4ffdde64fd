"""How far a solver is refined, with solvers whose error is known: ``f = f∞ (1 + c n⁻ᵖ)``."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from southwell.cases.judge.convergence import Compared, follow
from southwell.cases.judge.spectrum import Answer, Spectrum, of_blade
from southwell.cases.solve.refinement import LEAST, MOST, Refining, solve
from southwell.core.modes import STATIONS, Modes
from southwell.references.protocol.worker import Run

ORDER, EXACT = 2, 7.0
SHAPE = np.zeros((1, len(STATIONS), 4), complex)
SHAPE[0, :, 2] = STATIONS**2
WEIGHT = np.tile(np.eye(4), (len(STATIONS), 1, 1))


def of(omega: float, elements: int, error: float) -> Spectrum:
    return of_blade(Modes(omega, np.array([EXACT * (1.0 + error)]), SHAPE, elements), WEIGHT)


def solver(coefficient: Callable[[float], float], requests: list[Run]) -> Callable[[Sequence[Run]], list[Answer]]:
    """Answers with an error of the theoretical order and one of the next even order, which extrapolation leaves."""

    def ask(runs: Sequence[Run]) -> list[Answer]:
        requests.extend(runs)
        return [of(w, n, coefficient(w) * (n**-2.0 + 5.0 * n**-4.0)) for w, n, _ in runs]

    return ask


def refined(coefficient: float, cap: int = 10_000) -> list[int]:
    """Elements of the answers at one speed."""
    runs: list[Run] = []
    compared = Compared(of(1.0, 1, 0.0), (0,))
    solve(solver(lambda _: coefficient, runs), [1.0], Refining((10, 20, 30), ORDER, cap), 1, lambda *_: compared)
    return [n for _, n, _ in runs]


def uncertainty(coefficient: float, elements: Sequence[int]) -> float:
    answers = [of(1.0, n, coefficient * (n**-2.0 + 5.0 * n**-4.0)) for n in elements]
    (mode,) = follow(answers, Compared(of(1.0, 1, 0.0), (0,)), ORDER)
    assert mode.estimate is not None
    assert mode.estimate.uncertainty is not None
    return mode.estimate.uncertainty


@pytest.mark.parametrize("coefficient", [0.1, 1.0, 20.0, 150.0])
def test_refinement_ends_where_the_uncertainty_is_small_enough(coefficient: float) -> None:
    elements = refined(coefficient)
    assert uncertainty(coefficient, elements) <= 2e-4
    if len(elements) > 3:
        assert uncertainty(coefficient, elements[:-1]) > 2e-4


def test_a_further_refinement_is_no_finer_than_the_order_requires() -> None:
    near = next(c for c in np.geomspace(0.1, 1e3, 400) if 2e-4 < uncertainty(c, (10, 20, 30)) < 2.5e-4)
    far = next(c for c in np.geomspace(0.1, 1e3, 400) if uncertainty(c, (10, 20, 30)) > 2e-3)
    assert refined(near)[3] == 50
    assert refined(far)[3] == 60
    for elements in (refined(near), refined(far)):
        ratios = [b / a for a, b in pairwise(elements[2:])]
        assert min(ratios) >= LEAST - 1e-9
        assert max(ratios) <= MOST + 10 / 30


def test_the_finest_is_the_cap() -> None:
    assert refined(1e3, cap=100) == [10, 20, 30, 60, 100]
    assert refined(1e3, cap=70) == [10, 20, 30, 60]  # 70 is too close to 60
    assert refined(1e3, cap=30) == [10, 20, 30]


def test_each_speed_is_refined_for_itself() -> None:
    runs: list[Run] = []
    compared = Compared(of(1.0, 1, 0.0), (0,))
    solve(
        solver(lambda w: 0.1 if w < 2.0 else 100.0, runs),
        [1.0, 3.0],
        Refining((10, 20, 30), ORDER, 10_000),
        1,
        lambda *_: compared,
    )
    assert [run for run in runs if run[0] == 1.0] == [(1.0, n, 1) for n in (10, 20, 30)]
    assert len([run for run in runs if run[0] == 3.0]) > 3


def test_an_unknown_order_doubles_the_elements() -> None:
    requests: list[Run] = []

    def ask(runs: Sequence[Run]) -> list[Answer]:
        requests.extend(runs)
        return [of(w, n, {10: 0.1, 20: 0.0, 30: 0.05}.get(n, 1e-9 / n)) for w, n, _ in runs]

    compared = Compared(of(1.0, 1, 0.0), (0,))
    solve(ask, [1.0], Refining((10, 20, 30), ORDER, 60), 1, lambda *_: compared)
    assert [n for _, n, _ in requests] == [10, 20, 30, 60]


def test_a_level_with_as_many_elements_as_the_one_before_is_a_failure() -> None:
    compared = Compared(of(1.0, 1, 0.0), (0,))
    (solution,) = solve(
        lambda runs: [of(w, min(n, 20), 0.0) for w, n, _ in runs],
        [1.0],
        Refining((10, 20, 30), ORDER, 60),
        1,
        lambda *_: compared,
    )
    assert solution.failure
    assert solution.failure.kind == "nonsense"
    assert [answer.elements for answer in solution.answers] == [10, 20]


def test_the_uncertainty_that_a_code_states_is_added_to_that_of_refinement() -> None:
    answers = [of(1.0, n, n**-2.0) for n in (10, 20, 40)]
    rounded = [*answers[:-1], replace(answers[-1], uncertainty=np.array([1e-3]))]
    compared = Compared(of(1.0, 1, 0.0), (0,))
    (alone,), (with_rounding,) = (follow(a, compared, ORDER) for a in (answers, rounded))
    assert alone.estimate
    assert with_rounding.estimate
    assert alone.estimate.uncertainty
    assert with_rounding.estimate.uncertainty == pytest.approx(alone.estimate.uncertainty + 1e-3)
