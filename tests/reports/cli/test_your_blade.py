"""A blade file from the command line: changes, margins as a status, verification without a case file."""

import re
from dataclasses import replace
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from southwell.cases.campbell.sweep import NamedMode
from southwell.cases.campbell.tracked import TrackedMode
from southwell.cases.input.blades import offset
from southwell.cases.judge.results import Control
from southwell.cases.store import results_file
from southwell.core.blade import uniform_blade
from southwell.references.protocol import registry
from southwell.reports.cli.blade import show
from southwell.reports.shared import sheets, table_columns
from southwell.reports.shared.units import RPM
from southwell.reports.verification import terminal

from ...support import samples
from .test_cli import southwell

DECK = Path(__file__).parents[3] / "examples" / "nrel-5mw-blade.dat"
BLADE = f"{DECK} --length 61.5 --hub-radius 1.5"


def test_a_heavier_blade_is_slower_by_the_square_root(capsys: pytest.CaptureFixture[str]) -> None:
    """ω ∝ 1/√m at rest: 1/1.1 − 1 = −9.09 % of every mode."""
    status, out, _ = southwell(f"modes {BLADE} --rpm 0 --modes 4 --set mass=*1.21 --against {DECK}", capsys)
    assert status == 0
    table = out[out.index("Changes against") :]
    assert re.findall(r"([−+][\d.]+) %", table) == ["−9.09"] * 4
    assert max(map(len, table.splitlines())) <= 80


def test_a_tiny_change_has_significant_digits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """ω ∝ 1/√m at rest: a mass larger by 2e-9 changes every frequency by −1e-9, which is not "+0.00 %"."""
    _, out, _ = southwell(f"modes {BLADE} --rpm 0 --modes 2 --set mass=*1.000000002 --against {DECK}", capsys)
    assert re.findall(r"(\S+) %  \S+ %", out[out.index("Changes against") :]) == ["−1.00e-07"] * 2


def test_stiffer_in_flap_moves_flapwise_modes_only_little_of_the_others(capsys: pytest.CaptureFixture[str]) -> None:
    """√1.1 − 1 = 4.88 % bounds every change; a twisted blade's edgewise modes have a little of it."""
    _, out, _ = southwell(f"modes {BLADE} --rpm 0,12.1 --modes 2 --set 'EI_flap=*1.1' --against {DECK}", capsys)
    rows = re.findall(r"^ (\w+ 1) +([\d.]+) .*\+([\d.]+) %", out[out.index("Changes against") :], re.M)
    change = {(name, speed): float(value) for name, speed, value in rows}
    assert 4.5 < change["flapwise 1", "0"] < 4.88
    assert 3.0 < change["flapwise 1", "12.1"] < change["flapwise 1", "0"]
    assert 0.0 < change["edgewise 1", "0"] < 0.3


@pytest.mark.slow
@pytest.mark.parametrize(("per_rev", "expected"), [("1:6", 1), ("1", 0)])
def test_strict_turns_a_violated_margin_into_the_status(
    per_rev: str, expected: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    line = f"campbell {BLADE} --rpm 0:12.1:6 --operating 6.9:12.1 --margin 10 --modes 2 --elements 12 -o {tmp_path}"
    if expected:
        assert southwell(f"{line} --per-rev {per_rev}", capsys)[0] == 0
    status, out, _ = southwell(f"{line} --per-rev {per_rev} --strict", capsys)
    assert status == expected
    assert ("✘ At 6.9 to 12.1 rpm" in out) == bool(expected)


@pytest.mark.slow
def test_a_blade_file_is_verified_without_a_case(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = f"--rpm 0,12.1 --codes assumed-modes --faults none --out {tmp_path}"
    status, out, _ = southwell(f"verify {BLADE} {options}", capsys)
    assert status == 0, out
    run = results_file.read(tmp_path / "results.jsonl")
    cells = [c for c in run.cells if c.code == "assumed-modes"]
    assert len(cells) == 12
    assert {c.verdict for c in cells} == {"pass"}
    assert {c.target for c in cells} == {1e-3}
    (setting,) = run.settings
    assert (setting.unit, setting.facts["length"], setting.facts["speeds"]) == ("rpm", "61.5 m", "0, 12.1 rpm")
    assert "PitchAxis" in setting.facts["in its files, not used"]


@pytest.mark.slow
def test_a_changed_case_says_so_and_is_not_compared_with_its_printed_table(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    line = f"verify tip-mass --codes exact-beam --faults none --set mass=*1.1 --out {tmp_path}"
    assert southwell(line, capsys)[0] == 0
    run = results_file.read(tmp_path / "results.jsonl")
    assert run.settings[0].title.endswith("changed: mass × 1.1")
    assert not {c.role for c in run.cells} & {"table", "discretisation"}


@pytest.mark.slow
def test_each_line_of_the_diagram_has_its_uncertainty_and_who_confirms_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(registry, "names", lambda: ("assumed-modes", "pinocchio"))
    line = f"campbell {BLADE} --rpm 0:12:6 --modes 2 --elements 20 --per-rev 1 --verify -o {tmp_path}"
    status, out, _ = southwell(line, capsys)
    assert status == 0
    rows = re.findall(r"^ (\w+ 1) +(\S+) +([\d.]+) ± (\S+) +(\S+) ", out[out.index("Independent confirmation") :], re.M)
    assert [(name, speed, codes) for name, speed, _, _, codes in rows] == [
        (name, speed, "assumed-modes") for speed in ("0", "12") for name in ("flapwise 1", "edgewise 1")
    ]
    assert all(0 < float(u) < 1e-3 * float(f) for _, _, f, u, _ in rows)
    assert "## Independent confirmation" in (tmp_path / "campbell.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "phrase"),
    [
        (f"verify {BLADE}", "--rpm: missing"),
        ("verify missing.dat --rpm 0", "missing.dat: no such file"),
        ("verify park-cantilever --rpm 5", "are for blade files"),
        ("verify pitch-link --set mass=*2", "pitch-link is not a blade"),
        (f"modes {BLADE} --rpm 0 --set mass", "not NAME=*FACTOR"),
        (f"modes {BLADE} --rpm 0 --set GJ=*2", "GJ is rigid in this blade"),
        (f"modes {BLADE} --rpm 0 --against park-blade", "name one of them"),
        (f"modes {BLADE} --rpm 0 --against {DECK} --json", "leave one out"),
        (f"campbell {BLADE} --rpm 0:12:6 --strict", "add --operating"),
        (f"campbell {BLADE} --rpm 0:12:6 --azimuth 90 --verify", "without gravity"),
    ],
)
def test_wrong_options_are_one_line(arguments: str, phrase: str, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = southwell(arguments, capsys)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert phrase in err


@pytest.mark.parametrize("count", [1, 6, 11])
def test_frequencies_are_whole_in_eighty_columns(count: int) -> None:
    """Every digit of every speed, in as many tables as that takes."""
    rows = [
        NamedMode(rpm / RPM.speeds, mode, f"edgewise {mode}", (10.0 * mode + rpm) / RPM.frequencies, 1e-9, 0.0)
        for rpm in range(0, 3 * count, 3)
        for mode in (1, 2)
    ]
    modes = [TrackedMode(f"edgewise {k}", tuple(row for row in rows if row.mode == k)) for k in (1, 2)]
    console = Console(width=80, file=StringIO(), highlight=False)
    title = "a blade: 257 stations, accuracy 1e-06"
    for table in terminal.frequencies(modes, title, RPM, 80):
        console.print(table)
    output = console.file.getvalue()  # type: ignore[attr-defined]
    assert title in output, "a title wider than its table is not wrapped"
    assert "…" not in output
    assert max(map(len, output.splitlines())) <= 80
    printed = [float(x) for line in output.splitlines() if line.startswith("  edge") for x in line.split()[2:-1]]
    assert sorted(printed) == pytest.approx(sorted(r.frequency * RPM.frequencies for r in rows))


def test_a_table_is_continued_with_every_column_that_names_a_row() -> None:
    """Six rows of one blade used to be continued with its name alone."""
    head = ("blade", "speed", "mode", "name", "samples", "mean, Hz", "std. deviation", "5 %", "95 %")
    rows = tuple(("a-long-name", f"{30 * k} rpm", "1", "flapwise 1", "8", *["1.234567"] * 4) for k in range(3))
    console = Console(width=60, file=StringIO(), highlight=False)
    console.print(sheets.terminal(sheets.Sheet("Frequencies over the samples", head, rows, keys=4), 60))
    output = console.file.getvalue()  # type: ignore[attr-defined]
    assert [output.count(f" {30 * k} rpm") for k in range(3)] == 3 * [output.count("blade")]
    assert output.count("blade") > 1
    assert output.count("1.234567") == 12
    assert max(map(len, output.splitlines())) <= 60


@pytest.mark.parametrize("width", [64, 72, 80, 96, 120])
def test_no_column_of_words_is_cut(width: int) -> None:
    """The last column read `noth`: Rich narrowed another one below its least width."""
    head = ("case", "code", "answers", "speeds", "modes", "now")
    speeds = ", ".join(f"{2 * k} rad/s" for k in range(7))
    codes = ("exact-beam", "paper's equations, literally", "wright1982/four-decimals")
    rows = [("wright-flapwise", code, "21", speeds, "1, 2, 3", "nothing") for code in codes]
    console = Console(width=width, file=StringIO(), highlight=False)
    for table in table_columns.tables(head, rows, width):
        console.print(table)
    output = console.file.getvalue()  # type: ignore[attr-defined]
    assert output.count("nothing") == 3
    assert max(len(line.rstrip()) for line in output.splitlines()) < width


def test_a_narrow_terminal_has_no_column_of_broken_words_for_faults() -> None:
    control = Control(
        "no hub radius", "solver", "the root is on the axis", "+3 %", "beam", 10.0, ("beam, a: fail",), 0.03
    )
    run = replace(samples.run(), controls=(control,))
    for width, output in ((80, False), (120, True)):
        console = Console(width=width, file=StringIO(), highlight=False)
        console.print(terminal.controls(run, width))
        text = console.file.getvalue()  # type: ignore[attr-defined]
        assert ("detected by" in text) == output
        assert ("beam, a: fail" in text) == output
        assert "largest difference" in text
        assert "no hub radius" in text


def test_centres_on_the_axis_are_one_line() -> None:
    blade = uniform_blade("b", 99.0, 1.0, EA=1.5e10, GJ=1.5e9, EI_y=1.5e10, EI_z=2.5e10, mass=1234.5)
    (table,) = show.stations(blade, 5)
    assert table.caption == "All centres are on the axis, within 0.5 mm."
    aside = replace(blade, mass=offset(blade.mass, np.full(len(blade.stations), 1e-3)))
    assert len(show.stations(aside, 5)) == 2


def test_stations_are_whole_in_eighty_columns() -> None:
    console = Console(width=80, file=StringIO(), highlight=False)
    blade = uniform_blade("b", 99.0, 1.0, EA=1.5e10, GJ=1.5e9, EI_y=1.5e10, EI_z=2.5e10, mass=1234.5)
    aside = replace(blade, mass=offset(blade.mass, np.full(len(blade.stations), 0.2)))
    for table in show.stations(aside, 5):
        console.print(table)
    output = console.file.getvalue()  # type: ignore[attr-defined]
    assert "…" not in output
    assert output.count("99.000") == 2
    assert output.count("2.5e+10") == 2
