"""A turbine against the same machine as a general mechanism, closed forms, and the plain solver of a beam."""

from dataclasses import replace
from typing import cast

import numpy as np
import pytest
from scipy.optimize import brentq

from southwell import multibody as mb
from southwell.core import solve
from southwell.core.blade import uniform_blade
from southwell.core.rotor.multiblade import blades_of, second_order
from southwell.core.rotor.orbit import orbit_of
from southwell.core.space import spatial as sp
from southwell.core.space.inertia import transformed
from southwell.core.spectrum import eigen
from southwell.core.turbine.assembly import assemble
from southwell.core.turbine.machine import Resolution, machine, rigid_rotor
from southwell.core.turbine.tower import Support, Tower
from southwell.core.turbine.tower_modes import ordinal, tower_modes
from southwell.core.turbine.tracking import linked
from southwell.core.turbine.turbine import Drivetrain, Turbine, shaft_pose
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.tests.support.turbines import SMALL, as_mechanism, rigid_nacelle_and_rotor, small

OMEGA = 4.0

ONE = Resolution(tower_elements=1, blade_elements=1, tower_modes=6, blade_modes=7)
"""One element each."""


def general(turbine: Turbine, omega: float, psi: float = 0.3) -> np.ndarray:
    """Frequencies of the mechanism: the angle of the blades' coordinates is taken out by multi-blade coordinates."""

    orbit = orbit_of(as_mechanism(turbine, ONE, omega), "spin.rz")
    names = [orbit.tree.coordinates[j] for j in orbit.free]
    inner = 6 * ONE.blade_elements
    own = {letter: [k for k, name in enumerate(names) if name.startswith(f"{letter}e")] for letter in "pqr"}
    first = [k for k, name in enumerate(names) if name.startswith("beam")]
    order = first[6 * ONE.tower_elements :]  # internal coordinates: the tower's, then those of blade after blade
    for k, letter in enumerate("pqr"):
        own[letter] += order[k * inner : (k + 1) * inner]
    groups = list(zip(*own.values(), strict=True))
    M, C, K = second_order(*orbit.matrices(psi), np.array(psi), omega, blades_of(len(names), groups))
    other = second_order(*orbit.matrices(1.1), np.array(1.1), omega, blades_of(len(names), groups))
    for a, b in zip((M, C, K), other, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-9 * np.abs(a).max())
    return eigen.damped(M, C, K, 10).frequencies


@pytest.mark.parametrize(
    ("yaw", "drivetrain"), [(np.inf, Drivetrain()), (4e5, Drivetrain(2e6))], ids=["rigid", "yaw and shaft"]
)
def test_a_turbine_is_the_same_as_a_general_mechanism(yaw: float, drivetrain: Drivetrain) -> None:
    turbine = small(yaw, drivetrain)
    exact = general(turbine, OMEGA)  # not reduced
    np.testing.assert_allclose(turbine_modes(machine(turbine, ONE), OMEGA, 10).frequencies, exact, rtol=1e-6)


def test_more_modes_change_little() -> None:
    turbine = small(4e5, Drivetrain(2e6, 0.3, 20.0, True))
    few = turbine_modes(machine(turbine, replace(SMALL, blade_modes=8)), OMEGA, 10).frequencies
    many = turbine_modes(machine(turbine, replace(SMALL, blade_modes=12)), OMEGA, 10).frequencies
    np.testing.assert_allclose(few, many, rtol=1e-6)


def test_equations_are_those_of_a_conservative_machine() -> None:
    a = assemble(machine(small(4e5, Drivetrain(2e6, 0.3, 20.0, True)), SMALL), OMEGA)
    for part, sign in ((a.M, 1.0), (a.C, -1.0), (a.K, 1.0)):
        np.testing.assert_allclose(part, sign * part.T, atol=1e-9 * np.abs(part).max())
    turning = np.zeros(len(a.M))
    turning[list(a.shaft)] = 1.0
    assert np.abs(a.K @ turning).max() < 1e-6 * np.abs(a.K).max()


def test_four_blades_have_a_differential_motion() -> None:
    names = turbine_modes(machine(small(blades=4), SMALL), OMEGA, 14).names
    assert any(name.endswith("differential") for name in names)


def test_five_blades_have_whirls_of_two_diameters() -> None:
    """They do not move the hub: a clamped blade's frequency, 2Ω higher or lower in the ground's frame."""
    turbine = small(blades=5)
    modes = turbine_modes(machine(turbine, SMALL), OMEGA, 16)
    by_name = dict(zip(modes.names, modes.frequencies, strict=True))
    blade = solve.modes(turbine.blade, OMEGA, elements=2, count=1).frequencies[0]
    assert by_name["1st flap forward whirl of 2 diameters"] == pytest.approx(blade + 2.0 * OMEGA, rel=1e-5)
    assert by_name["1st flap backward whirl of 2 diameters"] == pytest.approx(blade - 2.0 * OMEGA, rel=1e-5)
    assert {"1st flap backward whirl", "1st flap forward whirl", "1st flap collective"} <= set(modes.names)
    at_rest = turbine_modes(machine(turbine, SMALL), 0.0, 16).names
    assert at_rest.count("1st flap standing wave of 2 diameters") == 2


def test_names_and_tracking() -> None:
    full_machine = machine(small(), SMALL)
    slow, fast = turbine_modes(full_machine, OMEGA, 8), turbine_modes(full_machine, 1.02 * OMEGA, 8)
    assert {"1st tower fore-aft", "1st tower side-side", "1st flap collective"} <= set(slow.names)
    assert {"1st flap backward whirl", "1st flap forward whirl"} <= set(slow.names)
    order = linked(slow, fast)
    assert [fast.names[k] for k in order] == list(slow.names)
    np.testing.assert_allclose(slow.energies.sum(1), 1.0)
    assert [ordinal(k) for k in (1, 2, 3, 4, 11, 12, 21)] == ["1st", "2nd", "3rd", "4th", "11th", "12th", "21st"]


def test_whirl_of_a_reversed_rotor_has_the_same_frequencies() -> None:
    full_machine = machine(replace(small(), blade=replace(small().blade, pitch=0.0)), SMALL)
    solution, back = turbine_modes(full_machine, OMEGA, 8), turbine_modes(full_machine, -OMEGA, 8)
    flap = {n: f for n, f in zip(solution.names, solution.frequencies, strict=True) if "1st flap" in n}
    second = {n: f for n, f in zip(back.names, back.frequencies, strict=True) if "1st flap" in n}
    assert flap.keys() == second.keys()
    for name, value in flap.items():
        assert value == pytest.approx(second[name], rel=2e-3)


def test_stiff_blades_leave_the_tower_with_a_rigid_rotor() -> None:
    """At rest, as the plain solver's beam with a tip mass, under gravity."""
    turbine = replace(small(), gravity=9.81)
    stiff = replace(turbine, blade=replace(turbine.blade, stiffness=1e6 * turbine.blade.stiffness))
    full_machine = machine(stiff, replace(SMALL, tower_elements=6))
    rotor = rigid_rotor(stiff, full_machine.blade_mesh)
    tower = replace(turbine.tower, tip_mass=rigid_nacelle_and_rotor(stiff, rotor))
    exact = solve.modes(tower, 0.0, elements=6, count=4, gravity=np.array([-9.81, 0.0, 0.0])).frequencies
    np.testing.assert_allclose(turbine_modes(full_machine, 0.0, 4).frequencies, exact, rtol=3e-6)


def test_a_turbine_on_springs_with_a_stiff_rotor_is_a_tower_on_springs() -> None:
    turbine = replace(small(), gravity=9.81)
    K = np.diag([1e8, 2e6, 3e6, 5e7, 8e7, 6e7])
    K[1, 5] = K[5, 1] = -4e6
    soil = np.array([[1.0, 3e4], [6.0, 1e4]])
    wire = (12.0, np.diag([0.0, 5e4, 5e4, 0.0, 0.0, 0.0]))
    stiff = replace(
        turbine,
        blade=replace(turbine.blade, stiffness=1e6 * turbine.blade.stiffness),
        support=Support(K, (wire,), soil),
    )
    full_machine = machine(stiff, replace(SMALL, tower_elements=12))
    tip = rigid_nacelle_and_rotor(stiff, rigid_rotor(stiff, full_machine.blade_mesh))
    exact = tower_modes(Tower(replace(turbine.tower, tip_mass=tip), stiff.support, 9.81), 4).frequencies
    np.testing.assert_allclose(turbine_modes(full_machine, 0.0, 4).frequencies, exact, rtol=1e-4)
    clamped = turbine_modes(machine(replace(stiff, support=Support()), SMALL), 0.0, 4).frequencies
    assert np.abs(clamped / exact - 1.0).max() > 0.05


def test_a_rigid_turbine_on_a_floater_is_a_body_with_a_gyroscope() -> None:
    """M ẍ + C ẋ + K x = 0 of six coordinates: the moment of a shaft's angular momentum h is −h × θ̇."""
    turbine = small()
    rigid = 1e7
    K = np.diag([1e6, 2e5, 3e5, 5e6, 8e6, 6e6])
    K[1, 5] = K[5, 1] = -4e5
    floater = mb.inertia(9000.0, (1e5, 3e5, 2e5), (-4.0, 0.3, 0.7)) + np.diag([500.0, 3e3, 4e3, 0.0, 1e4, 2e4])
    stiff = replace(
        turbine,
        tower=replace(turbine.tower, stiffness=rigid * turbine.tower.stiffness),
        blade=replace(turbine.blade, stiffness=rigid * turbine.blade.stiffness),
        support=Support(K, mass=floater),
    )
    full_machine = machine(stiff, SMALL)
    rotor = rigid_rotor(stiff, full_machine.blade_mesh)
    top = sp.pose(np.eye(3), np.array([turbine.tower.length, 0.0, 0.0]))
    M = tower_inertia(turbine) + transformed(rigid_nacelle_and_rotor(stiff, rotor), top) + floater
    speed = 10.0 * OMEGA
    h = speed * rotor[5, 5] * turbine.shaft[:3, 2]
    C = np.zeros((6, 6))
    C[3:, 3:] = -sp.skew(h)
    exact = eigen.damped(M, C, K, 6).frequencies
    np.testing.assert_allclose(turbine_modes(full_machine, speed, 6).frequencies, exact, rtol=1e-5)
    assert {name.split()[0] for name in turbine_modes(full_machine, speed, 6).names} == {"platform"}
    at_rest = eigen.damped(M, 0.0 * C, K, 6).frequencies
    assert np.abs(at_rest / exact - 1.0).max() > 5e-3


def tower_inertia(turbine: Turbine) -> np.ndarray:
    """(6, 6) of the uniform tower at its base: a rod along x, and the moments of its sections."""
    m, length = turbine.tower.mass[0], turbine.tower.length
    out = m * length
    out[1, 5] = out[5, 1] = 0.5 * m[0, 0] * length**2
    out[2, 4] = out[4, 2] = -0.5 * m[0, 0] * length**2
    out[4, 4] += m[0, 0] * length**3 / 3.0
    out[5, 5] += m[0, 0] * length**3 / 3.0
    return out


def test_tower_with_a_tip_body() -> None:
    """1 + c ch + μβ (c sh − s ch) … for a point mass: W. Weaver, S. Timoshenko, D. Young, *Vibration Problems*, 1990."""
    mass, EI, length, tip = 100.0, 3e7, 20.0, 800.0
    tower = uniform_blade("tower", length, 0.0, EA=np.inf, GJ=np.inf, EI_y=EI, EI_z=EI, mass=mass)
    tower = replace(tower, tip_mass=np.diag([tip] * 3 + [0.0] * 3))

    def equation(b: float) -> float:
        c, s, ch, sh = np.cos(b), np.sin(b), np.cosh(b), np.sinh(b)
        return 1.0 + c * ch + tip / (mass * length) * b * (c * sh - s * ch)

    exact = (cast(float, brentq(equation, 0.5, 1.8)) / length) ** 2 * np.sqrt(EI / mass)
    frequencies = solve.modes(tower, 0.0, count=2, accuracy=1e-7).frequencies
    np.testing.assert_allclose(frequencies, exact, rtol=1e-6)


def test_tower_under_the_weight_of_its_tip() -> None:
    """A massless column with a tip mass under gravity: ω² = P λ/((tan λL − λL) m), λ² = P/EI."""
    EI, length, tip, g = 3e7, 20.0, 8000.0, 9.81
    tower = uniform_blade("tower", length, 0.0, EA=np.inf, GJ=np.inf, EI_y=EI, EI_z=EI, mass=1e-6 * tip)
    tower = replace(tower, tip_mass=np.diag([tip] * 3 + [0.0] * 3))
    P = tip * g
    wave = np.sqrt(P / EI)
    exact = np.sqrt(P * wave / (np.tan(wave * length) - wave * length) / tip)
    frequencies = solve.modes(tower, 0.0, count=2, gravity=np.array([-g, 0.0, 0.0])).frequencies
    np.testing.assert_allclose(frequencies, exact, rtol=2e-5)


def test_default_resolution_is_converged() -> None:
    full_machine = machine(small(), Resolution())
    finer = machine(small(), Resolution(24, 48, 10, 16))
    a, b = turbine_modes(full_machine, OMEGA, 10).frequencies, turbine_modes(finer, OMEGA, 10).frequencies
    np.testing.assert_allclose(a, b, rtol=1e-5)


def test_an_upwind_rotor_tilts_upwards() -> None:
    """NREL 5 MW: the hub is 2.4 m above the tower's top and 5 m upwind; the rotor's axis points downwind and down."""
    pose = shaft_pose(1.96256, -5.0191, np.radians(-5.0))
    np.testing.assert_allclose(pose[:3, 3], [2.4, 0.0, -5.0], atol=1e-4)
    assert pose[0, 2] < 0 < pose[2, 2]
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)


def test_torsion_of_a_shaft_between_rotor_and_generator() -> None:
    """ω² = k (1/I + 1/(n² J)) of two bodies on a shaft; J counts with the square of the gear ratio n."""
    k, J, ratio = 2e4, 0.3, 20.0
    turbine = small(drivetrain=Drivetrain(k, J, ratio, True))
    stiff = replace(
        turbine,
        blade=replace(turbine.blade, stiffness=1e6 * turbine.blade.stiffness),
        tower=replace(turbine.tower, stiffness=1e6 * turbine.tower.stiffness),
    )
    full_machine = machine(stiff, SMALL)
    inertia = rigid_rotor(stiff, full_machine.blade_mesh)[5, 5]
    solution = turbine_modes(full_machine, 0.0, 1)
    assert solution.names == ("drivetrain torsion",)
    assert solution.frequencies[0] == pytest.approx(np.sqrt(k * (1 / inertia + 1 / (ratio**2 * J))), rel=1e-4)


def wrong_nacelle(turbine: Turbine) -> Turbine:
    """Moments about the tower's top taken for those about the mass centre."""
    inertia = turbine.nacelle.copy()
    arm = inertia[:3, 3:] / inertia[0, 0]
    inertia[3:, 3:] += inertia[0, 0] * arm.T @ arm
    return replace(turbine, nacelle=inertia)


WRONG = {
    "tilt": lambda t: replace(t, shaft=shaft_pose(0.7, -1.5, 0.09)),
    "overhang": lambda t: replace(t, shaft=shaft_pose(0.7, 1.5, -0.09)),
    "precone": lambda t: replace(t, blade=replace(t.blade, precone=0.04)),
    "pitch": lambda t: replace(t, blade=replace(t.blade, pitch=-0.1)),
    "nacelle about the wrong point": wrong_nacelle,
    "gear ratio not squared": lambda t: replace(
        t, drivetrain=replace(t.drivetrain, generator=t.drivetrain.generator / t.drivetrain.gear_ratio)
    ),
}
"""Turbines with one error each."""


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_machine_has_other_frequencies(name: str) -> None:
    """By far more than codes differ that solve the same machine (1e-6)."""
    turbine = small(4e5, Drivetrain(2e6, 0.3, 20.0, True))
    correct = turbine_modes(machine(turbine, ONE), OMEGA, 10).frequencies
    altered = turbine_modes(machine(WRONG[name](turbine), ONE), OMEGA, 10).frequencies
    assert np.abs(altered / correct - 1.0).max() > 1e-4
