"""``southwell mechanism``: what it says about the accuracy of its results."""

from pathlib import Path

import pytest

from southwell.reports.cli.app import main

Captured = pytest.CaptureFixture[str]

HUNG = """
name = "hung"
gravity = [9.81, 0, 0]
[bodies.mass]
mass = 10.0
moments = [0.1, 0.1, 0.1]
[joints.end]
kind = "elastic"
parent = "ground"
child = "mass"
at_parent = {{ point = [2.0, 0, 0] }}
[[beams]]
body_a = "ground"
body_b = "mass"
length = 2.0
EA = {EA}
GJ = 1e3
EI_y = 1e3
EI_z = 1e3
"""


def hung(folder: Path, EA: float) -> str:
    """A file with 98.1 N on a beam of this axial stiffness, N."""
    (folder / "hung.toml").write_text(HUNG.format(EA=EA))
    return str(folder / "hung.toml")


def southwell(capsys: Captured, *arguments: str) -> tuple[int, str, str]:
    """Status, standard output and standard error."""
    with pytest.raises(SystemExit) as exit_info:
        main(["mechanism", *arguments])
    out, err = capsys.readouterr()
    return int(exit_info.value.code or 0), out, err


def test_a_large_strain_is_reported_and_so_is_the_discretisation(tmp_path: Path, capsys: Captured) -> None:
    status, out, _ = southwell(capsys, hung(tmp_path, 98.1 / 0.05))
    assert status == 0
    assert "steady strain up to 5.0%: above 2%, check that linear elastic sections describe the beams" in out
    assert "each beam is one element" in out


def test_a_small_strain_is_not_reported(tmp_path: Path, capsys: Captured) -> None:
    status, out, _ = southwell(capsys, hung(tmp_path, 98.1 / 0.01))
    assert status == 0
    assert "steady strain" not in out


def test_a_strain_above_20_percent_is_refused_unless_allowed(tmp_path: Path, capsys: Captured) -> None:
    path = hung(tmp_path, 98.1 / 0.3)
    status, _, err = southwell(capsys, path)
    assert status == 2
    assert f"{path}: beams: steady strain 30%: too large" in err
    status, out, _ = southwell(capsys, path, "--allow-large-strain")
    assert status == 0
    assert "steady strain up to 30.0%" in out


def test_without_beams_nothing_is_discretised(capsys: Captured) -> None:
    status, out, _ = southwell(capsys, "pitch-link")
    assert status == 0
    assert "nothing is discretised" in out
