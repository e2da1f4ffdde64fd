"""Sequences with a known limit and order: the estimate must find both, and refuse where there is none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from southwell.cases.judge.uncertainty import ROUNDING, from_bracket, from_print, from_refinement, observed_order

LIMIT = 189.82


def sequence(elements: tuple[int, ...], order: float, error: float) -> list[float]:
    """Frequencies that approach ``LIMIT`` at exactly ``order``, ``error`` away from it at 10 elements."""
    return [LIMIT * (1.0 + error * (10.0 / n) ** order) for n in elements]


ratios = st.integers(14, 30)


@given(st.floats(0.6, 6.0), ratios, ratios, st.sampled_from([1e-2, -3e-3]))
def test_observed_order_at_unequal_ratios(order: float, first: int, second: int, error: float) -> None:
    n = (100, 10 * first, first * second)
    assert observed_order(n, sequence(n, order, error)) == pytest.approx(order, rel=1e-3)


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("elements", [(10, 20, 40), (10, 15, 30), (5, 10, 20, 40)])
def test_extrapolation_finds_the_limit(order: int, elements: tuple[int, ...]) -> None:
    values = sequence(elements, order, 1e-2)
    estimate = from_refinement(elements, values, order)
    assert estimate.value == pytest.approx(LIMIT, rel=1e-12)
    assert estimate.order == pytest.approx(order)
    assert estimate.uncertainty == pytest.approx(0.03 * (values[-1] / LIMIT - 1.0))
    assert not estimate.note


@pytest.mark.parametrize("next_", [-0.15, 0.1, 0.15])
def test_an_order_that_is_right_by_chance_is_not_believed(next_: float) -> None:
    """With the sizes h = 1, ½, ¼ the terms in h⁴ and h⁶ are chosen so that both extrapolated values are the same."""
    h = np.array([1.0, 0.5, 0.25])
    last = -next_ * (1 / 4 - 1 / 64) / (5 / 16 - 5 / 1024)
    values = LIMIT * (1.0 + 0.01 * (h**2 + next_ * h**4 + last * h**6))
    estimate = from_refinement((10, 20, 40), values.tolist(), 2)
    assert not estimate.note
    assert estimate.uncertainty is not None
    assert abs(estimate.value / LIMIT - 1.0) <= estimate.uncertainty
    assert abs((4 * values[1] - values[0]) / 3 - estimate.value) < 1e-12 * LIMIT


@given(
    st.sampled_from([2, 4]),
    st.sampled_from([(10, 20, 40), (15, 30, 45), (24, 48, 96), (10, 14, 20)]),
    st.floats(-1e-2, 1e-2),
    st.floats(-1.0, 1.0),
    st.sampled_from([1, 2]),
)
def test_the_band_holds_the_limit(order: int, elements: tuple[int, ...], error: float, next_: float, step: int) -> None:
    """An error with a second term, one or two orders higher and as large as the first at 10 elements."""
    values = [
        LIMIT * (1.0 + error * (10.0 / n) ** order + next_ * error * (10.0 / n) ** (order + step)) for n in elements
    ]
    estimate = from_refinement(elements, values, order)
    if estimate.uncertainty is not None:
        assert abs(estimate.value / LIMIT - 1.0) <= estimate.uncertainty


def test_a_sequence_off_its_theoretical_order_is_trusted_less() -> None:
    values = sequence((10, 20, 40), 3.0, 1e-2)
    estimate = from_refinement((10, 20, 40), values, 4)
    assert estimate.uncertainty == pytest.approx(3.0 * abs(values[-1] / LIMIT - 1.0), rel=1e-2)
    assert "observed order 3.00 instead of 4" in estimate.note


def test_faster_than_theory_is_not_believed() -> None:
    values = sequence((10, 20, 40), 6.0, 1e-2)
    estimate = from_refinement((10, 20, 40), values, 2)
    change = abs(values[2] - values[1]) / LIMIT
    assert estimate.uncertainty == pytest.approx(3.0 * change / 3.0, rel=1e-3)  # as if of order 2: 2² − 1 = 3


@pytest.mark.parametrize(
    ("values", "phrase"),
    [([1.0, 1.1, 1.05], "not monotone: 1, 1.1, 1.05"), ([1.0, 1.1, 1.3], "not converging: 1, 1.1, 1.3")],
)
def test_sequences_that_do_not_converge_are_refused(values: list[float], phrase: str) -> None:
    estimate = from_refinement((10, 20, 40), values, 2)
    assert estimate.uncertainty is None
    assert phrase in estimate.note
    assert estimate.value == values[-1]


def test_scatter_far_below_any_target_is_given_as_such() -> None:
    estimate = from_refinement((10, 20, 40), [100.0, 100.00003, 100.00001], 2)
    assert estimate.uncertainty == pytest.approx(3 * 3e-7, rel=1e-3)  # Eça and Hoekstra: three times the spread
    assert estimate.order is None


def test_two_refinements_show_no_order() -> None:
    estimate = from_refinement((10, 20), [1.0, 1.01], 4)
    assert estimate.uncertainty is None
    assert estimate.note.startswith("2 of 3")


def test_the_last_change_of_a_spectral_code_is_its_uncertainty() -> None:
    estimate = from_refinement((4, 6, 8), [1.5, 2.0, 2.02], 0)
    assert estimate.value == 2.02
    assert estimate.uncertainty == pytest.approx(0.02 / 2.02)


def test_the_uncertainty_is_at_least_the_rounding() -> None:
    assert from_refinement((4, 6, 8), [2.0, 2.0, 2.0], 0).uncertainty == ROUNDING
    assert from_refinement((4, 6, 8), [2.0, 2.0, 2.0], 4).uncertainty == ROUNDING
    assert from_bracket(2.0, 0.0).uncertainty == ROUNDING


@pytest.mark.parametrize(
    ("text", "value", "half"),
    [("189.7", 189.7, 0.05), ("11.71", 11.71, 0.005), ("70", 70.0, 0.5), ("1.20", 1.2, 0.005), ("3.6e2", 360.0, 5.0)],
)
def test_the_uncertainty_of_a_printed_number_is_half_its_last_digit(text: str, value: float, half: float) -> None:
    estimate = from_print(text)
    assert estimate.value == value
    assert estimate.uncertainty == pytest.approx(half / value)


def test_the_order_of_a_real_sequence_is_seen() -> None:
    """Lowest frequency of a fixed-free string by finite differences: 2 n sin(π/4n), of second order, to π/2."""
    n = np.array([8, 16, 32])
    estimate = from_refinement(n.tolist(), (2 * n * np.sin(np.pi / 4 / n)).tolist(), 2)
    assert estimate.value == pytest.approx(np.pi / 2, rel=1e-6)
    assert estimate.uncertainty is not None
    assert abs(estimate.value / (np.pi / 2) - 1) < estimate.uncertainty < 1e-5
