"""The page of a measured rotor: every measured point is on it, and no measurement is called a contradiction."""

from collections.abc import Iterator

import pytest

from southwell.cases.judge.measured import Validation
from southwell.cases.validation import comparison, rotating_beams
from southwell.cases.validation.comparison import SPEEDS, VARIED_AT, Simulated, points
from southwell.cases.validation.points import Point
from southwell.reports.validation import page

NAMES = {"FS 1": 1.0, "FA 1": 1.02, "EA 1": 1.7, "FA 2": 2.1, "FS 2": 2.14, "EA 2": 3.5, "FS 3": 3.3, "FA 3": 3.35}


def model(u: float) -> Simulated:
    """f² = f₀² + 2 Ω² for every mode, so that interpolation is exact."""
    base = tuple({n: (f * f + 2.0 * (rpm / 60.0) ** 2) ** 0.5 for n, f in NAMES.items()} for rpm in SPEEDS)
    return Simulated(base, tuple(dict.fromkeys(NAMES, u) for _ in VARIED_AT), dict.fromkeys(NAMES, 0.0))


def test_a_point_between_the_speeds_is_where_southwells_law_puts_it() -> None:
    (first, *_), *_ = [[p for p in points(model(0.0)) if p.line == line] for line in ("1BE", "2FA")]
    assert first.rpm == 0.0
    assert first.validation.simulated == pytest.approx(1.7)
    late = [p for p in points(model(0.0)) if p.line == "1BE"][-1]
    assert late.validation.simulated == pytest.approx((1.7**2 + 2.0 * (35.1685 / 60.0) ** 2) ** 0.5, rel=1e-9)


def test_a_line_of_two_modes_is_their_mean_and_their_distance_is_uncertain() -> None:
    at_rest = next(p for p in points(model(0.0)) if p.line == "2FS")
    assert at_rest.validation.numerical == 0.0
    pair = next(p for p in points(model(0.0)) if p.line == "1F")
    assert pair.validation.simulated == pytest.approx(1.01, abs=1e-4)
    assert pair.validation.numerical == pytest.approx(0.01, abs=1e-4)


def test_every_measured_point_is_on_the_page() -> None:
    measured = points(model(0.02))
    assert len(measured) == sum(len(line["points"]) for line in comparison.data()["lines"])
    beams = {name: tuple(of_beam(name)) for name in rotating_beams.BEAMS}
    text, *drawn = page.pages(model(0.02), measured, beams).values()
    stated = text.count("| model error not visible at") + text.count("| model error visible (at")
    assert stated == len(measured) + sum(map(len, beams.values()))
    assert "contradicts" not in text.replace("does not confirm or contradict a solver", "")
    assert [figure.startswith("<svg") for figure in drawn] == [True, True]


def of_beam(name: str) -> Iterator[Point]:
    """Measured points, each simulated without an error."""
    d = rotating_beams.data()[name]
    for k, table in enumerate(d["frequencies"], 1):
        for rpm, row in zip(d["rpm"], table, strict=True):
            for sweep, f in zip(d["sweep"], row, strict=True):
                line = f"flapwise {k}, {sweep:g}°" if len(d["sweep"]) > 1 else f"flapwise {k}"
                yield Point(line, rpm, Validation(f, f, 0.0, 0.0, d["measured"]))


def test_more_input_uncertainty_shows_no_more_of_the_models_error() -> None:
    for uncertainty, vague in zip(points(model(0.0)), points(model(0.1)), strict=True):
        assert vague.validation.visible <= uncertainty.validation.visible


def test_a_mode_that_changes_its_character_is_still_the_same_mode() -> None:
    """A variation in which the second antisymmetric mode moves a little more across than along, and so is called otherwise."""
    base = {"FA 1": 1.0, "EA 1": 1.7, "FS 1": 1.1, "FA 2": 2.2, "FA 3": 3.5}
    other = {"FS 1": 1.2, "FA 1": 1.01, "EA 1": 1.72, "EA 2": 2.23, "FA 2": 3.54}
    moved = comparison.changes(base, other)
    assert moved == {
        "FA 1": pytest.approx(0.01), "EA 1": pytest.approx(0.02), "FA 2": pytest.approx(0.03), "FA 3": pytest.approx(0.04),
        "FS 1": pytest.approx(0.1),
    }  # fmt: skip
    assert comparison.changes(base, {"FA 1": 1.0})["FA 3"] == float("inf")
    assert comparison.inputs([base, other, base])["FA 2"] == pytest.approx(0.03)
