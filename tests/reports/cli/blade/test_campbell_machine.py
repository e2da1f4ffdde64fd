"""``southwell campbell`` of a whole turbine, and ``southwell modes`` of its tower."""

from pathlib import Path

import pytest

from southwell.cases.campbell.machine import MachineRequest, machine_diagram
from southwell.cases.campbell.required import RequiredMargin
from southwell.cases.input.errors import CaseError
from southwell.cases.input.readers.openfast import turbine
from southwell.reports.cli import app
from southwell.tests.support import htc_decks
from southwell.tests.support.turbine_decks import deck


def southwell(line: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as exit_:
        app.main(line.split())
    out, err = capsys.readouterr()
    return int(exit_.value.code or 0), " ".join(out.split()), err


def test_a_deck_becomes_a_diagram_of_the_turbine(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = deck(tmp_path), tmp_path / "out"
    line = f"campbell {path} --rpm 0:24:6 --modes 8 --operating 6:24 --strict --margin 90% -o {out}"
    status, output, err = southwell(line, capsys)
    assert (status, err) == (1, "")  # margins are violated
    assert output.startswith("small.fst: the whole turbine on rigid ground")
    assert "not used: DTTorDmp" in output
    assert "not used: TwrFADmp(1)" in output
    page = (out / "campbell.md").read_text()
    for name in ("1st tower fore-aft", "1st edge backward whirl", "Crossings", "DTTorDmp"):
        assert name in page
    assert {p.name for p in out.iterdir()} == {f"campbell.{kind}" for kind in ("md", "svg", "png", "csv")}
    rows = (out / "campbell.csv").read_text().splitlines()
    assert len(rows) == 1 + 5 * 8


def test_one_blade_of_a_turbine_on_request(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = deck(tmp_path)
    status, _, err = southwell(f"campbell {path} --rpm 0:20:10 --azimuth 0 -o {tmp_path / 'out'}", capsys)
    assert status == 2
    assert "--azimuth" in err
    assert "--blade-only" in err
    line = f"campbell {path} --blade-only --rpm 0:20:10 --modes 1 --elements 8 -o {tmp_path / 'out'}"
    status, output, _ = southwell(line, capsys)
    assert status == 0
    assert "one blade of the turbine, clamped at the hub" in output


def test_an_htc_becomes_a_diagram_of_the_turbine(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = htc_decks.htc(tmp_path)
    status, output, err = southwell(f"campbell {path} --modes 4 --rpm 0,20 -o {tmp_path / 'out'}", capsys)
    assert (status, err) == (0, "")
    assert output.startswith("small.htc: the whole turbine on rigid ground")
    assert "taken as rigid, with all mass: towertop below 0.001 %" in output


def test_modes_of_a_tower(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck(tmp_path)
    status, output, err = southwell(f"modes {tmp_path / 'tower.dat'} --modes 2", capsys)
    assert (status, err) == (0, "")
    assert "flapwise is fore-aft" in output


def test_lines_margins_and_uncertainty(tmp_path: Path) -> None:
    machine = turbine.read(deck(tmp_path)).turbine
    request = MachineRequest((0.0, 0.5, 1.0, 1.5, 2.0), modes=6, operating=(1.0, 2.0), margin=RequiredMargin(0.05))
    diagram = machine_diagram(machine, request)
    assert len({line.name for line in diagram.lines}) == 6
    assert all(line.uncertainty < 1e-5 for line in diagram.lines)
    for crossing in diagram.crossings:
        line = diagram.lines[crossing.line]
        assert line.frequencies.min() * 0.99 < crossing.per_rev * crossing.omega < line.frequencies.max() * 1.01
    met = {(c.line, c.per_rev) for c in diagram.crossings if 1.0 <= c.omega <= 2.0}
    assert met
    assert all(not n.kept and n.distance == 0.0 for n in diagram.nearest if (n.line, n.per_rev) in met)
    with pytest.raises(CaseError, match="at least two"):
        machine_diagram(machine, MachineRequest((1.0,)))
