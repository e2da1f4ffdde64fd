"""Motion prescribed as a function of time: derivatives taken analytically, closed forms at a frozen instant."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from southwell import multibody as mb
from southwell.core.mechanism.motion import instant

G, LENGTH = 9.81, 0.7


def pendulum(law, axis: str) -> mb.Mechanism:
    """A bob hung from a support that moves along ``axis``; y is up, the pendulum swings about z."""
    return mb.Mechanism(
        bodies=(mb.Body("support"), mb.Body("bob", mb.inertia(2.0, 0.0, (0, -LENGTH, 0)))),
        joints=(
            mb.Joint("slide", "prismatic", "ground", "support", mb.at(axis=axis), mb.at(axis=axis)),
            mb.Joint("pin", "revolute", "support", "bob"),
        ),
        motions=(mb.Motion("slide.z", law=law),),
        gravity=(0, -G, 0),
    )


SHAKE = mb.Harmonic(0.3, 4.0, 0.4, mean=0.1)
RAMP = Polynomial([0.2, -1.0, 0.8, 0.5])


def acceleration(law, time: float) -> float:
    """Closed forms: −A ω² sin(ω t + φ) for the harmonic, 2 c₂ + 6 c₃ t for the cubic."""
    harmonic = -0.3 * 16.0 * np.sin(4.0 * time + 0.4)
    cubic = 2 * 0.8 + 6 * 0.5 * time
    return {id(SHAKE): harmonic, id(RAMP): cubic}.get(id(law), harmonic + cubic)


LAWS = [pytest.param(SHAKE, id="harmonic"), pytest.param(RAMP, id="polynomial")]
LAWS += [pytest.param(mb.Sum((SHAKE, RAMP)), id="sum")]


@pytest.mark.parametrize("time", [0.0, 0.35, 1.2])
@pytest.mark.parametrize("law", LAWS)
def test_support_accelerating_upwards(law, time: float) -> None:
    """ω² = (g + a)/l at that instant."""
    solution = mb.solve(pendulum(law, "y"), time=time)
    lifted = G + acceleration(law, time)
    assert solution.values[0] ** 2 == pytest.approx(-lifted / LENGTH, rel=1e-12)
    assert solution.steady["slide.z"] == pytest.approx(law(time), rel=1e-14)


@pytest.mark.parametrize("time", [0.0, 0.35, 1.2])
@pytest.mark.parametrize("law", LAWS)
def test_support_accelerating_sideways(law, time: float) -> None:
    """It hangs at tan θ = −a/g and swings with ω² = √(g² + a²)/l."""
    solution = mb.solve(pendulum(law, "x"), time=time)
    a = acceleration(law, time)
    assert np.tan(solution.steady["pin.rz"]) == pytest.approx(-a / G, rel=1e-10)
    assert solution.frequencies[0] ** 2 == pytest.approx(np.hypot(G, a) / LENGTH, rel=1e-10)


def test_a_rotor_that_spins_up() -> None:
    """Blade on a lag hinge at e, angle q: e S (Ω² sin q + α cos q) + I α = 0; ω² = e S (Ω² cos q − α sin q)/I, at Ω = αt."""
    mass, arm, offset, alpha, time = 3.0, 0.8, 0.5, 2.0, 4.0
    first, second = mass * arm, mass * arm**2 + 0.1
    m = mb.Mechanism(
        bodies=(mb.Body("hub"), mb.Body("blade", mb.inertia(mass, 0.1, (arm, 0, 0)))),
        joints=(
            mb.Joint("shaft", "revolute", "ground", "hub"),
            mb.Joint("lag", "revolute", "hub", "blade", mb.at(offset)),
        ),
        motions=(mb.Motion("shaft.rz", law=Polynomial([0.0, 0.0, 0.5 * alpha])),),
    )
    solution = mb.solve(m, {"lag.rz": -0.1}, time=time)
    q, omega = solution.steady["lag.rz"], alpha * time
    assert offset * first * (omega**2 * np.sin(q) + alpha * np.cos(q)) + second * alpha == pytest.approx(0.0, abs=1e-9)
    expected = offset * first * (omega**2 * np.cos(q) - alpha * np.sin(q)) / second
    assert solution.frequencies[0] == pytest.approx(np.sqrt(expected), rel=1e-10)
    assert solution.linear.state.v[0] == pytest.approx(omega)


def test_derivatives_are_those_of_the_function() -> None:
    law, t, h = mb.Sum((SHAKE, RAMP)), 0.7, 1e-4
    now = instant(mb.Motion("x", law=law), t)
    assert now.position == pytest.approx(law(t), rel=1e-15)
    assert now.rate == pytest.approx((law(t + h) - law(t - h)) / (2 * h), abs=1e-6)
    assert now.acceleration == pytest.approx((law(t + h) - 2 * law(t) + law(t - h)) / h**2, abs=1e-5)
    assert SHAKE.deriv(0) is SHAKE


def test_a_function_without_derivatives_is_refused() -> None:
    with pytest.raises(mb.MechanismError, match=r"slide\.z.*has no derivatives.*Polynomial"):
        mb.solve(pendulum(np.sin, "y"))


def test_law_and_numbers_together_are_refused() -> None:
    m = pendulum(SHAKE, "y")
    both = mb.Mechanism(m.bodies, m.joints, (mb.Motion("slide.z", rate=1.0, law=SHAKE),))
    with pytest.raises(mb.MechanismError, match=r"slide\.z.*both a law and numbers"):
        mb.solve(both)


def test_two_motions_of_one_coordinate_are_refused() -> None:
    m = pendulum(SHAKE, "y")
    twice = mb.Mechanism(m.bodies, m.joints, (mb.Motion("slide.z"), mb.Motion("slide.z", rate=1.0)))
    with pytest.raises(mb.MechanismError, match=r"slide\.z.*given twice"):
        mb.solve(twice)


@pytest.mark.parametrize("turns", [1, 4, 1000])
def test_whole_turns_change_nothing(turns: int) -> None:
    """A rotor's angle grows without bound: modes frozen there are those of the same angle in the first turn."""
    once, later = (
        mb.solve(
            mb.Mechanism(
                bodies=(mb.Body("hub"), mb.Body("blade", mb.inertia(3.0, 0.1, (0.8, 0, 0)))),
                joints=(
                    mb.Joint("shaft", "revolute", "ground", "hub"),
                    mb.Joint("lag", "revolute", "hub", "blade", mb.at(0.5)),
                ),
                motions=(mb.Motion("shaft.rz", law=Polynomial([0.4 + angle, 8.0])),),
                gravity=(0, -G, 0),
            )
        )
        for angle in (0.0, 2 * np.pi * turns)
    )
    assert later.frequencies[0] == pytest.approx(once.frequencies[0], rel=1e-11)
