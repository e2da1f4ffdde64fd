"""Solid blades in scikit-fem: invariants of the mechanics, then exact beams, at zero speed and rotating."""

import numpy as np
import pytest

from southwell.core.condense import ties
from southwell.core.effects import Effects
from southwell.core.solve import mesh_modes
from southwell.references.protocol.interface import CodeError
from southwell.references.solid import hexahedra
from southwell.references.solid.materials import Material
from southwell.references.solid.mesh import Bricks, clamped_section, straight_bricks
from southwell.tests.support.solid_sections import clamped_free_to_contract
from southwell.tests.support.solids import (
    HUB,
    LENGTH,
    ROOT,
    SQUARE,
    STEEL,
    mac,
    square_bar,
    square_beam,
    timoshenko,
    twisted,
)

pytestmark = pytest.mark.skipif(hexahedra.version() is None, reason=f"not installed: {hexahedra.HINT}")


def small() -> hexahedra.Solid:
    return hexahedra.solid(twisted(4, (2, 2)), STEEL)


def test_mass_and_centre_of_a_tapered_rectangle() -> None:
    """∫ρ c t dx and ∫ρ c t x dx for linear chord and thickness: exact for a trilinear mesh."""
    x = np.linspace(1.0, 3.0, 4)
    s = hexahedra.solid(straight_bricks(x, 0.5 - 0.1 * (x - 1), 0.2 - 0.05 * (x - 1), across=(2, 2)), STEEL)
    area = np.polynomial.Polynomial([0.6, -0.1]) * np.polynomial.Polynomial([0.25, -0.05])
    m = hexahedra.mass(s).sum(axis=1)
    for power in (0, 1):
        exact = STEEL.density * np.diff((area * np.polynomial.Polynomial([0.0, 1.0]) ** power).integ()([1.0, 3.0]))[0]
        assert m @ s.nodes[:, 0] ** power == pytest.approx(exact, rel=1e-12)


def test_stiffness_is_symmetric_and_free_of_rigid_motions() -> None:
    s = small()
    K = hexahedra.tangent(s)
    R = ties.motion(*hexahedra.freedoms(s), np.eye(4))
    assert abs(K - K.T).max() < 1e-12 * abs(K).max()
    assert np.abs(K @ R).max() < 1e-10 * abs(K).max()


def test_a_finite_rigid_rotation_causes_no_strain() -> None:
    s = small()
    c, si = np.cos(1.0), np.sin(1.0)
    turned = s.nodes @ np.array([[c, si, 0], [-si, c, 0], [0, 0, 1]])
    u = (turned - s.nodes).T.ravel()
    assert np.abs(hexahedra.internal_force(s, u)).max() < 1e-11 * abs(hexahedra.tangent(s)).max() * np.abs(u).max()


def test_tangent_is_the_derivative_of_the_internal_force() -> None:
    """At a stretched, sheared and rotated state, along a random direction, by central differences."""
    s = small()
    rng = np.random.default_rng(1)
    u = (s.nodes @ (0.1 * rng.normal(size=(3, 3)))).T.ravel() + 1e-4 * rng.normal(size=3 * len(s.nodes))
    v = rng.normal(size=len(u))
    h = 1e-7
    slope = (hexahedra.internal_force(s, u + h * v) - hexahedra.internal_force(s, u - h * v)) / (2 * h)
    np.testing.assert_allclose(hexahedra.tangent(s, u) @ v, slope, atol=1e-7 * np.abs(slope).max())


def test_uniform_tension_on_a_distorted_mesh() -> None:
    """The patch test: u = ε (x, −ν y, −ν z) needs E A ε at the ends and no other forces."""
    corners = straight_bricks(np.linspace(0.0, 1.0, 4), 0.2, 0.1, across=(3, 3)).corners.copy()
    corners[1:-1, 1:-1, 1:-1] += 0.01 * np.random.default_rng(2).uniform(-1, 1, size=(2, 2, 2, 3))
    s = hexahedra.solid(Bricks(corners), STEEL)
    u = (1e-6 * s.nodes * np.array([1.0, -STEEL.poisson, -STEEL.poisson])).T.ravel()
    force = (hexahedra.tangent(s) @ u).reshape(3, -1)
    tip = s.nodes[:, 0] == 1.0
    pull = STEEL.young * 0.02 * 1e-6
    np.testing.assert_allclose(force[:, tip].sum(axis=1), [pull, 0.0, 0.0], atol=1e-9 * pull)
    np.testing.assert_allclose(force[:, ~tip & (s.nodes[:, 0] > 0.0)], 0.0, atol=1e-9 * pull)


def test_steady_stretch_of_a_rotating_bar() -> None:
    """u(L) = ρ Ω² (R L²/2 + L³/3)/E with zero Poisson's ratio, at strains of 1e-7."""
    bar, omega, length, hub = Material(2e11, 0.0, 7800.0), 1.0, 2.0, 0.5
    s = hexahedra.solid(straight_bricks(np.linspace(hub, hub + length, 5), 0.1, 0.1, across=(1, 1)), bar)
    u, _ = hexahedra.steady_displacements(s, omega, hexahedra.motions(s, clamped_section(hub)))
    tip = u[: len(s.nodes)][s.nodes[:, 0] == hub + length]
    exact = 7800.0 * omega**2 * (hub * length**2 / 2 + length**3 / 3) / 2e11
    np.testing.assert_allclose(tip, exact, rtol=1e-5)


def test_square_cantilever_at_zero_speed_has_timoshenkos_frequencies() -> None:
    """The paper's cantilever, three frequencies in each plane; clamped so that the root may contract."""
    frequencies = hexahedra.modes(
        square_bar(LENGTH, 60, start=HUB), SQUARE, 0.0, 6, clamped_free_to_contract(HUB)
    ).frequencies
    np.testing.assert_allclose(frequencies, np.repeat(timoshenko(3), 2), rtol=3e-4)


def test_square_cantilever_rotating_at_ten_rad_per_second() -> None:
    """Against core's Timoshenko beam, edgewise and flapwise: prestress, spin softening and Coriolis forces."""
    solution = hexahedra.modes(square_bar(LENGTH, 60, start=HUB), SQUARE, 10.0, 6, clamped_free_to_contract(HUB))
    beam = mesh_modes(square_beam(), 10.0, 80, 6)
    np.testing.assert_allclose(solution.frequencies, beam.frequencies, rtol=3e-4)
    assert (mac(solution, beam).diagonal() > 0.999).all()


def test_coriolis_forces() -> None:
    """Slenderness 70, γ = 2: they lower the first edgewise frequency by 6e-4, in the solid as in the beam.

    The St Venant–Kirchhoff material stiffens with strain, here 4e-4, which raises the solid's frequencies by 5e-4.
    """
    material, side, length = Material(1e9, 0.0, 1000.0), np.sqrt(12.0) / 70.0, 1.0
    omega = 2.0 * np.sqrt(1e9 * side**2 / 12 / 1000.0)
    bricks = straight_bricks(np.linspace(0.0, length, 31), side, side, across=(2, 2))
    beam = square_beam(material, side, length, 0.0)
    drop = {}
    for coriolis in (True, False):
        frequencies = hexahedra.modes(
            bricks, material, omega, 4, clamped_free_to_contract(0.0), coriolis=coriolis
        ).frequencies
        exact = mesh_modes(beam, omega, 60, 4, effects=Effects(coriolis=coriolis)).frequencies
        np.testing.assert_allclose(frequencies, exact, rtol=1e-3)
        drop[coriolis] = frequencies[0], exact[0]
    solids, beams = (drop[True][k] / drop[False][k] - 1 for k in (0, 1))
    assert beams < -6e-4
    assert solids == pytest.approx(beams, rel=2e-3)


def test_errors_name_the_cause() -> None:
    bricks = twisted(2, (2, 2))
    with pytest.raises(CodeError, match="clamp: fixes 0 displacements"):
        hexahedra.modes(bricks, STEEL, 0.0, 2, clamped_section(ROOT + 0.1))
    with pytest.raises(CodeError, match=r"mesh: no layer of nodes at the station x = 0\.35 m"):
        hexahedra.modes(bricks, STEEL, 0.0, 2, clamped_section(ROOT))
    with pytest.raises(CodeError, match=r"no (stable )?steady state"):
        hexahedra.modes(bricks, STEEL, 1e5, 2, clamped_section(ROOT))
