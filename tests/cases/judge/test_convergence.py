"""Modes are followed through refinements to the finest, by their shapes."""

import numpy as np
import pytest

from southwell.cases.judge.convergence import Compared, follow
from southwell.cases.judge.pairing import Pair
from southwell.cases.judge.spectrum import Spectrum, of_blade
from southwell.core.modes import Modes

WEIGHT = np.tile(np.eye(4), (21, 1, 1))
FLAP, EDGE = np.zeros((2, 21, 4), complex)
FLAP[:, 2] = EDGE[:, 1] = np.linspace(0.0, 1.0, 21)


def answer(elements: int, flap: float, edge: float, uncertainty: tuple[float, ...] = ()) -> Spectrum:
    """Two modes, in ascending order."""
    pairs = sorted([(flap, 0), (edge, 1)])
    shapes = np.array([(FLAP, EDGE)[k] for _, k in pairs])
    modes = Modes(
        1.0, np.array([frequency for frequency, _ in pairs]), shapes, elements, uncertainty=np.array(uncertainty)
    )
    return of_blade(modes, WEIGHT)


COMPARED = Compared(answer(99, 1.0, 2.0), (0, 1))


def test_a_mode_is_followed_where_modes_change_places() -> None:
    """ω = 1.9 + 2/n² falls below the other mode, 2; at the finest refinement it is the first."""
    answers = [answer(n, 1.9 + 2.0 / n**2, 2.0) for n in (2, 4, 8)]
    flap, edge = follow(answers, COMPARED, 2)
    assert [flap.partner.mode, edge.partner.mode] == [0, 1]
    assert [n for n, _ in flap.history] == [2, 4, 8]
    assert [frequency for _, frequency in flap.history] == pytest.approx([2.4, 2.025, 1.93125])
    assert flap.estimate is not None
    assert flap.estimate.value == pytest.approx(1.9)
    assert not flap.bracketed


def test_an_error_bound_is_that_of_the_finest_answer() -> None:
    """The others state none."""
    answers = [answer(2, 1.3, 2.0), answer(4, 1.2, 2.0), answer(8, 1.1, 2.0, (0.1, 0.2))]
    flap, edge = follow(answers, COMPARED, 2, bracket=True)
    assert flap.estimate is not None
    assert edge.estimate is not None
    assert flap.bracketed
    assert (flap.estimate.value, flap.estimate.uncertainty) == pytest.approx((1.1, 0.1))
    assert edge.estimate.uncertainty == pytest.approx(0.2)


def test_without_an_error_bound_a_bracket_is_estimated_from_refinement() -> None:
    answers = [answer(n, 1.0 + 1.0 / n**2, 2.0) for n in (2, 4, 8)]
    flap, _ = follow(answers, COMPARED, 2, bracket=True)
    assert not flap.bracketed
    assert flap.estimate is not None
    assert flap.estimate.value == pytest.approx(1.0)
    assert flap.estimate.uncertainty is not None
    assert flap.estimate.uncertainty < 0.1


def test_without_answers_there_is_no_partner() -> None:
    flap, edge = follow([], COMPARED, 2)
    assert (flap.estimate, flap.history, edge.history) == (None, (), ())
    assert flap.partner == Pair(None, 0.0, "no partner: the code returned no modes")
