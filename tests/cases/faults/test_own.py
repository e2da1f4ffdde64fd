"""Faults on the blade that is verified: detected by a fail of an independent code, or by the second reading of its file."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.faults import own, own_reading, table
from southwell.cases.faults.seeding import seeded
from southwell.cases.input import library
from southwell.cases.judge.results import Cell, Control, Verdict
from southwell.cases.plan.blade import BladeSubject, blades
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.core.blade import uniform_blade
from southwell.core.solve import mesh_modes
from southwell.references.protocol.description import Description

from ...support import decks

BLADE = uniform_blade("beam", 6.0, 0.6, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=1.2)
CONTROL = Control("no hub radius", "solver", "the root is on the axis", "", "beam", 10.0, ())


def users(blade_hub: float = 0.6) -> BladeSubject:
    """A blade that does not come with the package, at one speed."""
    (subject,) = blades(library.load("park-cantilever"))
    blade = replace(BLADE, hub_radius=blade_hub)
    case = replace(subject.case, path="mine.toml")
    return BladeSubject(case, replace(subject.variant, name="beam", blade=blade, speeds=np.array([0.0, 10.0])))


def cell(verdict: Verdict, reference: float = 5.0, difference: float = 0.0) -> Cell:
    return Cell(
        *("beam", 10.0, 1, "flapwise", "code", "1", "code", 5.0, reference, difference, 1e-9, 1e-3, verdict),
        shares="nothing",
        ordinal=1,
    )


def test_only_the_verdict_fail_detects_a_fault() -> None:
    correct = [cell("pass")]
    judgement = own.judged(CONTROL, correct, [cell("fail", 5.2, -0.04)])
    assert judgement.detected_by == ("beam, code, flapwise 1, 10 rad/s: fail",)
    assert judgement.change == -0.04
    assert own.judged(CONTROL, correct, [cell("inconclusive", 5.2, -0.04)]).missed
    assert own.judged(CONTROL, [cell("fail")], [cell("fail", 5.2)]).missed


def test_a_fault_below_the_target_is_without_effect_here() -> None:
    judgement = own.judged(CONTROL, [cell("pass")], [cell("pass", 5.0001)])
    assert judgement.without_effect == "changes no compared frequency by more than 0.0020 %"
    assert not judgement.missed


def test_witnesses_share_nothing_and_pass_every_mode_at_the_highest_speed() -> None:
    subject = users()
    good = cell("pass")
    others = [replace(good, code="two", mode=2, verdict="fail"), replace(good, code="two")]
    derived = replace(good, code="three", shares="mechanical model")
    slow = replace(good, code="four", omega=0.0)
    deck = replace(good, code="a column that reads the deck")
    codes = [Description(asked=f"package.{name}:CODE", name=name) for name in ("code", "two", "three", "four")]
    assert own.witnesses([deck, good, *others, derived, slow], subject, codes) == ("package.code:CODE",)


def test_blades_of_the_package_have_no_faults_of_their_own() -> None:
    assert users().users
    assert not blades(library.load("park-cantilever"))[0].users


def test_without_an_independent_code_no_fault_is_tried() -> None:
    (run,) = own.run(users(), (), ("no hub radius",))
    assert run.needs == own.NO_WITNESS
    assert not run.missed


@pytest.mark.slow
@pytest.mark.parametrize(("hub", "detected"), [(0.6, True), (0.0, False)])
def test_faults_of_core_act_on_the_users_blade(hub: float, detected: bool) -> None:
    softening, radius = own.run(users(hub), ("exact-beam",), ("softening's sign", "no hub radius"))
    assert "exact-beam" in softening.detected_by[0]
    assert bool(radius.detected_by) == detected
    assert bool(radius.without_effect) != detected


def outcomes(controls: Sequence[Control]) -> dict[str, str]:
    return {
        c.control.removeprefix("reader: "): "missed" if c.missed else c.without_effect or c.detected_by[0]
        for c in controls
    }


@pytest.mark.slow
def test_the_second_reading_detects_mistakes_of_the_reader(tmp_path: Path) -> None:
    pytest.importorskip("weio")
    decks.openfast(tmp_path)
    (subject,) = subjects(Request((str(tmp_path / "elastodyn_main.dat"),), rpm="10"), lambda _: None)
    assert isinstance(subject, BladeSubject)
    result = outcomes(own_reading.run(subject))
    assert "missed" not in result.values()
    assert "flapwise stiffness" in result["columns exchanged"]
    assert "mass per length" in result["mass multiplier"]
    assert "twist" in result["station"]
    assert result["prebend's sign"] == "changes no property of this blade"


@pytest.mark.slow
def test_the_paper_s_equations_detect_a_whole_end_mass_and_codes_a_pairing() -> None:
    mass, pairing, twist = own.run(
        users(), ("exact-beam",), ("whole end mass", "paired with the next", "twist across ±180°")
    )
    assert "paper's equations, literally" in mass.detected_by[0]
    assert "exact-beam" in pairing.detected_by[0]
    assert twist.without_effect == "changes no compared frequency"


def test_a_twist_that_jumps_by_a_turn_is_detected_where_its_sign_changes() -> None:
    fault = table.BY_NAME["twist across ±180°"]
    crossing, above = (replace(BLADE, twist=np.array(twist)) for twist in ([0.2, -0.1], [0.2, 0.1]))
    for blade, largest in ((crossing, 0.005), (above, 0.0)):
        correct = mesh_modes(blade, 10.0, 8, 2).frequencies
        with seeded(fault.seams):
            altered = mesh_modes(blade, 10.0, 8, 2).frequencies
        assert (abs(altered / correct - 1.0) >= largest).any()
        assert (largest > 0) == (altered != correct).any()


def test_every_fault_of_the_users_blade_follows_from_those_of_every_run() -> None:
    assert own.chosen(table.FAST) == own.NAMES
    assert own.chosen(("whole end mass",)) == ("whole end mass",)
    assert own.chosen(("paired by number", "density")) == ("paired by number",)
    assert own.chosen(()) == ()


def test_a_blade_without_a_file_has_no_reading() -> None:
    assert own_reading.run(users()) == []
