"""Exudyn's geometrically exact beam: by closed forms, by core and by scikit-fem's exact beam."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core import solve
from southwell.core.blade import Blade, section_mass
from southwell.references.exudyn import geometrically_exact as exact
from southwell.references.exudyn import system
from southwell.references.exudyn.geometrically_exact import CODE
from southwell.references.protocol.interface import CodeError
from southwell.references.scikit_fem.reissner import CODE as REISSNER

from ...support.beams import curved
from ...support.exudyn_beams import FULL, PARK, extrapolated, families, needs_exudyn, observed_order, unit

pytestmark = needs_exudyn


def uncoupled_strains(blade: Blade) -> Blade:
    """The blade without off-diagonal section stiffness."""
    return replace(blade, stiffness=np.where(np.eye(6, dtype=bool), blade.stiffness, 0.0))


def test_the_cantilever_of_the_paper():
    """Two independent spectral solutions of the extensible beam with rotary inertia."""
    value, order = extrapolated(CODE, lambda n: families(CODE.solve(PARK, 10.0, n, 6), 3))
    np.testing.assert_allclose(value, FULL, rtol=1e-5)
    np.testing.assert_allclose(order, 2.0, atol=0.03)


@pytest.mark.parametrize("omega", [1.0, 3.4])
def test_precone_of_a_right_angle_makes_a_whirling_shaft(omega):
    """In rotating axes every frequency ω at zero speed splits into ω ± Ω, for any discretisation; ω − Ω whirls forwards."""
    rest = CODE.solve(unit(EA=1e6), 0.0, 12, 8).frequencies[::2]
    shaft = CODE.solve(replace(unit(EA=1e6), precone=np.pi / 2), omega, 12, 8)
    np.testing.assert_allclose(shaft.frequencies, np.sort([rest - omega, rest + omega], axis=None)[:8], rtol=1e-8)
    x, y = shaft.shapes[:2, -1, :2].T  # (cos, sin) is forwards: y = −i x
    np.testing.assert_allclose(y / x, [-1j, 1j], rtol=1e-6)


@pytest.mark.parametrize("omega", [0.0, 8.0])
def test_torsion_with_rotary_inertia(omega):
    """ω² = ((2k−1)π/2)² GJ/I_x + Ω² (I_z − I_y)/I_x: rotor blades rotate towards flat (the propeller moment)."""
    I_y, I_z = 1e-4, 9e-4
    blade = unit(EI_y=1e4, EI_z=2e4, EA=1e8, I_y=I_y, I_z=I_z)
    value, order = extrapolated(CODE, lambda n: CODE.solve(blade, omega, n, 2).frequencies)
    squared = (np.array([1, 3]) * np.pi / 2) ** 2 / (I_y + I_z) + omega**2 * (I_z - I_y) / (I_y + I_z)
    np.testing.assert_allclose(value, np.sqrt(squared), rtol=1e-6)
    np.testing.assert_allclose(order, 2.0, atol=0.02)


def test_shear():
    """A Timoshenko beam with negligible shear stiffness is a shear beam: ω = (2k−1)π/2 √(GA/ρA)."""
    blade = unit(EI_y=1e5, EI_z=1e5, EA=1e6, GA_y=1.0, GA_z=4.0)
    value, _ = extrapolated(CODE, lambda n: families(CODE.solve(blade, 0.0, n, 6), 2))
    np.testing.assert_allclose(value, np.outer([1, 2], np.array([1, 3]) * np.pi / 2), rtol=2e-5)


@pytest.mark.parametrize("precone", [np.radians(2.5), 0.3])
def test_a_curved_twisted_tapered_blade_with_offset_mass(precone):
    """Core's frequencies and those of scikit-fem's exact beam, which are of fourth order or higher."""
    blade = replace(uncoupled_strains(curved()), precone=precone)
    values = [CODE.solve(blade, 3.0, n, 5).frequencies for n in (30, 60, 120)]
    value = values[2] + (values[2] - values[1]) / 3
    np.testing.assert_allclose(value, solve.mesh_modes(blade, 3.0, 60, 5).frequencies, rtol=1e-5)
    np.testing.assert_allclose(value, REISSNER.solve(blade, 3.0, 40, 5).frequencies, rtol=1e-5)
    np.testing.assert_allclose(observed_order(values), 2.0, atol=0.03)


def test_a_twisted_coned_blade_with_a_tip_mass_has_a_steady_state():
    """It needs increments of speed: from zero to full speed in one step Newton's method diverges."""
    blade = replace(
        unit(0.1, EI_z=9.0, EA=1e5, I_y=1e-4, I_z=9e-4),
        twist=np.array([0.9, 0.0]),
        precone=0.3,
        tip_mass=np.diag([0.5, 0.5, 0.5, 0.01, 0.004, 0.006]),
    )
    value, _ = extrapolated(CODE, lambda n: CODE.solve(blade, 8.0, n, 4).frequencies)
    np.testing.assert_allclose(value, solve.mesh_modes(blade, 8.0, 60, 4).frequencies, rtol=2e-5)


def test_a_step_of_the_stiffness_is_no_element():
    """Elements of a ten-millionth of the length would have rounding errors of 1e-5 of the frequencies, or no steady state."""
    uniform = unit()
    factor = np.array([1.0, 1.0, 0.25, 0.25])[:, None, None]
    stiffness = np.where(np.isinf(uniform.stiffness[:1]), np.inf, uniform.stiffness[:1] * factor)
    blade = Blade("stepped", np.array([0.0, 0.5, 0.5 + 1e-7, 1.0]), stiffness, uniform.mass[:1] * factor, np.zeros(4))
    assert len(exact.assemble(blade, 12).ends) == 13
    value, _ = extrapolated(CODE, lambda n: CODE.solve(blade, 5.0, n, 4).frequencies)
    np.testing.assert_allclose(value, solve.mesh_modes(blade, 5.0, 60, 4).frequencies, rtol=1e-5)


def test_exudyn_has_the_exact_tangent_of_its_forces():
    """By central differences about a deformed state, in which stiffness and steady forces both matter."""
    beam = exact.assemble(replace(uncoupled_strains(curved())), 5)
    random, size = np.random.default_rng(0), len(beam.ends)
    state = exact.moved(beam.reference, 0.02 * random.standard_normal((size, 6)))
    step = 1e-5 * np.eye(6 * size).reshape(-1, size, 6)
    for forces in (exact.elastic, lambda beam, state: exact.centrifugal(beam, state, 3.0)):
        rows = [(forces(beam, exact.moved(state, s))[0] - forces(beam, exact.moved(state, -s))[0]) / 2e-5 for s in step]
        differences = np.array(rows)
        symmetric = (
            differences + differences.T
        ) / 2  # rotations do not commute: the rest is not part of the second variation
        error = abs(forces(beam, state)[1].toarray() - symmetric)
        assert error.max() < 1e-8 * abs(symmetric).max()


def test_masses_and_moments_are_those_of_the_blade():
    """∫m, ∫ms of a tapered blade with a tip mass, in closed form."""
    mass = section_mass(np.array([3.0, 1.0]), np.array([0.2, 0.1]), np.array([0.5, 0.3]))
    blade = replace(unit(), mass=mass, tip_mass=np.diag([2.0, 2, 2, 0.3, 0.1, 0.2]))
    beam = exact.assemble(blade, 4)
    assert beam.mass[:, 3, 3].sum() == pytest.approx(2 + 2, rel=1e-12)
    assert beam.mass[:, 3, 3] @ beam.ends == pytest.approx(3 / 2 - 2 / 3 + 2, rel=1e-12)
    assert np.trace(beam.mass[:, :3, :3].sum(0)) == pytest.approx((0.15 + 0.4 + 0.55) / 2 + 0.3, rel=1e-12)


def test_coupled_strains_are_refused_as_exudyn_refuses_them():
    blade = curved()
    with pytest.raises(CodeError, match="Exudyn's beam refuses off-diagonal section stiffness"):
        CODE.solve(blade, 0.0, 12, 2)
    exu, _container, mbs = system.system()
    nodes = [mbs.AddNode(exu.itemInterface.NodeRigidBodyEP(referenceCoordinates=[x, 0, 0, 1, 0, 0, 0])) for x in (0, 1)]
    section = exu.BeamSection()
    section.stiffnessMatrix = blade.stiffness[0]
    beam = exu.itemInterface.ObjectBeamGeometricallyExact(length=1.0, nodeNumbers=nodes, sectionData=section)
    with pytest.raises(Exception, match="stiffnessMatrix contains values which can not be used"):
        mbs.AddObject(beam)


def test_the_ancf_beam_stresses_a_curved_reference():
    """The reason why it is not used: its strains are not relative to the reference configuration."""
    exu, _container, mbs = system.system()
    items, angle = exu.itemInterface, 0.1
    c, s = np.cos(angle), np.sin(angle)
    ends = [[0.0, 0, 0, s, c, 0, 0, 0, 1], [0.5, 0, 0, -s, c, 0, 0, 0, 1]]
    nodes = [mbs.AddNode(items.NodePointSlope23(referenceCoordinates=end)) for end in ends]
    section = exu.BeamSection()
    section.stiffnessMatrix, section.massPerLength = np.diag([2e6, 3e5, 4e5, 50.0, 80.0, 120.0]), 1.5
    mbs.AddObject(items.ObjectANCFBeam(length=0.5, nodeNumbers=nodes, sectionData=section))
    mbs.Assemble()
    force, _ = system.forces(exu, mbs)
    assert abs(force).max() > 40.0  # EI_z (2 × 0.1 rad)/(0.5 m) = 48 N m
