"""The closed forms against formulas, against each other in the limits where they meet, and against the in-house solver."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import root_scalar

from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.effects import Effects
from southwell.core.solve import mesh_modes
from southwell.references.protocol.interface import CodeError
from southwell.references.theories import assumed_modes, exact_beam, southwell_equation, straight_beam, yoo_shin

from ...support.straight_blades import TURN, X, Y, Z, family, kinked, park, slender

ASSUMED, YOO_SHIN, SOUTHWELL, EXACT = assumed_modes.CODE, yoo_shin.CODE, southwell_equation.CODE, exact_beam.CODE
CODES = (ASSUMED, YOO_SHIN, SOUTHWELL, EXACT)
FINE = 32


def ids(code) -> str:
    return code.name


def cantilever(k: int) -> float:
    """βL of the uniform cantilever's k-th bending mode: cos βL cosh βL = −1."""
    return root_scalar(
        lambda x: np.cos(x) + 1 / np.cosh(x), bracket=((k - 1) * np.pi + 1e-3, k * np.pi), xtol=1e-15
    ).root


# ---------------------------------------------------------------------------------------------------------- formulas


@pytest.mark.parametrize("code", CODES, ids=ids)
def test_at_rest_the_cantilevers_closed_form(code) -> None:
    solution = code.solve(park(), 0.0, FINE, 20)
    if code is EXACT:
        solution = code.solve(replace(park(), mass=section_mass([1.2, 1.2])), 0.0, FINE, 20)
    expected = [cantilever(k) ** 2 * np.sqrt(1.4e4 / 1.2) / 36.0 for k in range(1, 6)]
    for plane in (Y, Z):
        np.testing.assert_allclose(family(solution, plane)[:5], expected, rtol=1e-11)


@pytest.mark.parametrize("code", [YOO_SHIN, EXACT], ids=ids)
def test_at_rest_stretching_modes_are_the_bars(code) -> None:
    solution = code.solve(slender(10.0), 0.0, FINE, 12)
    np.testing.assert_allclose(family(solution, X)[:3], 10.0 * np.pi * np.array([0.5, 1.5, 2.5]), rtol=1e-11)


@pytest.mark.parametrize("omega", [0.0, 3.0])
def test_torsion_of_a_flat_blade_gains_the_square_of_the_speed(omega: float) -> None:
    """Flat: I_y = 0, I_x = I_z. Then flapwise motion is not coupled and ω² = ω₀² + Ω² (the tennis racket's term)."""
    blade = uniform_blade("flat", 1.0, 0.0, EA=1e4, GJ=2.0, EI_y=1.0, EI_z=50.0, mass=1.0, I_z=0.1)
    rest = np.pi * np.array([0.5, 1.5, 2.5]) * np.sqrt(2.0 / 0.1)
    result = family(EXACT.solve(blade, omega, FINE, 12), TURN)
    np.testing.assert_allclose(result[:3], np.hypot(rest, omega), rtol=1e-11)


def test_steady_stretch_of_a_uniform_blade() -> None:
    """E A r″ + m Ω² r = 0, r(0) = R, r′(L) = 1."""
    blade, omega = slender(70.0, 0.1), 60.0
    at = straight_beam.line(blade, FINE)
    k = omega / 70.0
    b = (1 + k * 0.1 * np.sin(k)) / (k * np.cos(k))
    stretch, slope = exact_beam.steady_stretch(blade, at, omega, FINE)
    np.testing.assert_allclose(stretch, k * (b * np.cos(k * at.s) - 0.1 * np.sin(k * at.s)), rtol=1e-12)
    np.testing.assert_allclose(slope, -(k**2) * (0.1 * np.cos(k * at.s) + b * np.sin(k * at.s)), atol=1e-9)


@pytest.mark.parametrize("code", [YOO_SHIN, EXACT], ids=ids)
def test_no_steady_state_above_the_speed_of_unbounded_stretch(code) -> None:
    critical = 70.0 * np.pi / 2
    code.solve(slender(), 0.999 * critical, FINE, 4)
    with pytest.raises(CodeError, match=r"no stable steady state|no steady stretch"):
        code.solve(slender(), 1.001 * critical, FINE, 4)


def test_cable_of_the_uniform_blade() -> None:
    """Frequencies Ω √(j (2j − 1)) out of the plane of rotation."""
    j = np.arange(1, 8)
    np.testing.assert_allclose(southwell_equation.cable(slender(), (Z,), FINE, 7), j * (2 * j - 1), rtol=1e-10)
    np.testing.assert_allclose(southwell_equation.cable(slender(), (Y,), FINE, 7) + 1, j * (2 * j - 1), rtol=1e-10)


def test_southwells_coefficient_of_the_uniform_cantilever() -> None:
    """K = ∫ T φ′² / ∫ φ², with the cantilever's own mode in closed form; 1.193 flapwise, less 1 edgewise."""
    b = cantilever(1)
    r = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))

    def phi(x: float) -> float:
        return np.cosh(b * x) - np.cos(b * x) - r * (np.sinh(b * x) - np.sin(b * x))

    def slope(x: float) -> float:
        return b * (np.sinh(b * x) + np.sin(b * x) - r * (np.cosh(b * x) - np.cos(b * x)))

    K = quad(lambda x: (1 - x * x) / 2 * slope(x) ** 2, 0, 1)[0] / quad(lambda x: phi(x) ** 2, 0, 1)[0]
    assert round(K, 3) == 1.193
    solution = SOUTHWELL.solve(slender(), 7.0, FINE, 6)
    for plane, less in ((Z, 0.0), (Y, 1.0)):
        assert family(solution, plane)[0] == pytest.approx(np.sqrt(b**4 + (K - less) * 49.0), rel=1e-11)


# ------------------------------------------------------------------- the paper's cantilever at 10 rad/s, as computed elsewhere


@pytest.mark.parametrize(
    ("code", "edgewise", "flapwise"),
    [
        (ASSUMED, ("11.71325", "70.44004", "189.93315"), ("15.40131", "71.14632", "190.19622")),
        (YOO_SHIN, ("11.71188", "70.43864", "189.93196"), ("15.40131", "71.14632", "190.19622")),
        (EXACT, ("11.710953", "70.419355", "189.81994"), ("15.400199", "71.126584", "190.083784")),
    ],
    ids=["assumed-modes", "yoo-shin", "exact-beam"],
)
def test_the_papers_cantilever(code, edgewise: tuple[str, ...], flapwise: tuple[str, ...]) -> None:
    """Digits of two independent spectral solutions that take the sections as rigid in torsion."""
    solution = code.solve(park(), 10.0, FINE, 12)
    for plane, digits in ((Y, edgewise), (Z, flapwise)):
        for frequency, text in zip(family(solution, plane)[: len(digits)], digits, strict=True):
            assert round(frequency, len(text.partition(".")[2])) == float(text)


def test_torsion_lowers_flapwise_modes_slightly() -> None:
    """The sections' inertia couples the two, 2 Ω I_y φ β̇, and the lower of two coupled frequencies gives way: by some 1e-8."""
    stiff, soft = (family(EXACT.solve(park(GJ), 10.0, FINE, 12), Z)[:3] for GJ in (np.inf, 1.08e4))
    change = soft / stiff - 1
    assert (change < 0).all()
    assert (change > -5e-8).all()


# ------------------------------------------------------------------------------------------------------------ each other


def test_yoo_shin_tends_to_assumed_modes_for_slender_blades() -> None:
    """The Coriolis coupling falls off with 1/EA."""

    def gap(slenderness: float) -> np.ndarray:
        blade = slender(slenderness, 0.1)
        return (
            family(ASSUMED.solve(blade, 10.0, FINE, 8), Y)[:3] / family(YOO_SHIN.solve(blade, 10.0, FINE, 8), Y)[:3] - 1
        )

    np.testing.assert_allclose(gap(400.0) / gap(800.0), 4.0, rtol=0.01)
    assert gap(70.0)[0] > 0.01
    assert gap(1e4).max() < 1e-6


def test_exact_beam_tends_to_yoo_shin_for_slender_blades() -> None:
    """Without rotary inertia only the steady stretch is between them; it falls off with 1/EA, and Coriolis stays."""

    def gap(slenderness: float) -> np.ndarray:
        blade = slender(slenderness, 0.1)
        a, b = (code.solve(blade, 10.0, FINE, 8) for code in (YOO_SHIN, EXACT))
        return np.concatenate([family(a, p)[:3] / family(b, p)[:3] - 1 for p in (Y, Z)])

    np.testing.assert_allclose(gap(400.0) / gap(800.0), 4.0, rtol=0.01)
    assert np.abs(gap(70.0)).max() > 1e-3
    assert np.abs(gap(1e4)).max() < 1e-6


def test_flapwise_yoo_shin_is_assumed_modes() -> None:
    a, b = (code.solve(kinked(inertia=0.0), 6.0, FINE, 6) for code in (ASSUMED, YOO_SHIN))
    np.testing.assert_allclose(family(a, Z)[:2], family(b, Z)[:2], rtol=1e-12)


@given(hub=st.floats(0, 3), omega=st.floats(0, 20), taper=st.floats(0.1, 1), EI_y=st.floats(0.1, 1))
@settings(max_examples=40, deadline=None)
def test_southwells_bracket_holds_for_every_mode(hub: float, omega: float, taper: float, EI_y: float) -> None:
    k = np.array([1.0, taper])
    blade = replace(slender(70.0, hub), stiffness=section_stiffness(4900 * k, k, EI_y * k, k), mass=section_mass(k))
    for bending in assumed_modes.bendings(blade, 20):
        beta = southwell_equation.cable(blade, bending.planes, 20, 5)
        value, lower, upper, _ = southwell_equation.squared(bending, beta, omega, 5)
        exact = assumed_modes.stationary_modes(bending.mass, bending.stiffness(omega), 5)[0] ** 2
        rounding = 1e-9 * exact
        assert (lower <= exact + rounding).all()
        assert (exact <= upper + rounding).all()
        assert (lower <= value + rounding).all()
        assert (value <= upper + rounding).all()
        assert value[0] == upper[0]  # Southwell's theorem: never too low a first frequency
    result, truth = (code.solve(blade, omega, 20, 6) for code in (SOUTHWELL, ASSUMED))
    for plane in (Y, Z):
        here = np.abs(result.shapes).max(1).argmax(1) == plane
        assert here.sum() >= 2
        reach = result.uncertainty[here][:2] * result.frequencies[here][:2]
        assert (np.abs(result.frequencies[here][:2] - family(truth, plane)[:2]) <= reach + 1e-9).all()


@pytest.mark.parametrize("seed", range(10))
def test_southwells_bracket_holds_for_any_two_stiffnesses(seed: int) -> None:
    """Also where the modes that are stiff in bending are soft as cables, unlike a blade's."""
    draw = np.random.default_rng(seed)
    basis = np.linalg.qr(np.eye(8) + 0.3 * draw.normal(size=(8, 8)))[0]
    beta = np.sort(draw.uniform(0, 9, 8))
    elastic, centrifugal = np.diag(np.arange(1.0, 9.0)), basis @ np.diag(beta[::-1]) @ basis.T
    bending = assumed_modes.Bending(elastic, centrifugal, np.eye(8), np.zeros((21, 4, 8)), (Z,))
    value, lower, upper, _ = southwell_equation.squared(bending, beta, 1.3, 8)
    exact = np.linalg.eigvalsh(elastic + 1.69 * centrifugal)
    assert (lower <= exact + 1e-12).all()
    assert (exact <= upper + 1e-12).all()
    assert upper[0] == value[0]
    assert upper[-1] == pytest.approx(exact[-1])


@pytest.mark.parametrize("omega", [0.0, 4.0, 15.0])
def test_southwells_bracket_of_a_twisted_blade(omega: float) -> None:
    result, truth = (code.solve(kinked(0.8, 0.0), omega, 16, 6) for code in (SOUTHWELL, ASSUMED))
    assert (np.abs(result.frequencies - truth.frequencies) <= result.uncertainty * result.frequencies + 1e-9).all()
    assert (result.uncertainty > (1e-6 if omega else -1.0)).all()


# --------------------------------------------------------------------------------------------------------------- in-house


def extrapolated(blade: Blade, omega: float, count: int, order: int, model: Effects) -> np.ndarray:
    coarse, fine = (mesh_modes(blade, omega, n, count, effects=model).frequencies for n in (100, 200))
    return fine + (fine - coarse) / (2.0**order - 1)


@pytest.mark.parametrize("tip", [0.0, 1.0], ids=["free tip", "tip mass with inertia"])
def test_the_solver_converges_to_the_exact_beam(tip: float) -> None:
    """Bending, torsion and stretch of a blade on which rotary inertia, prestretch and every coupling are large."""
    blade = kinked(tip=tip)
    expected = EXACT.solve(blade, 5.0, FINE, 8)
    assert {int(c) for c in np.abs(expected.shapes).max(1).argmax(1)} == {X, Y, Z, TURN}
    np.testing.assert_allclose(extrapolated(blade, 5.0, 8, 2, Effects()), expected.frequencies, rtol=2e-8)


@pytest.mark.parametrize(("twist", "pitch"), [(0.0, 0.0), (0.8, 0.0), (0.8, -0.3)])
def test_the_solver_without_the_same_effects_converges_to_assumed_modes(twist: float, pitch: float) -> None:
    """Bending alone, for which the solver's elements are of fourth order; the solver's fourth mode here is a stretch."""
    blade = replace(kinked(twist, 0.0), pitch=pitch)
    frequencies = ASSUMED.solve(blade, 6.0, FINE, 3).frequencies
    np.testing.assert_allclose(extrapolated(blade, 6.0, 3, 4, ASSUMED.effects), frequencies, rtol=1e-7)


def test_the_solver_without_the_same_effects_converges_to_yoo_shin() -> None:
    """Bending coupled with stretch, for which the solver's elements are of second order."""
    blade = kinked(inertia=0.0)
    solution = YOO_SHIN.solve(blade, 6.0, FINE, 6)
    assert X in np.abs(solution.shapes).max(1).argmax(1)
    np.testing.assert_allclose(extrapolated(blade, 6.0, 6, 2, YOO_SHIN.effects), solution.frequencies, rtol=2e-8)


def test_gyroscopic_lag_has_the_solvers_sign() -> None:
    """Moving forwards (+y) a section turns faster with the rotor and is pulled outwards: x leads y by a quarter."""
    for result in (
        YOO_SHIN.solve(slender(), 10.0, 16, 4),
        EXACT.solve(slender(), 10.0, 16, 4),
        mesh_modes(slender(), 10.0, 50, 4),
    ):
        shape = result.shapes[0]
        ratio = shape[-1, X] / shape[-1, Y]
        assert ratio.imag > 1e-3
        assert abs(ratio.real) < 1e-9


def test_flapwise_torsion_lag_has_the_solvers_sign() -> None:
    blade = uniform_blade("bar", 1.0, 0.2, EA=2000.0, GJ=3.0, EI_y=1.0, EI_z=20.0, mass=1.0, I_y=0.02, I_z=0.05)
    ratios = []
    for result in (EXACT.solve(blade, 6.0, 16, 4), mesh_modes(blade, 6.0, 200, 4)):
        shape = result.shapes[np.abs(result.shapes).max(1).argmax(1) == Z][0]
        ratios.append(shape[-1, TURN] / shape[-1, Z])
    assert abs(ratios[0].imag) > 0.01
    assert ratios[1] == pytest.approx(ratios[0], rel=1e-3)


def test_pitch_turns_a_blade_as_a_whole() -> None:
    """At rest it changes no frequency; by a quarter turn the two bending stiffnesses change places."""
    blade = slender(70.0, 0.1, EI_y=0.2)
    rest = [ASSUMED.solve(replace(blade, pitch=p), 0.0, 16, 6).frequencies for p in (0.0, 0.7)]
    np.testing.assert_allclose(rest[1], rest[0], rtol=1e-11)
    turned = ASSUMED.solve(replace(blade, pitch=np.pi / 2), 8.0, 16, 6).frequencies
    swapped = uniform_blade("swapped", 1.0, 0.1, EA=4900.0, GJ=1.0, EI_y=1.0, EI_z=0.2, mass=1.0)
    np.testing.assert_allclose(turned, ASSUMED.solve(swapped, 8.0, 16, 6).frequencies, rtol=1e-11)


def test_a_pitched_blade_bends_along_its_own_axes() -> None:
    """Softest about its own y, it moves along its own z: the blade's z turned from y towards z, (−sin, cos)."""
    shape = ASSUMED.solve(replace(slender(EI_y=0.2), pitch=0.7), 0.0, 16, 1).shapes[0].real
    np.testing.assert_allclose(shape[:, Y], -np.tan(0.7) * shape[:, Z], atol=1e-10)
    assert np.abs(shape[-1, Z]) > 0.1


def test_twist_of_round_sections_changes_nothing() -> None:
    plain, twisted = slender(70.0, 0.1), replace(slender(70.0, 0.1), twist=np.array([0.9, 0.0]))
    a, b = (ASSUMED.solve(blade, 8.0, 16, 6).frequencies for blade in (plain, twisted))
    np.testing.assert_allclose(b, a, rtol=1e-10)
