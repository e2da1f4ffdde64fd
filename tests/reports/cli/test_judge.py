"""``southwell judge``: verdict first, findings, modes; status and width."""

import json
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input.readers.openfast.turbine import read
from southwell.core.turbine.machine import machine
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.reports.cli.app import main
from southwell.tests.support.elastodyn_decks import shaped
from southwell.tests.support.linearised_defects import exchanged_blades, healthy
from southwell.tests.support.linearised_machines import Lin, Machine
from southwell.tests.support.turbine_decks import deck


def write(folder: Path, lins: list[Lin], name: str = "case") -> list[str]:
    paths = [folder / f"{name}.{k + 1}.lin" for k in range(len(lins))]
    for path, lin in zip(paths, lins, strict=True):
        path.write_text(lin.text())
    return [str(path) for path in paths]


def southwell(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as status:
        main(["judge", *words])
    out, err = capsys.readouterr()
    return int(status.value.code or 0), out, err


def test_a_set_without_defects_has_status_0(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = southwell(capsys, *write(tmp_path, healthy(n=5)))
    assert status == 0
    assert out.startswith("Yes: no defect was found (5 linearisations, 1 operating point)\n")
    assert "tower fore-aft 1" in out


def test_a_defect_is_status_1_and_named_before_the_modes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = southwell(capsys, *write(tmp_path, exchanged_blades()))
    lines = out.splitlines()
    assert status == 1
    assert lines[0].startswith(
        "No: these linearisations have a defect (12 linearisations, 1 operating point; 1 defect)"
    )
    assert lines[1].startswith("✘ blades exchanged: ")


def test_limited_evidence_is_status_1(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = southwell(capsys, *write(tmp_path, healthy(n=1)))
    assert status == 1
    assert out.startswith("Open: no defect was found, but the files do not show everything")


def test_invalid_input_is_one_line_and_status_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "case.1.lin"
    path.write_text("nothing\n")
    for words in ([str(path)], [str(tmp_path / "absent.lin")], [str(tmp_path)], []):
        status, out, err = southwell(capsys, *words)
        assert (status, out, err.count("\n")) == (2, "", 1)


def test_operating_points_are_a_campbell_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    slow, fast = healthy(Machine(omega=0.8), 5), healthy(Machine(omega=1.1), 5)
    status, out, _ = southwell(capsys, *write(tmp_path, slow, "slow"), *write(tmp_path, fast, "fast"))
    assert status == 0
    assert "7.639" in out
    assert "10.5" in out
    assert out.count("flapwise 1 backward") == 2  # frequency and damping


@pytest.mark.parametrize("width", [80, 120])
def test_tables_fit(
    width: int, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("southwell.reports.shared.console.WIDE", width)
    many = [p for k in range(6) for p in write(tmp_path, healthy(Machine(omega=0.5 + 0.1 * k), 1), f"point{k}")]
    for words in (many, many[:1]):
        _, out, _ = southwell(capsys, *words)
        tables = [line for line in out.splitlines() if not line.startswith(("Open", "○", "–", "✘"))]
        assert max(len(line) for line in tables) <= width
        assert sum("─" in line for line in tables) >= 1


def test_json_has_findings_and_modes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = southwell(capsys, "--json", *write(tmp_path, healthy(n=5)))
    data = json.loads(out)
    assert (status, data["verdict"]) == (0, "Yes")
    (point,) = data["operating_points"]
    assert len(point["files"]) == 5
    assert point["modes"][0]["name"] == "tower side-side 1"
    assert point["modes"][0]["frequency_hz"] == pytest.approx(0.3294, rel=1e-3)


def test_a_deck_is_listed_beside(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = write(tmp_path, healthy(n=1))
    fst = str(deck(tmp_path, free=True))
    tower = tmp_path / "tower.dat"
    shapes = [f"{value} {name}({k})" for name in ("TwFAM1Sh", "TwSSM1Sh") for k, value in enumerate((1, 0, 0, 0, 0), 2)]
    tower.write_text(tower.read_text() + "\n".join(shapes) + "\n")
    status, out, err = southwell(capsys, *files, "--fst", fst)
    assert (status, out) == (2, "")
    assert "the deck's blades have no such shape" in err
    fst = str(shaped(tmp_path))
    for file in files:  # no cause is sought with aerodynamics, which takes seconds
        Path(file).write_text(Path(file).read_text().replace("; BeamDyn", "; AeroDyn"))
    _, out, _ = southwell(capsys, *files, "--fst", fst)
    assert "beside Southwell's turbine in vacuo" in out
    _, out, _ = southwell(capsys, *files, "--fst", fst, "--json")
    (point,) = json.loads(out)["operating_points"]
    modes = {pair["mode"]: pair for pair in point["machine"]}
    expected = turbine_modes(machine(read(Path(fst)).turbine), 1.1, 20)
    frequency = expected.frequencies[expected.names.index("1st tower fore-aft")] / (2 * np.pi)
    assert modes["tower fore-aft 1"]["southwell_frequency_hz"] == pytest.approx(frequency, rel=1e-4)
    assert point["remark"].startswith("aerodynamic stiffness is part of the rest")


def test_a_blade_is_no_deck_of_a_turbine(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = write(tmp_path, healthy(n=1))
    deck(tmp_path)
    for name in ("blade.dat", "absent.fst"):
        status, out, err = southwell(capsys, *files, "--fst", str(tmp_path / name))
        assert (status, out, err.count("\n")) == (2, "", 1)
