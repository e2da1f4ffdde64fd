"""Closed loops against Exudyn, stage by stage: matrices of the tree, loop directions, reactions, reduced matrices,
modes.

Exudyn closes a loop with the locked axes of the joint; core welds the body to a copy beyond the joint. The mechanisms
are the same; algebra and code are different for everything after the description.
"""

from dataclasses import replace
from typing import cast

import numpy as np
import pytest
import scipy.linalg
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from southwell import multibody as mb
from southwell.core.mechanism.joints import SCREWS, Kind
from southwell.core.spectrum import modal
from southwell.core.tree import dynamics
from southwell.references.exudyn import mechanism as em
from southwell.references.matrices import null_space
from southwell.references.protocol.interface import CodeError
from southwell.tests.support.linkages import (
    FOUR,
    KINDS,
    LOOPS,
    G,
    falling,
    four_bar,
    ground_resonance,
    random_loop,
    slider_crank,
    spatial_loop,
)

Array = np.ndarray

pytestmark = pytest.mark.skipif(em.CODE.version() is None, reason=f"not installed: {em.CODE.hint}")


def assert_agreement(
    mechanism: mb.Mechanism, guess: dict[str, float]
) -> tuple[modal.Linearization, em.ExudynTangent, Array]:
    """Compare every stage, K̂ to 1e-9 because Exudyn computes it by differences; return the linearisation, Exudyn's matrices and
    reactions."""
    linear = modal.linearize(mechanism, guess)
    tree, state = linear.tree, linear.state
    model = em.ExudynModel(mechanism)
    n, steady = len(model.names), null_space.linearize(model, guess)
    np.testing.assert_allclose(steady.q, state.q[:n], atol=1e-9)
    expected, free = model.at(state.q[:n]), steady.free
    multipliers = np.linalg.lstsq(expected.J[:, free].T, expected.force[free], rcond=1e-9)[0]

    def near(name: str, actual: np.ndarray, other: np.ndarray, tolerance: float, size: float = 0.0) -> None:
        scale = max(float(np.abs(actual).max(initial=0.0)), size)
        assert np.abs(actual - other).max(initial=0.0) <= tolerance * scale, (name, actual, other)

    # the tree, before any loop
    k = state.kinematics
    opened = dynamics.cartesian(tree, k)
    M, C, K = (a[:n, :n] for a in dynamics.tangent(tree, k, opened))
    near("M*", M, expected.M, 1e-13)
    near("C*", C, expected.C, 1e-11, float(np.abs(M).max()))
    near("K*", K, expected.K, 1e-9, float(np.abs(linear.K).max()))
    # the null space of the loops
    null, part = null_space.null_space(expected.J[:, free]), linear.partition
    own = scipy.linalg.orth(part.R[np.isin(part.free, np.arange(n))])
    assert null.shape == own.shape
    assert scipy.linalg.subspace_angles(null, own).max(initial=0.0) < 1e-8
    # reactions, as generalised forces on the free coordinates
    needed = dynamics.unbalanced(tree, k, opened, state.q, state.v)[free]
    near("Jλ", needed, (multipliers @ expected.J)[free], 1e-11, 1.0)
    # reduced to the same independent coordinates
    order = cast(tuple[np.ndarray, np.ndarray], scipy.linalg.qr(null.T, pivoting=True, mode="r"))[1]
    chosen = np.sort(order[: null.shape[1]])
    names = tuple(tree.coordinates[free[j]] for j in chosen)
    second = modal.about(tree, state, names)
    reduced = null_space.along(expected, free, null @ np.linalg.inv(null[chosen]))
    for name, a, b, tolerance in zip(
        ("M̂", "Ĉ", "K̂"), (second.M, second.C, second.K), reduced, (1e-12, 1e-11, 1e-9), strict=True
    ):
        near(name, a, b, tolerance, float(np.abs(second.M).max()))
    # and modes
    solution, answer = mb.solve(mechanism, guess), em.CODE.solve_mechanism(mechanism, guess)
    largest = np.abs(solution.values).max()
    np.testing.assert_allclose(np.abs(answer.values), solution.frequencies, rtol=1e-9, atol=1e-9 * largest)
    return linear, expected, multipliers


@pytest.mark.parametrize("cut", ["B", "C", "D"])
def test_four_bar(cut: str) -> None:
    linear, *_ = assert_agreement(four_bar(cut), FOUR)
    assert len(linear.partition.redundant) == 3


@pytest.mark.slow
def test_driven_slider_crank_with_a_damped_spring_between_points() -> None:
    linear, *_ = assert_agreement(*slider_crank())
    assert linear.names


def test_spatial_loop_on_a_rotating_hub() -> None:
    assert_agreement(*spatial_loop())


@pytest.mark.nightly
@settings(max_examples=25)
@given(
    kinds=st.lists(st.sampled_from(KINDS), min_size=3, max_size=5),
    loop=st.sampled_from(LOOPS),
    turned=st.lists(st.booleans(), min_size=5, max_size=5),
    seed=st.integers(0, 2**31),
)
def test_random_loops_on_a_rotating_hub(kinds: list[Kind], loop: Kind, turned: list[bool], seed: int) -> None:
    """A chain with joints of any kind, some given from child to parent, whose end is joined to the hub or to its first body."""
    freedoms = sum(len(SCREWS[k]) for k in kinds) - (6 - len(SCREWS[loop]))
    assume(1 <= freedoms <= 6)
    m, guess = random_loop(kinds, loop, turned, seed)
    try:
        modal.linearize(m, guess)
    except mb.MechanismError:
        assume(False)
    assert_agreement(m, guess)


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
    guess = {"plane.x": 0.1, "plane.rz": 0.1}
    _, expected, multipliers = assert_agreement(m, guess)
    answer = em.CODE.solve_mechanism(m, guess)
    assert np.abs(answer.values[0]) == pytest.approx(np.sqrt(mass * G * arm / (moment + mass * arm**2)), rel=1e-9)
    assert np.abs(expected.K).max() < 1e-9 * expected.curvature(multipliers).max()


REFUSED = [
    (lambda m: replace(m, beams=(mb.Beam("crank", "rocker", mb.bushing(np.eye(4), np.eye(6))),)), "beams or bushings"),
    (lambda m: replace(m, coordinate_springs=(mb.CoordinateSpring("C.rz", 1.0),)), r"C\.rz.*cut another joint"),
    (lambda m: replace(m, motions=(mb.Motion("A.rz", 0.9, 0.0, 1.0),)), "accelerating"),
]


@pytest.mark.parametrize(("change", "match"), REFUSED, ids=[match for _, match in REFUSED])
def test_an_unsupported_mechanism_is_declined_with_a_reason(change, match: str) -> None:
    m = change(four_bar("C"))
    reason = em.CODE.unsupported_mechanism(m)
    assert reason
    with pytest.raises(CodeError, match=match):
        em.CODE.solve_mechanism(m, FOUR)


def test_moving_loops_are_an_error() -> None:
    m = replace(four_bar("C"), motions=(mb.Motion("A.rz", 0.9, 1.0),))
    with pytest.raises(CodeError, match="loops move"):
        em.CODE.solve_mechanism(m, FOUR)


def test_a_periodic_mechanism_is_detected_from_its_matrices() -> None:
    m = ground_resonance()
    with pytest.raises(CodeError, match="periodic"):
        em.CODE.solve_mechanism(m, {})
    with pytest.raises(mb.MechanismError, match=r"shaft\.rz.*vary with time"):
        mb.solve(m)


def test_no_steady_state_is_an_error() -> None:
    with pytest.raises(CodeError, match="no steady state"):
        em.CODE.solve_mechanism(falling(), {})
