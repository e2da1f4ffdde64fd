"""Results do not depend on the units of mass, length and time: frequencies scale, and refusals stay the same.

In other units a code sees other numbers: this finds every tolerance that is an absolute value, or that mixes units.
"""

import re
from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from southwell import multibody as mb
from southwell.core.mechanism.length import coordinate_units
from southwell.core.spectrum.eigen import EigenError
from southwell.references.matrices.rescaling import Units, in_units
from southwell.tests.core.steady.test_periodic import REFUSED
from southwell.tests.support import linkages, mechanisms

pytestmark = pytest.mark.numerical

Case = tuple[mb.Mechanism, dict[str, float]]
DECADES = st.integers(-3, 3)

ACCEPTED = {
    **mechanisms.CASES,
    "slider-crank on a table": linkages.slider_crank,
    "spatial loop": linkages.spatial_loop,
    **{
        f"random loop closed by a {loop} joint": partial(
            linkages.random_loop, [linkages.KINDS[(k + i) % 6] for i in range(3)], loop, [False, True, False], k
        )
        for k, loop in enumerate(linkages.LOOPS)
    },
}
SLOW = {"five-bar, undamped", "slider-crank on a table"}

UNSTEADY = {
    **{name: (mechanism, {}) for name, (mechanism, _) in REFUSED.items()},
    "ground resonance with one blade": (linkages.ground_resonance(), {}),
    "a falling mass": (linkages.falling(), {}),
    "a loop that cannot close": (replace(linkages.four_bar("C"), motions=(mb.Motion("D.rz", 0.0),)), linkages.FOUR),
}


def in_other_units(case: Case, units: Units) -> Case:
    mechanism, guess = case
    unit = coordinate_units(mechanism, units.length)
    return in_units(mechanism, units), {name: value / unit[name] for name, value in guess.items()}


@cache
def in_SI(name: str) -> mb.Solution:
    mechanism, guess = ACCEPTED[name]()
    return mb.solve(mechanism, guess)


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.nightly] if n in SLOW else []) for n in ACCEPTED])
@settings(max_examples=3, deadline=None)
@given(mass=DECADES, length=DECADES, time=DECADES)
def test_frequencies_scale_with_the_units(name: str, mass: int, length: int, time: int) -> None:
    """Within the stated rounding of both; the same coordinates are independent and the same constraints redundant."""
    units = Units(10.0**mass, 10.0**length, 10.0**time)
    expected, solution = in_SI(name), mb.solve(*in_other_units(ACCEPTED[name](), units))
    assert (solution.independent, solution.redundant) == (expected.independent, expected.redundant)
    np.testing.assert_array_equal(solution.frequencies == 0, expected.frequencies == 0)  # rigid modes
    allowed = expected.uncertainty + solution.uncertainty
    assert (np.abs(solution.frequencies / units.time - expected.frequencies) <= allowed * expected.frequencies).all()
    # eigenvalues of equal modulus, such as the real pair of an instability, have no order
    pairs = np.abs(solution.values[:, None] / units.time - expected.values) <= 2.0 * allowed[:, None] * np.abs(
        expected.values
    )
    assert pairs.any(axis=0).all()


@pytest.mark.parametrize("name", UNSTEADY)
@settings(max_examples=3, deadline=None)
@given(mass=DECADES, length=DECADES, time=DECADES)
def test_refusals_do_not_depend_on_the_units(name: str, mass: int, length: int, time: int) -> None:
    case = UNSTEADY[name]
    messages = []
    for mechanism, guess in (case, in_other_units(case, Units(10.0**mass, 10.0**length, 10.0**time))):
        with pytest.raises(mb.MechanismError) as caught:
            mb.solve(mechanism, guess)
        messages.append(re.sub(r"-?\d[\d.e+-]*", "#", str(caught.value)))
    assert messages[0] == messages[1]


@pytest.mark.parametrize("metres", [1e-3, 1.0, 10.0, 100.0, 1000.0])
def test_a_slider_crank_of_any_size_is_assembled(metres: float) -> None:
    """From a guess of half the distance; the slider is at ``r cos θ + √(l² − r² sin² θ)``."""
    mechanism, _ = linkages.slider_crank()
    at_rest = replace(mechanism, motions=(mb.Motion("turn.rz", 0.0), mb.Motion("O.rz", 0.8)))
    guess = {"P.rz": -0.5, "guide.z": 1.0}
    solution = mb.solve(*in_other_units((at_rest, guess), Units(length=1.0 / metres)))
    exact = 0.5 * np.cos(0.8) + np.sqrt(4.0 - (0.5 * np.sin(0.8)) ** 2)
    assert solution.steady["guide.z"] == pytest.approx(exact * metres, rel=1e-12)


def test_units_of_a_prismatic_oscillator() -> None:
    """√(k/m) and m g/k from numbers in grams, millimetres and milliseconds."""
    rail = mb.Joint("rail", "prismatic", "ground", "mass")
    mechanism = mb.Mechanism(
        (mb.Body("mass", mb.inertia(2.0)),),
        (rail,),
        coordinate_springs=(mb.CoordinateSpring("rail.z", 50.0, 4.0, 0.3),),
        gravity=(0.0, 0.0, -9.81),
    )
    solution = mb.solve(in_units(mechanism, Units(1e-3, 1e-3, 1e-3)))
    assert solution.frequencies == pytest.approx([5.0e-3], rel=1e-12)
    assert solution.damping == pytest.approx([4.0 / (2 * 2.0 * 5.0)], rel=1e-12)
    assert solution.steady["rail.z"] == pytest.approx(1e3 * (0.3 - 2.0 * 9.81 / 50.0), rel=1e-12)


@pytest.mark.parametrize("rate", [1e160, 1e200])
def test_values_that_overflow_are_refused(rate: float) -> None:
    mechanism, guess = ACCEPTED["pitch-link"]()
    fast = replace(mechanism, motions=tuple(replace(m, rate=rate) for m in mechanism.motions))
    with (
        np.errstate(all="ignore"),
        pytest.raises(mb.MechanismError, match="not finite: a value is out of range; check units"),
    ):
        mb.solve(fast, guess)


def test_a_stiffness_that_overflows_is_refused() -> None:
    swing = mb.Joint("swing", "revolute", "ground", "bob")
    spring = mb.CoordinateSpring("swing.rz", stiffness=1e300, neutral=1e100)
    mechanism = mb.Mechanism(
        (mb.Body("bob", mb.inertia(1.0, 1.0, (1.0, 0.0, 0.0))),), (swing,), coordinate_springs=(spring,)
    )
    with np.errstate(all="ignore"), pytest.raises(mb.MechanismError, match="not finite"):
        mb.solve(mechanism)


@pytest.mark.parametrize(("stiffness", "mass", "error"), [(5e-324, 1.0, EigenError), (1.0, 1e308, mb.MechanismError)])
def test_extreme_numbers_are_refused_with_a_message(stiffness: float, mass: float, error: type[Exception]) -> None:
    spring = mb.CoordinateSpring("swing.rz", stiffness)
    mechanism = mb.Mechanism(
        (mb.Body("bob", mb.inertia(mass, mass)),),
        (mb.Joint("swing", "revolute", "ground", "bob"),),
        coordinate_springs=(spring,),
    )
    with np.errstate(all="ignore"), pytest.raises(error, match="check"):
        mb.solve(mechanism)


@settings(max_examples=8, deadline=None)
@given(mass=DECADES, length=DECADES, time=DECADES)
def test_a_beam_with_mass_moves_steadily_in_any_unit(mass: int, length: int, time: int) -> None:
    """On a shaft it does; an end that turns about its own axis at 1e-8 of the speed does not."""
    units = Units(10.0**mass, 10.0**length, 10.0**time)
    beam = mb.straight_beam(2.0, EA=1e6, GJ=1e4, EI_y=1e4, EI_z=1e4, mass=3.0, I_y=0.1, I_z=0.1)
    for creep in (0.0, 1e-8):
        mechanism = mb.Mechanism(
            (mb.Body("hub"), mb.Body("tip", mb.inertia(1.0, 0.1))),
            (
                mb.Joint("shaft", "revolute", "ground", "hub", mb.at(x=-2.0)),
                mb.Joint("arm", "elastic", "hub", "tip", mb.at(x=2.0, axis="z")),
            ),
            (mb.Motion("shaft.rz", rate=3.0), mb.Motion("arm.rx", rate=3.0 * creep)),
            beams=(mb.Beam("hub", "tip", beam),),
        )
        scaled = in_units(mechanism, units)
        if creep:
            with pytest.raises(mb.MechanismError, match="do not move together steadily"):
                mb.solve(scaled)
        else:
            expected, solution = mb.solve(mechanism), mb.solve(scaled)
            np.testing.assert_allclose(solution.frequencies / units.time, expected.frequencies, rtol=1e-6)
