"""A turbine of two blades against a general mechanism, closed forms, and an isotropic rotor with constant equations."""

from dataclasses import replace

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.core.rotor.orbit import orbit_of
from southwell.core.rotor.periodic import PeriodicError
from southwell.core.space.inertia import transformed
from southwell.core.space.spatial import pose
from southwell.core.spectrum import eigen
from southwell.core.turbine.assembly import assemble, periodic
from southwell.core.turbine.machine import Resolution, machine, rigid_rotor
from southwell.core.turbine.turbine import Drivetrain, Teeter, Turbine
from southwell.core.turbine.turbine_modes import turbine_modes
from southwell.tests.support.turbines import SMALL, as_mechanism, small

OMEGA = 4.0

ONE = Resolution(tower_elements=1, blade_elements=1, tower_modes=6, blade_modes=7)

FLAT = mb.inertia(200.0, (5.0, 50.0, 45.0))
"""A hub that is not symmetric about the shaft."""


def rigid(turbine: Turbine) -> Turbine:
    """The turbine with blades so stiff that their bending changes frequencies by 1e-7, as much as rounding does."""
    return replace(turbine, blade=replace(turbine.blade, stiffness=3e5 * turbine.blade.stiffness))


@pytest.mark.parametrize(
    "turbine",
    [
        replace(small(blades=2), hub=FLAT),
        replace(small(4e5, Drivetrain(2e6), blades=2), teeter=Teeter(0.3), hub=FLAT),
        replace(small(blades=2), teeter=Teeter(-0.2, 4e4)),
    ],
    ids=["fixed hub", "underslung teeter, yaw and shaft", "teeter on a spring"],
)
def test_two_blades_are_the_same_as_a_general_mechanism(turbine: Turbine) -> None:
    """At several azimuths; the two routes share the element alone."""
    orbit = orbit_of(as_mechanism(turbine, ONE, OMEGA), "spin.rz")
    _, system = periodic(machine(turbine, ONE), OMEGA)
    assert system.harmonics == 2
    computed = [eigen.damped(*system.at(psi), 10).frequencies for psi in (0.3, 1.9)]
    exact = [eigen.damped(*orbit.matrices(psi), 10).frequencies for psi in (0.3, 1.9)]
    np.testing.assert_allclose(computed, exact, rtol=1e-8)
    assert np.abs(exact[0] / exact[1] - 1.0).max() > 1e-3


def test_a_teetering_rotor_of_stiff_blades() -> None:
    """(I_z − I_x) Ω²/I_y about the hinge, of a body that spins about z and teeters about y; Ω without height along z."""
    turbine = replace(rigid(small(blades=2)), teeter=Teeter(0.3), hub=FLAT)
    full_machine = machine(turbine, SMALL)
    a, _ = periodic(full_machine, OMEGA)
    (hinge,) = a.teeter
    x, y, z = np.diagonal(
        transformed(rigid_rotor(turbine, full_machine.blade_mesh), pose(np.eye(3), np.array([0.0, 0.0, -0.3])))
    )[3:]
    assert a.K[hinge, hinge] / a.M[hinge, hinge] == pytest.approx(OMEGA**2 * (z - x) / y, rel=1e-6)
    assert x > 1e-4 * y


def balanced(drivetrain: Drivetrain) -> tuple[Turbine, Turbine]:
    """Stiff rotors of two and three blades with the same inertia, symmetric about the shaft."""
    two, three = rigid(small(4e5, drivetrain, blades=2)), rigid(small(4e5, drivetrain))
    of = [rigid_rotor(t, machine(t, SMALL).blade_mesh) - t.hub for t in (two, three)]
    whole = mb.inertia(600.0, (2e4, 2e4, 2e4)) + of[1]
    return replace(two, hub=whole - of[0]), replace(three, hub=whole - of[1])


@pytest.mark.parametrize("drivetrain", [Drivetrain(), Drivetrain(2e6, 0.3, 20.0, True)], ids=["locked", "free"])
def test_a_balanced_rotor_of_two_stiff_blades_is_isotropic(drivetrain: Drivetrain) -> None:
    """As one of three, whose equations are constant."""
    two, three = balanced(drivetrain)
    modes = turbine_modes(machine(two, replace(SMALL, periodic_motions=3)), OMEGA, 4)
    exact = turbine_modes(machine(three, SMALL), OMEGA, 4)
    np.testing.assert_allclose(modes.frequencies, exact.frequencies, rtol=2e-7)
    assert modes.names == exact.names
    a = assemble(machine(three, SMALL), OMEGA)
    without = eigen.damped(a.M, 0.0 * a.C, a.K).frequencies
    assert np.abs(exact.frequencies / without[without > 1e-3][:4] - 1.0).max() > 1e-2  # the rotor is a gyroscope


def test_the_motions_used_at_first_do_not_matter() -> None:
    turbine = replace(small(4e5, blades=2), teeter=Teeter(0.3))
    few, many = (turbine_modes(machine(turbine, replace(SMALL, periodic_motions=k)), OMEGA, 4) for k in (3, 12))
    np.testing.assert_allclose(few.frequencies, many.frequencies, rtol=1e-9)
    assert few.names[:3] == ("1st tower side-side", "1st tower fore-aft", "teeter")
    assert (few.confidence > 0.5).all()


@pytest.mark.slow
def test_a_mode_has_the_frequency_of_the_motion_that_names_it() -> None:
    """Other frequencies of a mode differ by multiples of Ω, and can move more mass: the lines do not jump between them."""
    full_machine = machine(small(blades=2), SMALL)
    edge = []
    for omega in (3.6, 3.7, 3.8):
        modes = turbine_modes(full_machine, omega, 12)
        assert (np.diff(modes.frequencies) >= 0).all()
        edge += [f for f, n in zip(modes.frequencies, modes.names, strict=True) if n == "1st edge differential"]
    np.testing.assert_allclose(edge, 13.14, rtol=3e-3)
    assert len(edge) == 3


def test_rotors_without_constant_modes_are_refused() -> None:
    full_machine = machine(small(blades=2), SMALL)
    with pytest.raises(PeriodicError, match="two blades vary with the azimuth"):
        assemble(full_machine, OMEGA)
    with pytest.raises(PeriodicError, match="0 rad/s"):
        turbine_modes(full_machine, 0.0)
    with pytest.raises(ValueError, match="only a hub of two blades teeters"):
        machine(replace(small(), teeter=Teeter()), SMALL)
    with pytest.raises(ValueError, match="two or more"):
        machine(small(blades=1), SMALL)
