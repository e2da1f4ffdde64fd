"""The printed tables: read as written, and compared with exact computation digit by digit."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.solve.published_tables import UNITS
from southwell.core.blade import Blade, uniform_blade
from southwell.core.effects import ALL_EFFECTS, Effects
from southwell.core.modes import Modes
from southwell.core.solve import mesh_modes
from southwell.references import published
from southwell.references.published import Datum, Series, TableError
from southwell.references.theories import assumed_modes, yoo_shin

from ..support import tapered_beams
from ..support.straight_blades import X, Y, Z, family, park

COLUMN = {"edgewise": Y, "flapwise": Z, "axial": X}

DATA = [
    (name, series, datum)
    for name in published.names()
    for series in published.load(name).series
    for datum in series.data
]
EXACT = [entry for entry in DATA if not entry[1].target]
COARSE = [entry for entry in DATA if entry[1].target and entry[1].blade]  # those of decks: test_deck_tables
SUSPECTS = [entry for entry in DATA if entry[2].suspect]


def ids(value: str | Series | Datum) -> str:
    if isinstance(value, Datum):
        return f"{value.family}{value.mode}-{value.speed:g}"
    return value if isinstance(value, str) else value.name


def blade_of(name: str, series: Series) -> Blade:
    """The beam of a series; that of the paper is identified from its digits."""
    if name == "park2010":
        return park()
    blade = uniform_blade(
        name, 1.0, series.hub_ratio, EA=(series.slenderness or 1e3) ** 2, GJ=1.0, EI_y=1.0, EI_z=1.0, mass=1.0
    )
    return replace(blade, tip_mass=series.tip_mass_ratio * np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]))


def computed(name: str, series: Series, datum: Datum) -> float:
    """The frequency computed with the model of the series."""
    if series.tapered:
        return float(tapered_beams.exact(series.height_taper, series.breadth_taper, datum.speed)[datum.mode - 1])
    solved = solved_modes(name, published.load(name).series.index(series), datum.speed)
    return float(family(solved, COLUMN[datum.family])[datum.mode - 1])


@cache
def solved_modes(name: str, number: int, speed: float) -> Modes:
    """By the code with the model of the series; the paper's column by core with the paper's discretisation."""
    series = published.load(name).series[number]
    blade = blade_of(name, series)
    if (name, series.name) == ("park2010", "present"):
        return mesh_modes(blade, speed, 50, 8, mass="half_end", stiffness="body_fixed", effects=series.effects)
    code = {c.effects: c for c in (assumed_modes.CODE, yoo_shin.CODE)}[series.effects]
    return code.solve(blade, speed, 32, 10)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "series", "datum"), COARSE, ids=ids)
def test_a_datum_of_a_coarse_method_is_within_its_target(name: str, series: Series, datum: Datum) -> None:
    case, _, _ = series.blade.partition("/")
    blade = next(v.blade for v in library.load(case).variants if v.name == series.blade)
    unit, speed = UNITS[published.load(name).unit]
    solution = mesh_modes(blade, datum.speed * speed, 120, 8, effects=series.effects)
    value = family(solution, COLUMN[datum.family])[datum.mode - 1] / unit
    assert abs(datum.value / value - 1.0) < (series.target or 0.0)


@pytest.mark.parametrize(("name", "series", "datum"), EXACT, ids=ids)
def test_a_datum_is_right_to_its_last_digit_or_suspect(name: str, series: Series, datum: Datum) -> None:
    """Within half a unit, or marked suspect; none within half a unit is marked."""
    off = abs(computed(name, series, datum) - datum.value) > datum.half_unit
    assert off == datum.suspect


@pytest.mark.parametrize(("name", "series", "datum"), SUSPECTS, ids=ids)
def test_evidence_gives_the_computed_value(name: str, series: Series, datum: Datum) -> None:
    value = computed(name, series, datum)
    assert any(f"{value:.{digits}f}" in datum.evidence for digits in (5, 6))


def test_the_solver_rounds_to_the_digits_of_hodges_and_rutkowski() -> None:
    """Core is independent of the code that checks the digits; to one unit of the last digit, with 1601 stations."""
    (series,) = published.load("hodges_rutkowski1981").series
    solution = mesh_modes(tapered_beams.blade(series.height_taper, 0.0), 12.0, 50, 8, effects=series.effects)
    printed = [datum.value for datum in series.data if datum.speed == 12]
    np.testing.assert_allclose(family(solution, Z)[:3], printed, rtol=0, atol=1e-4)


@pytest.mark.parametrize(("height", "breadth"), [(0.8, 0.8), (0.0, 0.8)])
def test_core_and_the_series_agree_on_double_tapers(height: float, breadth: float) -> None:
    """Including the value misprinted as 38.4920."""
    effects = Effects(prestretch=False, coriolis=False, rotary_inertia=False)
    result = family(mesh_modes(tapered_beams.blade(height, breadth), 0.0, 50, 8, effects=effects), Z)[:3]
    np.testing.assert_allclose(result, tapered_beams.exact(height, breadth, 0.0)[:3], rtol=2e-6)


def test_the_yoo_shin_digits_are_truncated() -> None:
    """As the notes of that table state for its ten values up to speed 10."""
    series = published.load("yoo_shin1998").series[0]
    slow = [datum for datum in series.data if datum.speed <= 10]
    assert len(slow) == 10
    for datum in slow:
        assert np.floor(1e4 * computed("yoo_shin1998", series, datum)) / 1e4 == pytest.approx(datum.value, abs=1e-9)


@pytest.mark.parametrize("name", published.names())
def test_no_datum_is_duplicated(name: str) -> None:
    for series in published.load(name).series:
        keys = [(d.family, d.mode, d.speed) for d in series.data]
        assert len(keys) == len(set(keys))
    assert len({s.name for s in published.load(name).series}) == len(published.load(name).series)


@pytest.mark.parametrize(
    ("printed", "value", "half_unit"), [("189.7", 189.7, 0.05), ("4.9700", 4.97, 5e-5), ("12", 12.0, 0.5)]
)
def test_rounding_is_half_a_unit_of_the_last_digit(printed: str, value: float, half_unit: float) -> None:
    datum = Datum(family="edgewise", mode=1, speed=0.0, printed=printed)
    assert datum.value == value
    assert datum.half_unit == pytest.approx(half_unit, rel=1e-15)


def test_a_series_declares_the_effects_it_lacks() -> None:
    park2010 = published.load("park2010")
    assert park2010.series[1].effects == Effects(prestretch=False, rotary_inertia=False)
    assert replace(park2010.series[0].effects, rotary_inertia=True) == ALL_EFFECTS


GOOD = """
citation = "A. Author, 2000"
beam = "a beam"
unit = "rad/s"
scale = "as printed"
[[series]]
name = "a"
title = "A"
provenance = "read"
description = "exact"
lacks = []
hub_ratio = 0.0
data = [{ family = "edgewise", mode = 1, speed = 10, printed = "11.71" }]
"""


def test_a_valid_file_is_read() -> None:
    assert published.parse(GOOD, "good.toml").series[0].data[0].value == 11.71


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('beam = "a beam"', 'beam = "a beam"\nbream = "a fish"', ["bream"]),
        ('scale = "as printed"', "", ["scale"]),
        ("mode = 1", "mode = 0", ["data[0].mode"]),
        ('printed = "11.71"', "printed = 11.71", ["data[0].printed"]),
        ('printed = "11.71"', 'printed = "11,71"', ["data[0].printed"]),
        ('printed = "11.71"', 'printed = "11.71", suspect = true', ["evidence"]),
        ('printed = "11.71"', 'printed = "11.71", colour = "red"', ["colour"]),
        ("lacks = []", 'lacks = ["gravity"]', ["lacks", "gravity"]),
        ('family = "edgewise"', 'family = "sideways"', ["family", "sideways"]),
        ('unit = "rad/s"', 'unit = "Hz"', ["unit", "Hz"]),
        ("lacks = []", "lacks = []\ntarget = 0.02", ["target", "grounds"]),
        ("lacks = []", "lacks = [", ["line"]),
    ],
)
def test_an_invalid_file_is_an_error(old: str, new: str, words: list[str]) -> None:
    assert old in GOOD
    with pytest.raises(TableError) as reported:
        published.parse(GOOD.replace(old, new), "bad.toml")
    message = str(reported.value)
    assert message.startswith("bad.toml: ")
    assert "\n" not in message
    assert all(word in message for word in words)


def test_an_unknown_table_is_an_error_that_suggests_the_nearest() -> None:
    with pytest.raises(TableError, match="'park2011' is not known: did you mean park2010"):
        published.load("park2011")
    with pytest.raises(TableError, match="give one of bir2010, bmodes3"):
        published.load("xyz")


def test_a_table_in_a_file_is_named_by_its_stem() -> None:
    assert published.label("tables/rig.toml") == "rig"
    assert published.label("park2010") == "park2010"
