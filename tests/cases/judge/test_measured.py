"""E = S − D against u_val: what may be said of a model that is compared with a measurement."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from southwell.cases.judge.measured import COVERAGE, Validation, statement

SIZE = st.floats(0.0, 10.0)


@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0), SIZE, SIZE, SIZE, SIZE)
def test_more_uncertainty_never_makes_an_error_more_visible(
    s: float, d: float, n: float, i: float, u: float, more: float
) -> None:
    plain = Validation(s, d, n, i, u)
    for vaguer in (
        Validation(s, d, n + more, i, u),
        Validation(s, d, n, i + more, u),
        Validation(s, d, n, i, u + more),
    ):
        assert vaguer.visible <= plain.visible
    assert plain.visible <= abs(s - d)
    assert plain.visible >= abs(s - d) - COVERAGE * (n + i + u) - 1e-12


@pytest.mark.parametrize("bad", [-0.1, float("nan"), float("inf")])
def test_an_uncertainty_is_finite_and_not_negative(bad: float) -> None:
    with pytest.raises(ValueError, match=r"data: .* finite and not negative"):
        Validation(1.0, 1.0, 0.0, 0.0, bad)


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan"), float("inf")])
def test_a_frequency_is_finite_and_above_zero(bad: float) -> None:
    with pytest.raises(ValueError, match=r"measured: .* finite and above zero"):
        Validation(1.0, bad, 0.0, 0.0, 0.1)


def test_a_small_visible_error_is_not_rounded_to_zero() -> None:
    assert statement(Validation(1.0, 0.9, 0.0, 0.0, 0.04998)) == "model error visible (at least 0.0044 %)"


@given(st.floats(0.5, 2.0), st.floats(0.0, 0.5))
def test_relative_and_absolute_differences_are_equally_visible(ratio: float, u: float) -> None:
    """|D/S − 1| exceeds k u_val/S by as much as |E| exceeds k u_val, which is what rows of results hold."""
    v = Validation(simulated=1.3, measured=1.3 * ratio, numerical=0.0, inputs=0.0, data=u)
    difference, uncertainty = v.relative
    assert max(abs(difference) - uncertainty, 0.0) * 1.3 == pytest.approx(v.visible, abs=1e-12)
