"""Verdicts at and around their borders, and the reasons that go with them."""

import pytest

from southwell.cases.judge.verdict import Effect, bracketed, discretised, judge, known_difference, percent

TARGET = 1e-3


@pytest.mark.parametrize(
    ("difference", "uncertainty", "verdict"),
    [
        (0.0, 0.0, "pass"),
        (6e-4, 3.9e-4, "pass"),
        (-6e-4, 3.9e-4, "pass"),
        (6e-4, 4.1e-4, "inconclusive"),
        (1.5e-3, 5.1e-4, "inconclusive"),
        (1.5e-3, 4.9e-4, "fail"),
        (-1.5e-3, 4.9e-4, "fail"),
        (0.0, 1.1e-3, "inconclusive"),
        (0.0, None, "inconclusive"),
        (1.0, None, "inconclusive"),
    ],
)
def test_difference_and_uncertainty_against_target(difference: float, uncertainty: float | None, verdict: str) -> None:
    answer, reason = judge(difference, uncertainty, TARGET)
    assert answer == verdict
    assert bool(reason) == (verdict != "pass")


def test_the_papers_own_tenth_of_a_percent_needs_the_rounding_of_its_digits() -> None:
    """189.7 against 189.9, printed as 0.1 %: it is 0.105 %, and 0.026 % + 0.026 % of rounding."""
    rounding = 0.05 / 189.7 + 0.05 / 189.9
    assert judge(189.7 / 189.9 - 1.0, rounding, TARGET)[0] == "inconclusive"


def test_a_missing_effect_that_matters_is_named_and_quantified() -> None:
    effects = [Effect("prestretch", -0.0123), Effect("rotary inertia", 1e-7)]
    verdict, reason = known_difference(-0.0123, TARGET, effects)
    assert verdict == "known difference"
    assert "no prestretch: −1.23 %" in reason
    assert "rotary" not in reason


def test_two_missing_effects_are_quantified_apart_and_together() -> None:
    _, reason = known_difference(-0.05, TARGET, [Effect("prestretch", -0.02), Effect("coriolis", -0.03)])
    assert "no prestretch: −2.00 %, no coriolis: −3.00 %, together −5.00 %" in reason


def test_an_effect_of_a_few_per_cent_of_the_shift_is_named() -> None:
    _, reason = known_difference(-0.0123, TARGET, [Effect("prestretch", -0.012), Effect("rotary inertia", -3e-4)])
    assert "no rotary inertia" in reason
    assert "together" in reason


@pytest.mark.parametrize(("shift", "verdict"), [(-9e-4, "pass"), (-1.1e-3, "known difference")])
def test_a_missing_effect_is_a_plain_pass_up_to_the_target(shift: float, verdict: str) -> None:
    assert known_difference(shift, TARGET, [Effect("prestretch", shift)])[0] == verdict


def test_a_mode_that_only_exists_without_the_effect_has_a_cause_without_a_size() -> None:
    verdict, reason = known_difference(None, TARGET, [Effect("geometric", -0.7)])
    assert verdict == "inconclusive"
    assert "no geometric: size unknown" in reason


def test_a_wide_but_true_bracket_is_an_estimate_and_a_wrong_one_fails() -> None:
    assert bracketed(0.010, 0.012, TARGET)[0] == "estimate"
    assert "±" not in bracketed(0.010, 0.012, TARGET)[1]
    assert "1.20 %" in bracketed(0.010, 0.012, TARGET)[1]
    assert "differs by −0.99 %" in bracketed(0.010, 0.012, TARGET)[1]
    assert bracketed(0.013, 0.012, TARGET)[0] == "fail"
    assert bracketed(1e-5, 1e-5, TARGET) == ("pass", "")
    assert bracketed(1e-5, None, TARGET)[0] == "inconclusive"


def test_a_bracket_is_relative_to_the_codes_own_answer() -> None:
    """Answers of 0.5 ± 100 % and of 2 ± 50 % reach the reference of 1; a little less does not."""
    assert bracketed(-0.5, 1.01, TARGET)[0] == "estimate"
    assert bracketed(-0.5, 0.99, TARGET)[0] == "fail"
    assert bracketed(1.0, 0.51, TARGET)[0] == "estimate"
    assert bracketed(1.0, 0.49, TARGET)[0] == "fail"


def test_a_coarse_discretisation_is_excused_only_by_its_own_refinement() -> None:
    def verdict(difference: float, limit: float | None, remainder: float = 0.0) -> tuple[str, str]:
        return discretised(difference, 1e-7, TARGET, remainder, limit, "50 elements")

    assert verdict(-1.3e-3, 2e-7)[0] == "known difference"
    assert "−0.13 %" in verdict(-1.3e-3, 2e-7)[1]
    assert verdict(-1.3e-3, -1.2e-3)[0] == "fail"
    assert verdict(-1.3e-3, None)[0] == "fail"
    assert verdict(-4e-4, None) == ("pass", "")
    assert verdict(-1.3e-3, 2e-7, 9e-4)[0] == "known difference"  # a printed number, nearly core's so discretised
    assert verdict(-1.3e-3, 2e-7, 1.1e-3)[0] == "fail"  # and one that is not


def test_the_uncertainty_counts_where_refinements_should_lead_to_the_reference() -> None:
    assert discretised(-1.3e-3, 2e-4, TARGET, 0.0, 7e-4, "50 elements")[0] == "known difference"
    assert discretised(-1.3e-3, 4e-4, TARGET, 0.0, 7e-4, "50 elements")[0] == "fail"


@pytest.mark.parametrize(
    ("value", "text"), [(-0.0123, "−1.23 %"), (4.4e-4, "+0.044 %"), (1e-3, "+0.10 %"), (0.314, "+31.40 %")]
)
def test_percent(value: float, text: str) -> None:
    assert percent(value) == text
