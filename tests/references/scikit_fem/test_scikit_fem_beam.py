"""scikit-fem's prestressed beam against exact values, closed forms, another nonlinear code, and core."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import root_scalar

from southwell.cases.input.library import load
from southwell.core import solve
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade, without_rotary_inertia
from southwell.core.modes import STATIONS
from southwell.references.exudyn.ancf import CODE as ANCF
from southwell.references.protocol.interface import CodeError
from southwell.references.scikit_fem.beam import CODE
from southwell.tests.support.beams import EXACT_EDGEWISE, EXACT_FLAPWISE, PARK, curved, tapered, yoo_shin

pytestmark = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")

Array = NDArray[np.float64]
EXACT = np.sort(np.concatenate([EXACT_EDGEWISE, EXACT_FLAPWISE]))
TIP_MASS = np.diag([40.0, 40.0, 40.0, 9.0, 1.0, 8.0])
WINDPACT = {v.name: v.blade for v in load("park-blade").variants}["park-blade/windpact"]


def frequencies(blade: Blade, omega: float, elements: int, count: int = 6) -> Array:
    return CODE.solve(blade, omega, elements, count).frequencies


def orders(blade: Blade, omega: float, levels: tuple[int, ...], count: int) -> Array:
    """Observed order of convergence of each mode over doubled levels."""
    f = [frequencies(blade, omega, n, count) for n in levels]
    return np.log2((f[0] - f[1]) / (f[1] - f[2]))


def extrapolated(blade: Blade, omega: float) -> Array:
    """Core's eight lowest frequencies, from 80 and 160 elements: torsion and stretch are of second order."""
    coarse, fine = (solve.mesh_modes(blade, omega, n, 8).frequencies for n in (80, 160))
    return fine + (fine - coarse) / 3


def shaft(I_y: float, I_z: float, **changes: float) -> Blade:
    """A beam with torsional frequencies (k − ½) π √(GJ / I_x) at zero speed, far below those of bending."""
    stiff = {"EA": 1e4, "GJ": 1e-2, "EI_y": 1e2, "EI_z": 1e2, "mass": 1.0}
    return uniform_blade("shaft", 1.0, 0.1, **{**stiff, "I_y": I_y, "I_z": I_z, **changes})


def test_the_beam_with_all_effects_converges_to_exact_values() -> None:
    """Seven digits, including rotary inertia and steady stretch; the values are accurate to about 1e-6 rad/s."""
    np.testing.assert_allclose(frequencies(PARK, 10.0, 80), EXACT, rtol=1e-7)


@pytest.mark.parametrize(
    ("blade", "omega", "levels", "count"),
    [
        (PARK, 10.0, (5, 10, 20), 6),
        (yoo_shin(0.1), 20.0, (10, 20, 40), 6),
        (tapered(), 3.0, (20, 40, 80), 5),
        (replace(tapered(), tip_mass=TIP_MASS), 3.0, (20, 40, 80), 5),
        (WINDPACT, 30 * np.pi / 30, (20, 40, 80), 5),
    ],
    ids=["cantilever", "slender 70", "tapered and twisted", "with tip mass", "windpact"],
)
def test_fourth_order(blade: Blade, omega: float, levels: tuple[int, ...], count: int) -> None:
    """Kinks at the stations do not reduce the order, since they are ends of elements."""
    assert CODE.order == 4
    np.testing.assert_allclose(orders(blade, omega, levels, count), 4, atol=0.4)


@pytest.mark.skipif(ANCF.version() is None, reason=f"not installed: {ANCF.hint}")
@pytest.mark.parametrize("gamma", [10.0, 50.0])
@pytest.mark.parametrize("hub_ratio", [0.0, 1.0])
def test_large_stretch_agrees_with_nonlinear_theory(hub_ratio: float, gamma: float) -> None:
    """Slenderness 70: steady strains of 1 % to over 50 %, against a nonlinear code without analytical linearisation."""
    actual = frequencies(yoo_shin(hub_ratio), gamma, 80, 8)
    np.testing.assert_allclose(actual, ANCF.solve(yoo_shin(hub_ratio), gamma, 80, 8).frequencies, rtol=2e-7)


@pytest.mark.parametrize(
    ("inertia", "tip_mass", "pitch", "omega"),
    [
        pytest.param(True, TIP_MASS, 0.4, 3.0, id="everything"),
        pytest.param(True, TIP_MASS, 0.4, 0.0, id="at rest"),
        pytest.param(True, TIP_MASS, 0.0, 3.0, id="without pitch"),
        pytest.param(True, np.zeros((6, 6)), 0.4, 3.0, id="without tip mass"),
        pytest.param(False, TIP_MASS, 0.4, 3.0, id="without rotary inertia"),
    ],
)
def test_a_tapered_twisted_blade_agrees_with_core(inertia: bool, tip_mass: Array, pitch: float, omega: float) -> None:
    """Core uses rigid sections on helices: taper, twisted bending, inertias and their positions must agree."""
    blade = replace(tapered(), tip_mass=tip_mass, pitch=pitch)
    blade = blade if inertia else without_rotary_inertia(blade)
    np.testing.assert_allclose(frequencies(blade, omega, 80, 8), extrapolated(blade, omega), rtol=1e-5)


@pytest.mark.parametrize("omega", [2.0, 5.0, 8.0])
def test_a_blade_soft_in_torsion_agrees_with_core(omega: float) -> None:
    """The steady untwist is up to 0.24 rad: the propeller moment and the torque's effect on bending (1e-4) matter."""
    s, scale = np.array([0.0, 0.4, 1.0]), np.array([1.3, 1.0, 0.5])
    stiffness = section_stiffness(EA=4900 * scale, GJ=0.1 * scale, EI_y=scale, EI_z=5 * scale)
    mass = section_mass(scale, I_y=0.001 * scale, I_z=0.02 * scale)
    blade = Blade("soft", s, stiffness, mass, twist=np.array([0.6, 0.4, 0.0]), hub_radius=0.2)
    np.testing.assert_allclose(frequencies(blade, omega, 80, 8), extrapolated(blade, omega), rtol=5e-6)


def test_windpact_at_zero_speed_and_rotating() -> None:
    """First frequency of the public 3 MW blade: 0.932 Hz at zero speed, +10.3 % at 20 rpm, +21.7 % at 30 rpm."""
    rest, at_20, at_30 = (frequencies(WINDPACT, rpm * np.pi / 30, 80, 1)[0] for rpm in (0, 20, 30))
    assert f"{rest / (2 * np.pi):.3f}" == "0.932"
    assert [f"{100 * (f / rest - 1):.1f}" for f in (at_20, at_30)] == ["10.3", "21.7"]


class TestTorsion:
    def test_at_rest(self) -> None:
        exact = np.array([0.5, 1.5, 2.5]) * np.pi * np.sqrt(1e-2 / 0.03)
        np.testing.assert_allclose(frequencies(shaft(0.01, 0.02), 0.0, 80, 3), exact, rtol=1e-7)

    def test_the_tennis_racket_effect_of_a_flat_section(self) -> None:
        """All inertia about z: ω² = ω₀² + Ω² exactly (R. L. Bielawa, *Rotary Wing Structural Dynamics*, 2006, ch. 3)."""
        blade, omega = shaft(0.0, 0.03), 2.0
        rest = np.array([0.5, 1.5, 2.5]) * np.pi * np.sqrt(1e-2 / 0.03)
        np.testing.assert_allclose(frequencies(blade, omega, 80, 3), np.hypot(rest, omega), rtol=1e-7)

    def test_no_torsional_modes_without_inertia(self) -> None:
        """Torsional stiffness then has no effect, and no artificial inertia is added."""
        soft, stiff = (uniform_blade("b", 1.0, 0.1, EA=4900, GJ=GJ, EI_y=1, EI_z=1, mass=1) for GJ in (0.1, 1e3))
        np.testing.assert_allclose(frequencies(soft, 10.0, 20), frequencies(stiff, 10.0, 20), rtol=1e-10)


class TestElements:
    def test_of_a_uniform_blade_have_the_requested_number(self) -> None:
        assert [CODE.solve(PARK, 0.0, n, 1).elements for n in (5, 33, 80)] == [5, 33, 80]

    @pytest.mark.parametrize("stations", [3, 20, 50])
    def test_end_at_every_kink_and_grow_with_the_level(self, stations: int) -> None:
        s = np.linspace(0.0, 1.0, stations)
        kinked = section_stiffness(EA=1e4, GJ=1.0, EI_y=2.0 + np.cos(40 * s), EI_z=3.0)
        blade = Blade("kinked", s, kinked, np.repeat(section_mass(1.0), stations, axis=0), 0 * s)
        result = np.array([CODE.solve(blade, 1.0, n, 1).elements for n in CODE.levels])
        assert (result % (stations - 1) == 0).all()
        assert (result >= CODE.levels).all()
        assert (result[1:] >= 1.4 * result[:-1]).all()


class TestShapes:
    def test_are_evaluated_between_nodes(self) -> None:
        """The cantilever's shape at zero speed, with ten elements and twenty-one stations."""
        beta = root_scalar(lambda x: np.cos(x) * np.cosh(x) + 1, bracket=(4.0, 5.0)).root
        x = beta * STATIONS
        ratio = (np.cosh(beta) + np.cos(beta)) / (np.sinh(beta) + np.sin(beta))
        exact = np.cosh(x) - np.cos(x) - ratio * (np.sinh(x) - np.sin(x))
        blade = replace(PARK, stiffness=np.repeat(section_stiffness(2.8e7, 1e4, 2.8e4, 1.4e4), 2, axis=0))
        flap = CODE.solve(without_rotary_inertia(blade), 0.0, 10, 4).shapes[3]
        np.testing.assert_allclose(flap[:, 2] / flap[-1, 2], exact / exact[-1], atol=2e-4)
        assert np.abs(flap[:, [0, 1, 3]]).max() < 1e-9 * np.abs(flap[:, 2]).max()

    def test_are_in_blade_axes_with_the_right_phase(self) -> None:
        """The lowest edgewise mode moves along y, the lowest flapwise along z.

        Moving along +y it rotates faster and is pulled outwards, a quarter cycle ahead: u = i k v, k > 0 (Coriolis).
        """
        modes = CODE.solve(yoo_shin(0.0), 10.0, 20, 2)
        edgewise, flapwise = modes.shapes[:, -1] / np.abs(modes.shapes[:, -1]).max(axis=1, keepdims=True)
        assert abs(edgewise[1]) == pytest.approx(1)
        assert abs(flapwise[2]) == pytest.approx(1)
        assert abs(edgewise[0]) > 1e-3
        assert abs((edgewise[0] / edgewise[1]).real) < 1e-9
        assert (edgewise[0] / edgewise[1]).imag > 1e-3


def test_the_same_call_gives_the_same_answer_after_other_calls() -> None:
    """A Hermite element reused on another mesh would silently give the result of the first."""
    first = CODE.solve(PARK, 10.0, 7, 4)
    CODE.solve(tapered(), 1.0, 31, 4)
    second = CODE.solve(PARK, 10.0, 7, 4)
    np.testing.assert_array_equal(first.frequencies, second.frequencies)
    np.testing.assert_array_equal(first.shapes, second.shapes)


def test_prints_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    CODE.solve(tapered(), 1.0, 20, 4)
    assert capfd.readouterr().out == ""


@pytest.mark.parametrize(
    ("blade", "reason"),
    [
        (curved(), "sections couple"),
        (replace(PARK, curve=np.array([[0.0, 0, 0], [6 * np.cos(0.1), 0, 6 * np.sin(0.1)]])), "prebend"),
        (replace(PARK, precone=0.04), "precone = 0.04 rad"),
        (replace(PARK, tip_mass=np.diag([1.0, 1, 1.00005, 0, 0, 0])), "tip_mass"),
        (replace(PARK, mass=PARK.mass * np.diag([1.00005, 1, 1, 1, 1, 1])), "mass differs"),
        (replace(PARK, stiffness=np.repeat(section_stiffness(1, 1, 1, 1, GA_y=1e6), 2, axis=0)), "shear"),
        (replace(PARK, stiffness=np.repeat(section_stiffness(np.inf, 1, 1, 1), 2, axis=0)), "EA is infinite"),
    ],
)
def test_an_unsupported_blade_is_declined_with_a_reason(blade: Blade, reason: str) -> None:
    assert reason in (CODE.unsupported(blade) or "")
    with pytest.raises(CodeError, match=reason):
        CODE.solve(blade, 0.0, 20, 4)


@pytest.mark.parametrize("gamma", [112.0, 300.0])
def test_no_steady_state_at_high_speed(gamma: float) -> None:
    """The stretch of an elastic bar is unbounded at γ = α π/2 = 110."""
    with pytest.raises(CodeError, match=r"no (stable )?steady"):
        CODE.solve(yoo_shin(0.0), gamma, 20, 4)


def test_unstable_torsion_is_an_error() -> None:
    """A section normal to the plane of rotation is unstable if Ω² (I_y − I_z) exceeds its stiffness."""
    limit = 0.5 * np.pi * np.sqrt(1e-2 / (0.03 - 0.01))
    assert len(frequencies(shaft(0.03, 0.01), 0.99 * limit, 4, 20)) == 20
    with pytest.raises(CodeError, match="steady state"):
        CODE.solve(shaft(0.03, 0.01), 1.01 * limit, 4, 20)
