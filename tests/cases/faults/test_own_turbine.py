"""Faults on the turbine that is verified: detected by a fail of a code without them, or by the second reading of its file."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.faults import own, own_reading, own_turbine, table
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.cases.plan.turbine import TurbineSubject
from southwell.cases.solve import turbine as solving
from southwell.core.turbine.machine import Resolution, machine
from southwell.core.turbine.turbine import Turbine
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.references.protocol.process import Limits
from southwell.references.protocol.turbines import TurbineModes
from southwell.references.protocol.worker import Run
from southwell.tests.support.turbine_decks import deck


@pytest.fixture
def subject(tmp_path: Path) -> TurbineSubject:
    (turbine,) = subjects(Request((str(deck(tmp_path)),), rpm="0,20"), print)
    assert isinstance(turbine, TurbineSubject)
    return turbine


def test_a_users_turbine_has_its_own_faults_in_place_of_those_of_the_packages_blades(subject: TurbineSubject) -> None:
    assert subject.users
    assert own.chosen(table.FAST, own_turbine.NAMES) == own_turbine.NAMES
    assert own.chosen(("turbine: tilt", "density"), own_turbine.NAMES) == ("turbine: tilt",)
    (packaged,) = subjects(Request(("nrel-5mw-turbine",)), print)
    assert isinstance(packaged, TurbineSubject)
    assert not packaged.users


def test_without_an_independent_code_no_fault_is_tried(subject: TurbineSubject) -> None:
    (control,) = own_turbine.run(subject, (), ("turbine: tilt",))
    assert control.needs == own_turbine.NO_WITNESS


@pytest.mark.slow
def test_every_fault_makes_a_code_fail_that_does_not_have_it(
    subject: TurbineSubject, monkeypatch: pytest.MonkeyPatch
) -> None:
    speeds: list[float] = []

    def answers(name: str, turbine: Turbine, runs: Sequence[Run], limits: Limits, version: str) -> list[TurbineModes]:
        full_machine = machine(turbine, Resolution())
        speeds.extend(omega for omega, _, _ in runs)
        solved = [(n, turbine_modes(full_machine, omega, count)) for omega, n, count in runs]
        values = [np.asarray(1j * m.frequencies * (1.0 + 0.5 / n**2), np.complex128) for n, m in solved]
        return [TurbineModes(v, m.motions, n) for v, (n, m) in zip(values, solved, strict=True)]

    monkeypatch.setattr(solving, "turbine_answers", answers)
    controls = own_turbine.run(subject, ("exudyn-turbine", "pinocchio-turbine"), own_turbine.NAMES)
    assert {c.control for c in controls} == set(own_turbine.NAMES)
    for control in controls:
        assert control.detected_by or control.without_effect, control.control
        assert all("exudyn-turbine" in c or "Southwell's own model" in c for c in control.detected_by)
        assert all(c.endswith(": fail") for c in control.detected_by)
    silent = {c.control: c.without_effect for c in controls if c.without_effect}
    assert set(silent) <= {"turbine: gear ratio"}, silent  # the drivetrain's mode is above those compared
    assert len(speeds) == len(set(speeds)) * 3  # each refinement once at speed, and once at rest


@pytest.mark.slow
def test_the_second_reading_detects_mistakes_of_reading(subject: TurbineSubject) -> None:
    pytest.importorskip("weio")
    controls = {c.control: c for c in own_reading.run(subject)}
    assert {fault.name for fault in own_reading.TURBINE} < set(controls)
    assert not [c.control for c in controls.values() if c.missed]
    assert "rise of the shaft downwind" in " ".join(controls["reader: tilt's sign"].detected_by)
    assert "generator's inertia" in controls["reader: gear ratio"].detected_by[0]
    assert "nacelle's mass downwind" in controls["reader: nacelle"].detected_by[0]
