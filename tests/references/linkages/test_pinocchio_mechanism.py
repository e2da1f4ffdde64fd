"""Closed loops in Pinocchio against core, with other trees and closures, and its parts against differences."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from southwell import multibody as mb
from southwell.core.mechanism.description import Load
from southwell.core.mechanism.joints import SCREWS, Kind
from southwell.core.rank import ranked
from southwell.core.tree.spanning import compile_tree
from southwell.references.linkages import mechanism as lm
from southwell.references.linkages.pinocchio_tree import PinocchioTree
from southwell.references.linkages.spanning import AXES, spanning
from southwell.references.matrices import null_space
from southwell.references.protocol.interface import CodeError
from southwell.tests.support.linkages import (
    FOUR,
    KINDS,
    LOOPS,
    G,
    bar,
    falling,
    four_bar,
    ground_resonance,
    random_loop,
    slider_crank,
    spatial_loop,
)

pytestmark = pytest.mark.skipif(lm.CODE.version() is None, reason=f"not installed: {lm.CODE.hint}")


def assert_agreement(mechanism: mb.Mechanism, guess: dict[str, float]) -> null_space.Linearized:
    """Compare steady state, eigenvalues with damping, and shapes; return the adapter's equations."""
    solution, answer = mb.solve(mechanism, guess), lm.CODE.solve_mechanism(mechanism, guess)
    own = [solution.coordinates.index(name) for name in answer.coordinates]
    np.testing.assert_allclose(answer.steady, solution.linear.state.q[own], atol=1e-10)
    largest = float(np.abs(solution.values).max())
    assert len(answer.values) == len(solution.values)
    for value, shape in zip(answer.values, answer.shapes, strict=True):
        k = int(np.abs(solution.values - value).argmin())
        assert abs(solution.values[k] - value) < 1e-9 * largest
        near = np.abs(solution.values - value) < 1e-3 * largest
        if near.sum() == 1:
            expected = solution.shapes[k, own]
            mac = abs(np.vdot(expected, shape)) ** 2 / (np.vdot(expected, expected) * np.vdot(shape, shape)).real
            assert mac > 1 - 1e-6
    return null_space.linearize(PinocchioTree(mechanism), guess)


@pytest.mark.parametrize("cut", ["", "B", "C", "D"])
def test_four_bar(cut: str) -> None:
    assert assert_agreement(four_bar(cut), FOUR).null.shape[1] == 1


def test_slider_crank_with_a_damped_spring_between_points() -> None:
    assert_agreement(*slider_crank())


def test_spatial_loop_on_a_rotating_hub() -> None:
    assert_agreement(*spatial_loop())


def test_a_pendulum_on_a_loop_joint_has_only_the_stiffness_of_constraint_curvature() -> None:
    """A bar free in a plane and pinned to the ground: ω² = m g l/(I + m l²); the tree has no stiffness."""
    mass, arm, moment = 4.0, 0.8, 0.5
    m = mb.Mechanism(
        (mb.Body("bar", mb.inertia(mass, moment)),),
        (
            mb.Joint("plane", "planar", "ground", "bar"),
            mb.Joint("pin", "revolute", "ground", "bar", mb.at(y=arm), mb.at(y=arm), cut=True),
        ),
        gravity=(0, -G, 0),
    )
    answer = lm.CODE.solve_mechanism(m, {"plane.x": 0.1, "plane.rz": 0.1})
    assert abs(answer.values[0]) == pytest.approx(np.sqrt(mass * G * arm / (moment + mass * arm**2)), rel=1e-12)


@pytest.mark.slow
@settings(max_examples=25)
@given(
    kinds=st.lists(st.sampled_from(KINDS), min_size=3, max_size=5),
    loop=st.sampled_from(LOOPS),
    turned=st.lists(st.booleans(), min_size=5, max_size=5),
    seed=st.integers(0, 2**31),
)
def test_random_loops_on_a_rotating_hub(kinds: list[Kind], loop: Kind, turned: list[bool], seed: int) -> None:
    """With a spring between points of hub and last body, and a load on that body that rotates with the hub."""
    assume(1 <= sum(len(SCREWS[k]) for k in kinds) - (6 - len(SCREWS[loop])) <= 6)
    m, guess = random_loop(kinds, loop, turned, seed)
    rng = np.random.default_rng(seed + 1)
    last = f"b{len(kinds) - 1}"
    spring = mb.Spring("hub", last, rng.normal(size=3), rng.normal(size=3), 20.0, 0.5, 0.7)
    m = replace(m, springs=(spring,), loads=(Load(last, rng.normal(size=3), "hub"),))
    try:
        solution = mb.solve(m, guess)
    except mb.MechanismError:
        assume(False)
        return
    state = solution.linear.state
    assert_agreement(m, dict(zip(solution.linear.tree.coordinates, state.q.tolist(), strict=True)))


def every_element() -> tuple[PinocchioTree, np.ndarray]:
    """A mechanism with a loop of every kind, a spring between points and a load, at a configuration where no term vanishes."""
    rng = np.random.default_rng(3)
    m, _ = random_loop(["spherical", "cylindrical", "universal"], "revolute", [False, True, False, False, False], 5)
    loops = []
    for k, kind in enumerate(AXES):
        ends = [mb.at(*rng.normal(size=3), axis=rng.normal(size=3)) for _ in range(2)]
        loops.append(mb.Joint(f"loop {k}", kind, "b0", "b2", ends[0], ends[1], cut=True))  # type: ignore[arg-type]
    spring = mb.Spring("hub", "b2", rng.normal(size=3), rng.normal(size=3), 20.0, 3.0, 0.7)
    m = replace(
        m, joints=(*m.joints[:-1], *loops), springs=(spring,), loads=(Load("b2", rng.normal(size=3), "ground"),)
    )
    model = PinocchioTree(m)
    return model, rng.normal(size=len(model.rates))


def test_every_derivative_agrees_with_differences() -> None:
    model, q = every_element()
    here, h = model.at(q), 1e-5
    assert len(here.loops) == 6 + 5 + 5 + 4 + 4 + 3 + 3
    for k, e in enumerate(h * np.eye(len(q))):
        up, down = model.at(q + e), model.at(q - e)
        np.testing.assert_allclose((up.force - down.force) / (2 * h), here.K[:, k], atol=1e-7, err_msg=f"K {k}")
        for i, (f, a, b) in enumerate(zip(here.loops, up.loops, down.loops, strict=True)):
            np.testing.assert_allclose((a.value - b.value) / (2 * h), f.gradient[k], atol=1e-8, err_msg=f"{i}")
            np.testing.assert_allclose((a.gradient - b.gradient) / (2 * h), f.hessian[:, k], atol=1e-8, err_msg=f"{i}")
        rates = model.rates.copy()
        forces = []
        for sign in (1, -1):
            model.rates = rates + sign * e
            forces.append(model.at(q).force)
        model.rates = rates
        np.testing.assert_allclose((forces[0] - forces[1]) / (2 * h), here.C[:, k], atol=1e-7, err_msg=f"C {k}")
    for f in here.loops:
        np.testing.assert_allclose(f.hessian, f.hessian.T, atol=1e-12)


@pytest.mark.parametrize("kind", AXES)
def test_a_loop_joint_leaves_only_its_coordinates_free(kind: Kind) -> None:
    """A free body is joined to the ground by the loop joint; only the coordinates of that joint remain free."""
    frames = [
        mb.at(0.3, -0.2, 0.5, axis=np.array([1.0, 2.0, 0.5])),
        mb.at(0.1, 0.4, 0, axis=np.array([0.2, 1.0, -1.0])),
    ]
    tied = mb.Mechanism((mb.Body("b"),), (mb.Joint("j", kind, "ground", "b", frames[0], frames[1]),))
    tree = PinocchioTree(tied)
    at = np.linspace(0.2, 0.7, len(tree.rates))
    pose = np.eye(4)
    for link, value in zip(tree.tree.links, at, strict=True):
        pose = pose @ link.frame @ np.array(mb.at()) @ _moved(link.axis, link.turns, value)
    pose = pose @ (tree.tree.bodies["b"][1] if len(at) else frames[0] @ np.linalg.inv(frames[1]))
    loose = mb.Joint("loose", "free", "ground", "b", np.eye(4), np.asarray(np.linalg.inv(pose), float))
    model = PinocchioTree(replace(tied, joints=(loose, replace(tied.joints[0], cut=True))))
    here = model.at(np.zeros(6))
    np.testing.assert_allclose([f.value for f in here.loops], 0.0, atol=1e-12)
    assert not here.misclosed()
    assert ranked(here.J).null.shape[1] == len(AXES[kind].split())


def _moved(axis: np.ndarray, turns: bool, value: float) -> np.ndarray:
    out = np.eye(4)
    if turns:
        k = np.cross(np.eye(3), axis)
        out[:3, :3] = np.eye(3) - np.sin(value) * k + (1 - np.cos(value)) * k @ k
    else:
        out[:3, 3] = value * axis
    return out


def test_joints_with_springs_and_motions_are_in_the_tree_and_cut_joints_are_not() -> None:
    m = four_bar("A")  # its spring is on A
    assert [j.name for j in spanning(m).loops] != ["A"]
    assert [j.name for j in spanning(replace(m, coordinate_springs=())).loops] == ["A"]
    assert compile_tree(m).weld_names == ("A",)
    assert_agreement(m, FOUR)


def test_a_joint_closed_with_opposed_axes_is_an_error() -> None:
    m = mb.Mechanism(
        (bar("one", 1.0, 1.0), bar("two", 1.0, 1.0)),
        (
            mb.Joint("A", "spherical", "ground", "one"),
            mb.Joint("B", "spherical", "one", "two", mb.at(1.0)),
            mb.Joint("C", "revolute", "ground", "two", mb.at(1.0, 1.0), mb.at(1.0), cut=True),
        ),
        coordinate_springs=tuple(mb.CoordinateSpring(f"{j}.{c}", 1e-3) for j in "AB" for c in ("rx", "ry", "rz")),
    )
    guess = {"A.rx": np.pi, "B.rz": -np.pi / 2}
    with pytest.raises(CodeError, match=r"'C' closes with opposed axes|no steady state"):
        lm.CODE.solve_mechanism(m, guess)


REFUSED = [
    (lambda m: replace(m, beams=(mb.Beam("crank", "rocker", mb.bushing(np.eye(4), np.eye(6))),)), "beams or bushings"),
    (
        lambda m: replace(m, coordinate_springs=tuple(mb.CoordinateSpring(f"{j}.rz", 1.0) for j in "ABCD")),
        "every joint",
    ),
    (lambda m: replace(m, motions=(mb.Motion("A.rz", 0.9, 0.0, 1.0),)), "accelerating"),
    (lambda m: replace(m, joints=m.joints[1:3]), "no joint connects it"),
]


@pytest.mark.parametrize(("change", "match"), REFUSED, ids=[match for _, match in REFUSED])
def test_an_unsupported_mechanism_is_declined_with_a_reason(change, match: str) -> None:
    with pytest.raises(CodeError, match=match):
        lm.CODE.solve_mechanism(change(four_bar("C")), FOUR)


def test_moving_loops_are_an_error() -> None:
    m = replace(four_bar("C"), motions=(mb.Motion("A.rz", 0.9, 1.0),))
    with pytest.raises(CodeError, match="loops move"):
        lm.CODE.solve_mechanism(m, FOUR)


def test_a_periodic_mechanism_is_detected_from_its_matrices() -> None:
    m = ground_resonance()
    with pytest.raises(CodeError, match="periodic"):
        lm.CODE.solve_mechanism(m, {})


def test_no_steady_state_is_an_error() -> None:
    with pytest.raises(CodeError, match="no steady state"):
        lm.CODE.solve_mechanism(falling(), {})
