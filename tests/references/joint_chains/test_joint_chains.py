"""Joint chains against core (one discretisation, to rounding) and, stage by stage, against Pinocchio's."""

from collections.abc import Callable
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from southwell.core import solve
from southwell.core.blade import Blade, without_rotary_inertia
from southwell.core.element.discretize import discretize
from southwell.core.element.mesh import Mesh
from southwell.references.joint_chains import drake as drake_chain
from southwell.references.joint_chains import joint_chain
from southwell.references.joint_chains import mujoco as mujoco_chain
from southwell.references.joint_chains import pinocchio as pinocchio_chain
from southwell.references.joint_chains.joint_chain import ChainModel
from southwell.references.protocol.interface import CodeError
from southwell.tests.support.beams import PARK, TIP_MASS, curved, tapered, yoo_shin

Array = NDArray[Any]


def needs(module: str, code: Any) -> pytest.MarkDecorator:
    return pytest.mark.skipif(find_spec(module) is None, reason=f"not installed: {code.hint}")


both = pytest.mark.parametrize(
    "code",
    [
        pytest.param(drake_chain.CODE, id="drake", marks=needs("pydrake", drake_chain.CODE)),
        pytest.param(mujoco_chain.CODE, id="mujoco", marks=needs("mujoco", mujoco_chain.CODE)),
    ],
)

chains = pytest.mark.parametrize(
    "code",
    [*both.args[1], pytest.param(pinocchio_chain.CODE, id="pinocchio", marks=needs("pinocchio", pinocchio_chain.CODE))],
)


@pytest.mark.slow
@chains
@pytest.mark.parametrize(
    ("blade", "omega"),
    [
        (PARK, 0.0),
        (without_rotary_inertia(PARK), 10.0),
        (replace(tapered(), pitch=0.4), 3.0),
        (curved(), 1.5),
        (replace(curved(), tip_mass=TIP_MASS), 6.0),
        (replace(yoo_shin(0.0), precone=0.6), 20.0),
    ],
    ids=[
        "at rest",
        "point masses",
        "tapered, twisted, pitched",
        "curved, coupled, coned, shear",
        "with offset tip mass",
        "steeply coned",
    ],
)
def test_agrees_with_core_to_rounding(code: Any, blade: Blade, omega: float) -> None:
    solution = code.solve(blade, omega, 12, 10)
    own_answer = solve.mesh_modes(blade, omega, 12, 10, mass="half_end", stiffness="body_fixed")
    np.testing.assert_allclose(solution.frequencies, own_answer.frequencies, rtol=1e-10)


@both
def test_shapes_agree_with_pinocchio(code: Any) -> None:
    """The same spline through the same nodes, so the same to rounding except for a phase."""
    pytest.importorskip("pinocchio")
    actual, expected = (c.solve(curved(), 1.5, 10, 5).shapes.reshape(5, -1) for c in (code, pinocchio_chain.CODE))
    norms = np.linalg.norm(actual, axis=1) * np.linalg.norm(expected, axis=1)
    np.testing.assert_allclose(np.abs(np.sum(actual.conj() * expected, axis=1)) / norms, 1, atol=1e-12)


@pytest.mark.parametrize(
    ("make", "rtol"),
    [
        pytest.param(drake_chain.build, 1e-12, id="drake", marks=needs("pydrake", drake_chain.CODE)),
        pytest.param(mujoco_chain.build, 1e-9, id="mujoco", marks=needs("mujoco", mujoco_chain.CODE)),
    ],
)
def test_every_stage_agrees_with_pinocchio(make: Callable[[Mesh], ChainModel], rtol: float) -> None:
    """Mass, inertial force, its derivatives, and motion of the bodies, at strains of 0.1, far from the undeformed state."""
    pytest.importorskip("pinocchio")
    chain = discretize(replace(curved(), tip_mass=TIP_MASS), 5, "half_end", "body_fixed")
    q = 0.1 * np.random.default_rng(3).standard_normal(30)
    stages = []
    for model in (make(chain), pinocchio_chain.build(chain)):
        stages.append((model.mass(q), *model.inertial(q, 2.0), model.jacobian(q)))
    for actual, expected in zip(*stages, strict=True):
        assert actual.shape == expected.shape
        np.testing.assert_allclose(actual, expected, atol=rtol * np.abs(expected).max(), rtol=0)


@chains
@pytest.mark.parametrize(("gamma", "reason"), [(100.0, "no stable steady state"), (1e4, "no (stable )?steady state")])
def test_no_steady_state_at_high_speed(code: Any, gamma: float, reason: str) -> None:
    with pytest.raises(CodeError, match=reason):
        code.solve(yoo_shin(0.1), gamma, 6, 4)


@both
@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"root": np.array([np.inf] * 5 + [0.0])}, "the root is not clamped"),
        ({"tip_mass": np.diag([1.0, 1.0, 1.00005, 0.1, 0.1, 0.1])}, "tip_mass is not a rigid body's"),
    ],
)
def test_an_unsupported_blade_is_declined_with_a_reason(code: Any, changed: dict[str, Array], reason: str) -> None:
    blade = replace(PARK, **changed)
    assert (code.unsupported(blade) or "").startswith(reason)
    with pytest.raises(CodeError, match=reason):
        code.solve(blade, 0.0, 5, 4)


def test_derivatives_without_their_symmetry_are_an_error() -> None:
    K, C = np.eye(3), np.array([[0.0, 1, 0], [-1, 0, 2], [0, -2, 0]])
    joint_chain.require_symmetries(K, C, 1e-9, "code")
    with pytest.raises(CodeError, match=r"dtau_dq: 1\.0e-06 from symmetric: code's"):
        joint_chain.require_symmetries(K + 1e-6 * np.eye(3, k=1), C, 1e-9, "code")
    with pytest.raises(CodeError, match=r"dtau_dv: 2\.0e\+00 from skew"):
        joint_chain.require_symmetries(K, C + np.eye(3), 1e-9, "code")
