"""Exudyn's ANCF cable and kinematic tree against closed forms, exact tables, and each other."""

import subprocess
import sys
from dataclasses import replace
from importlib import resources

import numpy as np
import pytest

from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.modes import STATIONS
from southwell.references.protocol.interface import CodeError

from ...support.beams import curved
from ...support.exudyn_beams import (
    ANCF,
    FULL,
    INEXTENSIBLE,
    NO_ROTARY,
    PARK,
    RHO,
    STRETCHED,
    TREE,
    A,
    E,
    I,
    both,
    cantilever,
    extrapolated,
    families,
    needs_exudyn,
    roots,
    unit,
)


@pytest.fixture(scope="module")
def windpact() -> Blade:
    file = resources.files("southwell.cases.data") / "windpact-3.0.csv"
    s, twist, mass, flap, edge, GJ, EA = np.loadtxt(file.open(), delimiter=",", skiprows=3).T
    return Blade(
        name="windpact 3.0",
        stations=s * 47.025,
        stiffness=section_stiffness(EA, GJ, flap, edge),
        mass=section_mass(mass),
        twist=np.radians(twist),
        hub_radius=2.475,
    )


@needs_exudyn
class TestAnswers:
    @both
    def test_at_rest_converges_to_the_closed_form(self, code):
        exact = roots(3) ** 2 * np.sqrt(E * I / (RHO * A)) / 6.0**2
        value, order = extrapolated(code, lambda n: code.solve(NO_ROTARY, 0.0, n, 6).frequencies[::2])
        np.testing.assert_allclose(value, exact, rtol=2e-6 if code is TREE else 1e-7)
        assert (abs(order - code.order) < 0.05 * code.order).all()

    def test_rotating_tree_converges_to_the_exact_beam(self):
        value, order = extrapolated(TREE, lambda n: families(TREE.solve(PARK, 10.0, n, 6), 3))
        np.testing.assert_allclose(value, FULL, rtol=2e-6)
        assert (abs(order - 2) < 0.05).all()

    @both
    def test_rotation_without_rotary_inertia(self, code):
        value, order = extrapolated(code, lambda n: families(code.solve(NO_ROTARY, 10.0, n, 6), 3))
        np.testing.assert_allclose(value, STRETCHED, rtol=2e-6)
        assert (abs(order - code.order) < 0.05 * code.order).all()
        # stretch lowers frequencies, by at most the effect of the strain of 8e-5 and of Coriolis (1.2e-4)
        assert ((value < INEXTENSIBLE) & (value > INEXTENSIBLE * (1 - 2e-4))).all()

    @both
    @pytest.mark.parametrize("omega", [10.0, 30.0])
    def test_edgewise_differs_from_flapwise_by_spin_softening(self, code, omega):
        """For the inextensible beam ω_flap² − ω_edge² = Ω² exactly; in a fixed frame the difference would be zero."""
        edgewise, flapwise = families(code.solve(NO_ROTARY, omega, code.levels[0], 6), 3)
        np.testing.assert_allclose(flapwise**2 - edgewise**2, omega**2, rtol=0.03)

    @pytest.mark.slow
    @pytest.mark.parametrize(("hub", "gamma"), [(0.0, 2.0), (0.0, 10.0), (1.0, 10.0), (5.0, 2.0)])
    def test_both_agree_where_coriolis_and_stretch_matter(self, hub, gamma):
        """Two formulations, of fourth and second order, agree; strains up to 0.03."""
        cable, _ = extrapolated(ANCF, lambda n: ANCF.solve(unit(hub), gamma, n, 6).frequencies)
        tree, _ = extrapolated(TREE, lambda n: TREE.solve(unit(hub), gamma, n, 6).frequencies)
        np.testing.assert_allclose(tree, cable, rtol=3e-5)

    @pytest.mark.slow
    def test_both_agree_at_a_strain_of_a_quarter(self):
        """γ = 50: the root's boundary layer, 1/35 of the length, is resolved by 80 cubics or 192 hinges."""
        cable = ANCF.solve(unit(), 50.0, 80, 6).frequencies
        values = [TREE.solve(unit(), 50.0, n, 6).frequencies for n in (96, 192)]
        np.testing.assert_allclose((4 * values[1] - values[0]) / 3, cable, rtol=1e-4)

    @both
    def test_coriolis_coupling_lowers_the_frequency(self, code):
        """α = 70, γ = 10: 5.0490 uncoupled, 4.9700 coupled (Yoo and Shin 1998), lower still for the steady stretch."""
        value, _ = extrapolated(code, lambda n: families(code.solve(unit(), 10.0, n, 6), 1))
        assert 4.97 * (1 - 0.5 * 10**2 / 70**2) < value[0, 0] < 4.97

    @both
    def test_no_steady_state_above_the_speed_of_unbounded_stretch(self, code):
        """x'' + (Ω/α)² x = 0 along the blade (x the deformed radius, L = 1): unbounded at Ω = απ/2 = 109.96."""
        assert code.solve(unit(), 105.0, 20, 2).frequencies[0] > 0
        with pytest.raises(CodeError, match=r"no (stable )?steady state"):
            code.solve(unit(), 115.0, 20, 2)

    @pytest.mark.slow
    def test_windpact_at_zero_speed_and_rotating(self, windpact):
        """First flap of the public 3 MW blade: 0.932 Hz at zero speed, +10.3 % at 20 rpm (printed digits)."""
        value, intervals = {}, len(windpact.stations) - 1
        for rpm in (0.0, 20.0):
            value[rpm], order = extrapolated(
                TREE, lambda n, rpm=rpm: TREE.solve(windpact, rpm * np.pi / 30, n * intervals // 12, 5).frequencies
            )
            assert (abs(order - 2) < 0.25).all()
        first = value[0.0][0] / (2 * np.pi)
        assert abs(first - 0.932) < 0.0005
        assert abs(value[20.0][0] / value[0.0][0] - 1.103) < 0.0005


@needs_exudyn
class TestShapes:
    @both
    def test_shapes_at_zero_speed_are_those_of_the_cantilever(self, code):
        """Any combination of a degenerate pair has the same shape along the span."""
        modes = code.solve(NO_ROTARY, 0.0, 4 * code.levels[0], 4)
        for shape, beta in zip(modes.shapes, np.repeat(roots(2), 2), strict=True):
            across = shape[:, 1:3] / np.linalg.norm(shape[-1, 1:3])
            expected = np.outer(cantilever(STATIONS, beta) / cantilever(np.array(1.0), beta), across[-1])
            np.testing.assert_allclose(across, expected, atol=5e-4)
            assert abs(shape[:, [0, 3]]).max() < 1e-6 * abs(shape).max()

    @both
    def test_flapwise_moves_along_z_and_edgewise_along_y(self, code):
        modes = code.solve(NO_ROTARY, 10.0, code.levels[0], 4)
        for shape, direction, nodes in zip(modes.shapes, (1, 2, 1, 2), (0, 0, 1, 1), strict=True):
            moved = (shape[:, direction] / shape[-1, direction]).real
            assert np.count_nonzero(np.diff(np.sign(moved[1:]))) == nodes
            assert moved[0] == pytest.approx(0.0, abs=1e-12)
            assert abs(shape[:, 3 - direction]).max() < 1e-6 * abs(shape[:, direction]).max()

    @both
    def test_stretch_lags_edgewise_motion_by_a_quarter_period(self, code):
        """Coriolis: forward motion (+y) causes an outward force; u and v are 90° apart, with the same sign in both codes."""
        shape = code.solve(unit(), 10.0, code.levels[0], 1).shapes[0, -1]
        ratio = shape[0] / shape[1]
        assert abs(ratio.real) < 1e-6 * abs(ratio)
        assert ratio.imag > 1e-3


@needs_exudyn
class TestManners:
    @both
    def test_prints_nothing_even_on_failure_and_leaves_no_files(self, code, capfd, monkeypatch, tmp_path):
        monkeypatch.chdir(tmp_path)
        code.solve(unit(), 10.0, 4, 2)
        with pytest.raises(CodeError):
            code.solve(unit(), 115.0, 4, 2)
        assert capfd.readouterr().out == ""
        assert list(tmp_path.iterdir()) == []

    @both
    def test_the_same_call_gives_the_same_bits_in_any_order(self, code):
        first = code.solve(unit(), 10.0, 8, 3)
        code.solve(PARK, 30.0, 5, 2)
        second = code.solve(unit(), 10.0, 8, 3)
        assert (first.frequencies == second.frequencies).all()
        assert (first.shapes == second.shapes).all()


@both
def test_the_version_is_found_without_an_import(code):
    module = type(code).__module__
    text = f"import sys; from {module} import CODE; CODE.version(); sys.exit('exudyn' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", text], check=False).returncode == 0


REFUSED = {
    "two bending stiffnesses": (ANCF, unit(EI_z=2.0), "EI_y = 1, EI_z = 2 N m² at station 0: .* one bending stiffness"),
    "taper": (ANCF, replace(unit(), mass=np.array([np.eye(6), 2 * np.eye(6)])), "vary"),
    "twist": (ANCF, replace(unit(), twist=np.array([0.0, 0.1])), "twist"),
    "precone": (ANCF, replace(unit(), precone=0.1), "precone"),
    "tip mass": (ANCF, replace(unit(), tip_mass=np.eye(6)), "tip mass"),
    "shear": (ANCF, unit(GA_y=10.0), "shear"),
    "no stretch": (ANCF, unit(EA=np.inf), "finite EI and EA"),
    "kink": (TREE, replace(curved(), kinks=(20.0,)), "a kink at 20 m"),
    "no bending": (TREE, unit(EI_y=np.inf), "rigid in bending"),
}


@pytest.mark.parametrize(("code", "blade", "reason"), REFUSED.values(), ids=REFUSED.keys())
def test_an_unsupported_blade_is_declined_with_a_reason(code, blade, reason):
    result = code.unsupported(blade)
    assert result is not None
    with pytest.raises(CodeError, match=reason):
        code.solve(blade, 1.0, 4, 2)


@both
def test_a_supported_blade_is_accepted(code):
    assert code.unsupported(PARK) is None
    assert code.unsupported(unit(5.0)) is None


def test_each_level_is_at_least_1_4_times_the_one_before():
    for code in (ANCF, TREE):
        assert (np.array(code.levels[1:]) / code.levels[:-1] >= 1.4).all()
