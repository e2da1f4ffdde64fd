"""Properties that only Exudyn's kinematic tree supports, each by a case with a known answer."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.judge.uncertainty import observed_order
from southwell.core import solve
from southwell.core.blade import TORSION, Blade, section_mass, section_stiffness
from southwell.core.modes import STATIONS
from southwell.references.exudyn import hinged_segments, system
from southwell.references.exudyn import tree as exudyn_tree
from southwell.references.exudyn.tree import CODE as TREE
from southwell.references.scikit_fem.reissner import CODE as REISSNER

from ...support.beams import curved, tapered
from ...support.exudyn_beams import extrapolated, families, needs_exudyn, unit

pytestmark = needs_exudyn


@pytest.mark.parametrize("omega", [1.0, 3.4])
def test_precone_of_a_right_angle_makes_a_whirling_shaft(omega):
    """Along the rotor axis, in rotating axes, every frequency ω at zero speed splits into ω ± Ω, for any discretisation."""
    rest = TREE.solve(unit(EA=1e6), 0.0, 12, 8).frequencies[::2]
    shaft = TREE.solve(replace(unit(EA=1e6), precone=np.pi / 2), omega, 12, 8).frequencies
    np.testing.assert_allclose(shaft, np.sort([rest - omega, rest + omega], axis=None)[:8], rtol=1e-7)


@pytest.mark.parametrize(("omega", "flapwise"), [(0.0, (1.557, 16.25)), (6.0, (6.509, 29.29)), (12.0, (12.48, 50.86))])
def test_tip_mass(omega, flapwise):
    """Tip mass equal to the beam's mass: flapwise frequencies of G. Bir's table, to the printed digit."""
    blade = replace(unit(EI_z=4.0, EA=1e7), tip_mass=np.diag([1.0, 1, 1, 0, 0, 0]))
    value, _ = extrapolated(TREE, lambda n: families(TREE.solve(blade, omega, n, 4), 2))
    last_digit = [0.001, 0.01] if flapwise[0] < 10 else [0.01, 0.01]
    assert (abs(value[1] - flapwise) < 0.5 * np.array(last_digit)).all()


@pytest.mark.slow
@pytest.mark.parametrize("omega", [0.0, 8.0])
def test_torsion_with_rotary_inertia(omega):
    """ω² = ((2k−1)π/2)² GJ/I_x + Ω² (I_z − I_y)/I_x: rotor blades rotate towards flat (the propeller moment)."""
    I_y, I_z = 1e-4, 9e-4
    blade = unit(EI_y=1e4, EI_z=2e4, EA=1e8, I_y=I_y, I_z=I_z)
    value, order = extrapolated(TREE, lambda n: TREE.solve(blade, omega, n, 2).frequencies)
    exact = (np.array([1, 3]) * np.pi / 2) ** 2 / (I_y + I_z) + omega**2 * (I_z - I_y) / (I_y + I_z)
    np.testing.assert_allclose(value, np.sqrt(exact), rtol=1e-5)
    assert (abs(order - 2) < 0.05).all()
    shape = TREE.solve(blade, omega, 96, 1).shapes[0, :, 3].real
    np.testing.assert_allclose(shape / shape[-1], np.sin(np.pi / 2 * STATIONS), atol=2e-3)


@pytest.mark.parametrize("omega", [0.0, 5.0])
def test_no_torsional_modes_without_rotary_inertia(omega, monkeypatch):
    """With equal elements. Where they shrink, rounding in Exudyn's differences turns the shapes by 6e-8."""
    monkeypatch.setattr(hinged_segments, "_ends", lambda blade, elements, _: np.linspace(0, blade.length, elements + 1))
    modes = TREE.solve(unit(), omega, 6, 40)
    assert len(modes.frequencies) == 3 * 6  # three displacements of each segment's end
    assert abs(modes.shapes[:, :, 3]).max() < 1e-9


def test_torsion_of_a_straight_blade_couples_by_rounding_only():
    tree = hinged_segments.hinge_segments(unit(), 6, 5.0)
    turns = tree.strain == TORSION
    for matrix in exudyn_tree.linearize(tree, 5.0)[:3]:
        for coupling in (matrix[turns][:, ~turns], matrix[~turns][:, turns]):
            assert abs(coupling).max() < 1e-12 * abs(matrix).max()


def test_shear():
    """A Timoshenko beam with negligible shear stiffness is a shear beam: ω = (2k−1)π/2 √(GA/ρA)."""
    blade = unit(EI_y=1e5, EI_z=1e5, EA=1e6, GA_y=1.0, GA_z=4.0)
    value, _ = extrapolated(TREE, lambda n: families(TREE.solve(blade, 0.0, n, 6), 2))
    np.testing.assert_allclose(value, np.outer([1, 2], np.array([1, 3]) * np.pi / 2), rtol=1e-4)


@pytest.mark.parametrize("turned", ["twist", "pitch"])
def test_twist_and_pitch_rotate_from_y_towards_z(turned):
    blade = unit(EI_y=1.0, EI_z=25.0)
    angle = 0.3
    blade = replace(blade, **{turned: np.full(2, angle) if turned == "twist" else angle})
    soft = TREE.solve(blade, 0.0, 12, 1).shapes[0, -1].real
    np.testing.assert_allclose(soft[1] / soft[2], -np.tan(angle), rtol=1e-6)


def test_shapes_of_a_coned_blade_are_in_the_hubs_axes():
    """Flapping is perpendicular to the blade's axis, which precone lifts towards +z: x/z = −tan of the precone."""
    shape = TREE.solve(replace(unit(EI_y=1.0, EI_z=25.0), precone=0.3), 0.0, 6, 1).shapes[0, -1].real
    np.testing.assert_allclose(shape[0] / shape[2], -np.tan(0.3), rtol=1e-6)


def test_elements_are_shorter_at_the_root_only_where_a_layer_is_thin():
    """Tension T = m Ω² (R L + L²/2): √(EI/T) = 1/50, so the element at ten of them from the root is twice as long as there."""
    blade, omega = unit(), 50 * np.sqrt(2)
    ends = hinged_segments.hinge_segments(blade, 300, omega).ends
    length = np.interp(0.2, (ends[1:] + ends[:-1]) / 2, np.diff(ends))
    assert length / np.diff(ends)[0] == pytest.approx(2.0, rel=0.01)
    even = [replace(blade, precone=np.pi / 2), replace(blade, root=np.array([np.inf] * 4 + [0.0, np.inf]))]
    for ends in [
        hinged_segments.hinge_segments(blade, 8).ends,
        *(hinged_segments.hinge_segments(b, 8, omega).ends for b in even),
    ]:
        np.testing.assert_allclose(ends, np.linspace(0, 1, 9), rtol=1e-6)


@pytest.mark.parametrize(("code", "order"), [(TREE, 2), (REISSNER, 4)], ids=["tree", "Reissner"])
def test_elements_at_steps_do_not_count_as_refinement(code, order):
    """They are as long at every refinement: with them, the observed orders were 2.3 and 4.5."""
    uniform = unit()
    stations = np.array([0.0, 0.3, 0.3 + 1e-5, 0.6, 0.6 + 1e-5, 1.0]) * uniform.length
    factor = np.array([1.0, 1.0, 0.5, 0.5, 0.25, 0.25])[:, None, None]
    stepped = Blade(
        "stepped",
        stations,
        np.where(np.isinf(uniform.stiffness[:1]), np.inf, uniform.stiffness[:1] * factor),
        uniform.mass[:1] * factor,
        np.zeros(6),
        hub_radius=uniform.hub_radius,
    )
    modes = [code.solve(stepped, 0.0, n, 4) for n in (12, 24, 48)]
    assert [m.elements for m in modes] == [12, 24, 48]
    assert observed_order([12, 24, 48], [float(m.frequencies[0]) for m in modes]) == pytest.approx(order, rel=0.02)


def test_steady_stretch_is_exact_in_the_limit():
    """γ = 50: tip at tan(λ)/λ with λ = γ/α, from x'' + λ² x = 0."""
    rate = 50 / 70
    exact, errors = np.tan(rate) / rate - 1, []
    for elements in (12, 24, 48):
        tree = hinged_segments.hinge_segments(unit(), elements)
        *_, q = exudyn_tree.linearize(tree, 50.0)
        errors.append(q[tree.strain == 0].sum() / exact - 1)
    assert abs(errors[2]) < 2e-4
    assert abs(np.log2(errors[1] / errors[2]) - 2) < 0.05


def test_the_mass_matrix_follows_from_the_jacobian():
    """Exudyn's M against Σ Jᵀ (m, I) J, with the adapter's J (used for mode shapes), also at non-zero coordinates."""
    blade = replace(unit(0.2, I_y=0.01, I_z=0.03), twist=np.array([0.2, 0.9]), pitch=0.1)
    tree = hinged_segments.hinge_segments(blade, 5)
    M, _, _, q = exudyn_tree.linearize(tree, 20.0)
    assert abs(q).max() > 0.01
    J = exudyn_tree.jacobian(tree, q, tree.centre)
    angle = (
        0.3 + 0.7 * 0.1 * np.arange(1, 10, 2) + np.cumsum(q[tree.strain == 3])[1::2]
    )  # untwisted by the propeller moment
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[np.eye(3)[0], [0, ci, -si], [0, si, ci]] for ci, si in zip(c, s, strict=True)])
    inertia = turn @ tree.inertia @ turn.transpose(0, 2, 1)
    expected = np.einsum("e,eik,eil->kl", tree.mass, J[:, :3], J[:, :3])
    expected += np.einsum("eik,eij,ejl->kl", J[:, 3:], inertia, J[:, 3:])
    np.testing.assert_allclose(M, expected, atol=1e-12 * abs(M).max())


def test_no_piece_ends_beyond_the_blade():
    """The sum of the station before and the last interval is rounded to more than the length."""
    stiffness = section_stiffness(*np.outer([1e9, 1e8, 1e9, 1e9], [1.0, 0.8, 0.3]))
    mass = section_mass(np.array([100.0, 80.0, 50.0]))
    for length in (51.4, 53.9):
        blade = Blade("tapered", length * np.array([0.0, 0.3, 1.0]), stiffness, mass, np.zeros(3))
        assert hinged_segments.hinge_segments(blade, 4, equal=True).ends[-1] == length


def test_segments_have_the_mass_and_inertia_of_the_blade():
    """Beyond the first hinge, about the root: ∫m, ∫ms, ∫ms² + ∫I of a tapered blade, in closed form."""
    mass = section_mass(np.array([3.0, 1.0]), np.array([0.2, 0.1]), np.array([0.5, 0.3]))
    blade = replace(unit(), mass=mass, tip_mass=np.diag([2.0, 2, 2, 0.3, 0.1, 0.2]))
    tree = hinged_segments.hinge_segments(blade, 4)
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


def limit(blade, omega):
    """Five frequencies, extrapolated, and core's."""
    coarse, fine = (TREE.solve(blade, omega, n, 5).frequencies for n in (48, 96))
    return fine + (fine - coarse) / 3, solve.mesh_modes(blade, omega, 60, 5).frequencies


def test_the_layer_at_the_root_is_resolved():
    """√(EI/T) is 1/117 of the length: with equal elements the frequencies are 0.013 to 0.015 % off."""
    result, core = limit(unit(5.0, EA=1e8), 50.0)
    np.testing.assert_allclose(result, core, rtol=1e-4)


@pytest.mark.slow
def test_a_blade_with_all_properties():
    """Coupled, curved, sheared, twisted, tapered, offset, coned, pitched."""
    result, core = limit(replace(curved(), precone=0.3), 3.0)
    np.testing.assert_allclose(result, core, rtol=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize("omega", [2.0, 8.0])
def test_a_twisted_blade_with_precone_has_a_steady_state(omega):
    """It needs speed steps: from zero to full speed in one step Newton's method diverges."""
    blade = replace(unit(0.1, EI_z=9.0, EA=1e5, I_y=1e-4, I_z=9e-4), twist=np.array([0.9, 0.0]), precone=0.3)
    result, core = limit(blade, omega)
    np.testing.assert_allclose(result, core, rtol=2e-4)


def test_no_axial_and_torsional_joints_without_such_stiffness_in_the_input():
    stiffness = tapered().stiffness.copy()
    stiffness[:, [0, 3], [0, 3]] = np.inf
    result, core = limit(replace(tapered(), stiffness=stiffness, precone=0.05), 3.0)
    np.testing.assert_allclose(result, core, rtol=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize("precone", [0.0, 0.2])
def test_a_flap_hinge(precone):
    """In the steady state it rotates until the blade is almost flat."""
    blade = replace(unit(0.2, EA=1e6), root=np.array([np.inf] * 4 + [0.0, np.inf]), precone=precone)
    result, core = limit(blade, 6.0)
    np.testing.assert_allclose(result, core, rtol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    "root", [[80.0, 60.0, 40.0, *3 * [np.inf]], [*3 * [np.inf], 2.0, 5.0, 7.0]], ids=["slides", "turns"]
)
def test_springs_at_the_root(root):
    blade = replace(unit(0.2, EA=1e4, I_y=1e-3, I_z=2e-3), root=np.array(root), pitch=0.3)
    result, core = limit(blade, 2.0)
    np.testing.assert_allclose(result, core, rtol=1e-4)


def test_at_rest_only_the_derivative_by_velocities_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = hinged_segments.hinge_segments(curved(), 8)
    M, C, K, _ = exudyn_tree.linearize(tree, 0.0)
    whole = system.linearized
    monkeypatch.setattr(system, "linearized", lambda exu, mbs, at_rest, full: whole(exu, mbs, full=full))
    mass, damping, stiffness, _ = exudyn_tree.linearize(tree, 0.0)
    np.testing.assert_array_equal(M, mass)
    np.testing.assert_array_equal(K, stiffness)
    assert not C.any()
    assert np.abs(damping).max() < 1e-8 * np.sqrt(np.abs(mass).max() * np.abs(stiffness).max())
