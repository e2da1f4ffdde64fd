"""Modes are named by their kinetic energy: closed forms and invariances (reference axis, units of length, precone)."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from southwell.cases.input import library
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.modes import STATIONS, Modes
from southwell.core.participation import DOMINANT_FRACTION, describe_fractions, families, numbered, participation
from southwell.core.solve import modes as solve
from southwell.core.space import spatial as sp

FLAP, EDGE, TORSION, AXIAL = range(4)
LENGTH, MASS, POLAR = 6.0, 1.2, 3e-3
BEAM = uniform_blade("beam", LENGTH, 0.3, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=MASS, I_y=1e-3, I_z=2e-3)
POINTLIKE = uniform_blade("points", LENGTH, 0.3, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=MASS)


def modes(*shapes: np.ndarray) -> Modes:
    return Modes(0.0, np.arange(1.0, len(shapes) + 1), np.array(shapes, complex), 10)


def shape(**columns: np.ndarray) -> np.ndarray:
    out = np.zeros((21, 4), complex)
    for name, values in columns.items():
        out[:, "xyzt".index(name)] = values
    return out


def test_energies_are_proportional_to_squared_displacements() -> None:
    sine = np.sin(0.5 * np.pi * STATIONS)
    (fractions,) = participation(modes(shape(y=3.0 * sine, z=4.0 * sine)), POINTLIKE)
    np.testing.assert_allclose(fractions, [16 / 25, 9 / 25, 0, 0], atol=1e-12)


def test_energy_of_torsion_is_that_of_the_polar_inertia() -> None:
    """θ and w of equal shape: energies m w² and I_p θ²; a sum of squared metres and radians would give half each."""
    sine = np.sin(0.5 * np.pi * STATIONS)
    rigid = replace(BEAM, mass=np.repeat(section_mass(MASS, POLAR, 0.0), 2, axis=0))
    (fractions,) = participation(modes(shape(z=sine, t=sine)), rigid)
    bending = POLAR * (0.5 * np.pi / LENGTH) ** 2  # I_y w'² turns with flap; ∫cos² = ∫sin² over the quarter wave
    whole = MASS + POLAR + bending
    np.testing.assert_allclose(fractions, [(MASS + bending) / whole, 0, POLAR / whole, 0], atol=2e-6)


def test_a_flap_mode_that_turns_more_radians_than_it_moves_metres_is_flap() -> None:
    """A sum of m² and rad² would call this torsion, 0.25 against 1; the energies are 0.3 against 0.003."""
    sine = np.sin(0.5 * np.pi * STATIONS)
    fractions = participation(modes(shape(z=0.5 * sine, t=sine)), BEAM)
    assert families(fractions) == ("flapwise",)
    assert fractions[0, TORSION] == pytest.approx(POLAR / (POLAR + 0.25 * MASS), rel=2e-3)


def test_a_phase_lag_does_not_matter() -> None:
    sine = np.sin(0.5 * np.pi * STATIONS)
    (fractions,) = participation(modes(np.exp(0.7j) * shape(y=3j * sine, z=4.0 * sine)), POINTLIKE)
    np.testing.assert_allclose(fractions, [16 / 25, 9 / 25, 0, 0], atol=1e-12)


def test_distributed_and_tip_mass_are_included() -> None:
    """y = s, z = s²: ∫(3 − s/2) s² ds = 32 and ∫(3 − s/2) s⁴ ds = 273.07 over 4 m; the tip adds 2·16 and 2·256."""
    blade = Blade(
        "tapered",
        stations=np.array([0.0, 4.0]),
        stiffness=np.repeat(section_stiffness(1.0, 1.0, 1.0, 1.0), 2, axis=0),
        mass=section_mass([3.0, 1.0]),
        twist=np.array([0.4, -0.2]),
        tip_mass=np.diag([2.0, 2.0, 2.0, 0.0, 0.0, 0.0]),
    )
    s = 4.0 * STATIONS
    (fractions,) = participation(modes(shape(y=s, z=s**2)), blade)
    edge, flap = 3 * 4**3 / 3 - 4**4 / 8 + 2 * 4**2, 3 * 4**5 / 5 - 4**6 / 12 + 2 * 4**4
    np.testing.assert_allclose(fractions[[EDGE, FLAP]], [edge / (edge + flap), flap / (edge + flap)], rtol=1e-12)


def test_torsion_about_an_axis_off_the_mass_centre_is_flap_too() -> None:
    """A pitching section whose mass centre lies 0.5 m from the axis: m d² θ² is motion of the mass, I_c θ² is torsion."""
    mass = section_mass([1.0, 1.0], 0.06, 0.04)
    mass[:, 2, 3] = mass[:, 3, 2] = 0.5
    mass[:, 3, 3] += 0.25
    mass[:, 0, 5] = mass[:, 5, 0] = -0.5
    mass[:, 5, 5] += 0.25
    (fractions,) = participation(modes(shape(t=np.ones(21))), replace(BEAM, mass=mass))
    np.testing.assert_allclose(fractions, [0.25 / 0.35, 0, 0.1 / 0.35, 0], atol=1e-12)


def test_a_tip_mass_off_the_axis_moves_with_bending_and_torsion() -> None:
    """2 kg half a metre towards y: torsion of −2 rad cancels the flap of 1 m; the slope v' = 2/L moves it along the blade."""
    tip = np.diag([2.0, 2.0, 2.0, 0.5, 0.0, 0.5])
    tip[0, 5] = tip[5, 0] = -1.0
    tip[2, 3] = tip[3, 2] = 1.0
    bent, torsion = STATIONS**2, -2.0 * STATIONS
    (fractions,) = participation(modes(shape(y=bent, z=bent, t=torsion)), replace(POINTLIKE, tip_mass=tip))
    flap, axial = MASS * LENGTH / 5, 2.0 * (0.5 * 2.0 / LENGTH) ** 2
    np.testing.assert_allclose(fractions, np.array([flap, flap + 2.0, 0, axial]) / (2 * flap + 2.0 + axial), atol=1e-9)


def shifted(blade: Blade, y: float, z: float) -> Blade:
    """The same solid described about an axis moved by (y, z) in its (untwisted) sections."""
    x = sp.adjoint(sp.pose(np.eye(3), np.array([0.0, y, z])))  # twist at the new point → twist at the old
    stiffness = np.linalg.inv(np.linalg.inv(x) @ np.linalg.inv(blade.stiffness) @ np.linalg.inv(x).T)
    mass = x.T @ blade.mass @ x
    curve = blade.curve + np.array([0.0, y, z])
    return replace(blade, stiffness=stiffness, mass=mass, curve=curve)


@settings(max_examples=6, deadline=None)
@given(y=st.floats(-0.4, 0.4), z=st.floats(-0.4, 0.4))
def test_energy_fractions_do_not_depend_on_the_reference_axis(y: float, z: float) -> None:
    solid = uniform_blade(
        "solid", LENGTH, 0.3, EA=1e7, GJ=8e2, EI_y=1e4, EI_z=6e4, GA_y=1e7, GA_z=1e7, mass=MASS, I_y=1e-2, I_z=6e-2
    )
    here = solve(solid, 0.0, 30, 8)
    solution = solve(shifted(solid, y, z), 0.0, 30, 8)
    np.testing.assert_allclose(solution.frequencies, here.frequencies, rtol=1e-8)
    np.testing.assert_allclose(participation(solution, shifted(solid, y, z)), participation(here, solid), atol=1e-4)


@pytest.mark.parametrize("angle", [0.1, -0.3])
def test_precone_and_pitch_turn_the_axes_with_the_blade(angle: float) -> None:
    for blade in (replace(BEAM, precone=angle), replace(BEAM, pitch=angle)):
        fractions = participation(solve(blade, 0.0, 20, 6), blade)
        np.testing.assert_allclose(fractions.max(1), 1.0, atol=1e-6)
        assert numbered(families(fractions))[:4] == ("flapwise 1", "edgewise 1", "flapwise 2", "edgewise 2")


def test_families_of_a_beam_are_those_of_its_closed_form() -> None:
    """Clamped-free: flap and edge at (βL)² √(EI/m)/L², torsion at (k − ½)π √(GJ/I_p)/L (Rayleigh 1877)."""
    beam = uniform_blade("soft", LENGTH, 0.0, EA=1e9, GJ=4.0, EI_y=1e4, EI_z=1.4e4, mass=MASS, I_y=1e-3, I_z=1e-3)
    solution = solve(beam, 0.0, 40, 8)
    names = numbered(families(participation(solution, beam)))
    roots = np.array([1.87510407, 4.69409113])
    expected = {
        **{f"flapwise {k + 1}": r**2 * np.sqrt(1e4 / MASS) / LENGTH**2 for k, r in enumerate(roots)},
        **{f"edgewise {k + 1}": r**2 * np.sqrt(1.4e4 / MASS) / LENGTH**2 for k, r in enumerate(roots)},
        **{f"torsion {k}": (k - 0.5) * np.pi * np.sqrt(4.0 / 2e-3) / LENGTH for k in (1, 2, 3)},
    }
    for name, frequency in expected.items():
        assert solution.frequencies[names.index(name)] == pytest.approx(frequency, rel=2e-3), name


def test_without_moments_of_inertia_torsion_has_no_energy() -> None:
    (fractions,) = participation(modes(shape(z=STATIONS, t=100.0 * STATIONS)), POINTLIKE)
    np.testing.assert_allclose(fractions, [1, 0, 0, 0], atol=1e-12)
    assert not participation(modes(shape(t=STATIONS)), POINTLIKE).any()


def test_axial_motion_is_named() -> None:
    assert families(participation(modes(shape(x=STATIONS, z=0.1 * STATIONS)), POINTLIKE)) == ("axial",)


def test_a_mode_without_a_dominant_motion_is_mixed_and_its_energy_fractions_are_listed() -> None:
    fractions = np.array(
        [[0.55, 0.42, 0.03, 0.0], [DOMINANT_FRACTION, 1 - DOMINANT_FRACTION, 0, 0], [0.02, 0.9, 0.08, 0]]
    )
    assert numbered(families(fractions)) == ("mixed 1", "flapwise 1", "edgewise 1")
    assert describe_fractions(fractions[0]) == "55 % flapwise, 42 % edgewise"
    assert describe_fractions(fractions[2]) == "90 % edgewise, 8 % torsion"


def test_the_windpact_1_5_blades_mode_near_4_2_hz_is_its_second_flap() -> None:
    """At 60 rpm BModes prints 4.1912 Hz; a sum of squared metres and radians would call it the first torsion."""
    for variant in library.load("windpact-1.5").variants:
        solution = solve(variant.blade, 2 * np.pi, 40, 6)
        fractions = participation(solution, variant.blade)
        assert 4.1 < solution.frequencies[2] / (2 * np.pi) < 4.4
        assert numbered(families(fractions)) == (
            "flapwise 1",
            "edgewise 1",
            "flapwise 2",
            "edgewise 2",
            "flapwise 3",
            "torsion 1",
        )
        assert fractions[2, FLAP] > 0.99
