"""A turbine in the matrix: its subject, the verdicts of codes on it, and the command."""

from collections.abc import Callable, Sequence
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from southwell.cases import data
from southwell.cases.input.readers.openfast import turbine as reader
from southwell.cases.input.readers.source import Mount
from southwell.cases.judge.results import Cell
from southwell.cases.plan import turbine as plan
from southwell.cases.plan.blade import BladeSubject
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.cases.plan.turbine import TurbineSubject
from southwell.cases.run.executors import Serial
from southwell.cases.solve import turbine as solving
from southwell.cases.verify import matrix
from southwell.core.turbine.machine import Resolution, machine
from southwell.core.turbine.turbine import Turbine
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.references.protocol.description import describe
from southwell.references.protocol.process import Limits
from southwell.references.protocol.turbines import TurbineModes
from southwell.references.protocol.worker import Run
from southwell.reports.cli import app
from southwell.tests.support.turbine_decks import deck


@pytest.fixture
def subject(tmp_path: Path) -> TurbineSubject:
    path = deck(tmp_path)
    reading = reader.read(path)
    return plan.subject(path, reading, (2.0,), False, Mount())


def cells(
    subject: TurbineSubject, monkeypatch: pytest.MonkeyPatch, alter: Callable[[np.ndarray, int], np.ndarray]
) -> tuple[Cell, ...]:
    """Cells of a code that answers with core's modes, its eigenvalues altered at each refinement."""

    def answers(name: str, turbine: Turbine, runs: Sequence[Run], limits: Limits, version: str) -> list[TurbineModes]:
        full_machine = machine(turbine, Resolution())
        out = []
        for omega, elements, count in runs:
            modes = turbine_modes(full_machine, omega, count)
            out.append(TurbineModes(alter(1j * modes.frequencies, elements), modes.motions, elements))
        return out

    monkeypatch.setattr(solving, "turbine_answers", answers)
    return matrix.run([subject], describe(["exudyn-turbine"]), Serial(), parts=False).cells


def test_a_code_of_second_order_that_converges_to_core_passes(
    subject: TurbineSubject, monkeypatch: pytest.MonkeyPatch
) -> None:
    result = cells(subject, monkeypatch, lambda values, n: values * (1.0 + 0.5 / n**2))
    assert [cell.verdict for cell in result] == ["pass"] * plan.MODES
    assert {"tower fore-aft 1", "drivetrain torsion 1"} <= {cell.name for cell in result}
    assert max(abs(cell.difference or 1.0) for cell in result) < 1e-4


def test_a_wrong_limit_fails(subject: TurbineSubject, monkeypatch: pytest.MonkeyPatch) -> None:
    result = cells(subject, monkeypatch, lambda values, n: values * (1.002 + 0.5 / n**2))
    assert {cell.verdict for cell in result} == {"fail"}


def test_a_damped_answer_does_not_pass(subject: TurbineSubject, monkeypatch: pytest.MonkeyPatch) -> None:
    result = cells(subject, monkeypatch, lambda values, n: values * (1.0 + 0.5 / n**2) - 1e-3 * np.abs(values))
    assert {cell.verdict for cell in result} == {"inconclusive"}


def test_a_primary_file_is_the_turbine_unless_only_its_blade_is_asked_for(tmp_path: Path) -> None:
    path = str(deck(tmp_path))
    (whole,) = subjects(Request((path,)), print)
    assert isinstance(whole, TurbineSubject)
    np.testing.assert_allclose(whole.points, 20.0 * np.pi / 30.0)
    (blade,) = subjects(Request((path,), rpm="20", blade_only=True), print)
    assert isinstance(blade, BladeSubject)


def test_labels_are_unique_and_end_with_a_number() -> None:
    names = ("1st tower fore-aft", "2nd flap tilt", "drivetrain torsion", "1st tower fore-aft", "yaw")
    expected = ("tower fore-aft 1", "flap tilt 2", "drivetrain torsion 1", "tower fore-aft 2", "yaw 1")
    assert solving.labels(names) == expected


@pytest.mark.slow
def test_a_deck_is_verified_with_an_independent_code(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = f"verify {deck(tmp_path)} --rpm 20 --faults none --out {tmp_path / 'out'} --codes exudyn-turbine"
    with pytest.raises(SystemExit) as exit_:
        app.main(line.split())
    output = " ".join(capsys.readouterr().out.split())
    assert (exit_.value.code or 0) == 0, output
    assert "8 cells: 8 ✔ pass" in output


def test_conform_points_a_code_for_turbines_to_its_case(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as exit_:
        app.main(["conform", "exudyn-turbine"])
    assert exit_.value.code == 2
    assert "run southwell verify nrel-5mw-turbine --codes exudyn-turbine" in capsys.readouterr().err


def test_a_turbine_in_toml_is_a_subject_at_the_given_speeds() -> None:
    path = Path(str(files(data) / "turbines" / "nrel-5mw-machine.toml"))
    (whole,) = subjects(Request((str(path),), rpm="6,12"), print)
    assert isinstance(whole, TurbineSubject)
    assert whole.rpm
    np.testing.assert_allclose(whole.points, np.array([6.0, 12.0]) * np.pi / 30.0)
