"""Rows of ``southwell modes`` are modes, followed by shape through the speeds, not frequencies of the same name."""

import json

import numpy as np
import pytest

from southwell.cases.campbell.diagram import CampbellRequest
from southwell.cases.campbell.tracked import tracked
from southwell.cases.input.errors import CaseError
from southwell.core import solve
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.modes import Modes
from southwell.reports.cli.app import main

RPM = np.pi / 30


def twisted() -> Blade:
    """A blade twisted by 60 degrees; flapwise and edgewise bending of its two lowest modes mix as it turns."""
    ones = np.ones(2)
    stiffness = section_stiffness(1e8 * ones, 1e4 * ones, 1e4 * ones, 1.3e4 * ones)
    return Blade(
        "twisted",
        np.array([0.0, 10.0]),
        stiffness,
        section_mass(ones, 0.01 * ones, 0.01 * ones),
        np.radians([0.0, -60.0]),
        1.0,
    )


def test_a_row_follows_its_mode_where_names_change() -> None:
    """The three lowest frequencies never meet between 0 and 17 rpm: numbers at close speeds identify the modes."""
    blade, speeds = twisted(), np.linspace(0.0, 17.0, 18) * RPM
    by_number = np.array([modes.frequencies[:3] for modes in solve.sweep(blade, speeds, 20, 3)])
    gaps = np.diff(by_number, axis=1)
    assert (gaps.min(axis=0) > 5 * np.abs(np.diff(gaps, axis=0)).max(axis=0)).all()
    first, second, third, *_ = tracked(blade, CampbellRequest((0.0, speeds[-1]), modes=3, elements=20))
    for row, column in zip((first, second, third), by_number.T, strict=True):
        assert [at.frequency for at in row.at] == pytest.approx(column[[0, -1]], rel=1e-9)
    assert [row.label for row in (first, second, third)] == ["flapwise 1 → mixed", "edgewise 1 → mixed", "flapwise 2"]
    assert [at.name for at in third.at] == ["flapwise 2", "flapwise 1"]


def test_the_command_prints_tracked_rows(capsys: pytest.CaptureFixture[str], tmp_path) -> None:
    path = tmp_path / "twisted.toml"
    stiffness = "[1e8, 0, 0, 0, 0, 0, 4e7, 0, 0, 0, 0, 4e7, 0, 0, 0, 1e4, 0, 0, 1.0e4, 0, 1.3e4]"
    mass = "[1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.02, 0, 0, 0.01, 0, 0.01]"
    path.write_text(
        'name = "twisted"\ntitle = "t"\ndescription = "d"\nsource = "s"\n[blade]\nkind = "sections"\nhub_radius = 1.0\n'
        f"s = [0.0, 10.0]\ntwist_deg = [0.0, -60.0]\nstiffness = [{stiffness}, {stiffness}]\nmass = [{mass}, {mass}]\n"
        "[speeds]\nrpm = [0.0, 17.0]\n[compare]\nmodes = 6\n"
    )
    with pytest.raises(SystemExit, match=r"^0$"):
        main(["modes", str(path), "--modes", "3", "--elements", "20", "--json"])
    rows = json.loads(capsys.readouterr().out)
    lowest = [row["frequency_hz"] for row in rows if row["label"] == "flapwise 1 → mixed"]
    assert lowest == pytest.approx([0.5611, 0.6408], abs=1e-4)
    with pytest.raises(SystemExit, match=r"^0$"):
        main(["modes", str(path), "--modes", "3", "--elements", "20"])
    (line,) = (line for line in capsys.readouterr().out.splitlines() if "flapwise 1" in line)
    assert [float(word) for word in line.split()[4:6]] == pytest.approx(lowest, abs=1e-6)


def test_a_speed_between_the_requested_ones_may_have_no_steady_state() -> None:
    """Tracking asks for it only to identify the modes; the answers at the requested speeds remain, with a doubt."""
    blade, requested = twisted(), (0.0, 17.0 * RPM)

    def core(omega: float) -> Modes:
        if omega not in requested:
            raise CaseError("no steady state")
        return solve.mesh_modes(blade, omega, 20, 3)

    modes = tracked(blade, CampbellRequest(requested, modes=3), solve=core)
    assert {at.omega for mode in modes for at in mode.at} == set(requested)
    assert any(mode.doubts for mode in modes)


def test_one_speed_needs_no_tracking() -> None:
    speeds = []

    def core(omega: float) -> Modes:
        speeds.append(omega)
        return solve.mesh_modes(twisted(), omega, 20, 3)

    modes = tracked(twisted(), CampbellRequest((5.0,), modes=3), solve=core)
    assert [len(mode.at) for mode in modes] == [1, 1, 1]
    assert speeds == [5.0]
