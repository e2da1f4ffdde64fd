"""What a notebook gets: the same numbers as core's, in tables and figures that show themselves."""

import inspect
import json
import pydoc
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes

import southwell
from southwell.cases.input.errors import CaseError
from southwell.cases.store import results_file
from southwell.core import solve
from southwell.reports.cli.app import main

mpl.use("agg")

OMEGA = 10.0


@pytest.fixture(scope="module")
def blade() -> southwell.Blade:
    return southwell.read("park-cantilever")


def test_modes_are_cores_with_names_and_uncertainties(blade: southwell.Blade) -> None:
    result, core = southwell.modes(blade, OMEGA, modes=3), solve.modes(blade, OMEGA, count=3)
    frame = result.to_frame()
    assert isinstance(result, southwell.Modes)
    assert frame["name"].tolist() == ["edgewise 1", "flapwise 1", "edgewise 2"]
    np.testing.assert_allclose(frame["frequency_rad_s"], core.frequencies, rtol=1e-12)
    np.testing.assert_allclose(frame["frequency_hz"] * 2 * np.pi, core.frequencies, rtol=1e-12)
    assert max(frame["uncertainty"]) <= 1e-6
    assert repr(result) == "<3 modes of park-cantilever at 10 rad/s: 1.864, 2.451, 11.21 Hz>"
    assert "<table" in result._repr_html_()
    axes = result.plot(modes=2)
    assert isinstance(axes, Axes)
    assert [np.asarray(line.get_xydata())[-1].tolist() for line in axes.lines] == [
        [blade.length, pytest.approx(1.0)]
    ] * 2


def test_the_file_of_a_case_is_read(blade: southwell.Blade) -> None:
    """A TOML file with speeds, as the commands take it; it used to be refused for its description."""
    read = southwell.read(Path(__file__).parents[3] / "cases" / "data" / "park-cantilever.toml")
    np.testing.assert_array_equal(read.mass, blade.mass)


def test_help_shows_the_parameters_that_a_user_types() -> None:
    """Of the functions of one speed that are made of sweeps, and without the members of NumPy's unions."""
    public = [value for name in southwell.__all__ if callable(value := getattr(southwell, name))]
    assert [f for f in public if "numpy._typing" in pydoc.render_doc(f)] == []
    text = pydoc.plain(pydoc.render_doc(southwell.modes)).replace("'", "")
    assert "modes(blade: Blade, omega: float | None = None, *, rpm" in text
    for single, sweep in ((solve.modes, solve.sweep), (solve.mesh_modes, solve.mesh_sweep)):
        output = list(inspect.signature(single).parameters)
        assert output == ["blade", "omega", *list(inspect.signature(sweep).parameters)[2:]]
        assert f"arguments and errors as for ``{sweep.__name__}``" in pydoc.render_doc(single)


def test_a_plot_has_every_mode_asked_for() -> None:
    """Torsion modes move no point of the axis; they used to be omitted without a word."""
    section = {"EA": 1e8, "GJ": 1e2, "EI_y": 1e5, "EI_z": 2e5, "mass": 3.0, "I_y": 0.1, "I_z": 0.1}
    result = southwell.modes(southwell.uniform_blade("beam", 5.0, 0.5, **section), OMEGA, modes=4, elements=10)
    assert "torsion 1" in result.names
    axes = result.plot(modes=4)
    assert [str(line.get_label()) for line in axes.lines] == result.names
    for line in axes.lines:
        assert np.abs(np.asarray(line.get_ydata(), float)).max() == pytest.approx(1.0)


@pytest.mark.slow
def test_python_and_the_command_take_the_same_names_and_give_the_same_numbers(
    blade: southwell.Blade, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The API used 50 elements where the command refines until the accuracy is reached."""
    frame = southwell.modes(blade, rpm=30, modes=2, accuracy=1e-5).to_frame()
    with pytest.raises(SystemExit):
        main(["modes", "park-cantilever", "--rpm", "30", "--modes", "2", "--accuracy", "1e-5", "--json"])
    rows = json.loads(capsys.readouterr().out)
    assert frame["frequency_rad_s"].tolist() == pytest.approx([row["frequency_rad_s"] for row in rows], rel=1e-13)
    diagram = southwell.campbell(blade, rpm="0:60:30", modes=2, operating=(30, 60), margin="1Hz")
    line = "campbell park-cantilever --rpm 0:60:30 --modes 2 --operating 30:60 --margin 1Hz"
    with pytest.raises(SystemExit):
        main([*line.split(), "-o", str(tmp_path)])
    written = pd.read_csv(tmp_path / "campbell.csv").query("omega_rad_s > 6")["frequency_rad_s"]
    at_end = diagram.to_frame().loc[60.0].to_numpy() * 2 * np.pi
    np.testing.assert_allclose(np.sort(at_end), np.sort(written), rtol=1e-12)
    margins = pd.read_csv(tmp_path / "margins.csv")
    np.testing.assert_allclose(diagram.margins()["high"] * 2 * np.pi, margins["at_high"], rtol=1e-9)
    assert set(margins["measure"]) == {"rad/s"}


def test_root_loads_take_rpm_or_rad_s(blade: southwell.Blade) -> None:
    in_rpm, in_rad = southwell.root_loads(blade, rpm=12.1), southwell.root_loads(blade, 12.1 * np.pi / 30)
    np.testing.assert_allclose(in_rpm.force, in_rad.force, rtol=1e-12)
    assert in_rpm.force[0] > 0


def test_a_blade_has_a_short_text() -> None:
    """The cantilever of Park et al.; it used to print every array."""
    blade = southwell.uniform_blade("beam", 5.0, 0.5, EA=1e8, GJ=1e5, EI_y=1e5, EI_z=1e5, mass=3.0)
    assert repr(blade) == "<Blade beam: 5 m, hub radius 0.5 m, 15 kg, 2 stations>"


def test_a_diagram_has_the_frequencies_of_each_speed_in_the_unit_given(blade: southwell.Blade) -> None:
    result = southwell.campbell(blade, rpm="0:60:30", modes=2, operating=(30, 60), elements=20)
    frame = result.to_frame()
    assert frame.index.name == "rotor speed, rpm"
    assert frame.index.tolist() == pytest.approx([0.0, 30.0, 60.0])
    for rpm, row in frame.iterrows():
        core = solve.modes(blade, float(str(rpm)) * np.pi / 30, 20, 2).frequencies / (2 * np.pi)
        np.testing.assert_allclose(np.sort(row), core, rtol=1e-9)
    margins = result.margins()
    assert len(margins) == 2 * 6
    first = frame.columns[0]
    ends = np.asarray(margins.query("mode == @first and per_rev == 2")[["low", "high"]])[0]
    np.testing.assert_allclose(ends, frame[first].loc[[30.0, 60.0]] / [1.0, 2.0] - 1.0, rtol=1e-6)
    assert repr(result) == "<Campbell diagram of park-cantilever: 2 modes, 3 speeds from 0 to 60 rpm>"
    assert result.verdict
    assert "<table" in result._repr_html_()
    assert result.plot(interactive=False).get_xlabel() == "rotor speed, rpm"


def test_a_verification_has_a_row_for_every_cell_and_a_verdict(blade: southwell.Blade) -> None:
    result = southwell.verify(blade, omega=[0.0, OMEGA], codes=["exact-beam"], modes=2)
    frame = result.to_frame()
    exact = frame[frame["code"] == "exact-beam"]
    assert len(exact) == 4
    assert set(exact["verdict"]) == {"pass"}
    assert set(exact["omega_rad_s"]) == {0.0, OMEGA}
    np.testing.assert_allclose(exact["value"] / exact["reference"] - 1.0, exact["difference"], atol=1e-12)
    assert result.passed
    evidence = result.evidence().set_index("code")
    assert evidence.loc["exact-beam", "modes"] == 4
    assert evidence.loc["exact-beam", "difference"] == np.abs(exact["difference"]).max()
    assert "pass" in repr(result)
    assert "<table" in result._repr_html_()
    assert result.plot().get_xscale() == "log"


def test_a_blade_without_independent_confirmation_does_not_pass(blade: southwell.Blade) -> None:
    assert not southwell.verify(blade, omega=OMEGA, codes=["southwell-equation"], modes=2).passed


@pytest.mark.parametrize(
    ("call", "phrase"),
    [
        (lambda b: southwell.read("no-such.dat"), "no-such.dat"),
        (lambda b: southwell.read("park-blade"), "name one of"),
        (lambda b: southwell.read("park-cantilever", length=3.0), "leave out"),
        (lambda b: southwell.campbell(b), "give either rpm or omega"),
        (lambda b: southwell.modes(b), "give either rpm or omega"),
        (lambda b: southwell.campbell(b, rpm="0:9:3", margin="wide"), "margin: 'wide' is neither"),
        (lambda b: southwell.campbell(b, rpm="0:9:3", omega="0:9:3"), "give either rpm or omega"),
        (lambda b: southwell.campbell(b, rpm=[3.0, 1.0]), "ascend"),
        (lambda b: southwell.campbell(b, rpm="fast"), "neither a speed"),
        (lambda b: southwell.verify("park-cantilever", rpm=3.0), "own speeds"),
    ],
)
def test_invalid_input_is_reported_in_one_line(call, phrase: str, blade: southwell.Blade) -> None:
    with pytest.raises(CaseError) as raised:
        call(blade)
    assert phrase in str(raised.value)
    assert "\n" not in str(raised.value)


def test_a_verification_has_faults_limits_and_a_folder(blade: southwell.Blade, tmp_path: Path) -> None:
    """A time that is too short for any code makes its cells inconclusive; results are written.

    The seeded fault needs a code that agrees on the blade without it, and no code had time to.
    """
    request = {"omega": OMEGA, "codes": ["exact-beam"], "modes": 1, "faults": "no hub radius", "out": tmp_path}
    result = southwell.verify(blade, **request, time_limit=1e-3)
    timed_out = [c for c in result.run.cells if c.code == "exact-beam"]
    assert {(c.verdict, c.value) for c in timed_out} == {("inconclusive", None)}
    assert [(c.control, c.detected_by) for c in result.run.controls] == [("no hub radius", ())]
    assert result.run.controls[0].needs == "an independent code that agrees on this blade"
    assert results_file.read(tmp_path / "results.jsonl") == result.run
