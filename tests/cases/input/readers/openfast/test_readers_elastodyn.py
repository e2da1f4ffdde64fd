"""ElastoDyn blades: an invented file worked out by hand, the NREL 5-MW blade against its report, files that are wrong."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import readers
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers import Mount
from southwell.cases.input.readers.openfast import elastodyn
from southwell.core.sampling import mass_at
from southwell.tests.support.blade_files import assert_same, real

DATA = Path(__file__).parents[4] / "data" / "blades"
BLADE, MAIN = DATA / "elastodyn_blade.dat", DATA / "elastodyn_main.dat"
MOUNT = Mount(length=50.0, hub_radius=2.0)


def test_every_number_of_the_file_is_in_its_field() -> None:
    blade = elastodyn.read(BLADE, MOUNT).blade
    np.testing.assert_allclose(blade.stations, [0, 10, 25, 40, 50])
    d = np.diagonal(blade.stiffness, axis1=1, axis2=2)
    np.testing.assert_allclose(d[:, 4], 1.5 * np.array([1.8e10, 4e9, 6e8, 7e7, 2e6]))  # flap, AdjFlSt
    np.testing.assert_allclose(d[:, 5], 0.75 * np.array([1.85e10, 7.2e9, 2.6e9, 6.4e8, 2.2e7]))  # edge, AdjEdSt
    assert np.isinf(d[:, :4]).all()
    np.testing.assert_allclose(blade.mass[:, 0, 0], 1.25 * np.array([700, 410, 260, 120, 15]))  # AdjBlMs
    assert not blade.mass[:, 3:].any()
    np.testing.assert_allclose(np.degrees(blade.twist), [-12.5, -11, -6.5, -2.25, 0])  # leading edge upwind: −z


def test_other_multipliers_can_be_given() -> None:
    reading = readers.reading(BLADE, replace(MOUNT, multipliers=(1.0, 3.0, 1.5)))
    own = readers.reading(BLADE, MOUNT)
    np.testing.assert_allclose(reading.blade.mass[0, 0, 0], 700)
    np.testing.assert_allclose(reading.blade.mass, own.blade.mass / 1.25)
    held = reading.blade.stiffness[:, 4:, 4:] / np.where(np.eye(2), own.blade.stiffness[:, 4:, 4:], 1)
    np.testing.assert_allclose(held, np.diag([2.0, 2.0])[None].repeat(len(held), axis=0))
    assert "AdjBlMs = 1.25, AdjFlSt = 1.5, AdjEdSt = 0.75: replaced by 1, 3, 1.5" in reading.source.notes


def test_multipliers_of_another_format_are_refused() -> None:
    with pytest.raises(CaseError, match=r"hawc2.htc: multipliers: HAWC2 files have no such option, ElastoDyn files do"):
        readers.read(DATA / "hawc2.htc", Mount(multipliers=(1.0, 1.0, 1.0)))


@pytest.mark.parametrize("path", [BLADE, MAIN])
def test_the_hub_is_the_main_files_whichever_is_named(path: Path) -> None:
    """The blade file alone is found to be named by the main file beside it."""
    reading = readers.reading(path)
    assert (reading.blade.length, reading.blade.hub_radius) == (50.0, 2.0)
    assert np.degrees(reading.blade.precone) == pytest.approx(-2.5)  # upwind
    assert reading.blade.pitch == 0.0  # BlPitch is the initial pitch of a simulation: listed, not used
    (pitch,) = [u for u in reading.source.unused if u.name == "BlPitch"]
    assert (pitch.largest, pitch.unit) == (3.0, "deg")
    np.testing.assert_allclose(np.diag(reading.blade.tip_mass), [40, 40, 40, 0, 0, 0])
    assert {p.name for p in reading.source.files} == {BLADE.name, MAIN.name}


def test_options_take_precedence_over_the_main_file() -> None:
    blade = readers.read(BLADE, Mount(main=MAIN, hub_radius=3.0, precone=0.1))
    assert (blade.length, blade.hub_radius, blade.precone) == (50.0, 3.0, 0.1)


def test_two_main_files_that_name_a_blade_are_ambiguous(tmp_path: Path) -> None:
    for name in ("a.dat", "b.dat"):
        (tmp_path / name).write_text(MAIN.read_text())
    (tmp_path / BLADE.name).write_text(BLADE.read_text())
    with pytest.raises(CaseError, match=r"2 main files in its folder name it \(a.dat, b.dat\): choose one with --main"):
        readers.read(tmp_path / BLADE.name)


def test_other_files_in_the_folder_are_ignored(tmp_path: Path) -> None:
    """Output of a run, an empty file, and another machine's main file that is cut short."""
    for path in (BLADE, MAIN):
        (tmp_path / path.name).write_text(path.read_text())
    (tmp_path / "a.dat").write_bytes(b"\0\1")
    (tmp_path / "b.dat").write_bytes(b"")
    (tmp_path / "c.dat").write_text('52 TipRad\n2 HubRad\n"other.dat" BldFile1\n')
    assert readers.read(tmp_path / BLADE.name).hub_radius == 2.0


def test_fast_7_columns_give_stretch_torsion_and_moments_of_inertia(tmp_path: Path) -> None:
    lines = BLADE.read_text().splitlines()
    head = next(k for k, line in enumerate(lines) if "BlFract" in line)
    lines[head] += " GJStff EAStff FlpIner EdgIner"
    lines[head + 2 : head + 7] = [
        f"{line} {1e8 - k} {2e9 - k} {3 + k} {4 + k}" for k, line in enumerate(lines[head + 2 : head + 7])
    ]
    (tmp_path / "b.dat").write_text("\n".join(lines))
    blade = readers.read(tmp_path / "b.dat", MOUNT)
    np.testing.assert_allclose(blade.stiffness[:, 3, 3], 1e8 - np.arange(5))
    np.testing.assert_allclose(blade.stiffness[:, 0, 0], 2e9 - np.arange(5))
    np.testing.assert_allclose(blade.mass[:, 4, 4], 3.0 + np.arange(5))  # about y: flap
    np.testing.assert_allclose(blade.mass[:, 5, 5], 4.0 + np.arange(5))
    np.testing.assert_allclose(blade.mass[:, 3, 3], 7.0 + 2 * np.arange(5))


NODES = np.array([2.8667, 5.6, 8.3333, *np.arange(11.75, 53, 4.1), 56.1667, 58.9, 61.6333])
WIDTHS = np.array([2.7333] * 3 + [4.1] * 11 + [2.7333] * 3)


def test_nrel_5mw_has_the_mass_and_moments_of_its_report() -> None:
    """17,740 kg, 363,231 kg m, 11,776,047 kg m² about the root (J. Jonkman et al., NREL/TP-500-38060, 2009, Table 2-2).

    The report's AdjBlMs of 1.04536 was chosen for FAST's sums over the 17 nodes of Table 3-1, which are made here; the
    widths are printed to 0.1 mm, which leaves 4e-6 of the second moment open. The integral of the table is 0.7 % less.
    """
    blade = elastodyn.read(real("nrel5mw/NRELOffshrBsline5MW_Blade.dat"), Mount(length=61.5, hub_radius=1.5)).blade
    lumps, s = mass_at(blade, NODES - 1.5)[:, 0, 0] * WIDTHS, NODES - 1.5
    assert lumps.sum() == pytest.approx(17740, abs=0.5)
    assert lumps @ s == pytest.approx(363231, abs=0.5)
    assert lumps @ s**2 == pytest.approx(11776047, rel=4e-6)


def test_decks_that_come_with_pybmodes_are_read_as_it_reads_them() -> None:
    pybmodes = pytest.importorskip("pybmodes")
    decks = sorted((Path(pybmodes.__file__).parent / "_examples" / "reference_decks").glob("*/*ElastoDyn.dat"))
    assert len(decks) >= 5
    from pybmodes.io.elastodyn_reader import read_elastodyn_blade, read_elastodyn_main

    for deck in decks:
        content = elastodyn.read(deck)
        main = read_elastodyn_main(deck)
        expected = read_elastodyn_blade(content.source.files[0])
        assert content.blade.length == pytest.approx(main.tip_rad - main.hub_rad, rel=1e-14)
        np.testing.assert_allclose(content.blade.stiffness[:, 4, 4], expected.adj_fl_st * expected.flp_stff, rtol=1e-14)
        np.testing.assert_allclose(content.blade.mass[:, 0, 0], expected.adj_bl_ms * expected.b_mass_den, rtol=1e-14)


def edited(tmp_path: Path, old: str, new: str, count: int = 1) -> Path:
    text = BLADE.read_text()
    assert old in text
    path = tmp_path / "bad.dat"
    path.write_bytes(text.replace(old, new, count).encode())
    return path


@pytest.mark.parametrize(
    ("change"),
    [
        ("\n", "\r\n", -1),
        ("  ", "\t", -1),
        ("7.0000000E+02", "7.0D+02", 1),
        ("7.0000000E+02", "700.", 1),
        (" - Number of blade input stations (-)", "", 1),
        ("---------------------- DISTRIBUTED BLADE PROPERTIES ----------------------------\n", "", 1),
        ("      (-)           (-)          (deg)          (kg/m)         (Nm^2)         (Nm^2)\n", "", 1),
    ],
    ids=["CRLF", "tabs", "Fortran", "plain", "comment", "ruler", "units"],
)
def test_other_layouts_of_the_file_give_the_same_blade(tmp_path: Path, change: tuple[str, str, int]) -> None:
    assert_same(elastodyn.read(edited(tmp_path, *change), MOUNT).blade, elastodyn.read(BLADE, MOUNT).blade)


BAD = {
    "count too large": (
        ("          5   NBlInp", "          6   NBlInp"),
        r"bad.dat: line 22: the table ends after 5 of 6 rows",
    ),
    "count too small": (
        ("          5   NBlInp", "          4   NBlInp"),
        r"line 21: another row after the 4 announced",
    ),
    "count not whole": (("          5   NBlInp", "        4.5   NBlInp"), r"line 4: NBlInpSt: 4.5: it is a count"),
    "column missing": (("3.7500000E-01  6.5", "6.5"), r"line 19: 5 numbers instead of 6 .*check for a missing"),
    "column too many": (("1.2500000E+01", "1 2.5"), r"line 17: 7 numbers instead of 6"),
    "not a number": (("2.6000000E+02", "26O"), r"line 19: 3 numbers instead of 6 .*'26O' is not a number"),
    "NaN": (("2.6000000E+02", "NaN"), r"line 19: BMassDen: NaN: not a finite number: fill gaps"),
    "overflow": (("2.6000000E+02", "1E999"), r"line 19: BMassDen: 1E999: not a finite number"),
    "negative stiffness": (("6.0000000E+08", "-6.0E+08"), r"line 19: FlpStff: -6e\+08: it must be positive"),
    "no mass": (("2.6000000E+02", "0.0"), r"line 19: BMassDen: 0: it must be positive"),
    "not from 0": (("0.0000000E+00  2.5", "0.1E+00  2.5"), r"line 17: BlFract: 0.1: .*begin at 0 and end at 1"),
    "not to 1": (("1.0000000E+00  3.75", "0.9E+00  3.75"), r"line 21: BlFract: 0.9: .*begin at 0 and end at 1"),
    "duplicate": (
        ("5.0000000E-01", "2.0E-01"),
        r"line 19: BlFract: 0.2: not beyond the previous station: sort them",
    ),
    "no farther than rounding": (
        ("2.0000000E-01  3.0", "1e-300  3.0"),
        r"line 18: BlFract: 1e-300: not beyond the previous station",
    ),
    "no name": (("AdjBlMs ", ""), r"bad.dat: AdjBlMs: missing: give the whole file"),
    "multiplier": (("1.5   AdjFlSt", "-1   AdjFlSt"), r"line 12: AdjFlSt: -1: a factor must be positive"),
    "multiplier no number": (("1.5   AdjFlSt", "one   AdjFlSt"), r"line 12: AdjFlSt: 'one' is not a finite number"),
    "no column": (("StrcTwst ", "Twist "), r"line 15: no column StrcTwst"),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_files_are_refused_with_line_and_value(tmp_path: Path, kind: str) -> None:
    (old, new), message = BAD[kind]
    with pytest.raises(CaseError, match=message) as caught:
        elastodyn.read(edited(tmp_path, old, new), MOUNT)
    assert "\n" not in str(caught.value)


def test_a_truncated_file(tmp_path: Path) -> None:
    text = BLADE.read_text()
    path = tmp_path / "cut.dat"
    path.write_text(text[: text.index("5.0000000E-01")])
    with pytest.raises(CaseError, match=r"cut.dat: line 18: the table ends after 2 of 5 rows: give all rows"):
        elastodyn.read(path, MOUNT)
    path.write_text(text[: text.index("6.0000000E+08")])
    with pytest.raises(CaseError, match="line 19: 4 numbers instead of 6"):
        elastodyn.read(path, MOUNT)


def test_a_file_without_length_is_refused(tmp_path: Path) -> None:
    (tmp_path / "alone.dat").write_text(BLADE.read_text())
    with pytest.raises(CaseError, match=r"length: .*give --main FILE, or --length and --hub-radius"):
        readers.read(tmp_path / "alone.dat")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "empty"),
        (b"\0\1\2", "not a text file"),
        (b"three blind mice\n1 2 3\n", "not a blade file of a known format"),
    ],
)
def test_other_files(tmp_path: Path, content: bytes, message: str) -> None:
    (tmp_path / "other.dat").write_bytes(content)
    with pytest.raises(CaseError, match=message):
        readers.read(tmp_path / "other.dat")
    with pytest.raises(CaseError, match="no such file"):
        readers.read(tmp_path / "none.dat")
