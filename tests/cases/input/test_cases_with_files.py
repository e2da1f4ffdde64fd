"""Cases whose blades are in published files that do not come with the package: run where they are, said where they are not."""

import os
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.input.errors import CaseError, FilesMissingError
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.core.blade import coupled, straight
from southwell.reports.cli import app as cli

FILES = "SOUTHWELL_BLADES"
NAMES = ("iea-15", "nrel-5mw-beamdyn")
real = pytest.mark.skipif(not os.environ.get(FILES), reason=f"set {FILES} to a folder of public blade files")


def southwell(*arguments: str) -> int:
    with pytest.raises(SystemExit) as exit_info:
        cli.main(arguments)
    return int(exit_info.value.code or 0)


@pytest.mark.parametrize("name", NAMES)
def test_without_the_files_the_variable_to_set_is_named(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv(FILES, raising=False)
    with pytest.raises(FilesMissingError, match=f"{name}: file: .*: {FILES} is not set: set it to a folder"):
        library.load(name)
    monkeypatch.setenv(FILES, str(tmp_path))
    with pytest.raises(FilesMissingError, match=f"not in {FILES}={tmp_path}"):
        library.load(name)
    assert set(library.load_all()[1]) == set(NAMES)


def test_a_damaged_file_is_an_error(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "iea15" / "IEA-15-240-RWT_BeamDyn_blade.dat"
    path.parent.mkdir()
    path.write_text("nothing\n")
    monkeypatch.setenv(FILES, str(tmp_path))
    with pytest.raises(CaseError) as caught:
        library.load("iea-15")
    assert not isinstance(caught.value, FilesMissingError)


def test_a_case_without_its_files_requested_by_name_is_bad_input(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv(FILES, raising=False)
    assert southwell("verify", "iea-15") == 2
    assert capsys.readouterr().err.startswith("southwell: iea-15: file: ")


def test_a_case_without_its_files_is_left_out_of_all_cases(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv(FILES, raising=False)
    notes: list[str] = []
    chosen = {subject.name for subject in subjects(Request(), notes.append)}
    assert not set(NAMES) & chosen
    assert "park-cantilever" in chosen
    assert [line.partition(": not run: ")[0] for line in notes] == list(NAMES)
    assert southwell("cases") == 0
    assert f"{FILES} is not set" in " ".join(capsys.readouterr().out.split())


@real
def test_the_decks_are_the_coupled_ones() -> None:
    """IEA-15: 65.25 t (TP-5000-75698, table 2-1), prebent by 4 m; NREL: 17,740 kg are of multiplied masses, as in nrel-5mw."""
    iea, nrel = (library.load(name).variants[0].blade for name in NAMES)
    assert coupled(iea)
    assert not straight(iea)
    assert iea.curve[-1, 2] == pytest.approx(-4.0, abs=1e-9)
    s = np.linspace(0, iea.length, 20001)
    mass = np.interp(s, iea.stations, iea.mass[:, 0, 0]).mean() * iea.length
    assert mass == pytest.approx(65250, rel=0.06)
    assert nrel.length == pytest.approx(61.5)
