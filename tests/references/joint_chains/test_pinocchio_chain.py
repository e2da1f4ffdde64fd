"""Pinocchio's chain against core (one discretisation, to rounding), closed forms, and the paper's printed digits."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from southwell.core import solve
from southwell.core.blade import without_rotary_inertia
from southwell.core.element.discretize import discretize
from southwell.references.joint_chains import pinocchio as pinocchio_chain
from southwell.references.joint_chains.pinocchio import CODE
from southwell.references.protocol.interface import CodeError
from southwell.tests.support.beams import PARK, A, E, I, curved

pytestmark = pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")

Array = NDArray[Any]
POINT_MASSES = without_rotary_inertia(PARK)


@pytest.mark.slow
def test_shapes_agree_with_core() -> None:
    """Between nodes too: the chain's spline against core's shape functions."""
    actual = CODE.solve(curved(), 1.5, 15, 5).shapes.reshape(5, -1)
    expected = solve.mesh_modes(curved(), 1.5, 15, 5, mass="half_end", stiffness="body_fixed").shapes.reshape(5, -1)
    norms = np.linalg.norm(actual, axis=1) * np.linalg.norm(expected, axis=1)
    np.testing.assert_allclose(np.abs(np.sum(actual.conj() * expected, axis=1)) / norms, 1, atol=2e-3)


def test_a_cantilever_of_point_masses_at_zero_speed() -> None:
    """Exact for any number of masses: flexibility s²(3t − s)/6EI at s of a unit force at t > s, elementary beam theory."""
    n, mass = 12, 3000.0 * A * 6.0 / 12
    s = 6.0 * np.arange(1, n + 1) / n
    near, far = np.minimum.outer(s, s), np.maximum.outer(s, s)
    flexibility = near**2 * (3 * far - near) / (6 * E * I)
    weight = np.sqrt(np.where(np.arange(1, n + 1) == n, mass / 2, mass))
    exact = 1 / np.sqrt(np.linalg.eigvalsh(weight[:, None] * flexibility * weight)[::-1])
    frequencies = CODE.solve(POINT_MASSES, 0.0, n, 6).frequencies
    np.testing.assert_allclose(frequencies, np.repeat(exact[:3], 2), rtol=1e-9)


@pytest.fixture(scope="module")
def series() -> tuple[Array, Array]:
    """Coefficients of (1, h², h⁴) for the point masses at 10 rad/s; frequencies at 10, 20 and 40 elements."""
    f = {n: CODE.solve(POINT_MASSES, 10.0, n, 6).frequencies for n in (10, 20, 28, 40)}
    h = 1 / np.array([20.0, 28.0, 40.0])
    coefficients = np.linalg.solve(np.stack([h**0, h**2, h**4], axis=1), np.array([f[20], f[28], f[40]]))
    return coefficients, np.array([f[n] for n in (10, 20, 40)])


def test_second_order(series: tuple[Array, Array]) -> None:
    _, f = series
    assert CODE.order == 2
    np.testing.assert_allclose(np.log2((f[0] - f[1]) / (f[1] - f[2])), 2, atol=0.05)


def test_the_papers_fifty_elements(series: tuple[Array, Array]) -> None:
    """Park et al. (2010), Table 1, Present: 11.71, 70.37, 189.7; extrapolated from 20, 28 and 40 elements."""
    coefficients, _ = series
    at_50 = (coefficients.T @ [1, 50.0**-2, 50.0**-4])[::2]
    assert [f"{f:.4g}" for f in at_50] == ["11.71", "70.37", "189.7"]
    np.testing.assert_allclose(at_50, [11.7058, 70.3722, 189.6735], atol=1e-4)


def test_convergence_to_the_nonlinear_beam(series: tuple[Array, Array]) -> None:
    """Without section inertia: a geometrically nonlinear beam's converged values (Exudyn's ANCF cable)."""
    limit = series[0][0]
    np.testing.assert_allclose(limit[::2], [11.71131, 70.43535, 189.92222], rtol=5e-6)
    np.testing.assert_allclose(limit[1::2], [15.40088, 71.14306, 190.18649], rtol=5e-6)


def test_point_masses_have_three_modes_each() -> None:
    """Rotations without inertia are condensed, without artificial inertia: they have no modes."""
    assert len(CODE.solve(POINT_MASSES, 10.0, 4, 99).frequencies) == 12


def test_a_joint_with_a_wrong_derivative_is_detected() -> None:
    """Pinocchio's composite joint of a translation and three rotations: dtau_dq is not symmetric."""
    pin = pytest.importorskip("pinocchio")
    chain = discretize(POINT_MASSES, 3, "half_end", "body_fixed")
    model = pin.Model()
    link = model.addJoint(0, pin.JointModelRZ(), pin.SE3.Identity(), "hub")
    for place in (chain.nodes[1], *chain.beams.undeformed[1:]):
        joint = pin.JointModelComposite(pin.JointModelTranslation())
        for turn in (pin.JointModelRX(), pin.JointModelRY(), pin.JointModelRZ()):
            joint.addJoint(turn)
        link = model.addJoint(link, joint, pin.SE3(place), f"composite {link}")
        model.appendBodyToJoint(link, pin.Inertia(2.4, np.zeros(3), np.zeros((3, 3))), pin.SE3.Identity())
    with pytest.raises(CodeError, match=r"dtau_dq: .* from symmetric"):
        pinocchio_chain.inertial(model, model.createData(), np.full(18, 0.01), 10.0)
    sound = pinocchio_chain.pinocchio_model(chain)
    pinocchio_chain.inertial(sound, sound.createData(), np.full(18, 0.01), 10.0)


def test_a_load_without_a_steady_state_reports_the_fraction_reached() -> None:
    floppy = replace(curved(), stiffness=0.01 * curved().stiffness)
    with pytest.raises(CodeError, match=r"omega: 4 rad/s: no steady state above \d+% of Ω²"):
        CODE.solve(floppy, 4.0, 10, 4)


def test_blades_with_as_many_elements_share_the_workspace_and_not_the_results() -> None:
    def frequencies() -> list[Array]:
        return [CODE.solve(blade, 3.0, 6, 6).frequencies for blade in (PARK, curved(), PARK)]

    shared = frequencies()
    alone = []
    for blade in (PARK, curved(), PARK):
        pinocchio_chain._LAST.clear()
        alone.append(CODE.solve(blade, 3.0, 6, 6).frequencies)
    np.testing.assert_array_equal(shared, alone)
