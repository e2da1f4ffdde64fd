"""Rotors on supports against tables and equations derived by hand: constant and periodic coefficients."""

from dataclasses import replace
from typing import cast

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from southwell import multibody as mb
from southwell.core.mechanism.description import MechanismError
from southwell.core.rotor.comparison import compared
from southwell.core.rotor.floquet import distance
from southwell.core.rotor.multiblade import blades_of
from southwell.core.rotor.orbit import linearize
from southwell.core.rotor.periodic import Periodic, PeriodicError, averaged_exactly, in_multiblade
from southwell.core.rotor.stability import limits
from southwell.core.rotor.whirl import whirl
from southwell.core.spectrum.eigen import damped
from southwell.tests.support.rotors import coleman_feingold, hammond, hammond_by_hand, hammond_roots

SHAFT = "shaft.rz"
THREE = blades_of(5, [[2, 3, 4]])
FOUR = blades_of(6, [[2, 3, 4, 5]])

COLEMAN_FEINGOLD = {
    0.8: (0.09917011, 0.31320478, 0.67745334, 0.8, 0.93580014),
    1.6: (0.09916903, 0.3131133, 0.54879598, 0.8, 1.06544292),
    2.4: (0.09916666, 0.31276005, 0.42068757, 0.8, 1.19539165),
}
"""Hz, by speed in rad/s."""

SUPPORT = (1240481.8, 20_000.0)


@pytest.mark.parametrize("omega", COLEMAN_FEINGOLD)
def test_coleman_and_feingold(omega: float) -> None:
    system, orbit = linearize(coleman_feingold(omega), SHAFT)
    assert orbit.amplitude.max() < 1e-12
    with pytest.raises(PeriodicError, match="no constant modes"):
        averaged_exactly(system)
    values = damped(*averaged_exactly(in_multiblade(system, THREE)).mean).values
    np.testing.assert_allclose(values.imag / (2 * np.pi), COLEMAN_FEINGOLD[omega], atol=5e-9)


def test_coleman_and_feingold_at_rest() -> None:
    result = mb.solve(replace(coleman_feingold(0.0), motions=(mb.Motion(SHAFT),))).frequencies / (2 * np.pi)
    np.testing.assert_allclose(result, [0.09917042, 0.31322738, 0.8, 0.80598123, 0.8069514], atol=5e-9)


def test_one_stiffer_blade_is_never_averaged_and_needs_floquet_and_hill() -> None:
    omega = 1.6
    system, _ = linearize(coleman_feingold(omega, stiffer=1.05), SHAFT)
    with pytest.raises(PeriodicError, match="blades differ"):
        averaged_exactly(in_multiblade(system, THREE))
    comparison = compared(system)
    strip = np.sort(np.abs(np.angle(comparison.hill.multipliers)) * omega / (2 * np.pi) ** 2)[::2]
    np.testing.assert_allclose(strip, [0.03740962, 0.04310606, 0.05847881, 0.06171777, 0.09916926], atol=5e-9)
    assert comparison.difference < 1e-11
    observed = compared(in_multiblade(system, THREE))  # the coordinates do not change the exponents
    assert distance(comparison.floquet.multipliers, observed.floquet.multipliers).max() < 1e-11


def test_whirl_of_the_blades_in_both_frames() -> None:
    """Edgewise whirl at 2.4 rad/s: backward below and forward above the blade's own frequency of 0.8 Hz."""
    omega = 2.4
    system, _ = linearize(coleman_feingold(omega), SHAFT)
    frequencies = damped(*averaged_exactly(in_multiblade(system, THREE)).mean)
    pair = np.array([[3, 4]])
    for mode, name in ((2, "backward"), (4, "forward")):
        turning = whirl(frequencies.vectors[:, mode], pair, omega)
        assert turning.name == name
        frequency = float(frequencies.values[mode].imag)
        rotating = frequency + (omega if name == "backward" else -omega)
        assert abs(rotating / (2 * np.pi) - 0.8) < 0.02


def test_the_exponents_of_a_reversed_rotor_are_the_same_and_its_whirl_is_mirrored() -> None:
    system, _ = linearize(coleman_feingold(-2.4), SHAFT)
    frequencies = damped(*averaged_exactly(in_multiblade(system, THREE)).mean)
    np.testing.assert_allclose(frequencies.values.imag / (2 * np.pi), COLEMAN_FEINGOLD[2.4], atol=5e-9)
    pair = np.array([[3, 4]])
    assert [whirl(frequencies.vectors[:, mode], pair, -2.4).name for mode in (2, 4)] == ["backward", "forward"]


def test_ground_resonance() -> None:
    """Exponents and limits of stability against the roots of the isotropic rotor's polynomial."""
    damping = 4067.5

    def system(omega: float) -> Periodic:
        linear = linearize(hammond(omega, (damping,) * 4, (SUPPORT[0], 5000.0)), SHAFT)[0]
        return in_multiblade(linear, FOUR)

    roots = hammond_roots(15.0, damping, (SUPPORT[0], 5000.0))
    values = damped(*averaged_exactly(system(15.0)).mean).values
    for root in roots:
        value = root if root.imag > 0 else root.conjugate()
        assert np.abs(values - value).min() < 1e-9 * abs(value)
    undamped = hammond_roots(15.0, 0.0, (SUPPORT[0], 0.0))
    assert np.real(undamped).max() > 0.1  # unstable without dampers


def test_a_failed_lag_damper_makes_the_rotor_periodic() -> None:
    """Matrices against equations derived by hand, and the monodromy against SciPy's integration of those."""
    omega, damping = 25.0, (0.0, 4067.5, 4067.5, 4067.5)
    system, _ = linearize(hammond(omega, damping, SUPPORT), SHAFT)
    for psi in (0.0, 0.7, 4.0):
        for actual, by_hand in zip(system.at(psi), hammond_by_hand(omega, damping, SUPPORT, psi), strict=True):
            np.testing.assert_allclose(actual, by_hand, atol=1e-9 * np.abs(by_hand).max())
    comparison = compared(system)
    assert comparison.difference < 1e-8

    def slope(time: float, flat: np.ndarray) -> np.ndarray:
        M, C, K = hammond_by_hand(omega, damping, SUPPORT, omega * time)
        x, v = np.split(flat.reshape(12, 12), 2)
        return np.concatenate([v, -np.linalg.solve(M, K @ x + C @ v)]).ravel()

    end = solve_ivp(slope, (0.0, 2 * np.pi / omega), np.eye(12).ravel(), "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    assert distance(np.linalg.eigvals(end.reshape(12, 12)), comparison.floquet.multipliers).max() < 1e-8
    with pytest.raises(PeriodicError, match="blades differ"):
        averaged_exactly(in_multiblade(system, FOUR))


def test_the_limit_of_ground_resonance() -> None:
    """Bisection against the root of the growth of the isotropic rotor's polynomial."""
    damping, support = 4067.5, (SUPPORT[0], 5000.0)

    def growth(omega: float) -> float:
        return float(np.real(hammond_roots(omega, damping, support)).max())

    def system(omega: float) -> Periodic:
        return in_multiblade(linearize(hammond(omega, (damping,) * 4, support), SHAFT)[0], FOUR)

    (limit,) = limits(system, [20.0, 21.0], 1e-4)
    exact = cast(float, brentq(growth, 20.0, 21.0, xtol=1e-12))
    assert abs(limit.at - exact) <= limit.uncertainty < 3e-3
    assert not limit.grows_above


def test_a_failed_damper_makes_a_stable_rotor_unstable() -> None:
    omega, damping, support = 18.0, 12_000.0, (SUPPORT[0], 5000.0)
    assert np.real(hammond_roots(omega, damping, support)).max() < -0.04
    failed, _ = linearize(hammond(omega, (0.0, *(damping,) * 3), support), SHAFT)
    assert compared(failed).floquet.growth > 0.1


def two_bladed(omega: float, stiffness: float, nacelle: float, rod: float) -> mb.Mechanism:
    """A rigid rotor of two thin blades on a nacelle that yaws about z; the shaft is along x."""
    body = mb.inertia(1.0, (rod, 0.0, rod))  # rod along the rotor's y axis, shaft about its z axis
    return mb.Mechanism(
        (mb.Body("nacelle", mb.inertia(1.0, nacelle)), mb.Body("rotor", body)),
        (
            mb.Joint("yaw", "revolute", "ground", "nacelle"),
            mb.Joint("shaft", "revolute", "nacelle", "rotor", mb.at(axis="x")),
        ),
        (mb.Motion(SHAFT, rate=omega),),
        coordinate_springs=(mb.CoordinateSpring("yaw.rz", stiffness),),
    )


def test_two_blades_on_a_yawing_nacelle() -> None:
    """((I + J sin²ψ) ν̇)˙ + k ν = 0, with ψ from the yaw axis."""
    omega, k, nacelle, rod = 3.0, 50.0, 4.0, 2.5
    system, _ = linearize(two_bladed(omega, k, nacelle, rod), SHAFT)
    M = np.array([system.at(psi)[0][0, 0] for psi in np.linspace(0, np.pi, 9)])
    assert M.min() == pytest.approx(nacelle)
    assert M.max() == pytest.approx(nacelle + rod)
    C = system.at(0.3)[1][0, 0]
    h = 1e-6
    slope = (system.at(0.3 + h)[0][0, 0] - system.at(0.3 - h)[0][0, 0]) / (2 * h)
    assert pytest.approx(omega * slope, rel=1e-6) == C
    assert compared(system).difference < 1e-10


def test_a_teetering_rotor() -> None:
    """Ω √((I_z − I_x)/I_y) about the teeter axis y, blades along x."""
    omega, moments = 4.0, (0.3, 5.0, 5.2)
    rotor = mb.Mechanism(
        (mb.Body("hub"), mb.Body("blades", mb.inertia(3.0, moments))),
        (
            mb.Joint("shaft", "revolute", "ground", "hub"),
            mb.Joint("teeter", "revolute", "hub", "blades", mb.at(axis="y"), mb.at(axis="y")),
        ),
        (mb.Motion(SHAFT, rate=omega),),
    )
    system, _ = linearize(rotor, SHAFT)
    assert system.constant
    exact = omega * np.sqrt((moments[2] - moments[0]) / moments[1])
    assert np.abs(compared(system).hill.frequencies) == pytest.approx([exact, exact], rel=1e-9)


def test_gravity_across_the_axis_gives_a_periodic_state() -> None:
    """The lag hinges of a horizontal rotor swing once per revolution; the state balances at every azimuth."""
    system, orbit = linearize(coleman_feingold(1.6, gravity=(0.0, -9.81, 0.0)), SHAFT)
    assert orbit.amplitude.max() > 0.01
    for psi in (0.1, 2.3, 5.0):
        force, size = orbit.unbalanced(psi)
        assert (np.abs(force) < 1e-10 * size).all()
    exponents = compared(system).floquet
    assert abs(exponents.growth) < 1e-9


def test_a_lag_hinge_swings_by_gravity_as_a_forced_oscillator() -> None:
    """I ζ̈ + (k + Ω² e S) ζ = −S g cos ψ for small gravity along −y: the amplitude S g/(k + Ω² e S − I Ω²)."""
    omega, offset, stiffness, g = 3.0, 0.5, 200.0, 1e-7
    S, moment = 8.0 * 2.0, 8.0 * 2.0**2
    blade = mb.Mechanism(
        (mb.Body("rotor"), mb.Body("blade", mb.inertia(8.0, 0.0, (2.0, 0.0, 0.0)))),
        (
            mb.Joint("shaft", "revolute", "ground", "rotor"),
            mb.Joint("lag", "revolute", "rotor", "blade", mb.at(x=offset)),
        ),
        (mb.Motion(SHAFT, rate=omega),),
        coordinate_springs=(mb.CoordinateSpring("lag.rz", stiffness),),
        gravity=(0.0, -g, 0.0),
    )
    _, orbit = linearize(blade, SHAFT)
    exact = -S * g / (stiffness + omega**2 * offset * S - moment * omega**2)
    assert orbit.motion(0.0).q[1] == pytest.approx(exact, rel=1e-6, abs=0.0)
    assert orbit.motion(1.0).q[1] == pytest.approx(exact * np.cos(1.0), rel=1e-6, abs=0.0)


def test_refused_mechanisms() -> None:
    fixed = coleman_feingold(1.6)
    with pytest.raises(MechanismError, match="no motion at a rate"):
        linearize(replace(fixed, motions=()), SHAFT)
    other = (mb.Motion(SHAFT, rate=1.6), mb.Motion("lag0.rz", rate=1.0))
    with pytest.raises(MechanismError, match="whole multiple"):
        linearize(replace(fixed, motions=other), SHAFT)
