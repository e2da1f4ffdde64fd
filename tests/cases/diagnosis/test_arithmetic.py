"""Differences by arithmetic are recognised before any hypothesis about the blade."""

import warnings

import numpy as np
import pytest

from southwell.cases.diagnosis.arithmetic import arithmetic

EVERY = [
    np.array([4.0, 7.0, 12.0, 25.0, 40.0, 52.0, 61.0, 80.0]),
    np.array([5.0, 7.5, 13.0, 26.0, 41.0, 53.0, 62.0, 81.0]),
]
REFERENCE = np.array([row[:4] for row in EVERY])
NUMBERS = (1, 2, 3, 4)


def name(frequencies: np.ndarray, labels: tuple[int | str, ...] = NUMBERS) -> str:
    return arithmetic(frequencies, REFERENCE, labels, EVERY).name


@pytest.mark.parametrize(
    ("factor", "start"),
    [(2 * np.pi, "constant ratio 2π"), (0.5 / np.pi, "constant ratio 1/2π"), (60.0, "constant ratio 60:"),
     (np.pi / 30, "constant ratio 2π/60"), (30 / np.pi, "constant ratio 60/2π"), (np.sqrt(2.0), "constant ratio √2")],
)  # fmt: skip
def test_constant_ratios_are_named(factor: float, start: str) -> None:
    slightly_wrong = factor * REFERENCE * (1 + 0.01 * np.array([1, -1, 0, 1]))
    assert name(slightly_wrong).startswith(start)


def test_eigenvalues_are_recognised_as_squares() -> None:
    assert name(REFERENCE**2) == "squared frequencies, (rad/s)²"
    assert name((REFERENCE / (2 * np.pi)) ** 2) == "squared frequencies, Hz²"


def test_exchanged_modes_are_named_with_their_labels() -> None:
    assert name(REFERENCE[:, [1, 0, 2, 3]]) == "modes in another order: 1 is 2, 2 is 1"
    labels = ("flapwise 1", "edgewise 1", "flapwise 2", "edgewise 2")
    assert name(REFERENCE[:, [0, 1, 3, 2]], labels).endswith("flapwise 2 is edgewise 2, edgewise 2 is flapwise 2")


def test_exchanged_modes_of_similar_frequency_are_named() -> None:
    """Two of four modes whose frequencies differ by a quarter."""
    reference = np.array([[4.0, 5.0, 12.0, 25.0], [5.0, 6.2, 13.0, 26.0]])
    exchanged = reference[:, [1, 0, 2, 3]] * (1 + 0.002 * np.array([1, -1, 0, 1]))
    assert arithmetic(exchanged, reference, NUMBERS, list(reference)).name == "modes in another order: 1 is 2, 2 is 1"


def test_conjugate_pairs_and_halves_are_recognised() -> None:
    assert name(np.array([row[[0, 0, 1, 1]] for row in EVERY])) == "every mode twice (conjugate pairs)"
    assert name(np.array([row[[0, 2, 4, 6]] for row in EVERY])) == "half of the modes: the 1st, 3rd, …"
    assert name(np.array([row[[1, 3, 5, 7]] for row in EVERY])) == "half of the modes: the 2nd, 4th, …"
    assert name(np.array([row[1:5] for row in EVERY])) == "the first mode is missing"


def test_a_unit_and_an_order_are_recognised_together() -> None:
    result = name(2 * np.pi * np.array([row[[0, 0, 1, 1]] for row in EVERY]))
    assert result == "constant ratio 2π: rad/s given as Hz, every mode twice (conjugate pairs)"


def test_a_hollow_shaft_in_hz_instead_of_rad_per_s() -> None:
    """A free hollow shaft, Timoshenko (petrobras/ross, issue 885, 2022: "9500 here, 1600 there")."""
    exact = np.array([[9646.8, 25312.6, 46599.6]])
    hertz = np.array([[1535.3, 4028.6, 7416.5]])
    assert arithmetic(hertz, exact, (1, 2, 3), [exact[0]]).name.startswith("constant ratio 1/2π")


@pytest.mark.parametrize("size", [0.01, 0.1, 0.5])
def test_random_numbers_are_no_arithmetic(size: float) -> None:
    rng = np.random.default_rng(5)
    altered = [name(REFERENCE * np.exp(size * rng.standard_normal(REFERENCE.shape))) for _ in range(20)]
    assert altered.count("") >= 19


def test_a_mode_without_any_number_is_no_reason_for_a_warning() -> None:
    """The mean over no speeds used to print one."""
    frequencies = 2 * np.pi * REFERENCE
    frequencies[:, 2] = np.nan
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert name(frequencies).startswith("constant ratio 2π")
