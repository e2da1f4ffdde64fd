"""``southwell modes`` of a tower's file."""

import json
from pathlib import Path

import pytest

from southwell.reports.cli import app
from southwell.tests.cases.input.machines.test_turbine_toml import TOWER, write


def test_modes_of_a_tower_in_toml(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path, TOWER)
    with pytest.raises(SystemExit) as exit_:
        app.main(["modes", str(path), "--modes", "3"])
    output = " ".join(capsys.readouterr().out.split())
    assert not exit_.value.code
    assert "1st side-side 0.6256" in output
    assert "rigid ground" in output
    with pytest.raises(SystemExit):
        app.main(["modes", str(path), "--modes", "2", "--json"])
    rows = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in rows] == ["1st side-side", "1st fore-aft"]


def test_an_option_of_blades_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path, TOWER)
    with pytest.raises(SystemExit) as exit_:
        app.main(["modes", str(path), "--rpm", "0,10"])
    assert exit_.value.code == 2
    assert "--rpm" in capsys.readouterr().err
