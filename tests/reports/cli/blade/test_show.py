"""``southwell show``: published and worked-out numbers in what it prints, files it writes, bad input."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.core.blade import uniform_blade
from southwell.reports.campbell import span
from southwell.reports.cli import app as cli
from southwell.tests.support import blade_files
from southwell.tests.support.blade_files import real

DATA = Path(__file__).parents[3] / "data" / "blades"
BEAM = f"""{blade_files.BEAM}rotary_inertia = false
root = {{ flap = 0.0, lag = 1e5 }}
tip_mass = {{ mass = 2.0 }}
"""


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as ending:
        cli.main(["show", *arguments])
    out, err = capsys.readouterr()
    return int(ending.value.code or 0), out, err


@pytest.fixture(autouse=True)
def wide(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "200")


def test_mass_and_moments_of_a_uniform_beam_with_tip_mass(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """1.2 kg/m over 6 m from 0.3 m, and 2 kg at 6.3 m."""
    path = tmp_path / "beam.toml"
    path.write_text(BEAM)
    status, out, _ = run(capsys, str(path))
    first = 1.2 * 6 * 3.3 + 2 * 6.3
    second = 1.2 * (6.3**3 - 0.3**3) / 3 + 2 * 6.3**2
    assert status == 0
    assert "9.2 kg, of which 2 kg at the tip" in out
    assert f"{first:.7g} kg m about the rotor's axis, {first - 9.2 * 0.3:.7g} kg m about the root" in out
    assert f"{second:.7g} kg m² about the rotor's axis" in out
    assert f"x {first / 9.2:.6g}, y 0, z 0 m" in out
    assert "flap free, lag spring 100000; otherwise clamped" in out
    path.write_text(
        BEAM.replace("mass = 2.0", "mass = 2.0, offset = [0.1, -0.2, 0.0], inertia = [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]")
    )
    assert (
        "centre x 0.1, y -0.2, z 0 m from the tip; moments of inertia about it 1, 2, 3 kg m²"
        in run(capsys, str(path))[1]
    )


def test_conventions_of_the_reader_are_printed_for_nrel_5mw(capsys: pytest.CaptureFixture[str]) -> None:
    blade = str(real("nrel5mw/NRELOffshrBsline5MW_Blade.dat"))
    status, out, _ = run(capsys, blade, "--length", "61.5", "--hub-radius", "1.5", "--precone", "-2.5")
    assert status == 0
    for message in (
        "17608.8 kg",
        "AdjBlMs = 1.04536",
        "y to the trailing edge",
        "-2.5° (positive downwind)",
        "13 of 49 stations",
    ):
        assert message in out
    assert "rigid" in out


@pytest.mark.slow
def test_figure_and_table_of_all_stations(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    for folder in ("a", "b"):
        status, out, _ = run(capsys, str(DATA / "bmodes.bmi"), "-o", str(tmp_path / folder))
        assert status == 0
        assert "span.svg, span.png, stations.csv" in out
    for name in ("span.svg", "span.png", "stations.csv"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    rows = list(csv.DictReader((tmp_path / "a" / "stations.csv").open(encoding="utf-8")))
    assert [float(r["s [m]"]) for r in rows] == [0.0, 10.0, 20.0]
    np.testing.assert_allclose([float(r["mass y [m]"]) for r in rows], [-0.3, -0.2, -0.1])
    np.testing.assert_allclose([float(r["EI edge [N m²]"]) for r in rows], [1.2e9, 4.5e8, 1.5e7])
    assert [r["shear z [m]"] for r in rows] == ["0.0"] * 3
    assert [float(r["axis x [m]"]) for r in rows] == [0.0, 10.0, 20.0]
    # str_tw 5°, tw_iner 8°, both with the leading edge upwind: towards −z from the section's own axes
    np.testing.assert_allclose([float(r["mass axes [deg]"]) for r in rows], [0.0, -3.0, 0.0], atol=1e-9)


def test_steady_loads_at_the_root(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ω² times the first moment about the rotor's axis; the beam is stiff at this speed."""
    monkeypatch.setattr(span, "write", lambda blade, folder: [])
    path = tmp_path / "beam.toml"
    path.write_text(BEAM)
    status, out, _ = run(capsys, str(path), "--steady", "--rpm", "30,60", "--out", str(tmp_path))
    force = (2 * np.pi) ** 2 * (1.2 * 6 * 3.3 + 2 * 6.3)
    row = next(line.split() for line in out.splitlines() if line.strip().startswith("60 rpm"))
    assert status == 0
    assert float(row[2]) == pytest.approx(force, rel=1e-4)
    assert row[3:] == ["0", "0", "0", "0", "0"]
    with (tmp_path / "root-loads.csv").open(encoding="utf-8") as file:
        assert float(list(csv.DictReader(file))[1]["Fx [N]"]) == pytest.approx(force, rel=1e-4)
    status, _, err = run(capsys, str(path), "--steady", "--rpm", "0")
    assert (status, err.count("\n")) == (2, 1)
    assert "a free direction of the root has no stiffness" in err
    assert "--steady: missing" in run(capsys, str(path), "--rpm", "60")[2]
    assert "--rpm: missing" in run(capsys, str(path), "--steady")[2]


def test_blades_of_a_case_each_have_a_folder(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(span, "write", lambda blade, folder: [])  # figures are another test's
    status, out, _ = run(capsys, "park-blade", "-o", str(tmp_path))
    assert status == 0
    assert {p.name for p in tmp_path.iterdir()} >= {"windpact", "surrogate"}
    assert "of 21 stations" in out
    assert " 21 stations" in run(capsys, "park-blade/windpact", "--all")[1]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["none.dat"], "none.dat: no such file"),
        ([str(DATA / "hawc2_st.dat")], "choose one with --subset"),
        ([str(DATA / "hawc2_st.dat"), "--subset", "one"], "--subset: 'one' is not set:subset"),
        ([str(DATA / "elastodyn_main.dat"), "--multipliers", "1,2"], "--multipliers: '1,2' is not mass,flap,edge"),
        (
            [str(DATA / "elastodyn_main.dat"), "--multipliers", "1,0,1"],
            "--multipliers: '1,0,1': not positive factors: give",
        ),
        (
            [str(DATA / "beamdyn_main.dat"), "--multipliers", "1,1,1"],
            "beamdyn_main.dat: multipliers: BeamDyn files have no such",
        ),
        ([str(DATA / "elastodyn_blade.dat"), "--length", "-1"], "--length -1: not a length"),
        ([str(DATA / "elastodyn_blade.dat"), "--precone", "nan"], "--precone nan: not a finite number"),
        (["park-blade", "--length", "50"], "a case defines"),
        (["park-bald"], "did you mean park-blade?"),
    ],
)
def test_bad_input_is_one_line_and_status_2(
    capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    status, out, err = run(capsys, *arguments)
    assert (status, out) == (2, "")
    assert err.count("\n") == 1
    assert err.startswith("southwell: ")
    assert message in err


def test_modes_and_campbell_take_blade_files(capsys: pytest.CaptureFixture[str]) -> None:
    blade = str(DATA / "bmodes.bmi")
    with pytest.raises(SystemExit) as ending:
        cli.main(["modes", blade, "--rpm", "10", "--modes", "2", "--elements", "10"])
    assert not ending.value.code
    assert "bmodes: 3 stations, 10 elements" in " ".join(capsys.readouterr().out.split())
    table = str(DATA / "elastodyn_blade.dat")  # the .bmi states a speed
    for command in ("modes", "campbell"):
        with pytest.raises(SystemExit) as ending:
            cli.main([command, table, "--length", "40", "--hub-radius", "1"])
        assert ending.value.code == 2
        assert "does not define rotor speeds: give them" in capsys.readouterr().err


@pytest.mark.parametrize(("ratio", "label", "scale"), [(2.0, "10⁷ N", "linear"), (100.0, "N", "log")])
def test_the_axis_of_a_stiffness_is_logarithmic_over_several_decades(ratio: float, label: str, scale: str) -> None:
    blade = uniform_blade("beam", 6.0, 0.3, EA=2.8e7, GJ=1e4, EI_y=1e4, EI_z=1e4, mass=1.2)
    tapered = replace(blade, stiffness=blade.stiffness / np.array([1.0, ratio])[:, None, None])
    axes = span.draw(tapered).axes[2]
    assert (axes.get_ylabel(), axes.get_yscale()) == (label, scale)
    low, high = axes.get_ylim()
    ticks = zip(axes.get_yticks(), axes.get_yticklabels(), strict=True)
    assert [text.get_text() for at, text in ticks if low <= at <= high and text.get_text()]
