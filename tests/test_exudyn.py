"""Exudyn's ANCF cable and kinematic tree against closed forms, exact tables, and each other."""

import subprocess
import sys
from dataclasses import replace
from importlib import resources

import numpy as np
import pytest
from scipy.optimize import brentq

from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.modes import STATIONS
from southwell.references import exudyn_tree
from southwell.references.exudyn_ancf import CODE as ANCF
from southwell.references.exudyn_tree import CODE as TREE
from southwell.references.interface import CodeError

needs_exudyn = pytest.mark.skipif(TREE.version() is None, reason=f"not installed: {TREE.hint}")
both = pytest.mark.parametrize("code", [ANCF, TREE], ids=lambda code: code.name)

E, RHO, A, I = 7e10, 3000.0, 4e-4, 2e-7
PARK = uniform_blade(
    "park", 6.0, 0.3, EA=E * A, GJ=E / 2.6 * 2 * I, EI_y=E * I, EI_z=E * I, mass=RHO * A, I_y=RHO * I, I_z=RHO * I
)
NO_ROTARY = replace(PARK, mass=np.repeat(section_mass(RHO * A), 2, axis=0))

# Chordwise and flapwise, modes 1 to 3, at 10 rad/s, rad/s. FULL: two independent spectral solutions of the extensible
# beam with rotary inertia. INEXTENSIBLE: the exact Euler-Bernoulli beam without stretch or rotary inertia.
FULL = np.array([[11.710953, 70.419355, 189.81994], [15.400199, 71.126584, 190.083784]])
INEXTENSIBLE = np.array([[11.71325, 70.44004, 189.93315], [15.40131, 71.14632, 190.19622]])
STRETCHED = np.array([[11.71131, 70.43535, 189.92222], [15.40088, 71.14306, 190.18649]])


def unit(hub: float = 0.0, **changes: float) -> Blade:
    """Length, mass per length and bending stiffness 1; slenderness 70 and no rotary inertia unless changed."""
    return uniform_blade(
        "unit", 1.0, hub, **{"EA": 4900.0, "GJ": 1.0, "EI_y": 1.0, "EI_z": 1.0, "mass": 1.0, **changes}
    )


def roots(count: int) -> np.ndarray:
    """βL of the cantilever: cosh βL cos βL = −1."""
    return np.array([brentq(lambda x: np.cos(x) + 1 / np.cosh(x), k * np.pi, (k + 1) * np.pi) for k in range(count)])


def cantilever(x: np.ndarray, beta: float) -> np.ndarray:
    """The cantilever's mode shape at fractions ``x``."""
    ratio = (np.cosh(beta) + np.cos(beta)) / (np.sinh(beta) + np.sin(beta))
    return np.cosh(beta * x) - np.cos(beta * x) - ratio * (np.sinh(beta * x) - np.sin(beta * x))


def families(modes, count: int) -> np.ndarray:
    """(2, count) chordwise and flapwise frequencies, told apart by which way the blade moves."""
    along_y, along_z = np.linalg.norm(modes.shapes[:, :, 1], axis=1), np.linalg.norm(modes.shapes[:, :, 2], axis=1)
    lateral = np.maximum(along_y, along_z) > np.linalg.norm(modes.shapes[:, :, 0], axis=1)
    return np.array(
        [
            modes.frequencies[lateral & (along_y > along_z)][:count],
            modes.frequencies[lateral & (along_z > along_y)][:count],
        ]
    )


def observed_order(values: list[np.ndarray]) -> np.ndarray:
    """Of three refinements, each twice the one before."""
    return np.log2((values[0] - values[1]) / (values[1] - values[2]))


def extrapolated(code, solve) -> tuple[np.ndarray, np.ndarray]:
    """Richardson's value from the two finest of the code's levels, and the observed order from all three."""
    values = [solve(elements) for elements in code.levels]
    return values[2] + (values[2] - values[1]) / (2.0**code.order - 1), observed_order(values)


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

    def test_tree_turning_converges_to_the_exact_beam(self):
        value, order = extrapolated(TREE, lambda n: families(TREE.solve(PARK, 10.0, n, 6), 3))
        np.testing.assert_allclose(value, FULL, rtol=2e-6)
        assert (abs(order - 2) < 0.05).all()

    @both
    def test_turning_without_rotary_inertia(self, code):
        value, order = extrapolated(code, lambda n: families(code.solve(NO_ROTARY, 10.0, n, 6), 3))
        np.testing.assert_allclose(value, STRETCHED, rtol=2e-6)
        assert (abs(order - code.order) < 0.05 * code.order).all()
        # stretch lowers frequencies, by no more than the strain of 8e-5 and Coriolis (1.2e-4) can
        assert ((value < INEXTENSIBLE) & (value > INEXTENSIBLE * (1 - 2e-4))).all()

    @both
    @pytest.mark.parametrize("omega", [10.0, 30.0])
    def test_chordwise_is_not_flapwise(self, code, omega):
        """The inextensible beam's ω_flap² − ω_chord² is Ω² exactly; a frozen frame would make it nothing."""
        chordwise, flapwise = families(code.solve(NO_ROTARY, omega, code.levels[0], 6), 3)
        np.testing.assert_allclose(flapwise**2 - chordwise**2, omega**2, rtol=0.03)

    @pytest.mark.parametrize(("hub", "gamma"), [(0.0, 2.0), (0.0, 10.0), (1.0, 10.0), (5.0, 2.0)])
    def test_both_agree_where_coriolis_and_stretch_matter(self, hub, gamma):
        """Two formulations, fourth order and second, meet; strains up to 0.03."""
        cable, _ = extrapolated(ANCF, lambda n: ANCF.solve(unit(hub), gamma, n, 6).frequencies)
        tree, _ = extrapolated(TREE, lambda n: TREE.solve(unit(hub), gamma, n, 6).frequencies)
        np.testing.assert_allclose(tree, cable, rtol=3e-5)

    def test_both_agree_at_a_strain_of_a_quarter(self):
        """γ = 50: the root's boundary layer, 1/35 of the length, is resolved by 80 cubics or 192 hinges."""
        cable = ANCF.solve(unit(), 50.0, 80, 6).frequencies
        values = [TREE.solve(unit(), 50.0, n, 6).frequencies for n in (96, 192)]
        np.testing.assert_allclose((4 * values[1] - values[0]) / 3, cable, rtol=1e-4)

    @both
    def test_coriolis_coupling_is_felt(self, code):
        """α = 70, γ = 10: 5.0490 uncoupled, 4.9700 coupled (Yoo and Shin 1998), lower still for the steady stretch."""
        value, _ = extrapolated(code, lambda n: families(code.solve(unit(), 10.0, n, 6), 1))
        assert 4.97 * (1 - 0.5 * 10**2 / 70**2) < value[0, 0] < 4.97

    @both
    def test_beyond_the_speed_of_endless_stretch_there_is_no_steady_state(self, code):
        """x'' + (Ω/α)² x = 0 along the blade (x its deformed radius, L = 1): endless at Ω = απ/2 = 109.96."""
        assert code.solve(unit(), 105.0, 20, 2).frequencies[0] > 0
        with pytest.raises(CodeError, match=r"no (stable )?steady state"):
            code.solve(unit(), 115.0, 20, 2)

    def test_windpact_at_rest_and_turning(self, windpact):
        """First flap of the public 3 MW blade: 0.932 Hz at rest, +10.3 % at 20 rpm (printed digits)."""
        value = {}
        for rpm in (0.0, 20.0):
            value[rpm], order = extrapolated(
                TREE, lambda n, rpm=rpm: TREE.solve(windpact, rpm * np.pi / 30, n, 5).frequencies
            )
            assert (abs(order - 2) < 0.25).all()  # stations fall inside elements
        first = value[0.0][0] / (2 * np.pi)
        assert abs(first - 0.932) < 0.0005
        assert abs(value[20.0][0] / value[0.0][0] - 1.103) < 0.0005


@needs_exudyn
class TestTree:
    """What only the tree takes: each property by a case whose answer is known."""

    @pytest.mark.parametrize("omega", [1.0, 3.4])
    def test_precone_of_a_right_angle_makes_a_whirling_shaft(self, omega):
        """Along the rotor's axis, seen in turning axes, every frequency at rest splits into ω ± Ω, discretised or not."""
        rest = TREE.solve(unit(EA=1e6), 0.0, 12, 8).frequencies[::2]
        shaft = TREE.solve(replace(unit(EA=1e6), precone=np.pi / 2), omega, 12, 8).frequencies
        np.testing.assert_allclose(shaft, np.sort([rest - omega, rest + omega], axis=None)[:8], rtol=1e-7)

    @pytest.mark.parametrize(
        ("omega", "flapwise"), [(0.0, (1.557, 16.25)), (6.0, (6.509, 29.29)), (12.0, (12.48, 50.86))]
    )
    def test_tip_mass(self, omega, flapwise):
        """Tip mass equal to the beam's mass: flapwise frequencies of G. Bir's table, to the printed digit."""
        blade = replace(unit(EA=1e7), tip_mass=np.diag([1.0, 1, 1, 0, 0, 0]))
        value, _ = extrapolated(TREE, lambda n: families(TREE.solve(blade, omega, n, 4), 2))
        last_digit = [0.001, 0.01] if flapwise[0] < 10 else [0.01, 0.01]
        assert (abs(value[1] - flapwise) < 0.5 * np.array(last_digit)).all()

    @pytest.mark.parametrize("omega", [0.0, 8.0])
    def test_torsion_with_rotary_inertia(self, omega):
        """ω² = ((2k−1)π/2)² GJ/I_x + Ω² (I_z − I_y)/I_x: rotor blades turn flat (the propeller moment)."""
        I_y, I_z = 1e-4, 9e-4
        blade = unit(EI_y=1e4, EI_z=2e4, EA=1e8, I_y=I_y, I_z=I_z)
        value, order = extrapolated(TREE, lambda n: TREE.solve(blade, omega, n, 2).frequencies)
        exact = (np.array([1, 3]) * np.pi / 2) ** 2 / (I_y + I_z) + omega**2 * (I_z - I_y) / (I_y + I_z)
        np.testing.assert_allclose(value, np.sqrt(exact), rtol=1e-5)
        assert (abs(order - 2) < 0.05).all()
        shape = TREE.solve(blade, omega, 96, 1).shapes[0, :, 3].real
        np.testing.assert_allclose(shape / shape[-1], np.sin(np.pi / 2 * STATIONS), atol=2e-3)

    def test_without_rotary_inertia_torsion_has_no_modes(self):
        modes = TREE.solve(unit(), 5.0, 6, 40)
        assert len(modes.frequencies) == 3 * 6  # three displacements of each segment's end
        assert abs(modes.shapes[:, :, 3]).max() < 1e-9

    def test_shear(self):
        """A Timoshenko beam so soft in shear that it is a shear beam: ω = (2k−1)π/2 √(GA/ρA)."""
        blade = unit(EI_y=1e5, EI_z=1e5, EA=1e6, GA_y=1.0, GA_z=4.0)
        value, _ = extrapolated(TREE, lambda n: families(TREE.solve(blade, 0.0, n, 6), 2))
        np.testing.assert_allclose(value, np.outer([1, 2], np.array([1, 3]) * np.pi / 2), rtol=1e-4)

    @pytest.mark.parametrize("turned", ["twist", "pitch"])
    def test_twist_and_pitch_turn_from_y_towards_z(self, turned):
        blade = unit(EI_y=1.0, EI_z=25.0)
        angle = 0.3
        blade = replace(blade, **{turned: np.full(2, angle) if turned == "twist" else angle})
        soft = TREE.solve(blade, 0.0, 12, 1).shapes[0, -1].real
        np.testing.assert_allclose(soft[1] / soft[2], -np.tan(angle), rtol=1e-6)

    def test_steady_stretch_is_exact_in_the_limit(self):
        """γ = 50: tip at tan(λ)/λ with λ = γ/α, from x'' + λ² x = 0."""
        rate = 50 / 70
        exact, errors = np.tan(rate) / rate - 1, []
        for elements in (12, 24, 48):
            tree = exudyn_tree.plant(unit(), elements)
            *_, q = exudyn_tree.linearize(tree, 50.0)
            errors.append(q[tree.strain == 0].sum() / exact - 1)
        assert abs(errors[2]) < 2e-4
        assert abs(np.log2(errors[1] / errors[2]) - 2) < 0.05

    def test_mass_matrix_is_what_the_motion_says(self):
        """Exudyn's M against Σ Jᵀ (m, I) J, with our J (the one mode shapes are read with), away from rest too."""
        blade = replace(unit(0.2, I_y=0.01, I_z=0.03), twist=np.array([0.2, 0.9]), pitch=0.1)
        tree = exudyn_tree.plant(blade, 5)
        M, _, _, q = exudyn_tree.linearize(tree, 20.0)
        assert abs(q).max() > 0.01
        J = exudyn_tree.jacobian(tree, q, tree.centre[:, 0])
        angle = (
            0.3 + 0.7 * 0.1 * np.arange(1, 10, 2) + np.cumsum(q[tree.strain == 3])
        )  # untwisted by the propeller moment
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[np.eye(3)[0], [0, ci, -si], [0, si, ci]] for ci, si in zip(c, s, strict=True)])
        inertia = turn @ tree.inertia @ turn.transpose(0, 2, 1)
        expected = np.einsum("e,eik,eil->kl", tree.mass, J[:, :3], J[:, :3])
        expected += np.einsum("eik,eij,ejl->kl", J[:, 3:], inertia, J[:, 3:])
        np.testing.assert_allclose(M, expected, atol=1e-12 * abs(M).max())

    def test_segments_have_the_mass_and_inertia_of_the_blade(self):
        """Beyond the first hinge, about the root: ∫m, ∫ms, ∫ms² + ∫I of a tapered blade, in closed form."""
        mass = section_mass(np.array([3.0, 1.0]), np.array([0.2, 0.1]), np.array([0.5, 0.3]))
        blade = replace(unit(), mass=mass, tip_mass=np.diag([2.0, 2, 2, 0.3, 0.1, 0.2]))
        tree = exudyn_tree.plant(blade, 4)
        start, hinges = 0.125, np.array([0.125, 0.375, 0.625, 0.875])
        at = hinges + tree.centre[:, 0]
        m = np.polynomial.Polynomial([3.0, -2.0])
        s = np.polynomial.Polynomial([0.0, 1.0])

        def span(p):
            return p.integ()(1.0) - p.integ()(start)

        assert tree.mass.sum() == pytest.approx(span(m) + 2, rel=1e-12)
        assert tree.mass @ at == pytest.approx(span(m * s) + 2, rel=1e-12)
        I_x, I_y = np.polynomial.Polynomial([0.7, -0.3]), np.polynomial.Polynomial([0.2, -0.1])
        assert tree.inertia[:, 0, 0].sum() == pytest.approx(span(I_x) + 0.3, rel=1e-12)
        assert tree.inertia[:, 1, 1].sum() + tree.mass @ at**2 == pytest.approx(span(m * s**2 + I_y) + 2.1, rel=1e-12)


@needs_exudyn
class TestShapes:
    @both
    def test_at_rest_they_are_the_cantilevers(self, code):
        """In the plane of a degenerate pair, whatever combination comes out has the one shape along the span."""
        modes = code.solve(NO_ROTARY, 0.0, code.levels[-1], 4)
        for shape, beta in zip(modes.shapes, np.repeat(roots(2), 2), strict=True):
            across = shape[:, 1:3] / np.linalg.norm(shape[-1, 1:3])
            expected = np.outer(cantilever(STATIONS, beta) / cantilever(np.array(1.0), beta), across[-1])
            np.testing.assert_allclose(across, expected, atol=5e-4)
            assert abs(shape[:, [0, 3]]).max() < 1e-6 * abs(shape).max()

    @both
    def test_flapwise_moves_along_z_and_chordwise_along_y(self, code):
        modes = code.solve(NO_ROTARY, 10.0, code.levels[0], 4)
        for shape, direction, nodes in zip(modes.shapes, (1, 2, 1, 2), (0, 0, 1, 1), strict=True):
            moved = (shape[:, direction] / shape[-1, direction]).real
            assert np.count_nonzero(np.diff(np.sign(moved[1:]))) == nodes
            assert moved[0] == pytest.approx(0.0, abs=1e-12)
            assert abs(shape[:, 3 - direction]).max() < 1e-6 * abs(shape[:, direction]).max()

    @both
    def test_stretch_lags_chordwise_motion_by_a_quarter(self, code):
        """Coriolis: moving forwards (+y) is flung outwards; u and v are 90° apart, the same way in both codes."""
        shape = code.solve(unit(), 10.0, code.levels[0], 1).shapes[0, -1]
        ratio = shape[0] / shape[1]
        assert abs(ratio.real) < 1e-6 * abs(ratio)
        assert ratio.imag > 1e-3


@needs_exudyn
class TestManners:
    @both
    def test_silent_even_in_failure_and_leaves_no_files(self, code, capfd, monkeypatch, tmp_path):
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
        again = code.solve(unit(), 10.0, 8, 3)
        assert (first.frequencies == again.frequencies).all()
        assert (first.shapes == again.shapes).all()


@both
def test_found_without_being_imported(code):
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
    "coupled": (TREE, replace(unit(), mass=np.eye(6) + 0.1 * np.eye(6, k=4) * np.ones((2, 1, 1))), "couple"),
    "prebend": (TREE, replace(unit(), curve=np.array([[0.0, 0, 0], [1, 0, 0.1]])), "prebend"),
    "no bending": (TREE, unit(EI_y=np.inf), "rigid in bending"),
}


@pytest.mark.parametrize(("code", "blade", "reason"), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_solved_is_refused_with_the_reason(code, blade, reason):
    found = code.unsupported(blade)
    assert found is not None
    with pytest.raises(CodeError, match=reason):
        code.solve(blade, 1.0, 4, 2)


@both
def test_what_can_be_solved_is_not_refused(code):
    assert code.unsupported(PARK) is None
    assert code.unsupported(unit(5.0)) is None


def test_each_level_is_at_least_1_4_times_the_one_before():
    for code in (ANCF, TREE):
        assert (np.array(code.levels[1:]) / code.levels[:-1] >= 1.4).all()
