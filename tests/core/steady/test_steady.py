"""The steady state converged to rounding: rigid stretch, slow speeds, and its strain."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from southwell.core import solve
from southwell.core.blade import Blade, uniform_blade
from southwell.core.element.discretize import discretize
from southwell.core.spectrum.lanczos import lanczos
from southwell.core.steady import blade_state
from southwell.core.steady.blade_state import LargeStrainError
from southwell.references.joint_chains import drake as drake_chain
from southwell.references.joint_chains import mujoco as mujoco_chain
from southwell.references.joint_chains import pinocchio as pinocchio_chain

CONED: Blade = replace(
    uniform_blade("coned", 61.5, 1.5, EA=np.inf, GJ=1e9, EI_y=1e9, EI_z=4e9, mass=300.0), precone=np.deg2rad(-2.5)
)
"""As slender as a wind turbine's, and inextensible as in ElastoDyn."""

SLOW = 3 * np.pi / 30


def test_rigid_stretch_does_not_scatter() -> None:
    """From 50 to 1600 elements no more than the discretisation's error, 6e-9 of the third mode."""
    f = np.array([solve.mesh_modes(CONED, SLOW, n, 3).frequencies for n in (50, 100, 200, 400, 800, 1600)])
    assert np.abs(f / f[3] - 1.0).max() < 1e-8


@pytest.mark.parametrize("how", [{}, {"mass": "half_end", "stiffness": "body_fixed"}], ids=["consistent", "half_end"])
@pytest.mark.parametrize("omega", [1e-3, SLOW, 1.5])
def test_another_newton_step_changes_nothing(omega: float, how: dict[str, Any]) -> None:
    body = discretize(CONED, 50, **how)
    once = blade_state.steady_state(body, omega, np.zeros(3))
    second = blade_state.steady_state(body, omega, np.zeros(3), once.shape)
    f, g = (lanczos(s.pencil, 4).frequencies for s in (once, second))
    np.testing.assert_allclose(f, g, rtol=1e-9)


@pytest.mark.parametrize(
    ("code", "module"),
    [(pinocchio_chain.CODE, "pinocchio"), (drake_chain.CODE, "pydrake"), (mujoco_chain.CODE, "mujoco")],
)
@pytest.mark.parametrize("omega", [0.05, SLOW, 1.5])
def test_joint_chains_converge_to_rounding_too(code: Any, module: str, omega: float) -> None:
    """The stated rounding of both codes covers the difference of their solutions of one model."""
    pytest.importorskip(module)
    expected = code.solve(CONED, omega, 10, 6)
    solution = solve.modes(CONED, omega, 10, 6, mass="half_end", stiffness="body_fixed")
    difference = np.abs(expected.frequencies / solution.frequencies - 1.0)
    assert (difference <= solution.rounding + expected.rounding + 1e-12).all()
    assert (solution.rounding < 1e-7).all()
    assert (expected.rounding < 1e-11).all()


def test_strain_of_a_spinning_rod() -> None:
    """Ω²m(L² − x²)/2EA, largest at the root: its mean over the first element."""
    rod = uniform_blade("rod", 2.0, 0.0, EA=1e6, GJ=1e6, EI_y=1e4, EI_z=1e4, mass=1.0)
    omega, h = 30.0, 2.0 / 64
    expected = omega**2 * (2.0**2 - h**2 / 3.0) / (2 * 1e6)
    assert solve.mesh_modes(rod, omega, 64, 1).strain == pytest.approx(expected, rel=3e-3)  # and its own second order


def test_large_strains_are_refused_unless_allowed() -> None:
    """Strain grows as γ²/2α² of a rod; α = 4: γ = 3.2 is a strain of 0.4 and more."""
    soft = uniform_blade("soft", 1.0, 0.0, EA=16.0, GJ=1.0, EI_y=1.0, EI_z=1.0, mass=1.0)
    assert 0.02 < solve.modes(soft, 1.5, count=2).strain < 0.2
    with pytest.raises(LargeStrainError, match=r"omega: 3.2 rad/s: steady strain \d+%: .*check units, or allow"):
        solve.modes(soft, 3.2, count=2)
    assert solve.modes(soft, 3.2, count=2, allow_large_strain=True).strain > 0.2
    assert solve.mesh_modes(soft, 3.2, 20, 2).strain > 0.2
