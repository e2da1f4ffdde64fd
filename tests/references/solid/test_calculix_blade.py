"""The CalculiX adapter: its bar is equivalent to the blade; against closed forms and core without Coriolis forces."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core import solve
from southwell.core.blade import TORSION, Blade, uniform_blade, without_rotary_inertia
from southwell.references.protocol.interface import CodeError
from southwell.references.solid import calculix
from southwell.references.solid.bar import bar
from southwell.references.solid.calculix_blade import CODE
from southwell.tests.support.analytic import ROOTS
from southwell.tests.support.beams import PARK, A, E, I, curved, tapered

needs_ccx = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")

PLANK = uniform_blade("plank", 6.0, 0.3, EA=2.8e7, GJ=1e4, EI_y=1.4e4, EI_z=5.6e4, mass=1.2, I_y=6e-4, I_z=2.4e-3)
SHEARING = replace(PARK, name="shearing", stiffness=PARK.stiffness.copy())
SHEARING.stiffness[:, [1, 2], [1, 2]] = 3e6, 1e6


def test_the_bar_has_the_blades_stiffness_and_mass() -> None:
    """Integrals over a rectangle of sides c and t: E c t, E c t³/12, E c³ t/12, ρ c t and its inertias."""
    bricks, material = bar(PLANK, 10)
    corners = bricks.corners
    c, t = np.ptp(corners[..., 1]), np.ptp(corners[..., 2])
    stiffness = material.young * np.array([c * t, c * t**3 / 12, c**3 * t / 12])
    np.testing.assert_allclose(stiffness, [2.8e7, 1.4e4, 5.6e4], rtol=1e-12)
    mass = material.density * np.array([c * t, c * t**3 / 12, c**3 * t / 12])
    np.testing.assert_allclose(mass, [1.2, 6e-4, 2.4e-3], rtol=1e-12)
    np.testing.assert_allclose([corners[..., 0].min(), corners[..., 0].max()], [0.3, 6.3], rtol=1e-12)
    _, soft = bar(SHEARING, 10)
    np.testing.assert_allclose(soft.shear[:2], np.array([3e6, 1e6]) * 6 / 5 * soft.young[0] / 2.8e7, rtol=1e-12)


@needs_ccx
def test_the_cantilever_at_zero_speed_is_the_closed_form() -> None:
    """Euler–Bernoulli; rotary inertia lowers the third pair by 5.4e-4; with it, core agrees to 2e-5."""
    beta2 = np.square(ROOTS[:3])
    bending = beta2 * np.sqrt(E * I / (3000.0 * A)) / 36.0
    frequencies = CODE.solve(PARK, 0.0, 40, 6).frequencies
    np.testing.assert_allclose(frequencies, np.repeat(bending, 2), rtol=6e-4)
    np.testing.assert_allclose(frequencies, solve.mesh_modes(PARK, 0.0, 60, 6).frequencies, rtol=2e-5)


@pytest.mark.slow
@needs_ccx
@pytest.mark.parametrize(
    ("blade", "omega", "rtol"),
    [(PARK, 10.0, 1.5e-4), (PARK, 30.0, 7e-4), (PLANK, 10.0, 1.5e-4), (SHEARING, 10.0, 4e-4)],
    ids=["cantilever", "fast", "plank", "shearing"],
)
def test_agrees_with_the_solver_without_coriolis_forces(blade: Blade, omega: float, rtol: float) -> None:
    """The St Venant–Kirchhoff material stiffens with strain: 8e-5 at 10 rad/s, nine times that at 30."""
    solution = CODE.solve(blade, omega, 40, 6)
    own_answer = solve.mesh_modes(blade, omega, 60, 6, effects=CODE.effects)
    np.testing.assert_allclose(solution.frequencies, own_answer.frequencies, rtol=rtol)


@needs_ccx
def test_shapes_are_in_blade_axes() -> None:
    """The plank's lowest mode is flapwise: along z, as the closed form says, and not about x."""
    shape = CODE.solve(PLANK, 0.0, 20, 1).shapes[0]
    own_answer = solve.mesh_modes(PLANK, 0.0, 40, 1).shapes[0]
    np.testing.assert_allclose(shape[:, 2] / shape[-1, 2], own_answer[:, 2] / own_answer[-1, 2], atol=2e-4)
    assert np.abs(np.delete(shape, 2, axis=1)).max() < 1e-3 * np.abs(shape[-1, 2])


@needs_ccx
def test_fourth_order() -> None:
    f = np.array([CODE.solve(PARK, 10.0, n, 6).frequencies for n in CODE.levels])
    f = f[:, 2:]  # the first pair has converged to the printed digits
    np.testing.assert_allclose(np.log2((f[0] - f[1]) / (f[1] - f[2])), CODE.order, atol=0.1)


@needs_ccx
def test_torsional_modes_are_left_out() -> None:
    """A stubby bar soft in shear has low torsional modes; ten modes requested give ten, none of them torsional."""
    stubby = uniform_blade(
        "stubby", 1.0, 0.1, EA=1e6, GJ=1.0, EI_y=1e4, EI_z=1e4, mass=1.0, I_y=0.01, I_z=0.01, GA_y=1e4, GA_z=1e4
    )
    bricks, material = bar(stubby, 10)
    radius = np.sqrt(2e4 / 1e6)
    all_ = calculix.modes(bricks, material, 0.0, 10, lambda nodes: np.repeat(nodes[:, :1] < 0.1 + 1e-9, 3, axis=1))
    twists = radius * np.abs(all_.shapes[:, :, 3]).max(1) > np.abs(all_.shapes[:, :, :3]).max((1, 2))
    assert twists.any()
    kept = CODE.solve(stubby, 0.0, 10, 10)
    assert len(kept.frequencies) == 10
    np.testing.assert_allclose(kept.frequencies[: (~twists).sum()], all_.frequencies[~twists], rtol=1e-6)


@pytest.mark.parametrize(
    ("blade", "reason"),
    [
        (tapered(), "this bar has none"),
        (curved(), "this bar has none"),
        (replace(PARK, tip_mass=np.eye(6)), "this bar has none"),
        (without_rotary_inertia(PARK), r"I_y = 0 kg m: a solid of this EI and EA has 0\.0006"),
        (uniform_blade("s", 1, 0, EA=np.inf, GJ=1, EI_y=1, EI_z=1, mass=1), "rigid in bending or stretch"),
        (replace(PARK, mass=PARK.mass * np.diag([1, 1, 1.00005, 1, 1, 1])), "mass differs with direction"),
    ],
    ids=["tapered", "curved", "tip mass", "thin", "rigid", "added mass"],
)
def test_an_unsupported_blade_is_declined_with_a_reason(blade: Blade, reason: str) -> None:
    with pytest.raises(CodeError, match=reason):
        CODE.solve(blade, 0.0, 10, 2)


def test_a_strain_that_stiffens_the_material_is_an_error() -> None:
    """ρ Ω² (R L + L²/2) / E = 2e-3 at 48.5 rad/s."""
    with pytest.raises(CodeError, match=r"omega: 49 rad/s: strain at the root 2\.0e-03"):
        CODE.solve(PARK, 49.0, 10, 2)


def test_the_installation_hint_if_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    assert CODE.version() is None
    assert CODE.hint == "apt-get install calculix-ccx"
    assert CODE.unsupported(PARK) is None
    with pytest.raises(CodeError, match="ccx is not on the PATH: apt-get install calculix-ccx"):
        CODE.solve(PARK, 0.0, 10, 2)


def test_torsional_stiffness_does_not_affect_the_results() -> None:
    """The bar has another torsional stiffness than the blade; torsion is decoupled and its modes are left out."""
    other = replace(PARK, stiffness=PARK.stiffness * np.where(np.eye(6)[TORSION], 9.0, 1.0))
    assert CODE.unsupported(other) is None
    assert bar(other, 10)[1] == bar(PARK, 10)[1]
