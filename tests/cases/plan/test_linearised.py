"""Linearisations as results of a program: ``--add openfast=case.*.lin`` beside the codes that solve a turbine."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from southwell.cases.input.errors import CaseError
from southwell.cases.judge.results import Cell
from southwell.cases.linearisation.machine import deck
from southwell.cases.plan import linearised
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.cases.plan.turbine import TurbineSubject
from southwell.core.effects import ALL_EFFECTS
from southwell.references.protocol.process import Limits
from southwell.tests.support.elastodyn_decks import files, shaped
from southwell.tests.support.linearised_machines import Lin, without


def write(folder: Path, lins: Sequence[Lin]) -> str:
    for k, lin in enumerate(lins):
        (folder / f"case.{k + 1}.lin").write_text(lin.text())
    return f"openfast={folder}/case.*.lin"


def cells(fst: Path, add: str) -> list[Cell]:
    """The cells of the added linearisations at the speeds of the run."""
    (subject,) = subjects(Request(subjects=(str(fst),), add=(add,)), print)
    assert isinstance(subject, TurbineSubject)
    results = linearised.read(*add.split("=", 1))
    (column,) = subject.columns([], Limits(), [results])
    core = subject.references([column])()[ALL_EFFECTS]
    return column(subject.points, core)[0]


@pytest.fixture
def fst(tmp_path: Path) -> Path:
    return shaped(tmp_path, nodes=40, pitch=0.0)


def test_modes_are_cells_with_the_parts_of_their_differences(fst: Path, tmp_path: Path) -> None:
    """The speed is that of the files. What is left of each difference is rounding and damping."""
    result = cells(fst, write(tmp_path, files(deck.read(fst))))
    by_name = {f"{cell.family} {cell.ordinal}": cell for cell in result}
    assert {"tower fore-aft 1", "flap collective 1", "edge forward whirl 1"} <= set(by_name)
    assert {cell.omega for cell in result} == {2.5}
    compared = [cell for cell in result if cell.difference is not None]
    assert len(compared) >= 6
    assert {cell.verdict for cell in compared} <= {"pass", "known difference"}
    assert "mode shapes +" in by_name["tower fore-aft 1"].reason


def test_files_with_a_defect_agree_with_nothing(fst: Path, tmp_path: Path) -> None:
    lins = files(deck.read(fst))
    lins[0] = replace(lins[0], omega=1.02 * lins[0].omega)
    result = cells(fst, write(tmp_path, lins))
    assert not {cell.verdict for cell in result} & {"pass", "known difference"}
    assert any("unsteady operating point" in cell.reason for cell in result)


def test_blades_pitched_otherwise_are_not_applicable(tmp_path: Path) -> None:
    fst = shaped(tmp_path, pitch=2.0)
    (cell,) = cells(fst, write(tmp_path, files(deck.read(fst), azimuths=1)))
    assert (cell.verdict, cell.reason.partition("give ")[2]) == ("not applicable", "--pitch=-2")


def test_a_rotor_alone_is_not_applicable(fst: Path, tmp_path: Path) -> None:
    lins = [without(lin, "tower") for lin in files(deck.read(fst), azimuths=1)]
    (cell,) = cells(fst, write(tmp_path, lins))
    assert cell.verdict == "not applicable"
    assert "no states of tower fore-aft 1, tower side-side 1" in cell.reason


def test_linearisations_belong_to_one_turbine(fst: Path, tmp_path: Path) -> None:
    name, pattern = write(tmp_path, files(deck.read(fst), azimuths=1)).split("=", 1)
    results = linearised.read(name, pattern)
    linearised.check([results], ["small"])
    with pytest.raises(CaseError, match=r"the run has none: give its primary file"):
        linearised.check([results], [])
    with pytest.raises(CaseError, match="no such files"):
        linearised.read("openfast", str(tmp_path / "other.*.lin"))
