"""Closed loops against Exudyn, stage by stage: matrices of the tree, loop directions, reactions, reduced matrices, modes.

Exudyn closes a loop with the joint's own locked axes; core welds the body to a copy beyond the joint. Same mechanisms, other
algebra and other code for everything after the description.
"""

from dataclasses import replace
from typing import cast

import numpy as np
import pytest
import scipy.linalg
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from southwell import multibody as mb
from southwell.core.multibody import dynamics
from southwell.core.multibody import linearize as lz
from southwell.core.multibody.joints import SCREWS, Kind
from southwell.core.multibody.kinematics import kinematics
from southwell.core.multibody.tree import compile_tree
from southwell.core.space import spatial as sp
from southwell.references.exudyn import mechanism as em
from southwell.references.exudyn.loops import system
from southwell.references.protocol.interface import CodeError

pytestmark = pytest.mark.skipif(em.CODE.version() is None, reason=f"not installed: {em.CODE.hint}")

G = 9.81


def compare(mechanism: mb.Mechanism, guess: dict[str, float]) -> tuple[lz.Linearization, em.Stages]:
    """Every stage of both, K̂ to 1e-9, for Exudyn has it by differences; returns both for more."""
    linear = lz.linearize(mechanism, guess)
    tree, state = linear.tree, linear.state
    n = em.own_coordinates(tree)
    np.testing.assert_allclose(em.linearize(tree, guess).q, state.q[:n], atol=1e-9)
    theirs = em.stages(tree, system(tree), state.q[:n])

    def near(name: str, ours: np.ndarray, other: np.ndarray, tolerance: float, size: float = 0.0) -> None:
        scale = max(float(np.abs(ours).max(initial=0.0)), size)
        assert np.abs(ours - other).max(initial=0.0) <= tolerance * scale, (name, ours, other)

    # the tree, before any loop
    k = state.kinematics
    opened = dynamics.cartesian(tree, k)
    M, C, K = (a[:n, :n] for a in dynamics.tangent(tree, k, opened))
    near("M*", M, theirs.M, 1e-13)
    near("C*", C, theirs.C, 1e-11, float(np.abs(M).max()))
    near("K*", K, theirs.K, 1e-9, float(np.abs(linear.K).max()))
    # what the loops leave free
    null, part = theirs.null, linear.partition
    ours = scipy.linalg.orth(part.R[np.isin(part.free, np.arange(n))])
    assert null.shape == ours.shape
    assert scipy.linalg.subspace_angles(null, ours).max(initial=0.0) < 1e-8
    # reactions, as generalised forces on the free coordinates
    free = theirs.free
    needed = dynamics.unbalanced(tree, k, opened, state.q, state.v)[free]
    near("Jλ", needed, (theirs.J @ theirs.multipliers)[free], 1e-11, 1.0)
    # reduced to the same independent coordinates
    order = cast(tuple[np.ndarray, np.ndarray], scipy.linalg.qr(null.T, pivoting=True, mode="r"))[1]
    chosen = np.sort(order[: null.shape[1]])
    names = tuple(tree.coordinates[free[j]] for j in chosen)
    again = lz.about(tree, state, names)
    reduced = theirs.reduced(null @ np.linalg.inv(null[chosen]))
    for name, a, b, tolerance in zip(
        ("M̂", "Ĉ", "K̂"), (again.M, again.C, again.K), reduced, (1e-12, 1e-11, 1e-9), strict=True
    ):
        near(name, a, b, tolerance, float(np.abs(again.M).max()))
    # and modes
    found, answer = mb.solve(mechanism, guess), em.CODE.solve_mechanism(mechanism, guess)
    largest = np.abs(found.values).max()
    np.testing.assert_allclose(np.abs(answer.values), found.frequencies, rtol=1e-9, atol=1e-9 * largest)
    return linear, theirs


def bar(name: str, length: float, mass: float) -> mb.Body:
    across = mass * length**2 / 12
    return mb.Body(name, mb.inertia(mass, (0.01 * across, across, across), (length / 2, 0, 0)))


def four_bar(cut: str = "") -> mb.Mechanism:
    """Crank 1, coupler 3, rocker 2, ground 3; y is up; three times overdetermined in space."""
    joints = (
        mb.Joint("A", "revolute", "ground", "crank"),
        mb.Joint("B", "revolute", "crank", "coupler", mb.at(1.0)),
        mb.Joint("C", "revolute", "coupler", "rocker", mb.at(3.0), mb.at(2.0)),
        mb.Joint("D", "revolute", "ground", "rocker", mb.at(3.0)),
    )
    return mb.Mechanism(
        (bar("crank", 1, 2.0), bar("coupler", 3, 3.0), bar("rocker", 2, 1.0)),
        tuple(replace(j, cut=j.name == cut) for j in joints),
        coordinate_springs=(mb.CoordinateSpring("A.rz", 80.0, 3.0, 1.0),),
        gravity=(0, -3.0, 0),
    )


FOUR = {"A.rz": 0.9, "B.rz": -0.32, "C.rz": 1.34, "D.rz": 1.92}


@pytest.mark.parametrize("cut", ["B", "C", "D"])
def test_four_bar(cut: str) -> None:
    linear, _ = compare(four_bar(cut), FOUR)
    assert len(linear.partition.redundant) == 3


def test_driven_slider_crank_with_a_damped_spring_between_points() -> None:
    """The whole turns on a table about the vertical; the slider is pulled by a damped spring fixed to the table."""
    m = mb.Mechanism(
        (mb.Body("table"), bar("crank", 0.5, 3.0), bar("rod", 2.0, 2.0), mb.Body("slider", mb.inertia(5.0, 0.1))),
        (
            mb.Joint("turn", "revolute", "ground", "table", mb.at(axis="y"), mb.at(axis="y")),
            mb.Joint("O", "revolute", "table", "crank"),
            mb.Joint("P", "revolute", "crank", "rod", mb.at(0.5)),
            mb.Joint("Q", "revolute", "rod", "slider", mb.at(2.0)),
            mb.Joint("guide", "prismatic", "table", "slider", mb.at(axis="x"), mb.at(axis="x"), cut=True),
        ),
        (mb.Motion("turn.rz", 0.0, 1.2),),
        springs=(mb.Spring("table", "slider", np.array([1.0, 0.3, 0]), np.array([0.1, 0, 0.2]), 60.0, 4.0, 0.5),),
        gravity=(0, -G, 0),
    )
    linear, _ = compare(m, {"O.rz": 0.8, "P.rz": -0.98, "Q.rz": 0.18, "guide.z": 2.3})
    assert linear.names


def test_spatial_loop_on_a_turning_hub() -> None:
    """Revolute, ball, ball, revolute (the rod's spin held by a universal joint across it): nothing lies in one plane."""
    swept, lifted = (
        mb.at(0.2, 1.0, 0.3, axis=np.array([0.2, 1.0, 0.4])),
        mb.at(0.1, 0, 0, axis=np.array([1.0, 0.1, 0.3])),
    )
    m = mb.Mechanism(
        (mb.Body("hub"), bar("crank", 0.6, 1.0), bar("rod", 1.2, 0.7), bar("rocker", 0.8, 1.5)),
        (
            mb.Joint("shaft", "revolute", "ground", "hub"),
            mb.Joint("in", "revolute", "hub", "crank", lifted),
            mb.Joint("ball", "spherical", "crank", "rod", mb.at(0.6)),
            mb.Joint("out", "revolute", "hub", "rocker", swept),
            mb.Joint("cardan", "universal", "rod", "rocker", mb.at(1.2, axis="x"), mb.at(0.8, axis="y"), cut=True),
        ),
        (mb.Motion("shaft.rz", 0.3, 5.0),),
        coordinate_springs=(
            mb.CoordinateSpring("in.rz", 30.0, 0.4, 0.3),
            mb.CoordinateSpring("out.rz", 20.0, 0.0, 0.5),
        ),
        gravity=(0.0, 0, -G),
    )
    guess = {"shaft.rz": 0.3, "in.rz": 0.7, "ball.rx": -0.3, "ball.ry": -1.7, "ball.rz": -1.3, "out.rz": 0.8}
    compare(m, {**guess, "cardan.rx": -0.4, "cardan.ry": -1.5})


KINDS: list[Kind] = ["revolute", "prismatic", "cylindrical", "universal", "spherical", "planar"]
LOOPS: list[Kind] = ["revolute", "cylindrical", "universal", "spherical", "planar", "prismatic"]


@settings(max_examples=25)
@given(
    kinds=st.lists(st.sampled_from(KINDS), min_size=3, max_size=5),
    loop=st.sampled_from(LOOPS),
    turned=st.lists(st.booleans(), min_size=5, max_size=5),
    seed=st.integers(0, 2**31),
)
def test_random_loops_on_a_turning_hub(kinds: list[Kind], loop: Kind, turned: list[bool], seed: int) -> None:
    """A chain with joints of any kind, some given from child to parent, whose end is tied to the hub or to its first body."""
    freedoms = sum(len(SCREWS[k]) for k in kinds) - (6 - len(SCREWS[loop]))
    assume(1 <= freedoms <= 6)
    rng = np.random.default_rng(seed)
    bodies, joints, springs, guess = [mb.Body("hub")], [mb.Joint("hub", "revolute", "ground", "hub")], [], {}
    for i, (kind, reverse) in enumerate(zip(kinds, turned, strict=False)):
        a = rng.normal(size=(3, 3)) * 0.3
        bodies.append(
            mb.Body(
                f"b{i}",
                mb.inertia(
                    rng.uniform(0.5, 2), (np.trace(a @ a.T) + 0.1) * np.eye(3) - a @ a.T, rng.normal(size=3) * 0.2
                ),
            )
        )
        ends = ("hub" if i == 0 else f"b{i - 1}", f"b{i}")
        frames = sp.exp(rng.normal(size=(2, 6)) * 0.6)
        near, far = ends[::-1] if reverse else ends
        joints.append(mb.Joint(f"j{i}", kind, near, far, frames[0], frames[1]))
        for name, _ in SCREWS[kind]:
            guess[f"j{i}.{name}"] = float(rng.normal() * 0.3)
            springs.append(
                mb.CoordinateSpring(f"j{i}.{name}", rng.uniform(200, 400), rng.uniform(0, 2), guess[f"j{i}.{name}"])
            )
    gravity = (0.0, 0.0, float(rng.normal() * 2))  # along the hub's axis, or the equations would be periodic
    hub = (mb.Motion("hub.rz", 0.0, 2.0),)
    chain = compile_tree(mb.Mechanism(tuple(bodies), tuple(joints), hub))
    q = np.array([guess.get(c, 0.0) for c in chain.coordinates])
    poses = kinematics(chain, q, 0 * q, 0 * q).poses
    start, end = ("hub", "b0")[int(rng.integers(2))], f"b{len(kinds) - 1}"
    place = sp.exp(rng.normal(size=6) * 0.5)
    ends = [sp.inverse(poses[chain.body(name)]) @ place for name in (start, end)]
    joints.append(mb.Joint("loop", loop, start, end, ends[0], ends[1], cut=True))
    m = mb.Mechanism(tuple(bodies), tuple(joints), hub, tuple(springs), gravity=gravity)
    try:
        lz.linearize(m, guess)
    except mb.MechanismError:
        assume(False)
    compare(m, guess)


def test_a_pendulum_on_a_loop_joint_is_stiff_by_the_constraints_curvature_alone() -> None:
    """A bar free in a plane and pinned to the ground: ω² = m g l/(I + m l²); its tree has no stiffness at all."""
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
    _, theirs = compare(m, guess)
    answer = em.CODE.solve_mechanism(m, guess)
    assert np.abs(answer.values[0]) == pytest.approx(np.sqrt(mass * G * arm / (moment + mass * arm**2)), rel=1e-9)
    assert np.abs(theirs.K).max() < 1e-9 * theirs.curvature.max()


REFUSED = [
    (lambda m: replace(m, beams=(mb.Beam("crank", "rocker", mb.bushing(np.eye(4), np.eye(6))),)), "beams or bushings"),
    (lambda m: replace(m, coordinate_springs=(mb.CoordinateSpring("C.rz", 1.0),)), r"C\.rz.*cut another joint"),
    (lambda m: replace(m, motions=(mb.Motion("A.rz", 0.9, 0.0, 1.0),)), "accelerating"),
]


@pytest.mark.parametrize(("change", "match"), REFUSED, ids=[match for _, match in REFUSED])
def test_what_it_cannot_do_is_refused_with_a_reason(change, match: str) -> None:
    m = change(four_bar("C"))
    reason = em.CODE.unsupported_mechanism(m)
    assert reason
    with pytest.raises(CodeError, match=match):
        em.CODE.solve_mechanism(m, FOUR)


def test_loops_that_move_are_refused() -> None:
    m = replace(four_bar("C"), motions=(mb.Motion("A.rz", 0.9, 1.0),))
    with pytest.raises(CodeError, match="loops move"):
        em.CODE.solve_mechanism(m, FOUR)


def test_a_periodic_mechanism_is_refused_by_its_own_matrices() -> None:
    """Ground resonance: the blade's inertia seen from the support turns with the rotor."""
    m = mb.Mechanism(
        (mb.Body("slide", mb.inertia(20.0)), mb.Body("rotor", mb.inertia(2.0, 0.1)), bar("blade", 1.0, 3.0)),
        (
            mb.Joint("X", "prismatic", "ground", "slide", mb.at(axis="x"), mb.at(axis="x")),
            mb.Joint("shaft", "revolute", "slide", "rotor"),
            mb.Joint("lag", "revolute", "rotor", "blade", mb.at(0.3)),
        ),
        (mb.Motion("shaft.rz", rate=5.0),),
        (mb.CoordinateSpring("X.z", 800.0), mb.CoordinateSpring("lag.rz", 20.0)),
    )
    tree = compile_tree(m)
    at_rest = em.stages(tree, system(tree), np.zeros(3))
    with pytest.raises(CodeError, match="periodic"):
        em._check_constant(tree, at_rest)
    with pytest.raises(mb.MechanismError, match=r"shaft\.rz.*periodic"):
        mb.solve(m)


def test_no_steady_state_is_an_error() -> None:
    slide = mb.Mechanism(
        (mb.Body("mass", mb.inertia(1.0, 0.1)),), (mb.Joint("rail", "prismatic", "ground", "mass"),), gravity=(0, 0, -G)
    )
    with pytest.raises(CodeError, match="no steady state"):
        em.CODE.solve_mechanism(slide, {})
