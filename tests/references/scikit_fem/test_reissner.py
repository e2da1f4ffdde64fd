"""scikit-fem's geometrically exact beam: its weak forms against differences, its order, closed forms, and core."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from southwell.cases.conformance.blades import PROPERTIES
from southwell.core import solve
from southwell.core.blade import Blade, section_stiffness, uniform_blade
from southwell.core.element import sections
from southwell.references.protocol.interface import CodeError
from southwell.references.scikit_fem import reissner
from southwell.references.scikit_fem import reissner_forms as forms
from southwell.references.scikit_fem.reissner import CODE
from southwell.references.theories.reference_line import line, moments
from southwell.tests.support.beams import EXACT_EDGEWISE, EXACT_FLAPWISE, PARK, curved, tapered, yoo_shin

Array = NDArray[np.float64]

needs_scikit_fem = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")
RNG = np.random.default_rng(1)
EXACT = np.sort(np.concatenate([EXACT_EDGEWISE, EXACT_FLAPWISE]))
STEP = 1e-4


def frequencies(blade: Blade, omega: float, elements: int, count: int = 6) -> Array:
    return CODE.solve(blade, omega, elements, count).frequencies


def core(blade: Blade, omega: float, count: int = 6) -> Array:
    coarse, fine = (solve.mesh_modes(blade, omega, n, count).frequencies for n in (60, 120))
    np.testing.assert_allclose(coarse, fine, rtol=1e-5)
    return fine


def body() -> Array:
    """Inertia (6, 6) of a few particles, from their positions."""
    out = np.zeros((6, 6))
    for m, y in zip([1.0, 2.0, 0.5, 1.5], RNG.normal(size=(4, 3)), strict=True):
        velocity = np.eye(3, 6)
        velocity[:, 3:] = np.cross(np.eye(3), y).T
        out = out + m * velocity.T @ velocity
    return out


class TestForms:
    """Against differences of the exact finite motion."""

    slope, axes, force = RNG.normal(size=3), Rotation.from_rotvec(RNG.normal(size=3)).as_matrix(), RNG.normal(size=6)
    position = RNG.normal(size=3)

    def strain(self, z: Array) -> Array:
        """Γ, and the curvature from differences of the rotation along the arc."""
        _, phi, w_s, phi_s = z.reshape(4, 3)
        turn, h = Rotation.from_rotvec(phi).as_matrix(), 1e-4
        ahead, behind = (Rotation.from_rotvec(phi + e * phi_s).as_matrix() for e in (h, -h))
        spin = turn.T @ (ahead - behind) / (2 * h)
        kappa = self.axes.T @ [spin[2, 1], spin[0, 2], spin[1, 0]]
        return np.concatenate([(turn @ self.axes).T @ (self.slope + w_s), kappa])

    def test_strain_rate(self) -> None:
        result = np.array([(self.strain(STEP * e) - self.strain(-STEP * e)) / (2 * STEP) for e in np.eye(12)]).T
        np.testing.assert_allclose(result, forms.strain_rate(self.slope, self.axes), atol=1e-7)

    def test_geometric_stiffness(self) -> None:
        result = second_differences(lambda z: float(self.force @ self.strain(z)), 12)
        np.testing.assert_allclose(result, forms.geometric(self.slope, self.axes, self.force), atol=1e-5)

    def test_centrifugal_force_and_its_change(self) -> None:
        """Minus the gradient and the curvature of −½ ∫ (x² + y²) dm over the particles."""
        mass = body()
        about = np.block([[self.axes, np.zeros((3, 1))], [np.zeros((1, 3)), np.eye(1)]])
        spatial = about @ moments(mass) @ about.T

        def potential(q: Array) -> float:
            w, phi = q.reshape(2, 3)
            turn = np.eye(4)
            turn[:3, :3], turn[:3, 3] = Rotation.from_rotvec(phi).as_matrix(), self.position + w
            at = turn @ spatial @ turn.T
            return -0.5 * (at[0, 0] + at[1, 1])

        force = [-(potential(STEP * e) - potential(-STEP * e)) / (2 * STEP) for e in np.eye(6)]
        np.testing.assert_allclose(force, forms.centrifugal_force(self.position, spatial), atol=1e-6)
        np.testing.assert_allclose(
            second_differences(potential, 6), forms.centrifugal(self.position, spatial), rtol=1e-5, atol=1e-5
        )

    def test_inertia_reproduces_the_matrix_of_the_body(self) -> None:
        mass = body()
        np.testing.assert_allclose(forms.inertia(moments(mass)), mass, atol=1e-12)

    def test_coriolis_force_of_a_point_mass(self) -> None:
        """2 m Ω × v: motion along x gives a force along y."""
        result = forms.gyroscopic(np.diag([0.0, 0.0, 0.0, 3.0]))
        np.testing.assert_array_equal(result[:3, :3], 2 * 3.0 * np.array([[0, -1, 0], [1, 0, 0], [0, 0, 0]]))
        general = forms.gyroscopic(moments(body()))
        np.testing.assert_allclose(general, -general.T, atol=1e-14)

    def test_curvature_of_a_finite_rotation(self) -> None:
        for size in (1e-4, 5e-3, 0.9):
            phi, rate, h = size * RNG.normal(size=3), RNG.normal(size=3), 1e-6
            ahead, behind = (Rotation.from_rotvec(phi + e * rate).as_matrix() for e in (h, -h))
            spin = Rotation.from_rotvec(phi).as_matrix().T @ (ahead - behind) / (2 * h)
            np.testing.assert_allclose(forms.bending_rate(phi, rate), [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-8)
            np.testing.assert_allclose(forms.exponential(phi), Rotation.from_rotvec(phi).as_matrix(), atol=1e-14)


def second_differences(f: Callable[[Array], float], n: int) -> Array:
    """(n, n) of a function of (n,) at zero."""
    h = 1e-3 * np.eye(n)
    signs = [(a, b) for a in (1, -1) for b in (1, -1)]
    results = [[sum(a * b * f(a * row + b * column) for a, b in signs) for column in h] for row in h]
    return np.array(results) / 4e-6


def test_the_line_agrees_with_core() -> None:
    blade = curved()
    s = np.array([[1.0, 3.0], [12.0, 19.0], [21.0, 39.0]])
    result, expected = line(blade, s), sections.frames(blade, s.ravel()).reshape(3, 2, 4, 4)
    np.testing.assert_allclose(result.position, expected[..., :3, 3], atol=1e-12)
    np.testing.assert_allclose(result.axes, expected[..., :3, :3], atol=1e-14)


@needs_scikit_fem
class TestFrequencies:
    def test_the_beam_with_all_effects_converges_to_exact_values(self) -> None:
        np.testing.assert_allclose(frequencies(PARK, 10.0, 96), EXACT, rtol=1e-7)

    @pytest.mark.parametrize(
        ("blade", "omega", "levels", "least"),
        [
            (PARK, 10.0, (10, 20, 40), 3.8),
            (yoo_shin(0.1), 20.0, (10, 20, 40), 3.6),
            (replace(tapered(), pitch=0.3), 3.0, (20, 40, 80), 3.5),
            (curved(), 3.0, (20, 40, 80), 3.5),
        ],
        ids=["cantilever", "slender 70", "tapered and twisted", "coupled, curved, sheared, precone"],
    )
    def test_fourth_order(self, blade: Blade, omega: float, levels: tuple[int, ...], least: float) -> None:
        """For each mode, unless it is at rounding."""
        f = [frequencies(blade, omega, n, 5) for n in levels]
        first, second = np.abs(f[0] / f[2] - f[1] / f[2]), np.abs(f[1] / f[2] - 1)
        assert CODE.order == 4
        assert ((np.log2(first / second) > least) | (second < 2e-7)).all()

    @pytest.mark.parametrize(("pitch", "omega"), [(0.0, 0.0), (0.6, 3.0)])
    def test_a_blade_with_all_properties_agrees_with_core(self, pitch: float, omega: float) -> None:
        """Coupled, curved, sheared, twisted, tapered, offset, coned; a body off the tip's axis; both torsion and bending."""
        lump = 300.0 * body() / 5.0
        blade = replace(curved(), tip_mass=lump, pitch=pitch, precone=0.2)
        np.testing.assert_allclose(frequencies(blade, omega, 40, 8), core(blade, omega, 8), rtol=1e-5)

    @pytest.mark.parametrize("problem", PROPERTIES, ids=lambda p: p.name)
    def test_each_property_agrees_with_core(self, problem) -> None:
        result = frequencies(problem.blade, problem.omega, 48, 5)
        np.testing.assert_allclose(result, core(problem.blade, problem.omega, 5), rtol=1e-5)

    def test_a_kinked_blade_agrees_with_core(self) -> None:
        s = np.array([0.0, 3.0, 6.0])
        curve = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0 + 3.0 * np.cos(0.4), -3.0 * np.sin(0.4), 0.0]])
        same = {name: np.repeat(getattr(PARK, name)[:1], 3, axis=0) for name in ("stiffness", "mass", "twist")}
        blade = replace(PARK, stations=s, curve=curve, kinks=(3.0,), **same)
        np.testing.assert_allclose(frequencies(blade, 10.0, 64), core(blade, 10.0), rtol=1e-6)

    @pytest.mark.parametrize("precone", [-0.1, 0.3])
    def test_a_coned_blade_on_a_flap_hinge_rotates_to_its_equilibrium(self, precone: float) -> None:
        blade = replace(PARK, root=np.array([np.inf] * 4 + [0.0, np.inf]), precone=precone)
        np.testing.assert_allclose(frequencies(blade, 10.0, 64, 4), core(blade, 10.0, 4), rtol=1e-6)

    @pytest.mark.parametrize("omega", [0.0, 20.0])
    def test_factors_of_m_and_c_that_are_applied_give_what_formed_ones_do(
        self, omega: float, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """On a root with motions of its own, which strains do not determine."""
        blade = replace(PARK, root=np.array([3e4, 2e4, 1e4, 300.0, 40.0, 50.0]))
        formed = CODE.solve(blade, omega, 24, 6)
        monkeypatch.setattr(reissner, "FORMED", 0)
        applied = CODE.solve(blade, omega, 24, 6)
        np.testing.assert_allclose(applied.frequencies, formed.frequencies, rtol=1e-10)

    def test_a_sliding_root_on_a_spring(self) -> None:
        blade = replace(PARK, root=np.array([3e4, 2e4, 1e4, 300.0, np.inf, np.inf]), pitch=0.4)
        np.testing.assert_allclose(frequencies(blade, 10.0, 64), core(blade, 10.0), rtol=1e-6)

    @pytest.mark.parametrize("omega", [2.0, 6.0])
    def test_rigid_strains_are_exact_constraints(self, omega: float) -> None:
        """Inextensible, rigid in shear and torsion, equal planes: edgewise² = flapwise² − Ω², exactly."""
        stiff = {"EA": np.inf, "GJ": np.inf, "EI_y": 48.0, "EI_z": 48.0}
        blade = uniform_blade("rigid but in bending", 2.0, 0.5, mass=3.0, **stiff)
        f = frequencies(blade, omega, 24)
        np.testing.assert_allclose(f[::2] ** 2, f[1::2] ** 2 - omega**2, rtol=1e-9)
        np.testing.assert_allclose(frequencies(blade, 0.0, 48, 1), 3.5160152685, rtol=1e-7)

    def test_axial_and_torsional_stiffness_missing_in_the_input_are_rigid(self) -> None:
        """As for ElastoDyn's blades: no artificial value for what the input does not give."""
        stiffness = tapered().stiffness.copy()
        stiffness[:, [0, 3], [0, 3]] = np.inf
        blade = replace(tapered(), stiffness=stiffness, precone=0.05)
        coarse, fine = (frequencies(blade, 3.0, n, 5) for n in (20, 40))
        np.testing.assert_allclose(fine + (fine - coarse) / 15, core(blade, 3.0, 5), rtol=2e-6)

    def test_no_locking(self) -> None:
        """Eight elements at any slenderness: shear and stretch a million times stiffer than bending do not affect the
        result."""
        soft, hard = (
            replace(PARK, stiffness=np.repeat(section_stiffness(k, 1e4, 1.4e4, 1.4e4, k, k), 2, axis=0))
            for k in (1.4e9, 1.4e13)
        )
        np.testing.assert_allclose(frequencies(soft, 5.0, 8), frequencies(hard, 5.0, 8), rtol=1e-4)


@needs_scikit_fem
class TestRefusals:
    def test_a_mass_that_depends_on_the_direction_is_declined(self) -> None:
        blade = replace(PARK, mass=PARK.mass * np.diag([1.00005, 1, 1, 1, 1, 1]))
        assert "not the matrix of a rigid body" in (CODE.unsupported(blade) or "")
        with pytest.raises(CodeError, match="mass: not the matrix of a rigid body"):
            CODE.solve(blade, 0.0, 8, 2)

    def test_a_steady_rotation_about_two_hinges(self) -> None:
        """Precone and an offset mass rotate both hinges, and their order matters."""
        blade = replace(PARK, root=np.array([np.inf] * 4 + [50.0, 50.0]), precone=0.2)
        mass = blade.mass.copy()
        mass[:, 0, 5] = mass[:, 5, 0] = -0.1 * mass[:, 0, 0]
        mass[:, 2, 3] = mass[:, 3, 2] = 0.1 * mass[:, 0, 0]
        mass[:, 3, 3] += 0.01 * mass[:, 0, 0]
        mass[:, 5, 5] += 0.01 * mass[:, 0, 0]
        with pytest.raises(CodeError, match="about two axes"):
            CODE.solve(replace(blade, mass=mass), 5.0, 8, 2)

    def test_no_steady_state_at_high_speed(self) -> None:
        with pytest.raises(CodeError, match=r"no (stable )?steady"):
            CODE.solve(yoo_shin(0.0), 300.0, 16, 4)

    def test_too_many_elements_are_an_error(self) -> None:
        with pytest.raises(CodeError, match="elements: 1000: scikit-fem-reissner allows 300"):
            CODE.solve(PARK, 0.0, 1000, 1)
