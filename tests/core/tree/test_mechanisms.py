"""The general solver: a pendulum, a four-bar, a frame, springs; independence of cut, numbering and rotation; refusals.

``test_closed_forms`` has rotating pendulums, tops, linkages and rings.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from southwell.core.blade import uniform_blade
from southwell.core.element import beams as bm
from southwell.core.element.discretize import discretize
from southwell.core.mechanism.description import (
    Beam,
    Body,
    CoordinateSpring,
    Mechanism,
    MechanismError,
    Motion,
    Spring,
    inertia,
)
from southwell.core.mechanism.joints import Joint, at
from southwell.core.space import spatial as sp
from southwell.core.spectrum import eigen, modal
from southwell.core.tree import dynamics
from southwell.core.tree.as_mechanism import mechanism, single_element
from southwell.core.tree.kinematics import kinematics
from southwell.core.tree.spanning import compile_tree
from southwell.tests.support.beams import PARK
from southwell.tests.support.closed_forms.linkages import bar
from southwell.tests.support.four_bar import A_, B_, C_, D_, four_bar, guess, pose_of

G = 9.81


def frequencies(mechanism: Mechanism, guess=None, **options) -> np.ndarray:
    return modal.modes(modal.linearize(mechanism, guess, **options)).frequencies


# --- pendulums -------------------------------------------------------------------------------------------------------


def test_compound_pendulum_with_a_torsion_spring() -> None:
    """ω² = (m g d + k)/(I_c + m d²)."""
    m, d, i, k = 3.0, 0.7, 0.4, 5.0
    bar = Mechanism(
        (Body("bar", inertia(m, i, (0, -d, 0))),),
        (Joint("pin", "revolute", "ground", "bar"),),
        coordinate_springs=(CoordinateSpring("pin.rz", k),),
        gravity=(0, -G, 0),
    )
    assert frequencies(bar)[0] == pytest.approx(np.sqrt((m * G * d + k) / (i + m * d**2)), rel=1e-12)


# --- linkages --------------------------------------------------------------------------------------------------------


def test_four_bar_with_a_spring_at_rest() -> None:
    """One degree of freedom: ω² = V″/M(θ) at V′ = 0, M from the bars' angular rates; the loop solved by trigonometry.

    The base's frame is laid so that the linkage's plane is vertical when its table is still: gravity acts along −y there.
    """
    gravity, masses, lengths = 3.0, (2.0, 3.0, 1.0), (A_, B_, C_)

    def potential(theta: float) -> float:
        coupler, rocker = pose_of(theta)
        heights = (
            A_ / 2 * np.sin(theta),
            A_ * np.sin(theta) + B_ / 2 * np.sin(coupler),
            C_ / 2 * np.sin(rocker),
        )
        return sum(m * gravity * h for m, h in zip(masses, heights, strict=True)) + 40.0 * (theta - 1.0) ** 2

    def mass(theta: float, h: float = 1e-4) -> float:
        def centres(t: float) -> np.ndarray:
            coupler, rocker = pose_of(t)
            z = [
                A_ / 2 * np.exp(1j * t),
                A_ * np.exp(1j * t) + B_ / 2 * np.exp(1j * coupler),
                D_ + C_ / 2 * np.exp(1j * rocker),
            ]
            return np.array([*z, t, coupler, rocker])

        rate = (8 * (centres(theta + h) - centres(theta - h)) - (centres(theta + 2 * h) - centres(theta - 2 * h))) / (
            12 * h
        )
        spin = np.array(masses) * np.array(lengths) ** 2 / 12
        return float((np.array(masses) * np.abs(rate[:3]) ** 2).sum() + (spin * np.abs(rate[3:]) ** 2).sum())

    h = 1e-3

    def slope(t: float) -> float:
        v = [potential(t + k * h) for k in (-2, -1, 1, 2)]
        return (v[0] - 8 * v[1] + 8 * v[2] - v[3]) / (12 * h)

    theta = float(np.asarray(brentq(slope, 0.5, 1.2, xtol=1e-13)))
    v = [potential(theta + k * h) for k in (-2, -1, 0, 1, 2)]
    curvature = (-v[0] + 16 * v[1] - 30 * v[2] + 16 * v[3] - v[4]) / (12 * h**2)
    upright = sp.pose(np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]), np.zeros(3))  # the linkage's y is up
    m = four_bar()
    m = Mechanism(
        m.bodies,
        (Joint("base", "revolute", "ground", "base", upright), *m.joints[1:]),
        m.motions,
        m.coordinate_springs,
        gravity=(0, 0, -gravity),
    )
    linear = modal.linearize(m, guess())
    assert linear.state.q[linear.tree.coordinate("A.rz")] == pytest.approx(theta, abs=1e-8)
    assert modal.modes(linear).frequencies[0] == pytest.approx(np.sqrt(curvature / mass(theta)), rel=1e-6)
    assert len(linear.partition.redundant) == 3  # a plane loop of four revolutes is three times overdetermined in space
    assert all(name.startswith("C: ") for name in linear.partition.redundant)


@pytest.fixture(scope="module")
def turning() -> np.ndarray:
    return frequencies(four_bar("C", table_rate=1.5), guess())


@pytest.mark.parametrize("cut", ["A", "B", "C", "D", ""])
def test_frequencies_do_not_depend_on_the_cut(cut: str, turning) -> None:
    np.testing.assert_allclose(frequencies(four_bar(cut, table_rate=1.5), guess()), turning, rtol=1e-10)


@pytest.mark.parametrize("name", ["A.rz", "B.rz", "C.rz", "D.rz"])
def test_frequencies_do_not_depend_on_the_independent_coordinate(name: str, turning) -> None:
    result = frequencies(four_bar("C", table_rate=1.5), guess(), independent=(name,))
    np.testing.assert_allclose(result, turning, rtol=1e-10)


def test_frequencies_do_not_depend_on_numbering(turning) -> None:
    result = frequencies(four_bar("", order=(3, 2, 0, 1), table_rate=1.5), guess())
    np.testing.assert_allclose(result, turning, rtol=1e-10)


def test_frequencies_do_not_depend_on_a_rigid_rotation(turning) -> None:
    turned = sp.exp(np.array([0.0, 0, 0, 0.4, -0.7, 1.1]))
    np.testing.assert_allclose(frequencies(four_bar("C", table_rate=1.5, turned=turned), guess()), turning, rtol=1e-10)


def test_a_flat_four_bar_is_reported_singular() -> None:
    """A parallelogram folded flat has one more degree of freedom than nearby configurations."""
    joints = (
        Joint("A", "revolute", "ground", "crank"),
        Joint("B", "revolute", "crank", "coupler", at(1.0)),
        Joint("C", "revolute", "coupler", "rocker", at(2.0), at(1.0)),
        Joint("D", "revolute", "ground", "rocker", at(2.0)),
    )
    m = Mechanism((bar("crank", 1, 1.0), bar("coupler", 2, 1.0), bar("rocker", 1, 1.0)), joints)
    with pytest.raises(MechanismError, match=r"singular"):
        modal.linearize(m)


# --- elastic loops ---------------------------------------------------------------------------------------------------


def test_portal_frame_on_a_rotating_table() -> None:
    """Rigid girder on two clamped columns: k = 24 EI/h³ each way; both directions couple through Coriolis as on springs."""
    h, span, mass, omega, ei = 2.0, 3.0, 40.0, 1.0, 900.0
    column = uniform_blade("column", h, 0.0, EA=1e7, GJ=1e7, EI_y=ei, EI_z=ei, mass=1e-6)
    beam = single_element(discretize(column, 1, mass="half_end").beams, 0)
    up = np.array([[0.0, 0, -1.0], [0, 1.0, 0], [1.0, 0, 0]])
    feet = [sp.pose(up, np.array([x, 0.0, 0.0])) for x in (-span / 2, span / 2)]
    heads = [sp.pose(up, np.array([x, 0.0, 0.0])) for x in (-span / 2, span / 2)]
    m = Mechanism(
        (Body("table"), Body("girder", inertia(mass, np.array([500.0, 500.0, 500.0])))),
        (Joint("turn", "revolute", "ground", "table"), Joint("sway", "elastic", "table", "girder", at(z=h))),
        (Motion("turn.rz", 0.0, omega),),
        beams=tuple(Beam("table", "girder", beam, at_a=f, at_b=g) for f, g in zip(feet, heads, strict=True)),
    )
    result = frequencies(m)
    # in the frame's plane the columns are clamped at both ends; across it the girder rocks on the tips of two cantilevers
    K, M, C = np.zeros((3, 3)), np.diag([mass, mass, 500.0]), np.zeros((3, 3))
    K[0, 0] = 24 * ei / h**3
    K[1:, 1:] = 2 * ei * np.array([[12 / h**3, 6 / h**2], [6 / h**2, 4 / h]])
    K[:2, :2] -= mass * omega**2 * np.eye(2)
    C[0, 1], C[1, 0] = -2 * mass * omega, 2 * mass * omega
    expected = eigen.damped(M, C, K).values.imag
    for e in expected[:2]:
        assert np.abs(result / e - 1).min() < 3e-3, (e, result)


# --- springs, dampers, invariance ------------------------------------------------------------------------------------


def test_spring_damper_between_points() -> None:
    """A mass hung on a damped spring: ω = √(k/m), ζ = c/(2√(km)); sideways a pendulum: ω² = g/l."""
    m, k, c = 2.0, 80.0, 3.0
    stretched = 1.0 + m * G / k
    hung = Mechanism(
        (Body("mass", inertia(m, 1.0)),),
        (Joint("loose", "planar", "ground", "mass"),),
        (Motion("loose.rz", 0.0),),
        springs=(Spring("ground", "mass", np.zeros(3), np.zeros(3), k, c, 1.0),),
        gravity=(0, -G, 0),
    )
    result = modal.modes(modal.linearize(hung, {"loose.y": -1.2}))
    assert isinstance(result, eigen.Damped)
    np.testing.assert_allclose(result.frequencies, [np.sqrt(G / stretched), np.sqrt(k / m)], rtol=1e-9)
    np.testing.assert_allclose(result.damping, [0.0, c / (2 * np.sqrt(k * m))], atol=1e-9)


def test_point_spring_tangents_match_difference_quotients() -> None:
    """Springs, dampers and bushings between bodies that move: τ's analytic tangents against quotients."""
    rng = np.random.default_rng(8)
    undeformed = sp.exp(0.1 * rng.normal(size=(1, 6)))
    k6 = np.cov(rng.normal(size=(6, 30))) * 50
    bushing = bm.bushing(undeformed[0], k6, rng.normal(size=6))
    m = Mechanism(
        (Body("a", inertia(1.0, 0.3, (0.1, 0.2, 0))), Body("b", inertia(2.0, 0.2, (0, 0.3, 0.1)))),
        (Joint("p", "spherical", "ground", "a", at(0.2)), Joint("q", "free", "a", "b", at(0.5, 0.1, 0.3))),
        springs=(
            Spring("a", "b", np.array([0.1, 0, 0.3]), np.array([0, 0.4, 0.2]), 30.0, 4.0, 0.3),
            Spring("ground", "b", np.array([2.0, 1, 0.3]), np.array([0.3, 0, 0.2]), 20.0, 2.0, 1.0),
        ),
        beams=(Beam("a", "b", bushing, at_a=sp.exp(0.1 * rng.normal(size=6))),),
        gravity=(0.3, -2.0, -9.0),
    )
    tree = compile_tree(m)
    n = len(tree.coordinates)
    q, v, a = 0.4 * rng.normal(size=(3, n))

    def tau(q: np.ndarray, v: np.ndarray) -> np.ndarray:
        k = kinematics(tree, q, v, a)
        return dynamics.unbalanced(tree, k, dynamics.cartesian(tree, k), q, v)

    k = kinematics(tree, q, v, a)
    _, C, K = dynamics.tangent(tree, k, dynamics.cartesian(tree, k))
    h = 1e-5
    dq = np.stack([(tau(q + h * e, v) - tau(q - h * e, v)) / (2 * h) for e in np.eye(n)], axis=-1)
    dv = np.stack([(tau(q, v + h * e) - tau(q, v - h * e)) / (2 * h) for e in np.eye(n)], axis=-1)
    np.testing.assert_allclose(K, dq, atol=1e-7 * np.abs(dq).max())
    np.testing.assert_allclose(C, dv, atol=1e-7 * np.abs(dv).max())


def test_the_hubs_zero_mode_when_its_speed_is_free() -> None:
    clamped = mechanism(discretize(PARK, 6), 10.0)
    free = Mechanism(
        clamped.bodies, clamped.joints, (Motion("hub.rz", 0.0, 10.0, prescribed=False),), beams=clamped.beams
    )
    result = np.sort(modal.modes(modal.linearize(free)).frequencies)
    assert result[0] < 1e-4
    # flapwise modes are unaffected; the first edgewise mode of a blade free to turn is that of a pinned beam, far above
    flapwise = frequencies(clamped)
    assert np.abs(result / flapwise[1] - 1).min() < 1e-6


def test_a_coordinate_without_equilibrium_is_named() -> None:
    m = Mechanism(
        (Body("bar", inertia(1.0, 0.1, (1.0, 0, 0))),),
        (Joint("slide", "prismatic", "ground", "bar"),),
        gravity=(0, 0, -G),
    )
    with pytest.raises(MechanismError, match=r"slide\.z.*no stiffness resists"):
        modal.linearize(m)


@pytest.mark.parametrize(
    ("bodies", "joints", "match"),
    [
        (("a", "a"), (), "given twice"),
        (("a",), (Joint("j", "revolute", "ground", "b"),), "'b' is unknown"),
        (("a", "b"), (Joint("j", "revolute", "ground", "a"),), "'b': no joint connects"),
        (("a",), (Joint("j", "hinge", "ground", "a"),), "kind 'hinge'"),  # type: ignore[arg-type]
    ],
)
def test_impossible_mechanisms_are_named(bodies, joints, match) -> None:
    with pytest.raises(MechanismError, match=match):
        modal.linearize(Mechanism(tuple(Body(b, inertia(1.0, 1.0)) for b in bodies), joints))


def test_a_loop_that_cannot_close_is_named() -> None:
    joints = (
        Joint("A", "revolute", "ground", "crank"),
        Joint("B", "revolute", "crank", "coupler", at(1.0)),
        Joint("C", "revolute", "coupler", "ground", at(1.0), at(5.0)),
    )
    with pytest.raises(MechanismError, match=r"joint 'C'.*does not close"):
        modal.linearize(Mechanism((bar("crank", 1, 1.0), bar("coupler", 1, 1.0)), joints))
