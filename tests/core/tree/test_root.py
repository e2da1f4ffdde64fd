"""Blades on hinges and springs at the root, and under steady loads: closed forms, limits, another code."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core.blade import Blade, BladeError, uniform_blade, without_rotary_inertia
from southwell.core.element.discretize import discretize
from southwell.core.solve import mesh_modes, modes
from southwell.core.spectrum.eigen import UnstableError
from southwell.core.steady import blade_state
from southwell.references.protocol import registry
from southwell.tests.support.beams import PARK, tapered
from southwell.tests.support.codes import BLADE_CODES

CLAMPED = np.inf
FLAP, LAG, BOTH = ([*4 * [CLAMPED], y, z] for y, z in ((0.0, CLAMPED), (CLAMPED, 0.0), (0.0, 0.0)))


def on(blade: Blade, root: list[float]) -> Blade:
    return replace(blade, root=np.array(root))


def rod(root: list[float]) -> Blade:
    """Nearly rigid, and without moments of inertia."""
    bare = without_rotary_inertia(PARK)
    stiff = np.where(np.isinf(bare.stiffness), bare.stiffness, 1e6 * bare.stiffness)
    return on(replace(bare, stiffness=stiff), root)


@pytest.mark.parametrize("mass", ["consistent", "half_end"])
def test_a_rigid_articulated_blade(mass) -> None:
    """Flap Ω √(1 + 3e/2L), lead–lag Ω √(3e/2L) (Bramwell, Done, Balmford, *Helicopter Dynamics*, 2001, ch. 1)."""
    e = 1.5 * PARK.hub_radius / PARK.length
    flap, lag = 10 * np.sqrt(1 + e), 10 * np.sqrt(e)
    tolerance = 1e-5 if mass == "consistent" else 2e-3  # half the first element's mass sits on the hinge
    for root, expected in ((FLAP, [flap]), (LAG, [lag]), (BOTH, [lag, flap])):
        frequencies = mesh_modes(rod(root), 10.0, 40, len(expected), mass=mass).frequencies
        np.testing.assert_allclose(frequencies, expected, rtol=tolerance)


def test_a_cable_flaps_at_the_roots_of_legendres_equation() -> None:
    """Ω √(k(2k − 1)): 1, √6, √15 for a rotating cable without stiffness (Lamb and Southwell 1921)."""
    cable = uniform_blade("cable", 6.0, 0.0, EA=2.8e7, GJ=1.0, EI_y=0.05, EI_z=1e7, mass=1.2)
    solution = mesh_modes(on(cable, FLAP), 10.0, 120, 3)
    k = np.arange(1, 4)
    np.testing.assert_allclose(solution.frequencies, 10 * np.sqrt(k * (2 * k - 1)), rtol=1e-4)


def test_springs_agree_with_the_finite_element_beam() -> None:
    """Another mechanical model, about the stretched state, where slope and rotation differ slightly."""
    code = registry.code("scikit-fem")
    if code.version() is None:
        pytest.skip(code.hint)
    for root in (FLAP, BOTH, [*4 * [CLAMPED], 500.0, 300.0]):
        blade = on(PARK, root)
        np.testing.assert_allclose(
            mesh_modes(blade, 10.0, 60, 4).frequencies, code.solve(blade, 10.0, 96, 4).frequencies, rtol=1e-7
        )


def test_stiff_springs_clamp() -> None:
    stiff, clamped = (mesh_modes(on(PARK, 6 * [k]), 10.0, 40, 6).frequencies for k in (1e13, CLAMPED))
    np.testing.assert_allclose(stiff, clamped, rtol=1e-8)


def test_the_joint_turns_with_the_pitch_and_not_with_the_twist() -> None:
    """On a beam that is the same in both planes, a quarter turn of pitch makes a flap hinge a lead–lag hinge."""
    lag = mesh_modes(on(PARK, LAG), 10.0, 20, 5).frequencies
    pitched = mesh_modes(replace(on(PARK, FLAP), pitch=np.pi / 2), 10.0, 20, 5).frequencies
    twisted = mesh_modes(replace(on(PARK, LAG), twist=np.array([0.4, 0.4])), 10.0, 20, 5).frequencies
    np.testing.assert_allclose(pitched, lag, rtol=1e-10)
    np.testing.assert_allclose(twisted, lag, rtol=1e-10)


def test_a_free_hinge_at_rest_is_reported() -> None:
    with pytest.raises(UnstableError, match="omega: 0 rad/s: flap: a free direction"):
        mesh_modes(on(PARK, FLAP), 0.0, 10, 3)


@pytest.mark.parametrize("elements", [40, 60, 100])
def test_a_free_lag_hinge_on_the_axis_is_reported(elements) -> None:
    """It has no stiffness at any speed; rounding must not appear as a frequency, and no other speed is recommended."""
    with pytest.raises(
        UnstableError, match=r"lag: a free direction of the root has no stiffness: add a spring or clamp it$"
    ):
        mesh_modes(replace(on(PARK, LAG), hub_radius=0.0), 10.0, elements, 6)


@pytest.mark.parametrize(("root", "match"), [([-1.0] * 6, "negative spring"), ([np.nan] * 6, "root: not a finite")])
def test_an_impossible_root_is_refused(root, match) -> None:
    with pytest.raises(BladeError, match=match):
        on(PARK, root)


HINGED = ("scikit-fem", "scikit-fem-reissner", "exudyn-tree")


@pytest.mark.parametrize("name", [n for n in BLADE_CODES if n not in HINGED])
def test_codes_that_clamp_the_root_report_hinges_as_unsupported(name) -> None:
    assert registry.code(name).unsupported(on(PARK, FLAP))


@pytest.mark.parametrize("mass", ["consistent", "half_end"])
def test_a_load_equal_to_the_blades_weight_is_gravity(mass) -> None:
    """In all directions at once: the same steady state and the same modes."""
    blade, g = tapered(), np.array([3.0, 5.0, -9.81])
    weight = blade.mass[:, 0, 0][:, None] * g
    pulled, loaded = (
        mesh_modes(blade, 2.0, 15, 5, mass=mass, gravity=gravity, load=load).frequencies
        for gravity, load in ((g, None), (np.zeros(3), weight))
    )
    np.testing.assert_allclose(loaded, pulled, rtol=1e-12)
    assert np.abs(pulled / mesh_modes(blade, 2.0, 15, 5, mass=mass).frequencies - 1).max() > 1e-4


def test_tip_deflection_under_a_uniform_load() -> None:
    """q L⁴ / 8 EI for a small load."""
    q = 1e-3
    body = discretize(PARK, 8, load=np.array(2 * [[0.0, 0.0, q]]))
    tip = blade_state.steady_state(body, 0.0, np.zeros(3)).shape.nodes[-1, 2, 3]
    assert tip == pytest.approx(q * PARK.length**4 / (8 * PARK.stiffness[0, 4, 4]), rel=1e-8)


def test_a_load_of_the_wrong_shape_is_refused() -> None:
    with pytest.raises(ValueError, match=r"load: shape \(3, 3\)"):
        modes(PARK, 1.0, load=np.zeros((3, 3)))


def test_springs_act_on_the_coordinates_of_a_joint_that_slides_and_turns() -> None:
    """Against Exudyn's kinematic tree of prismatic and revolute joints, its error of second order removed."""
    code = registry.code("exudyn-tree")
    if code.version() is None:
        pytest.skip(code.hint)
    soft = uniform_blade("soft", 1.0, 0.2, EA=1e4, GJ=1.0, EI_y=1.0, EI_z=1.0, mass=1.0, I_y=1e-3, I_z=2e-3)
    blade = replace(on(soft, [80.0, 60.0, 40.0, 2.0, 5.0, 7.0]), pitch=0.3)
    coarse, fine = (code.solve(blade, 2.0, n, 5).frequencies for n in (24, 48))
    np.testing.assert_allclose(mesh_modes(blade, 2.0, 40, 5).frequencies, fine + (fine - coarse) / 3, rtol=2e-6)
