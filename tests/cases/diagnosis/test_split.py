"""A difference is divided into an offset at rest and a slope with speed."""

import numpy as np
import pytest

from southwell.cases.diagnosis.split import indication, split

SPEEDS = np.array([0.0, 2.0, 4.0])
NAMES = [["flapwise 1", "edgewise 1"]] * 3


def lines(rest: tuple[float, float], slope: tuple[float, float]) -> np.ndarray:
    return np.sqrt(np.array(rest) ** 2 + np.outer(SPEEDS**2, slope))


RIGHT = lines((4.0, 7.0), (1.8, 0.4))


def test_offset_and_slope_are_those_of_the_numbers() -> None:
    flap, edge = split(NAMES, SPEEDS, lines((3.9, 7.0), (1.8, 0.5)), RIGHT)
    assert (flap.at_rest, flap.slope, flap.slope_reference) == pytest.approx((3.9, 1.8, 1.8), rel=1e-6)
    assert flap.offset == pytest.approx(-0.025, rel=1e-6)
    assert (edge.at_rest, edge.slope) == pytest.approx((7.0, 0.5), rel=1e-6)


def test_a_mode_is_followed_where_frequencies_cross() -> None:
    crossed = [["flapwise 1", "edgewise 1"], ["flapwise 1", "edgewise 1"], ["edgewise 1", "flapwise 1"]]
    swapped = RIGHT.copy()
    swapped[2] = swapped[2, ::-1]
    flap, _ = split(crossed, SPEEDS, swapped, swapped)
    assert flap.slope == pytest.approx(1.8, rel=1e-6)


@pytest.mark.parametrize(
    ("frequencies", "words"),
    [(lines((3.9, 6.8), (1.8, 0.4)), "offset at rest: stiffness or mass"),
     (lines((4.0, 7.0), (1.7, 0.3)), "grows from rest with speed"),
     (lines((3.8, 7.0), (1.75, 0.4)), "and a slope with speed"),
     (lines((4.0, 7.0), (0.0, 0.0)), "do not move with speed"),
     (lines((4.0, 7.0), (-0.5, -0.4)), "fall with speed"),
     (RIGHT * (1 + 1e-5), "")],
)  # fmt: skip
def test_offset_and_slope_say_what_kind_of_cause_it_is(frequencies: np.ndarray, words: str) -> None:
    hint = indication(split(NAMES, SPEEDS, frequencies, RIGHT), 4.0, 1e-4)
    assert words in hint
    assert bool(words) == bool(hint)


def test_one_speed_has_no_slope() -> None:
    (flap,) = split([["flapwise 1"]], np.zeros(1), np.array([[3.9]]), np.array([[4.0]]))
    assert flap.offset == pytest.approx(-0.025)
    assert np.isnan(flap.slope)
    assert not indication([flap], 0.0, 1e-4)
