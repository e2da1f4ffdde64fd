"""Moving loops: tangents against difference quotients of the reduced equations, symmetry without dissipation, driving torques
against their power, and invalid input.
"""

from dataclasses import replace

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.core.space import spatial as sp
from southwell.core.spectrum import modal
from southwell.core.tree import dynamics, partition
from southwell.core.tree.kinematics import kinematics, poses, transformation
from southwell.core.tree.spanning import compile_tree
from southwell.tests.support.closed_forms.linkages import ring
from southwell.tests.support.five_bar import GUESS, bar, five_bar, undamped

pytestmark = pytest.mark.numerical


def reduced_residual(linear: modal.Linearization, dq: np.ndarray, dv: np.ndarray, da: np.ndarray) -> np.ndarray:
    """Rᵀτ of the exact equations with the independent coordinates moved: loops closed again, with rates and accelerations."""
    tree, state, part = linear.tree, linear.state, linear.partition
    q, v, a = state.q.copy(), state.v.copy(), state.a.copy()
    own_answer, others = part.independent, part.dependent
    q[own_answer] += dq
    for _ in range(30):
        x, J = poses(tree, q)
        gap = partition.misfit(tree, x)
        q[others] -= np.linalg.pinv(partition.jacobian(tree, transformation(tree, J))[:, others]) @ gap
    v[own_answer] += dv
    a[own_answer] += da
    v[others] = a[others] = 0.0
    k = kinematics(tree, q, v, a)
    J = partition.jacobian(tree, k.B)
    inverse = np.linalg.pinv(J[:, others])
    v[others] = -inverse @ J @ v
    k = kinematics(tree, q, v, a)
    a[others] = -inverse @ (J @ a + partition.jacobian(tree, k.B1) @ v)
    k = kinematics(tree, q, v, a)
    c = dynamics.cartesian(tree, k)
    names = tuple(tree.coordinates[j] for j in own_answer)
    R = partition.partition(tree, k, names).R
    return R.T @ dynamics.unbalanced(tree, k, c, q, v)[part.free]


def test_tangents_of_moving_loops_match_difference_quotients() -> None:
    """M̂, Ĉ, K̂ with Ṙ and R̈ in them, and the multipliers' curvature, against the exact equations moved a little."""
    linear = modal.linearize(five_bar(), GUESS)
    n = len(linear.M)
    assert n >= 2
    loop_rates = [linear.state.v[linear.tree.coordinate(c)] for c in ("B.rz", "C.rz", "D.ry")]
    assert np.abs(loop_rates).min() > 0.1
    zero, h = np.zeros(n), 1e-5
    assert np.abs(reduced_residual(linear, zero, zero, zero)).max() < 1e-9 * np.abs(linear.K).max()

    def slope(kind: int) -> np.ndarray:
        def at(step: np.ndarray) -> np.ndarray:
            moved = [zero, zero, zero]
            moved[kind] = step
            return reduced_residual(linear, *moved)

        return np.stack([(at(h * e) - at(-h * e)) / (2 * h) for e in np.eye(n)], axis=-1)

    for order, actual in enumerate((linear.K, linear.C, linear.M)):
        np.testing.assert_allclose(actual, slope(order), atol=1e-7 * np.abs(actual).max())


@pytest.mark.parametrize("cut", ["B", "D", "E"])
def test_moving_loops_do_not_depend_on_the_cut(cut: str) -> None:
    """Rates that the motions determine are the same wherever the loop is cut; so are all modes."""
    first = mb.solve(five_bar("C"), GUESS)
    guess = {name: value for name, value in first.steady.items() if not name.startswith("beam")}
    other = mb.solve(five_bar(cut), guess)
    np.testing.assert_allclose(other.values, first.values, rtol=1e-9)


def test_matrices_without_dissipation_are_symmetric_or_skew() -> None:
    """A spatial loop that turns steadily, without dampers: M̂ and K̂ symmetric, Ĉ skew and not zero."""
    m = undamped()
    linear = modal.linearize(m, GUESS)
    assert len(linear.M) >= 3
    for a, sign in ((linear.M, 1), (linear.K, 1), (linear.C, -1)):
        assert np.abs(a - sign * a.T).max() < 1e-11 * np.abs(a).max()
    assert np.abs(linear.C).max() > 1e-2


@pytest.mark.parametrize("theta", [0.4, 1.3, 2.6])
def test_torque_that_drives_a_slider_crank(theta: float) -> None:
    """Constant rate ω, massless links: the torque's power is that of the slider, T ω = m a v, by trigonometry."""
    r, rod, mass, omega = 0.4, 1.1, 3.0, 5.0
    m = mb.Mechanism(
        (mb.Body("crank"), mb.Body("rod"), mb.Body("slider", mb.inertia(mass))),
        (
            mb.Joint("O", "revolute", "ground", "crank"),
            mb.Joint("P", "revolute", "crank", "rod", mb.at(r)),
            mb.Joint("Q", "revolute", "rod", "slider", mb.at(rod)),
            mb.Joint("guide", "prismatic", "ground", "slider", mb.at(axis="x"), mb.at(axis="x"), cut=True),
        ),
        (mb.Motion("O.rz", theta, omega),),
    )
    phi = float(np.arcsin(r / rod * np.sin(theta)))
    linear = modal.linearize(
        m, {"O.rz": theta, "P.rz": -theta - phi, "Q.rz": phi, "guide.z": r * np.cos(theta) + rod * np.cos(phi)}
    )
    rate = r * np.cos(theta) / (rod * np.cos(phi)) * omega
    turn = (rate**2 * np.sin(phi) - r / rod * omega**2 * np.sin(theta)) / np.cos(phi)  # φ̈
    v = -r * omega * np.sin(theta) - rod * rate * np.sin(phi)
    a = -r * omega**2 * np.cos(theta) - rod * (turn * np.sin(phi) + rate**2 * np.cos(phi))
    tree, state = linear.tree, linear.state
    guide = tree.coordinate("guide.z")
    assert (state.v[guide], state.a[guide]) == (pytest.approx(v, rel=1e-10), pytest.approx(a, rel=1e-10))
    torque = dynamics.unbalanced(tree, state.kinematics, state.cartesian, state.q, state.v)[tree.coordinate("O.rz")]
    assert torque * omega == pytest.approx(mass * a * v, rel=1e-9)
    assert linear.M.shape == (0, 0)  # no free coordinate
    assert not len(mb.solve(m, dict(zip(tree.coordinates, state.q.tolist(), strict=True))).values)


def test_damping_of_bushings_matches_difference_quotients() -> None:
    """A bushing with a full 6×6 damping between bodies that turn about each other."""
    rng = np.random.default_rng(4)
    damping = np.cov(rng.normal(size=(6, 30)))
    undeformed = sp.exp(0.2 * rng.normal(size=6))
    m = mb.Mechanism(
        (mb.Body("a", mb.inertia(1.0, 0.3)), mb.Body("b", mb.inertia(2.0, 0.2, (0.1, 0.3, 0)))),
        (mb.Joint("p", "spherical", "ground", "a", mb.at(0.2)), mb.Joint("q", "free", "a", "b", mb.at(0.5, 0.1, 0.3))),
        beams=(mb.Beam("a", "b", mb.bushing(undeformed, np.zeros((6, 6))), damping, mb.at(0.1), mb.at(y=0.2)),),
    )
    tree = compile_tree(m)
    bare = compile_tree(replace(m, beams=()))
    n = len(tree.coordinates)
    q, v = 0.3 * rng.normal(size=(2, n))

    def force(q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Force of the damper: its power is −ε̇ᵀ D ε̇, with the strain rate by a difference quotient."""

        def strain(q: np.ndarray) -> np.ndarray:
            x, _ = poses(tree, q)
            a, b = x[0] @ mb.at(0.1), x[1] @ mb.at(y=0.2)
            return sp.log((sp.inverse(a) @ b)[None])[0] - sp.log(undeformed[None])[0]

        h = 1e-6
        E = np.stack([(strain(q + h * e) - strain(q - h * e)) / (2 * h) for e in np.eye(n)], axis=-1)
        return E.T @ damping @ E @ v

    zero = np.zeros(n)
    k, k0 = (kinematics(t, q, v, zero) for t in (tree, bare))
    tangents = [dynamics.tangent(t, s, dynamics.cartesian(t, s))[1] for t, s in ((tree, k), (bare, k0))]
    expected = np.stack([force(q, e) for e in np.eye(n)], axis=-1)
    np.testing.assert_allclose(tangents[0] - tangents[1], expected, atol=1e-7 * np.abs(expected).max())


def test_a_loop_that_moves_at_no_given_rate_is_refused() -> None:
    m = five_bar()
    with pytest.raises(
        mb.MechanismError, match=r"coordinate '\w\.r\w': its loop moves.*do not determine its rate.*prescribed = false"
    ):
        modal.linearize(replace(m, motions=m.motions[:2]), GUESS)


def test_motions_that_contradict_a_loop_are_refused() -> None:
    m = mb.Mechanism(
        (bar("crank", 1, 2.0), bar("coupler", 3, 3.0), bar("rocker", 2, 1.0)),
        (
            mb.Joint("A", "revolute", "ground", "crank"),
            mb.Joint("B", "revolute", "crank", "coupler", mb.at(1.0)),
            mb.Joint("C", "revolute", "coupler", "rocker", mb.at(3.0), mb.at(2.0), cut=True),
            mb.Joint("D", "revolute", "ground", "rocker", mb.at(3.0)),
        ),
        (mb.Motion("A.rz", None, 1.0), mb.Motion("D.rz", None, 5.0)),
    )
    guess = mb.solve(replace(m, motions=(mb.Motion("A.rz", 0.9),)), {"B.rz": -0.3, "C.rz": 1.3, "D.rz": 1.9}).steady
    with pytest.raises(mb.MechanismError, match=r"motions: the prescribed rates contradict a loop"):
        modal.linearize(m, guess)


def test_a_slender_ring_that_does_not_quite_close_finds_its_shape() -> None:
    """Stiff in tension, soft in bending: full Newton steps fail here. The result is round, apart from the initial gap."""
    linear = modal.linearize(ring(1.5, 10))
    tree, state = linear.tree, linear.state
    hub = np.mean([x[:3, 3] for x in state.kinematics.poses[1:]], axis=0)
    radii = [np.linalg.norm(x[:3, 3] - hub) for x in state.kinematics.poses[1:]]
    np.testing.assert_allclose(radii, 1.0, atol=2e-3)
    unbalanced = dynamics.unbalanced(tree, state.kinematics, state.cartesian, state.q, state.v)
    assert np.abs(unbalanced[linear.partition.free]).max() < 1e-6
