"""Case files: the shipped ones say what they should, and bad ones end in one line with file, field, value and remedy."""

from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import Mount, southwell_toml
from southwell.cases.input.schema import read, speed_range
from southwell.core.solve import modes
from southwell.references import published
from southwell.references.sampling import sample

GOOD = """
name = "mine"
title = "A beam"
description = "of mine"
source = "none"

[blade]
kind = "beam"
length = 6.0
hub_radius = 0.3
E = 7e10
G = 2.7e10
density = 3000
A = 4e-4
I_y = 2e-7
I_z = 3e-7
J = 4e-7

[speeds]
rpm = [0, 30]

[compare]
modes = 3

[discretisation]
elements = 50
mass = "half_end"
stiffness = "body_fixed"
"""

TABLE = """# comment
fraction [-],twist [deg],mass [kg/m],EI_flap [N m^2],EI_edge [N m^2],GJ [N m^2],EA [N]
0,90,2,3,4,5,6

1,0,1,3,4,5,6
"""


@pytest.fixture
def write(tmp_path: Path):
    def to_file(text: str, table: str | None = None) -> Path:
        path = tmp_path / "mine.toml"
        path.write_text(text)
        if table is not None:
            (tmp_path / "table.csv").write_text(table)
        return path

    return to_file


def from_table(text: str = GOOD) -> str:
    begin, end = text.index("[blade]"), text.index("[speeds]")
    return text[:begin] + '[blade]\nkind = "stations"\nfile = "table.csv"\nlength = 10.0\n\n' + text[end:]


def test_a_beam_is_read_in_si(write) -> None:
    case = read(write(GOOD))
    (variant,) = case.variants
    assert (case.name, variant.name) == ("mine", "mine")
    np.testing.assert_allclose(variant.speeds, [0.0, np.pi])
    section = sample(variant.blade, 3.0)
    assert (variant.blade.length, variant.blade.hub_radius) == (6.0, 0.3)
    assert section.EI_y[0] == pytest.approx(14000.0)
    assert section.EI_z[0] == pytest.approx(21000.0)
    assert section.mass[0] == pytest.approx(1.2)
    assert section.I_x[0] == pytest.approx(3000 * 5e-7)
    assert np.isinf(section.GA_y[0])


def test_a_table_is_read_with_its_units(write) -> None:
    (variant,) = read(write(from_table(), TABLE)).variants
    blade = variant.blade
    np.testing.assert_allclose(blade.stations, [0.0, 10.0])
    np.testing.assert_allclose(blade.twist, [np.pi / 2, 0.0])
    np.testing.assert_allclose(np.diagonal(blade.stiffness[0])[[0, 3, 4, 5]], [6.0, 5.0, 3.0, 4.0])
    np.testing.assert_allclose(blade.mass[:, 0, 0], [2.0, 1.0])
    assert not blade.mass[:, 3:, 3:].any()


def test_variants_repeat_only_what_differs(write) -> None:
    case = read(write(GOOD + "\n[variants.short]\nlength = 3.0\n\n[variants.long]\nlength = 12.0\n"))
    assert [(v.name, v.blade.length) for v in case.variants] == [("mine/short", 3.0), ("mine/long", 12.0)]


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("0:30:10", [0, 10, 20, 30]),
        ("0:1:0.1", np.arange(11) / 10),
        ("5:9:3", [5, 8, 9]),
        ("0:12.1:6", [0, 6, 12, 12.1]),
        ("7.5", [7.5]),
        ("2:2:1", [2]),
        ("0, 5 ,10", [0, 5, 10]),
        ("0:4:2,10", [0, 2, 4, 10]),
    ],
)
def test_speed_ranges_include_both_ends(text: str, values: list[float]) -> None:
    np.testing.assert_allclose(speed_range(text), values, atol=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        *("", "0:30", "fast", "0:30:0", "0:30:-5", "30:0:5", "-5:5:1", "0:inf:1", "nan:1:1", "0:1e6:1e-3"),
        *("0,", "0,x", "0,-1", "5,0", "0,0"),
    ],
)
def test_impossible_speeds_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"0:30:5|ascending"):
        speed_range(text)


BAD = [
    ("length = 6.0", "length = 1e5", ["blade.length: 100000.0", "<= 10000"]),
    ("length = 6.0", "length = 1e300", ["blade.length: 1e+300", "check the exponent"]),
    ('kind = "beam"', 'kind = "baem"', ["blade.kind: 'baem'", "did you mean beam?"]),
    ("modes = 3", "modes = 101", ["compare.modes: 101", "<= 100"]),
    ("modes = 3", 'modes = 3\nmotions = ["flap"]', ["compare.motions[0]: 'flap'", "did you mean flapwise?"]),
    ("[speeds]", "[speeds", ["not TOML", "line 19", "correct"]),
    ("length = 6.0", "lenght = 6.0", ["blade.lenght", "unknown key", "did you mean length?"]),
    ("modes = 3", "modes = 3\nmotion = 4", ["compare.motion", "did you mean motions?"]),
    ("[compare]", "[comparison]", ["comparison: unknown key: did you mean compare?"]),
    ("length = 6.0", "length = 1e-15", ["blade: length: 1e-15 m", "check the unit"]),
    ("E = 7e10", "E = 1e-320", ["blade: stiffness: diagonal", "must be positive"]),
    ('name = "', 'name = "K', ["name: 'K", "capital letters", "write 'k"]),
    ("length = 6.0", "length = -6.0", ["blade.length: -6.0", "> 0.0", "check sign, unit and type"]),
    ("length = 6.0", "length = nan", ["blade.length: nan", "not a finite number"]),
    ("E = 7e10", "E = inf", ["blade.E: inf", "not a finite number"]),
    ("length = 6.0", 'length = "6 m"', ["blade.length: '6 m'", "expected float, got str"]),
    ("hub_radius = 0.3", "hub_radius = -1", ["blade.hub_radius: -1", ">= 0"]),
    ("J = 4e-7", "", ["G and J: give both, or neither"]),
    ('kind = "beam"', 'kind = "plate"', ["blade.kind: 'plate'"]),
    ('name = "mine"', "", ["name: missing"]),
    ('name = "mine"', 'name = "my case"', ["name: 'my case'"]),
    ("elements = 50", "elements = 0", ["discretisation.elements: 0", ">= 1"]),
    ('mass = "half_end"', 'mass = "lumped"', ["discretisation.mass: 'lumped'"]),
    ("rpm = [0, 30]", "rpm = []", ["speeds.rpm: empty", "give at least one speed"]),
    ("rpm = [0, 30]", "", ["speeds: none given: give exactly one of rad_s, rpm, gamma"]),
    ("rpm = [0, 30]", "rpm = [0]\nrad_s = [0]", ["speeds: rad_s, rpm given: give exactly one"]),
    ("rpm = [0, 30]", "rpm = [-1, 30]", ["speeds.rpm[0]: -1", ">= 0"]),
    ("rpm = [0, 30]", "rpm = [0, nan]", ["speeds.rpm[1]: nan"]),
    ("rpm = [0, 30]", "rpm = [30, 0]", ["speeds.rpm: [30.0, 0.0]", "not ascending"]),
    ("rpm = [0, 30]", "rpm = [5, 5]", ["speeds.rpm: [5.0, 5.0]", "remove duplicates"]),
    ("rpm = [0, 30]", 'rpm = "0:-5:1"', ["speeds.rpm: '0:-5:1'", "0 ≤ first ≤ last"]),
    ("rpm = [0, 30]", "gamma = [0, 1]", ['speeds.gamma: requires blade.kind = "dimensionless"']),
    ("[speeds]\nrpm = [0, 30]", "", ["speeds: missing"]),
    ("modes = 3", "modes = 0", ["compare.modes: 0"]),
    ("modes = 3", 'modes = 3\nmotions = ["sideways"]', ["compare.motions[0]: 'sideways'"]),
    ("modes = 3", "modes = 3\nmotions = []", ["compare.motions: []"]),
    (
        "[discretisation]",
        "[variants.x]\nlenght = 2\n[discretisation]",
        ["variants.x: blade.lenght", "did you mean length?"],
    ),
    ("[discretisation]", "[variants.x]\nlength = -2\n[discretisation]", ["variants.x: blade.length: -2"]),
]


@pytest.mark.parametrize(
    ("old", "new", "phrase"), BAD, ids=[" ".join(new.split()) or f"no {old}" for old, new, _ in BAD]
)
def test_invalid_input_is_reported_in_one_line(write, old: str, new: str, phrase: list[str]) -> None:
    assert GOOD.count(old) >= 1
    path = write(GOOD.replace(old, new, 1))
    with pytest.raises(CaseError) as caught:
        read(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    for part in phrase:
        assert part in message


BAD_TABLES = [
    (None, ["table.csv: no such file", "relative to its file"]),
    ("", ["empty: check that it was written to the end"]),
    ("# only this\n", ["only comments"]),
    (TABLE.replace("0,90", "0.5,90").replace("\n1,0", "\n0.2,0"), ["fraction [-]: last is 0.2"]),
    (TABLE.replace("0,90", "0.5,90"), ["stations: first is 5 m"]),
    (TABLE.replace("\n1,0", "\n0.7,0,1,3,4,5,6\n0.3,0,1,3,4,5,6\n1,0"), ["stations: number 2 (3 m)", "sort them"]),
    (TABLE.replace("\n1,0", "\n1,0,1,3,4,5,6\n1,0"), ["stations: number 2 (10 m)", "remove duplicates"]),
    (TABLE.replace("90,2", "90,nan"), ["line 3: mass [kg/m]: nan", "not a finite number"]),
    (TABLE.replace("90,2", "90,two"), ["line 3: mass [kg/m]: 'two' is not a number"]),
    (TABLE.replace("90,2", "90,"), ["line 3: mass [kg/m]: '' is not a number"]),
    (TABLE.replace("0,1,3", "0,3"), ["line 5: 6 columns instead of 7", "comma"]),
    (
        TABLE.replace("90,2,3", "90,2,-3"),
        ["stiffness: diagonal 4 (bending about y) at station 0 (0 m) is -3", "positive"],
    ),
    (TABLE.replace("mass [kg/m]", "mass [lb/ft]"), ["unknown column 'mass [lb/ft]': did you mean mass [kg/m]?"]),
    (TABLE.split("\n1,0")[0], ["rows: 1: at least two"]),
]


@pytest.mark.parametrize(("table", "phrase"), BAD_TABLES, ids=[phrase[0] for _, phrase in BAD_TABLES])
def test_invalid_tables_are_reported_in_one_line(write, table: str | None, phrase: list[str]) -> None:
    path = write(from_table(), table)
    with pytest.raises(CaseError) as caught:
        read(path)
    message = str(caught.value)
    assert message.startswith(str(path.parent / "table.csv"))
    assert "\n" not in message
    for part in phrase:
        assert part in message


def test_an_unknown_case_is_named_and_the_nearest_suggested() -> None:
    with pytest.raises(CaseError, match="case: 'park-cantilver' is not known: did you mean park-cantilever"):
        library.load("park-cantilver")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"nowhere\.toml: no such file"):
        library.load(str(tmp_path / "nowhere.toml"))


def test_every_shipped_case_is_read_and_named_as_its_file() -> None:
    assert set(library.names()) >= {"park-cantilever", "park-blade", "yoo-shin-chordwise", "wright-flapwise"}
    for name, case in library.load_all()[0].items():
        assert case.name == name
        assert all(v.blade.name == v.name for v in case.variants)


def test_the_windpact_blade_has_its_published_data() -> None:
    """WindPACT 3.0 MW: 21 stations, tip radius 49.5 m, twist 11.1° at the root; variants differ in what they say."""
    windpact, surrogate, untwisted = (v.blade for v in library.load("park-blade").variants)
    assert len(windpact.stations) == 21
    assert windpact.hub_radius + windpact.length == pytest.approx(49.5)
    assert surrogate.stiffness[:, 4, 4] == pytest.approx(1.3 * windpact.stiffness[:, 4, 4])
    assert surrogate.stiffness[:, 0, 0] == pytest.approx(windpact.stiffness[:, 0, 0])
    assert not untwisted.twist.any()
    assert windpact.twist[0] == pytest.approx(np.radians(11.1))


def test_missing_axial_and_torsional_stiffness_is_rigid_and_noted(tmp_path: Path) -> None:
    """Many published blades have neither; bending is that of the complete table, whose stiffness is large."""
    table = "fraction [-],twist [deg],mass [kg/m],EI_flap [N m^2],EI_edge [N m^2]\n0,0,3,48,96\n1,0,3,48,96\n"
    (tmp_path / "blade.csv").write_text(table)
    read = southwell_toml.read(tmp_path / "blade.csv", Mount(length=2.0))
    assert np.isinf(read.blade.stiffness[:, [0, 3], [0, 3]]).all()
    assert "axial and torsional stiffness not given: treated as rigid" in read.source.notes
    complete = table.replace("^2]\n", "^2],GJ [N m^2],EA [N]\n").replace("48,96\n", "48,96,1e9,1e12\n")
    (tmp_path / "complete.csv").write_text(complete)
    stiff = southwell_toml.read(tmp_path / "complete.csv", Mount(length=2.0))
    assert not any("rigid" in note and "not given" in note for note in stiff.source.notes)
    first, second = (modes(b.blade, 3.0, 20, 3).frequencies for b in (read, stiff))
    np.testing.assert_allclose(first, second, rtol=1e-6)


def test_a_beam_without_shear_modulus_and_torsion_constant_is_rigid_in_torsion(tmp_path: Path) -> None:
    path = tmp_path / "beam.toml"
    section = "E = 1e9\ndensity = 1e3\nA = 1e-3\nI_y = 1e-8\nI_z = 1e-8\n"
    path.write_text(f'name = "b"\n[blade]\nkind = "beam"\nlength = 2\n{section}')
    read = southwell_toml.read(path)
    assert np.isinf(read.blade.stiffness[:, 3, 3]).all()
    assert "torsional stiffness not given: treated as rigid" in read.source.notes


def test_a_published_table_is_given_by_its_path(write, tmp_path: Path) -> None:
    """The rotating cantilever of Wright et al. (1982, Table 3a), hub ratio 0 and speed 6: 7.3604."""
    (tmp_path / "wright.toml").write_text(
        'citation = "Wright et al. (1982), Table 3a"\nbeam = "b"\nunit = "dimensionless"\nscale = "s"\n'
        '[[series]]\nname = "exact"\ntitle = "t"\nprovenance = "p"\ndescription = "d"\nlacks = []\n'
        'data = [{ family = "flapwise", mode = 1, speed = 6, printed = "7.3604" }]\n'
    )
    head = 'name = "own"\ntitle = "t"\ndescription = "d"\nsource = "s"\n'
    text = head + '[blade]\nkind = "dimensionless"\nslenderness = 1e4\n[speeds]\ngamma = [0, 6]\n'
    compare = '[compare]\nmodes = 1\ntables = ["wright.toml"]\ngroups = 1\n'
    (table,) = read(write(text + compare)).text.compare.tables
    assert table == str(tmp_path / "wright.toml")
    assert published.label(table) == "wright"
    assert published.load(table).series[0].data[0].printed == "7.3604"
    with pytest.raises(CaseError, match=r"other\.toml: no such file"):
        read(write(text + compare.replace("wright", "other")))
    (tmp_path / "wright.toml").write_text("citation = 1\n")
    with pytest.raises(CaseError, match=r"compare\.tables: .*wright\.toml"):
        read(write(text + compare))
