"""``southwell campbell``: what a user types, sees, finds in the folder; every wrong input is one line and status 2."""

import csv
import os
import sys
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.campbell.prestress import LOAD, STANDARD_GRAVITY
from southwell.cases.input import library
from southwell.core.solve import modes
from southwell.reports.cli.blade import campbell_options
from southwell.reports.cli.blade.campbell_solution import SpeedProgress
from southwell.reports.shared.certain import certain
from southwell.reports.shared.units import RPM

from ..test_cli import BEAM, southwell


@pytest.fixture
def beam(tmp_path: Path) -> Path:
    path = tmp_path / "stub.toml"
    path.write_text(BEAM)
    return path


@pytest.mark.parametrize(
    ("arguments", "phrase"),
    [
        ("campbell", "BLADE"),
        ("campbell park-cantilever --rpm 10", "a diagram needs at least two"),
        ("campbell park-cantilever --per-rev one", "--per-rev: 'one' is neither first:last nor whole numbers"),
        ("campbell park-cantilever --per-rev 0:3", "--per-rev: '0:3': needs 1 ≤ first ≤ last"),
        ("campbell park-cantilever --per-rev 3:1", "--per-rev: '3:1': needs 1 ≤ first ≤ last"),
        ("campbell park-cantilever --operating 7", "--operating: '7' is not lowest:highest, as in 6.9:12.1"),
        ("campbell park-cantilever --operating 12:7", "--operating: '12:7': needs 0 ≤ lowest ≤ highest"),
        ("campbell park-cantilever --operating nan:7", "--operating: 'nan:7': needs 0 ≤ lowest ≤ highest"),
        (
            "campbell park-cantilever --rpm 0:30:10 --operating 7:40",
            "--operating: '7:40': beyond the speeds, 0 to 30 rpm",
        ),
        ("campbell park-cantilever --rpm 0:30:10 --tilt 5", "without --azimuth"),
        ("campbell park-cantilever --rpm 0:30:10 --elements 20001", "--elements. Must be <= 20000"),
        (
            "campbell park-cantilever --margin wide",
            "--margin: 'wide' is neither a percentage, a fraction nor a frequency",
        ),
        ("campbell park-cantilever --margin 100", "--margin: '100': needs 0 to 100 %"),
        ("campbell park-cantilever --modes 0", "--modes"),
        ("campbell park-cantilever --elements 1.5", "--elements"),
        ("campbell park-cantilever --workers 0", "--workers"),
        ("campbell park-cantilever --azimuth up", "--azimuth"),
        ("campbell park-cantilever --azimuth nan", "--azimuth nan: not a finite number of degrees"),
        ("campbell park-cantilever --subset one", "--subset: 'one' is not set:subset, as in 5:1"),
        ("campbell park-cantilever --pitch inf", "--pitch inf: not a finite number of degrees"),
        ("campbell yoo-shin-chordwise/delta-0 --omega 0:200:100 --elements 8", "100 rad/s: steady strain"),
    ],
)
def test_wrong_input_is_reported_in_one_line(
    arguments: str, phrase: str, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    status, out, err = southwell(arguments, capsys)
    assert (status, out) == (2, "")
    assert err.startswith("southwell: ")
    assert err.count("\n") == 1
    assert phrase in err
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_campbell_prints_tables_and_writes_figures_page_and_csv(
    beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    line = f"campbell {beam} --rpm 0:200:50 --modes 3 --elements 8 --operating 50:150 --per-rev 1,2,9 --margin 0.05"
    status, output, err = southwell(f"{line} -o {out}", capsys)
    assert (status, err) == (0, "")
    assert "At 50 to 150 rpm" in output.splitlines()[0] or "at 50 to 150 rpm" in output.splitlines()[0], (
        "the verdict is first"
    )
    blade = library.load(str(beam)).variants[0].blade
    solved = modes(blade, 200 * np.pi / 30, 8, 3)
    row = next(text for text in output.splitlines() if "flapwise 1" in text and " % flapwise" in text)
    assert certain(solved.frequencies[0] / (2 * np.pi), solved.uncertainty[0]) in row.split()
    names = {p.name for p in out.iterdir()}
    assert names == {
        *(f"{stem}.{kind}" for stem in ("campbell", "shapes") for kind in ("svg", "png", "csv")),
        *("span.svg", "span.png"),
        *("campbell.md", "resonances.csv", "margins.csv", "encounters.csv"),
    }
    assert all(name in output for name in names)
    page = (out / "campbell.md").read_text()
    for needed in ("campbell.svg", "shapes.svg", "## Modes", "BldFl1Sh", "at 50 rpm … 150 rpm", "southwell"):
        assert needed in page
    assert (out / "campbell.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
@pytest.mark.parametrize("mesh", ["", "--accuracy 1e-4", "--elements 8"])
def test_the_uncertainty_of_every_frequency_covers_its_error(
    mesh: str, beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Against core ten thousand times as accurate as asked for; the polynomials' and the shapes' frequencies have theirs."""
    status, output, _ = southwell(f"campbell {beam} --rpm 0:200:100 --modes 3 {mesh} -o {tmp_path / 'out'}", capsys)
    assert status == 0
    assert "± relative" in output
    with (tmp_path / "out" / "campbell.csv").open() as file:
        rows = list(csv.DictReader(file))
    blade = library.load(str(beam)).variants[0].blade
    exact = {
        omega: modes(blade, omega, count=7, accuracy=1e-10) for omega in {float(row["omega_rad_s"]) for row in rows}
    }
    for row in rows:
        true, uncertainty = exact[float(row["omega_rad_s"])], float(row["relative_uncertainty"])
        frequency = true.frequencies[int(row["mode"]) - 1]
        assert abs(float(row["frequency_rad_s"]) / frequency - 1.0) <= uncertainty + 1e-10
        assert float(row["steady_strain"]) == pytest.approx(true.strain, rel=0.2, abs=1e-12)
    accuracy = {"": 1e-6, "--accuracy 1e-4": 1e-4}.get(mesh, np.inf)
    assert max(float(row["relative_uncertainty"]) for row in rows) <= accuracy
    for name in ("shapes.csv", "resonances.csv", "encounters.csv"):
        assert "relative_uncertainty" in (tmp_path / "out" / name).read_text().splitlines()[0].split(",")


@pytest.mark.slow
def test_large_strains_are_refused_unless_allowed_and_then_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    line = f"campbell yoo-shin-chordwise/delta-0 --omega 50:100:50 --modes 1 --elements 8 -o {tmp_path}"
    status, _, err = southwell(line, capsys)
    assert status == 2
    assert "(--allow-large-strain)" in err
    status, output, _ = southwell(f"{line} --allow-large-strain", capsys)
    assert status == 0
    assert "steady strain up to" in output
    assert "steady strain up to" in (tmp_path / "campbell.md").read_text()


def test_a_blade_file_needs_speeds_and_its_format_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The same beam as a case's, mounted elsewhere: the hub radius of the command line counts."""
    file, out = tmp_path / "blade.toml", tmp_path / "out"
    file.write_text("name = 'own'\n" + BEAM[BEAM.index("[blade]") : BEAM.index("[speeds]")])
    status, _, err = southwell(f"campbell {file} -o {out}", capsys)
    assert (status, err) == (
        2,
        f"southwell: --rpm: missing: {file} does not define rotor speeds: give them, as in 0:15:0.5\n",
    )
    status, output, _ = southwell(
        f"campbell {file} --omega 0:20:10 --modes 2 --hub-radius 3 --elements 8 -o {out}", capsys
    )
    assert status == 0
    assert "Southwell TOML: blade.toml" in output
    page = (out / "campbell.md").read_text()
    assert "Southwell TOML: blade.toml" in page
    assert f"blade.toml, SHA-256 `{sha256(file.read_bytes()).hexdigest()}`" in page
    assert "None: no other code was run" in page
    rows = [row.split(",") for row in (out / "campbell.csv").read_text().splitlines()]
    at = rows[0].index("frequency_rad_s")
    frequencies = [float(row[at]) for row in rows[1:] if row[rows[0].index("omega_rad_s")] == "20.0"]
    (out / "case.toml").write_text(BEAM.replace("hub_radius = 0.1", "hub_radius = 3.0"))
    blade = library.load(str(out / "case.toml")).variants[0].blade
    np.testing.assert_allclose(frequencies, modes(blade, 20.0, 8, 2).frequencies, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.skipif(not os.environ.get("SOUTHWELL_BLADES"), reason="set SOUTHWELL_BLADES to public blade files")
@pytest.mark.parametrize(
    ("file", "mount", "first"),
    [
        ("nrel5mw/NRELOffshrBsline5MW_Blade.dat", "--length 61.5 --hub-radius 1.5", "AdjBlMs = 1.04536"),
        pytest.param(
            "nrel5mw/NRELOffshrBsline5MW_BeamDyn.dat", "--hub-radius 1.5", "BeamDyn", marks=pytest.mark.nightly
        ),
        ("nrel5mw/NREL_5MW_st.txt", "--hub-radius 1.5 --subset 5:1", "HAWC2"),
        pytest.param("iea15/IEA_15MW_RWT_Blade_st_FPM.st", "--hub-radius 3.97", "HAWC2", marks=pytest.mark.nightly),
        pytest.param(
            "iea3.4/IEA-3.4-130-RWT_ElastoDyn_blade.dat",
            "--length 63 --hub-radius 2",
            "ElastoDyn",
            marks=pytest.mark.nightly,
        ),
    ],
)
def test_published_blade_files_have_flapwise_1_edgewise_1_flapwise_2(
    file: str, mount: str, first: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = Path(os.environ["SOUTHWELL_BLADES"]) / file
    line = f"campbell {path} {mount} --rpm 0:12:4 --modes 3 --elements 24 --operating 4:12 -o {tmp_path}"
    status, output, err = southwell(line, capsys)
    assert (status, err) == (0, "")
    assert first in output
    rows = [row.split(",") for row in (tmp_path / "campbell.csv").read_text().splitlines()]
    name, place = rows[0].index("name"), rows[0].index("speed_number")
    assert [row[name] for row in rows[1:] if row[place] == "1"] == ["flapwise 1", "edgewise 1", "flapwise 2"]


@pytest.mark.slow
def test_each_blade_of_a_case_has_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, output, _ = southwell(f"campbell park-blade --modes 1 --elements 10 -o {tmp_path / 'out'}", capsys)
    assert status == 0
    labels = {v.name.partition("/")[2] for v in library.load("park-blade").variants}
    assert {p.name for p in (tmp_path / "out").iterdir()} == labels
    assert "30 rpm" in output  # in the head of a column


@pytest.mark.slow
def test_a_load_equal_to_the_weight_of_a_hanging_beam_is_gravity(
    beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its weight per length towards the tip as a table, or gravity with the blade hanging."""
    (blade,) = (v.blade for v in library.load(str(beam)).variants)
    weight = blade.mass[0, 0, 0] * STANDARD_GRAVITY
    table = tmp_path / "load.csv"
    table.write_text(f"# weight\n{','.join(LOAD)}\n0,{weight},0,0\n1,{weight},0,0\n")
    first = []
    for option in ("--azimuth 180", f"--load {table}"):
        status, *_ = southwell(f"campbell {beam} --modes 1 --elements 8 {option} -o {tmp_path / 'out'}", capsys)
        assert status == 0
        rows = (tmp_path / "out" / "campbell.csv").read_text().splitlines()
        first.append(float(rows[1].split(",")[rows[0].split(",").index("frequency_rad_s")]))
    assert first[0] == pytest.approx(first[1], rel=1e-10)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("0,1,0,0\n0.5,1,0,0\n", ["load.csv", "fraction", "0.5", "tip"]),
        ("0,1,0,0\n1,x,0,0\n", ["load.csv", "line 3", "fx"]),
        ("0,0,0,0\n0.37,20000,0,0\n1,0,0,0\n", ["load.csv", "fraction", "0.37", "not linear", "stations"]),
    ],
)
def test_an_invalid_load_is_reported_in_one_line(
    rows: str, words: list[str], beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "load.csv"
    table.write_text(f"{','.join(LOAD)}\n{rows}")
    status, _, err = southwell(f"campbell {beam} --load {table} -o {tmp_path / 'out'}", capsys)
    assert status == 2
    assert err.count("\n") == 1
    assert all(word in err for word in words)


@pytest.mark.nightly
def test_the_number_of_processes_does_not_change_frequencies(
    beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tables = []
    for workers in (1, 2):
        out = tmp_path / str(workers)
        status, *_ = southwell(f"campbell {beam} --modes 2 --elements 8 --workers {workers} -o {out}", capsys)
        assert status == 0
        text = (out / "campbell.csv").read_text().splitlines()
        column = text[0].split(",").index("frequency_rad_s")
        tables.append([float(row.split(",")[column]) for row in text[1:]])
    np.testing.assert_allclose(tables[0], tables[1], rtol=1e-9)


def test_progress_counts_requested_speeds_and_names_inserted_ones() -> None:
    progress = SpeedProgress("blade", [0.0, 1.0], RPM)
    progress(0.0)
    assert progress.bar.tasks[0].completed == 1
    progress(0.5)
    assert progress.bar.tasks[0].completed == 1
    assert "inserting 4.77465 rpm" in progress.bar.tasks[0].description


@pytest.mark.slow
def test_the_report_of_one_blade_is_one_file(beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Input, properties, conventions and results; figures are embedded."""
    status, output, _ = southwell(f"campbell {beam} --rpm 0,100 --modes 2 --elements 6 --html -o {tmp_path}", capsys)
    assert status == 0
    assert "campbell.html" in output
    page = (tmp_path / "campbell.html").read_text(encoding="utf-8")
    for heading in (
        "Input",
        "Modes",
        "Independent confirmation",
        "Properties along the span",
        "Inputs not used",
        "Reproduce",
    ):
        assert f">{heading}</h2>" in page
    assert page.count("data:image/svg+xml,") == 3
    assert "positive with the leading edge downwind" in page


@pytest.mark.slow
def test_every_table_of_the_page_is_in_the_pdf(beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With all sections that the page can have."""
    from ....support import printed

    points = tmp_path / "rig.csv"
    points.write_text("speed [rpm],measured [Hz],mode\n100,9.9,1\n")
    line = f"campbell {beam} --rpm 0,50,100 --modes 3 --elements 6 --operating 20:90 --against park-cantilever"
    status, output, err = southwell(f"{line} --add rig={points} --data-uncertainty 1% --pdf -o {tmp_path}", capsys)
    assert status == 0, err
    assert "campbell.pdf" in output
    page = (tmp_path / "campbell.md").read_text(encoding="utf-8")
    assert page.count("\n## ") > 8
    assert printed.missing(page, printed.read(tmp_path / "campbell.pdf")) == []


def test_without_typst_a_pdf_is_refused_before_the_work(
    beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "typst", None)
    status, _, err = southwell(f"campbell {beam} --rpm 0,50 --modes 1 --elements 4 --pdf -o {tmp_path}", capsys)
    assert status == 2
    assert "pip install '.[pdf]'" in err
    assert not (tmp_path / "campbell.md").exists()


def test_the_first_line_says_that_one_blade_of_a_turbine_is_analysed() -> None:
    (line,) = campbell_options.blade_alone("models/Main_Onshore.fst")
    assert line.startswith("Main_Onshore.fst: one blade of the turbine, clamped at the hub")
    assert not campbell_options.blade_alone("blade.dat")


def test_gravity_and_the_frozen_azimuth_are_stated_first(
    beam: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    line = f"campbell {beam} --rpm 0,50 --modes 1 --elements 4 --azimuth 90 --tilt 5 -o {tmp_path}"
    status, output, _ = southwell(line, capsys)
    assert status == 0
    first = "gravity: steady, with the blade frozen at azimuth 90° (0: up) and the rotor axis tilted by 5°"
    assert output.startswith(first)
    assert first in (tmp_path / "campbell.md").read_text(encoding="utf-8")
