"""The solver on the paper's cantilever: printed digits, exact values, orders of convergence, agreement of its two paths."""

import numpy as np
import pytest
from scipy.optimize import brentq

from southwell.core.blade import uniform_blade, without_rotary_inertia
from southwell.core.effects import Effects
from southwell.core.element.discretize import discretize
from southwell.core.solve import chain_modes, mesh_modes, modes
from southwell.core.space import spatial as sp
from southwell.core.spectrum import eigen, modal
from southwell.core.spectrum.mesh_solver import balance
from southwell.core.steady import blade_state
from southwell.core.tree.as_mechanism import mechanism
from southwell.tests.support.beams import EXACT_EDGEWISE, EXACT_FLAPWISE, PARK, curved, tapered, yoo_shin
from southwell.tests.support.dense import dense as dense_of
from southwell.tests.support.dense import to_twists


def planes(blade, omega, elements, count=6, **options) -> tuple[np.ndarray, np.ndarray]:
    """Edgewise and flapwise frequencies, distinguished by the direction of motion at the tip."""
    m = modes(blade, omega, elements, count, **options)
    tip = np.abs(m.shapes[:, -1])
    flap = tip[:, 2] > tip[:, 1]
    return m.frequencies[~flap], m.frequencies[flap]


def test_the_papers_table_digit_for_digit() -> None:
    """Park et al. 2010, Table 1, Present: 50 elements, point masses, stiffness linear in the parent's frame."""
    result = planes(PARK, 10.0, 50, mass="half_end", stiffness="body_fixed", effects=Effects(rotary_inertia=False))[0][
        :3
    ]
    assert [f"{f:.4f}" for f in result] == ["11.7058", "70.3722", "189.6735"]
    assert [f"{f:.4g}" for f in result] == ["11.71", "70.37", "189.7"]


def test_consistent_mass_reaches_the_exact_values() -> None:
    edgewise, flapwise = planes(PARK, 10.0, 50)
    np.testing.assert_allclose(edgewise[:3], EXACT_EDGEWISE, rtol=2e-5)
    np.testing.assert_allclose(flapwise[:3], EXACT_FLAPWISE, rtol=2e-5)


@pytest.mark.parametrize(("mass", "order", "levels"), [("half_end", 2, (20, 40, 80)), ("consistent", 4, (20, 40, 80))])
def test_observed_order_of_convergence(mass, order, levels) -> None:
    """log₂ of successive differences, the first two modes of the rotating cantilever in each plane."""
    blade = without_rotary_inertia(PARK)
    f = np.array([mesh_modes(blade, 10.0, n, 4, mass=mass).frequencies for n in levels])
    np.testing.assert_allclose(np.log2(np.abs((f[0] - f[1]) / (f[1] - f[2]))), order, atol=0.15)


@pytest.mark.parametrize("omega", [0.0, 1.5])
@pytest.mark.parametrize("blade", [tapered(), curved()], ids=["tapered and twisted", "curved and coupled"])
def test_fourth_order_or_better_for_every_kind_of_motion(blade, omega) -> None:
    """Bending, torsion, coupled, shear: six modes at rest and turning; changes from 10 to 20 and to 40 elements."""
    f = np.array([mesh_modes(blade, omega, n, 6).frequencies for n in (10, 20, 40)])
    change = np.abs(np.diff(f, axis=0)) / f[-1]
    assert ((np.log2(change[0] / change[1]) > 3.5) | (change[1] < 1e-8)).all()


def test_fourth_order_where_the_steady_strain_is_large() -> None:
    """Slenderness 70, γ = 10: a steady stretch of 1 %. Elements that neglect their stretch are of second order."""
    f = np.array([mesh_modes(yoo_shin(0.0), 10.0, n, 4).frequencies for n in (10, 20, 40)])
    assert (np.log2(np.abs((f[0] - f[1]) / (f[1] - f[2]))) > 3.3).all()


@pytest.mark.parametrize("elements", [2000, pytest.param(20_000, marks=pytest.mark.nightly)])
def test_many_elements_lose_no_digits_at_rest(elements: int) -> None:
    """The Euler-Bernoulli beam, cos β cosh β = −1, within the stated rounding; a stiffness of 1e17 times that of the mode."""
    blade = uniform_blade("slender", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=4e6, mass=10.0)
    beta = np.array(
        [brentq(lambda b: np.cos(b) + 1.0 / np.cosh(b), c - 0.3, c + 0.3, xtol=1e-15) for c in (1.9, 4.7, 7.9)]
    )
    exact = np.sort(np.outer(np.sqrt([1e6 / 10.0, 4e6 / 10.0]), (beta / 10.0) ** 2).ravel())[:4]
    solution = chain_modes(discretize(blade, elements), 0.0, 4)
    assert (np.abs(solution.frequencies / exact - 1.0) <= solution.rounding).all()
    assert solution.rounding.max() < 1e-12


@pytest.mark.nightly
def test_many_elements_lose_no_digits_at_speed() -> None:
    """Meshes whose discretisation errors are below 1e-14 agree within the stated rounding."""
    few, many = (chain_modes(discretize(PARK, n), 10.0, 6) for n in (5000, 20_000))
    assert (np.abs(many.frequencies / few.frequencies - 1.0) <= few.rounding + many.rounding).all()
    assert many.rounding.max() < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("count", [10, 40, 80])
def test_many_modes_of_a_chain_with_massless_rotations(count) -> None:
    """A basis of hundreds of vectors in a semi-definite product must not drift: Lanczos against LAPACK."""
    body = discretize(yoo_shin(0.0), 40, "half_end", "body_fixed")
    dense = modal.modes(modal.linearize(mechanism(body, 2.0)), count).frequencies
    frequencies = mesh_modes(yoo_shin(0.0), 2.0, 40, count, mass="half_end", stiffness="body_fixed").frequencies
    np.testing.assert_allclose(frequencies, dense, rtol=1e-9)


def test_stages_agree_between_the_paths() -> None:
    """M*, C*, K* are the Cartesian pencil projected by B, with twists in the bodies' axes."""
    body, n = discretize(curved(), 5), 5
    state = blade_state.steady_state(body, 1.5, np.zeros(3))
    shape, cartesian = state.shape, state.pencil
    dense = modal.linearize(mechanism(body, 1.5))
    k = dense.state.kinematics
    np.testing.assert_allclose(k.poses[1:], shape.nodes, atol=1e-9)
    twists = sp.adjoint(sp.inverse(k.poses[2:])) @ k.B[2 : n + 2, :, 1:]
    B = np.concatenate([twists, k.B[n + 2 :, :, 1:]], axis=1)  # an element's outer node, then its β
    B = np.linalg.solve(to_twists(cartesian, 12), B.reshape(12 * n, -1))
    for star, part in ((dense.M, cartesian.M), (dense.C, cartesian.C), (dense.K, cartesian.K)):
        projected = B.T @ dense_of(cartesian, part) @ B
        assert np.abs(projected - star).max() < 1e-9 * np.abs(star).max()


def test_undamped_modes_have_no_real_part() -> None:
    """The same pencil through the general complex solver: λ on the imaginary axis to rounding."""
    dense = modal.linearize(mechanism(discretize(PARK, 10), 10.0))
    frequencies = eigen.damped(dense.M, dense.C, dense.K, 6)
    lowest = eigen.gyroscopic(dense.M, dense.C, dense.K, 6).frequencies
    np.testing.assert_allclose(frequencies.values.imag, lowest, rtol=1e-9)
    assert np.abs(frequencies.values.real).max() < 1e-8 * lowest[-1]


def test_degenerate_pairs_at_rest_are_both_found() -> None:
    f = mesh_modes(PARK, 0.0, 30, 8).frequencies
    np.testing.assert_allclose(f[0::2], f[1::2], rtol=1e-10)
    beta_l = np.array([1.8751040687, 4.6940911330])  # Euler–Bernoulli; rotary inertia lowers it by up to 3e-4 here
    euler = beta_l**2 * np.sqrt(7e10 * 2e-7 / (3000 * 4e-4)) / 36.0
    assert (np.abs(f[0:4:2] / euler - 1) < 4e-4).all()


def test_without_geometric_stiffness_the_first_edgewise_mode_collapses() -> None:
    """The result without stress stiffening: √(ω₀² − Ω²), of which the paper warns."""
    first = planes(PARK, 10.0, 50, effects=Effects(geometric=False))[0][0]
    assert first == pytest.approx(np.sqrt(10.548911**2 - 100.0), rel=1e-3)


def test_linear_theory_without_prestretch_is_yoo_and_shins() -> None:
    """α = 70, δ = 0, γ = 10: 4.9700, 32.0456, 73.9131 printed (Yoo and Shin 1998; the last digit of the third truncated)."""
    result = planes(yoo_shin(0.0), 10.0, 60, effects=Effects(prestretch=False))[0]
    np.testing.assert_allclose(result[:3], [4.9700, 32.0456, 73.9131], atol=1e-4)


def test_no_coriolis_in_the_flapwise_plane_but_much_edgewise() -> None:
    full, without = (planes(yoo_shin(0.0), 10.0, 40, effects=Effects(coriolis=c)) for c in (True, False))
    np.testing.assert_allclose(full[1], without[1], rtol=1e-9)
    assert without[0][0] / full[0][0] - 1 > 0.01


def test_no_steady_state_beyond_the_axial_critical_speed() -> None:
    """EA u″ + μ Ω² (x + u) = 0 has no bounded solution past Ω L √(μ/EA) = π/2: here γ = 35 π = 109.96."""
    modes(yoo_shin(0.0), 109.0, 20, 2, allow_large_strain=True)
    with pytest.raises(
        (blade_state.SteadyStateError, eigen.UnstableError), match=r"no steady state at 112 rad/s.*lower the loads"
    ):
        mesh_modes(yoo_shin(0.0), 112.0, 20, 2)


def test_gravity_prestresses_by_azimuth() -> None:
    """Hanging down (gravity outwards) stiffens like tension, standing up softens, by about the same Δω²."""
    down, none, up = (
        mesh_modes(tapered(), 0.0, 20, 1, gravity=np.array([g, 0.0, 0.0])).frequencies[0] ** 2
        for g in (9.81, 0.0, -9.81)
    )
    assert up < none < down
    assert (down - none) == pytest.approx(none - up, rel=0.05)


def test_unprestressed_chain_needs_no_newton() -> None:
    body = discretize(PARK, 4)
    state = balance(body, 10.0, np.zeros(3), Effects(prestretch=False))
    np.testing.assert_array_equal(state.shape.nodes, body.nodes)
    tension = blade_state.prestress_at_rest(body, 10.0, np.zeros(3)).beams.preload.max()
    assert np.abs(state.pencil.residual).max() < 1e-8 * tension


@pytest.mark.parametrize(
    ("arguments", "match"),
    [((PARK, 10.0, 0), "elements: 0"), ((PARK, 10.0, 5, 0), "count: 0"), ((PARK, float("nan")), "omega: nan")],
)
def test_bad_arguments_are_named(arguments, match) -> None:
    with pytest.raises(ValueError, match=match):
        modes(*arguments)


def test_a_shape_carried_over_to_a_finer_mesh_is_a_close_guess() -> None:
    """Within 1 % of the displacement; at nodes that the meshes share, it is the same."""
    coarse, fine = (discretize(curved(), n) for n in (8, 16))
    elsewhere = blade_state.steady_state(coarse, 4.0, np.zeros(3)).shape
    guess = blade_state.carried_over(coarse, elsewhere, fine)
    result = blade_state.steady_state(fine, 4.0, np.zeros(3)).shape
    moved = np.abs(result.nodes - fine.nodes).max()
    assert np.abs(guess.nodes - result.nodes).max() < 0.01 * moved
    np.testing.assert_allclose(guess.nodes[::2], elsewhere.nodes, atol=1e-12)
