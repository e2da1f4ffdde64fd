"""A blade's mass and its sections' centres: against sections made of fibres, rods in closed form, and published totals."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import trapezoid

from southwell.cases.input import library
from southwell.cases.input.properties import about_hub, about_root, sections, tip
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.sampling import mass_at

from ...core.element.test_reference_axis import about

RNG = np.random.default_rng(7)

TILT = 0.3


def fibres(points: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Σ w bᵀ b of fibres at (y, z), b the fibre's strain along x from the section's: 1, z κ_y, −y κ_z."""
    strain = np.zeros((len(points), 6))
    strain[:, 0], strain[:, 4], strain[:, 5] = 1.0, points[:, 1], -points[:, 0]
    return np.einsum("p,pi,pj->ij", weights, strain, strain)


def panel(y: float, z: float, direction: tuple[float, float], shear: float) -> np.ndarray:
    """A thin panel that carries shear along its ``direction`` through (y, z): of the strain γ + τ × r along it."""
    strain = np.zeros(6)
    strain[1:3] = direction
    strain[3] = y * direction[1] - z * direction[0]
    return shear * np.outer(strain, strain)


def points(masses: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Σ m of points at (y, z), from the velocity of each: v + ω × r, written out."""
    out = np.zeros((6, 6))
    for m, (y, z) in zip(masses, at, strict=True):
        velocity = np.array([[1, 0, 0, 0, z, -y], [0, 1, 0, -z, 0, 0], [0, 0, 1, y, 0, 0]])
        out += m * velocity.T @ velocity
    return out


def prism(stiffness: np.ndarray, mass: np.ndarray, **changes: object) -> Blade:
    two = {"stations": [0.0, 3.0], "twist": [0.0, 0.0], "stiffness": [stiffness] * 2, "mass": [mass] * 2}
    return Blade(**{"name": "prism", **two, **changes})  # type: ignore[arg-type]


def fibrous() -> tuple[Blade, np.ndarray, np.ndarray]:
    """A flat section tilted by 0.3, more or less."""
    c, s = np.cos(TILT), np.sin(TILT)
    at = RNG.normal(size=(9, 2)) * [0.8, 0.1] @ np.array([[c, s], [-s, c]]) + [0.3, -0.1]
    stiff = RNG.uniform(1.0, 3.0, 9) * 1e8
    k = fibres(at, stiff) + panel(0.5, 0.2, (1, 0), 4e7) + panel(-0.2, 0.1, (0, 1), 3e7)
    k[3, 3] += 2e6
    return prism(k, points(RNG.uniform(1, 2, 9), at)), at, stiff


def test_tension_centre_and_axial_stiffness_are_those_of_the_fibres() -> None:
    blade, at, stiff = fibrous()
    section = sections(blade)
    np.testing.assert_allclose(section.tension_centre[0], stiff @ at / stiff.sum(), rtol=1e-10)
    np.testing.assert_allclose(section.EA, stiff.sum(), rtol=1e-10)


def test_principal_axes_and_bending_stiffness_are_those_of_the_fibres() -> None:
    blade, at, stiff = fibrous()
    y, z = (at - stiff @ at / stiff.sum()).T
    angle = sections(blade).principal[0]
    assert angle == pytest.approx(TILT, abs=0.15)
    along, across = y * np.cos(angle) + z * np.sin(angle), z * np.cos(angle) - y * np.sin(angle)
    assert abs(stiff @ (along * across)) < 1e-9 * (stiff @ along**2)
    np.testing.assert_allclose(sections(blade).EI_flap[0], stiff @ across**2, rtol=1e-9)
    np.testing.assert_allclose(sections(blade).EI_edge[0], stiff @ along**2, rtol=1e-9)


def test_shear_centre_is_where_two_panels_cross() -> None:
    """A panel along y at z = 0.2 and one along z at y = −0.2 carry any force through (−0.2, 0.2) without twisting."""
    section = sections(fibrous()[0])
    np.testing.assert_allclose(section.shear_centre[0], [-0.2, 0.2], rtol=1e-9)
    np.testing.assert_allclose(section.GJ[0], 2e6, rtol=1e-9)


def test_mass_centre_and_axes_are_those_of_the_points() -> None:
    at, masses = RNG.normal(size=(5, 2)), RNG.uniform(1, 2, 5)
    section = sections(prism(section_stiffness(1e8, 1e6, 1e6, 2e6)[0], points(masses, at)))
    np.testing.assert_allclose(section.mass_centre[0], masses @ at / masses.sum(), rtol=1e-12)
    y, z = (at - masses @ at / masses.sum()).T
    a = section.mass_axes[0]
    product = masses @ ((y * np.cos(a) + z * np.sin(a)) * (z * np.cos(a) - y * np.sin(a)))
    assert abs(product) < 1e-12 * masses.sum()


def test_sections_alike_every_way_have_no_principal_axes() -> None:
    section = sections(prism(section_stiffness(1e8, 1e6, 2e6, 2e6)[0], section_mass(3.0)[0]))
    assert np.isnan(section.principal).all()
    assert np.isnan(section.mass_axes).all()
    np.testing.assert_allclose(section.EI_flap, 2e6)


def test_rigid_strains_are_infinite_and_put_their_centre_on_the_axis() -> None:
    section = sections(prism(section_stiffness(np.inf, np.inf, 1e6, 2e6)[0], section_mass(3.0)[0]))
    assert np.isinf(section.EA).all()
    assert np.isinf(section.GJ).all()
    assert not section.tension_centre.any()
    assert not section.shear_centre.any()


@given(y=st.floats(-0.4, 0.4), z=st.floats(-0.4, 0.4))
@settings(max_examples=20, deadline=None)
def test_another_reference_axis_moves_every_centre_by_its_offset_and_nothing_else(y: float, z: float) -> None:
    blade = fibrous()[0]
    moved = about(blade, np.array([0.0, y, z]))
    a, b = sections(blade), sections(moved)
    for name in ("mass_centre", "tension_centre", "shear_centre"):
        np.testing.assert_allclose(getattr(b, name), getattr(a, name) - [y, z], atol=1e-8, err_msg=name)
    for name in ("principal", "mass_axes", "EA", "GJ", "EI_flap", "EI_edge"):
        np.testing.assert_allclose(getattr(b, name), getattr(a, name), rtol=1e-7, err_msg=name)
    np.testing.assert_allclose(about_root(moved).first, about_root(blade).first, atol=1e-9)
    np.testing.assert_allclose(about_root(moved).moments, about_root(blade).moments, atol=1e-9)


def tapered(**changes: object) -> Blade:
    """12 kg/m at the root, nothing left (1e-9) at the tip, 6 m."""
    mass = section_mass(np.array([12.0, 1e-9]))
    stiffness = np.repeat(section_stiffness(1e8, 1e6, 1e6, 2e6), 2, axis=0)
    return Blade("cone", np.array([0.0, 6.0]), stiffness, mass, np.zeros(2), **changes)  # type: ignore[arg-type]


def test_a_tapered_rod_has_the_mass_and_moments_of_a_triangle() -> None:
    """m₀L/2, m₀L²/6, m₀L³/12."""
    root_loads = about_root(tapered())
    np.testing.assert_allclose(
        [root_loads.mass, root_loads.first[0], root_loads.moments[2, 2]], [36.0, 72.0, 216.0], rtol=1e-9
    )
    np.testing.assert_allclose(root_loads.centre, [2.0, 0.0, 0.0], atol=1e-9)


def test_about_the_hub_precone_and_pitch_count() -> None:
    """At (1.5 + s) along an axis coned by 10°, a point is (1.5 + s) cos 10° from the rotor's axis and that far downwind."""
    blade = tapered(hub_radius=1.5, precone=np.radians(10), pitch=0.3)
    hub_loads = about_hub(blade)
    r = np.array([np.cos(np.radians(10)), 0.0, np.sin(np.radians(10))])
    np.testing.assert_allclose(hub_loads.centre, 3.5 * r, rtol=1e-9, atol=1e-12)
    second = 36.0 * 1.5**2 + 2 * 1.5 * 72.0 + 216.0
    np.testing.assert_allclose(hub_loads.moments[2, 2], second * r[0] ** 2, rtol=1e-9)
    np.testing.assert_allclose(about_root(blade).centre, [2.0, 0.0, 0.0], atol=1e-9)


def test_a_mass_at_the_tip_is_where_twist_and_pitch_turn_it() -> None:
    """2 kg 0.5 m along the tip section's y, which twist and pitch of 30° each turn by 60° towards z; pitched axes see 30°."""
    body = np.diag([2.0, 2, 2, 0, 0, 0])
    body[0, 5] = body[5, 0] = -1.0
    body[2, 3] = body[3, 2] = 1.0
    body[3, 3] = body[5, 5] = 0.5
    turned = tapered(tip_mass=body, pitch=np.radians(30))
    turned = replace(turned, twist=np.radians([0.0, 30.0]), mass=turned.mass * 1e-9)
    hub, own = about_hub(turned), about_root(turned)
    np.testing.assert_allclose(hub.centre, [6.0, 0.5 * np.cos(np.pi / 3), 0.5 * np.sin(np.pi / 3)], rtol=1e-7)
    np.testing.assert_allclose(own.centre, [6.0, 0.5 * np.cos(np.pi / 6), 0.5 * np.sin(np.pi / 6)], rtol=1e-7)
    np.testing.assert_allclose(hub.moments[2, 2], 2 * (36.0 + 0.5**2 * 0.25), rtol=1e-6)


def test_the_body_at_the_tip_is_told_about_its_own_centre() -> None:
    """A rod of 3 kg and 2 m across, whose centre lies at (0.1, 0.4, −0.2) from the tip: m l²/12 about itself."""
    at, own = np.array([0.1, 0.4, -0.2]), np.diag([1.0, 0.0, 1.0])
    cross = np.array([[0, 0.2, 0.4], [-0.2, 0, -0.1], [-0.4, 0.1, 0]])
    body = np.block([[3 * np.eye(3), -3 * cross], [3 * cross, own - 3 * cross @ cross]])
    result = tip(tapered(tip_mass=body))
    assert result is not None
    assert result.mass == 3.0
    np.testing.assert_allclose(result.centre, at, atol=1e-15)
    np.testing.assert_allclose(result.own, own, atol=1e-14)
    assert tip(tapered()) is None


def test_nrel_5mw_as_published() -> None:
    """17,740 kg, 363,231 kg m and 11,776,047 kg m² about the root: NREL/TP-500-38060 (2009), Table 2-2.

    These are sums over the 17 blade nodes of that report's AeroDyn table (Table 3-1: elements of 2.7333, 4.1 and 2.7333 m),
    as FAST does them, of the table times 1.04536. The integral of the very same table is 0.74 % less, and known to be.
    """
    blade = library.load("nrel-5mw").variants[0].blade
    element = np.repeat([2.7333, 4.1, 2.7333], [3, 11, 3])
    at = np.cumsum(element) - element / 2
    lumps = mass_at(blade, at)[:, 0, 0] * element
    np.testing.assert_allclose(lumps.sum(), 17740.0, rtol=1e-5)
    np.testing.assert_allclose(lumps @ at, 363231.0, rtol=1e-5)
    np.testing.assert_allclose(lumps @ at**2, 11776047.0, rtol=1e-5)
    root_loads = about_root(blade)
    table = trapezoid(blade.mass[:, 0, 0], blade.stations)
    np.testing.assert_allclose(root_loads.mass, table, rtol=1e-12)
    assert root_loads.mass / 17740.0 - 1 == pytest.approx(-0.0074, abs=1e-4)
    assert root_loads.first[0] / 363231.0 - 1 == pytest.approx(-0.0052, abs=1e-4)
