"""Codes that solve mechanisms give the same frequencies in any unit of mass, length and time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from southwell import multibody as mb
from southwell.references.exudyn import mechanism as exudyn
from southwell.references.linkages import mechanism as pinocchio
from southwell.references.matrices.rescaling import Units
from southwell.tests.core.mechanism.test_units import in_other_units
from southwell.tests.support import mechanisms

pytestmark = pytest.mark.numerical

DECADES = st.integers(-4, 4)


@pytest.mark.parametrize("code", [exudyn.CODE, pinocchio.CODE], ids=lambda code: code.name)
@pytest.mark.parametrize("name", ["pitch-link", "hinged-blade"])
@settings(max_examples=5, deadline=None)
@given(mass=DECADES, length=DECADES, time=DECADES)
def test_frequencies_scale_with_the_units(code, name: str, mass: int, length: int, time: int) -> None:
    if code.version() is None:
        pytest.skip(code.hint)
    units = Units(10.0**mass, 10.0**length, 10.0**time)
    case = mechanisms.CASES[name]()
    expected, scaled = (code.mechanism_modes(*c) for c in (case, in_other_units(case, units)))
    np.testing.assert_allclose(np.abs(scaled.values) / units.time, np.abs(expected.values), rtol=1e-6)
    assert scaled.coordinates == expected.coordinates


@pytest.mark.parametrize("code", [exudyn.CODE, pinocchio.CODE], ids=lambda code: code.name)
@pytest.mark.parametrize("metres", [1e-3, 1.0, 1e3])
def test_a_mass_slides_to_the_end_of_a_spring_of_any_length(code, metres: float) -> None:
    """From the other end: the spring is neutral at 1, and the weight moves it by ``m g/k``."""
    if code.version() is None:
        pytest.skip(code.hint)
    mechanism = mb.Mechanism(
        (mb.Body("mass", mb.inertia(2.0)),),
        (mb.Joint("rail", "prismatic", "ground", "mass"),),
        coordinate_springs=(mb.CoordinateSpring("rail.z", 50.0, 0.0, 1.0),),
        gravity=(0.0, 0.0, -9.81),
    )
    solution = code.mechanism_modes(*in_other_units((mechanism, {}), Units(length=1.0 / metres)))
    assert solution.steady == pytest.approx([metres * (1.0 - 2.0 * 9.81 / 50.0)], rel=1e-9)
    assert np.abs(solution.values) == pytest.approx([5.0], rel=1e-9)
