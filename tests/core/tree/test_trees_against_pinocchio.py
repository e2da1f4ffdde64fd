"""Random trees, stage by stage, against Pinocchio: mass matrix, inverse dynamics, and its analytic derivatives.

Independent codes on one mechanical model: this checks the algebra, not the model. Pinocchio requires the joints
depth first; each coordinate is a separate joint, since the derivative of its composite joint is wrong.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from southwell.core.mechanism.description import Body, Mechanism, inertia
from southwell.core.mechanism.joints import SCREWS, Joint, Kind
from southwell.core.space import spatial as sp
from southwell.core.tree import dynamics
from southwell.core.tree.kinematics import kinematics
from southwell.core.tree.spanning import compile_tree

pin = pytest.importorskip("pinocchio", reason="not run: pip install '.[codes]'")

KINDS: list[Kind] = ["revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "free", "elastic"]


@st.composite
def trees(draw) -> tuple[list[Kind], list[int], int]:
    """Joint kinds, parents (depth first: each on the last branch), and a seed for the numbers."""
    n = draw(st.integers(3, 8))
    kinds = [draw(st.sampled_from(KINDS)) for _ in range(n)]
    parents, branch = [-1], [0]
    for i in range(1, n):
        k = draw(st.integers(0, len(branch) - 1))
        parents.append(branch[k])
        branch = [*branch[: k + 1], i]
    return kinds, parents, draw(st.integers(0, 2**31))


def build(kinds: list[Kind], parents: list[int], rng: np.random.Generator):
    """The same tree for both codes."""
    gravity = rng.normal(size=3) * 5
    bodies, joints = [], []
    model = pin.Model()
    model.gravity.linear = gravity
    placed = {-1: (0, pin.SE3.Identity())}
    prismatic = {"x": pin.JointModelPX, "y": pin.JointModelPY, "z": pin.JointModelPZ}
    native = {**prismatic, "rx": pin.JointModelRX, "ry": pin.JointModelRY, "rz": pin.JointModelRZ}
    for i, (kind, parent) in enumerate(zip(kinds, parents, strict=True)):
        mass, centre, a = rng.uniform(0.5, 2), rng.normal(size=3) * 0.3, rng.normal(size=(3, 3))
        moments = (np.trace(a @ a.T) + 0.1) * np.eye(3) - a @ a.T  # of points at the rows of a
        bodies.append(Body(f"b{i}", inertia(mass, moments, centre)))
        at = sp.exp(rng.normal(size=6)), sp.exp(rng.normal(size=6))
        joints.append(Joint(f"j{i}", kind, "ground" if parent < 0 else f"b{parent}", f"b{i}", at[0], at[1]))
        link, pose = placed[parent]
        pose = pose * pin.SE3(at[0])
        for name, _ in SCREWS[kind]:
            link = model.addJoint(link, native[name](), pose, f"j{i}.{name}")
            pose = pin.SE3.Identity()
        pose = pose * pin.SE3(sp.inverse(at[1]))
        placed[i] = (link, pose)
        model.appendBodyToJoint(link, pin.Inertia(mass, centre, moments), pose)
    return compile_tree(Mechanism(tuple(bodies), tuple(joints), gravity=tuple(gravity))), model


@settings(max_examples=40)
@given(trees())
def test_every_stage_of_a_random_tree(tree_data) -> None:
    kinds, parents, seed = tree_data
    rng = np.random.default_rng(seed)
    tree, model = build(kinds, parents, rng)
    order = np.array([model.joints[model.getJointId(c)].idx_v for c in tree.coordinates])
    n = len(order)
    q, v, a = rng.normal(size=(3, n))

    def theirs(x: np.ndarray) -> np.ndarray:
        out = np.zeros(n)
        out[order] = x
        return out

    data = model.createData()
    pin.computeRNEADerivatives(model, data, theirs(q), theirs(v), theirs(a))
    dq, dv, tau = data.dtau_dq.copy(), data.dtau_dv.copy(), data.tau.copy()
    mass = np.triu(pin.crba(model, data, theirs(q)))
    mass = mass + np.triu(mass, 1).T
    bias = pin.nonLinearEffects(model, data, theirs(q), theirs(v))

    k = kinematics(tree, q, v, a)
    c = dynamics.cartesian(tree, k)
    M, C, K = dynamics.tangent(tree, k, c)
    at_rest = kinematics(tree, q, v, np.zeros(n))
    minus_q_star = dynamics.unbalanced(tree, at_rest, dynamics.cartesian(tree, at_rest), q, v)
    pick = np.ix_(order, order)
    for name, actual, other, tolerance in (
        ("M*", M, mass[pick], 1e-12),
        ("Q*", -minus_q_star, -bias[order], 1e-12),
        ("τ", dynamics.unbalanced(tree, k, c, q, v), tau[order], 1e-12),
        ("∂τ/∂q", K, dq[pick], 1e-9),
        ("∂τ/∂v", C, dv[pick], 1e-9),
    ):
        assert np.abs(actual - other).max() <= tolerance * np.abs(other).max(), name


@settings(max_examples=10)
@given(trees())
def test_b_matrix_is_the_frames_jacobian(tree_data) -> None:
    """B of every body against Pinocchio's joint Jacobians, and Y = B v."""
    kinds, parents, seed = tree_data
    rng = np.random.default_rng(seed)
    tree, model = build(kinds, parents, rng)
    order = np.array([model.joints[model.getJointId(c)].idx_v for c in tree.coordinates])
    q, v = rng.normal(size=(2, len(order)))
    data, expected = model.createData(), np.zeros(len(order))
    expected[order] = q
    pin.computeJointJacobians(model, data, expected)
    k = kinematics(tree, q, v, np.zeros_like(v))
    for i, link in enumerate(tree.link):
        joint = model.getJointId(tree.coordinates[link])
        J = pin.getJointJacobian(model, data, joint, pin.ReferenceFrame.WORLD)[:, order]
        np.testing.assert_allclose(k.B[i], J, atol=1e-12)
        np.testing.assert_allclose(k.Y[i], J @ v, atol=1e-11)
