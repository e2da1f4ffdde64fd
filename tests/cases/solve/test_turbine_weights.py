"""Mass, mass centre and inertia of a turbine, as each code assembles it, against a second reading of its deck."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.faults import turbines
from southwell.cases.plan.request import Request
from southwell.cases.plan.subjects import subjects
from southwell.cases.plan.turbine import TurbineSubject
from southwell.cases.solve import turbine_weights
from southwell.core.turbine.turbine import Turbine
from southwell.references.exudyn.turbine import CODE as EXUDYN
from southwell.references.joint_chains.pinocchio_turbine import CODE as PINOCCHIO
from southwell.references.protocol.description import describe
from southwell.references.protocol.fingerprint import Fingerprint
from southwell.references.protocol.process import Limits
from southwell.references.protocol.turbines import TurbineAdapter
from southwell.references.readers.turbine_mass import Moments, Weighed
from southwell.tests.support.turbine_decks import deck

pytest.importorskip("weio")


@pytest.fixture(scope="module")
def weighed(tmp_path_factory: pytest.TempPathFactory) -> tuple[Turbine, Weighed]:
    (subject,) = subjects(Request((str(deck(tmp_path_factory.mktemp("deck"))),)), print)
    assert isinstance(subject, TurbineSubject)
    assert subject.deck
    _, second = subject.second_reading(subject.deck)
    assert second
    return subject.turbine, second


def failing(model: Fingerprint, second: Weighed) -> set[str]:
    return {row.part for row in turbine_weights.rows("small", "code", "1", model, second) if row.verdict != "pass"}


def test_the_solvers_turbine_has_the_mass_of_the_deck(weighed: tuple[Turbine, Weighed]) -> None:
    turbine, second = weighed
    model = turbine_weights.of_core(turbine)
    assert not failing(model, second)
    assert model.mass == pytest.approx(second.total.mass, rel=1e-12)
    assert model.inertia == pytest.approx(second.total.inertia, rel=1e-9)


@pytest.mark.parametrize("code", [EXUDYN, PINOCCHIO], ids=lambda code: code.name)
def test_the_turbine_of_a_code_has_the_mass_of_the_deck(code: TurbineAdapter, weighed: tuple[Turbine, Weighed]) -> None:
    turbine, second = weighed
    model = code.turbine_fingerprint(turbine, 6)
    assert model is not None
    assert not failing(model, second)


def test_the_process_of_a_code_reports_the_mass_of_its_turbine(weighed: tuple[Turbine, Weighed]) -> None:
    turbine, second = weighed
    (code,) = describe(["exudyn-turbine"], [])
    (task,) = turbine_weights.weighings("small", turbine, second, [code], Limits())
    assert [row.verdict for row in task()] == ["pass"] * 8


def test_wrong_machines_are_named_by_their_weight(weighed: tuple[Turbine, Weighed]) -> None:
    turbine, second = weighed

    def wrong(**changed: object) -> set[str]:
        return failing(turbine_weights.of_core(replace(turbine, **changed)), second)

    nacelle = turbine.nacelle.copy()
    nacelle[3:, 3:] -= 9000.0 * 0.9**2 * np.diag([0.0, 1.0, 1.0])  # about its mass centre
    assert wrong(nacelle=nacelle) == {"inertia about the base, pitch", "inertia about the base, roll"}
    tilted = failing(turbine_weights.of_core(turbines.other_tilt(turbine)), second)
    assert "first moment of mass up" in tilted
    assert "rotor's inertia about the shaft" not in tilted
    coned = failing(turbine_weights.of_core(turbines.other_cone(turbine)), second)
    assert "first moment of mass downwind" in coned
    assert wrong(hub=1.01 * turbine.hub) >= {"mass", "rotor's inertia about the shaft"}


def test_moments_of_a_displaced_body() -> None:
    """A unit mass at (1, 2, 3) has the inertia r² I − r rᵀ."""
    body = Moments(2.0, np.zeros(3), np.zeros((3, 3))).moved(np.eye(3), np.array([1.0, 2.0, 3.0]))
    np.testing.assert_allclose(body.inertia, [26.0, 20.0, 10.0])
    np.testing.assert_allclose((body + body).first, [4.0, 8.0, 12.0])
