"""The paper's equations, written out, against closed forms, against themselves, and against the solver, of which they are the
oracle: random trees, closed loops and blades.
"""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.input.schema import Case, Variant
from southwell.cases.judge.results import Run
from southwell.cases.judge.witnesses import groups, witnesses
from southwell.cases.plan.blade_columns import PAPER, columns
from southwell.cases.solve import paper
from southwell.cases.solve.reference import references
from southwell.core import multibody as mb
from southwell.core import park2010, park2010_input, solve
from southwell.core import park2010_modes as oracle
from southwell.core.mechanism.description import at_time
from southwell.core.mechanism.joints import SCREWS, Kind, coordinate_names
from southwell.core.modes import Modes
from southwell.core.space import spatial as sp
from southwell.core.spectrum import modal
from southwell.core.spectrum.eigen import UnstableError
from southwell.core.steady.balance import balance_at
from southwell.core.tree import linearization
from southwell.core.tree.spanning import compile_tree
from southwell.core.tree.state import state_at
from southwell.references.protocol.process import Limits
from southwell.tests.support import linkages
from southwell.tests.support.beams import PARK, yoo_shin
from southwell.tests.support.five_bar import GUESS, five_bar

pytestmark = pytest.mark.numerical

AGREE = 1e-11
G = 9.81
Array = np.ndarray


def terms(t: park2010_input.Tree, q: Array, v_I: Array, names: tuple[str, ...] | None = None) -> park2010.Equations:
    return park2010.equations(t, q, v_I, park2010.partition(t, q, names))


def assert_close(actual: Array, expected: Array, tolerance: float = AGREE) -> None:
    assert actual.shape == expected.shape
    assert np.abs(actual - expected).max(initial=0.0) <= tolerance * np.abs(expected).max(initial=1e-300)


# closed forms ---------------------------------------------------------------------------------------------------------


def test_a_double_pendulum_in_full_swing() -> None:
    """Lagrange's equations (Landau and Lifshitz, *Mechanics*, § 5, problem 1) in absolute angles θ, ψ."""
    m1, m2, l1, l2 = 2.0, 1.0, 1.5, 0.8
    pendulum = mb.Mechanism(
        (mb.Body("upper", mb.inertia(m1, 0.0, (0, -l1, 0))), mb.Body("lower", mb.inertia(m2, 0.0, (0, -l2, 0)))),
        (mb.Joint("a", "revolute", "ground", "upper"), mb.Joint("b", "revolute", "upper", "lower", mb.at(y=-l1))),
        gravity=(0.0, -G, 0.0),
    )
    theta, psi, dtheta, dpsi = 0.7, -1.1, 2.0, -3.5
    s, c = np.sin(theta - psi), np.cos(theta - psi)
    M = np.array([[(m1 + m2) * l1**2, m2 * l1 * l2 * c], [m2 * l1 * l2 * c, m2 * l2**2]])
    Q = np.array(
        [
            -m2 * l1 * l2 * s * dpsi**2 - (m1 + m2) * G * l1 * np.sin(theta),
            m2 * l1 * l2 * s * dtheta**2 - m2 * G * l2 * np.sin(psi),
        ]
    )
    t = park2010_input.tree(pendulum)
    e = terms(t, np.array([theta, psi - theta]), np.array([dtheta, dpsi - dtheta]))
    relative = np.array([[1.0, 0.0], [1.0, 1.0]])  # absolute angles from relative ones
    assert_close(relative @ park2010.accelerations(t, e)[0], np.linalg.solve(M, Q))
    assert_close(e.M_star, relative.T @ M @ relative)
    assert_close(e.Q_star, relative.T @ Q)
    assert_close(e.R, np.eye(2))
    assert not e.gamma_bar.any()


def slider_crank(rate: float, acceleration: float, prescribed: bool) -> mb.Mechanism:
    """Crank of 0.3 m, massless rod of 1 m, slider of 2 kg along x; the loop is closed at the slider's pin."""
    return mb.Mechanism(
        (mb.Body("crank"), mb.Body("rod"), mb.Body("slider", mb.inertia(2.0))),
        (
            mb.Joint("crank", "revolute", "ground", "crank"),
            mb.Joint("knee", "revolute", "crank", "rod", mb.at(x=0.3)),
            mb.Joint("guide", "prismatic", "ground", "slider", mb.at(axis="x")),
            mb.Joint("pin", "revolute", "rod", "slider", mb.at(x=1.0), mb.at(), cut=True),
        ),
        (mb.Motion("crank.rz", 0.7, rate, acceleration),) if prescribed else (),
    )


def slider(theta: float, rate: float, acceleration: float) -> tuple[float, float, float]:
    """x, ẋ and ẍ of the slider by differentiating x = r cos θ + √(l² − r² sin² θ) twice."""
    r, rod = 0.3, 1.0
    s, c = np.sin(theta), np.cos(theta)
    root = np.sqrt(rod**2 - (r * s) ** 2)
    slope = -r * s - r**2 * s * c / root
    bend = -r * c - r**2 * (c**2 - s**2) / root - (r**2 * s * c) ** 2 / root**3
    return r * c + root, slope * rate, slope * acceleration + bend * rate**2


def closed(t: park2010_input.Tree, theta: float) -> Array:
    """Coordinates of the closed slider-crank, by trigonometry."""
    swing = -np.arcsin(0.3 * np.sin(theta))  # of the rod, absolute
    values = {"crank.rz": theta, "knee.rz": swing - theta, "guide.z": slider(theta, 0, 0)[0], "pin.rz": -swing}
    return np.array([values[name] for name in t.coordinates])


def test_a_slider_crank_follows_its_crank() -> None:
    """A prescribed crank leaves nothing free: γ̄ is the whole acceleration, and λ of Φᴹ the driving torque (reversed)."""
    rate, acceleration = 5.0, -2.0
    t = park2010_input.tree(slider_crank(rate, acceleration, prescribed=True))
    e = terms(t, closed(t, 0.7), np.zeros(0))
    _, v, a = slider(0.7, rate, acceleration)
    guide = t.coordinates.index("guide.z")
    assert e.R.shape[1] == 0
    assert e.v[guide].real == pytest.approx(v, rel=1e-12)
    assert e.gamma_bar[guide].real == pytest.approx(a, rel=1e-12)
    _, multipliers = park2010.accelerations(t, e)
    assert -multipliers[-1] * rate == pytest.approx(2.0 * a * v, rel=1e-9)  # power of the torque: that of the slider


def test_a_free_slider_crank_keeps_its_energy() -> None:
    """½ m ẋ² is constant: m ẍ ẋ = 0, so the acceleration of the crank makes ẍ = 0."""
    t = park2010_input.tree(slider_crank(0.0, 0.0, prescribed=False))
    e = terms(t, closed(t, 0.7), np.array([5.0]), ("crank.rz",))
    dv, _ = park2010.accelerations(t, e)
    _, slope, bend = slider(0.7, 1.0, 0.0)
    assert dv[t.coordinates.index("crank.rz")] == pytest.approx(-bend * 25.0 / slope, rel=1e-9)
    assert abs(dv[t.coordinates.index("guide.z")]) < 1e-9 * abs(bend * 25.0)
    assert e.M_hat[0, 0].real == pytest.approx(2.0 * slope**2, rel=1e-12)
    assert e.Q_hat[0].real == pytest.approx(-2.0 * slope * bend * 25.0, rel=1e-9)


def test_a_swung_mass_on_a_spring() -> None:
    """4 (x − 1) = Ω² x in the steady state; K̂ = 4 − Ω², and λ² = −(4 − Ω²)."""
    swung = mb.Mechanism(
        (mb.Body("hub"), mb.Body("mass", mb.inertia(1.0))),
        (mb.Joint("shaft", "revolute", "ground", "hub"), mb.Joint("slot", "prismatic", "hub", "mass", mb.at(axis="x"))),
        (mb.Motion("shaft.rz", 0.0, 1.0),),
        (mb.CoordinateSpring("slot.z", stiffness=4.0, neutral=1.0),),
    )
    t = park2010_input.tree(swung)
    q = oracle.steady_state(t)
    assert q[1] == pytest.approx(4.0 / 3.0, rel=1e-12)
    linear = oracle.linearize(t, q)
    assert linear.K[0, 0] == pytest.approx(3.0, rel=1e-12)
    assert oracle.modes(linear)[0][0] == pytest.approx(1j * np.sqrt(3.0), rel=1e-12)


# random trees ---------------------------------------------------------------------------------------------------------


def random_tree(seed: int) -> mb.Mechanism:
    """Six bodies on joints of all kinds, branching, some given from child to parent, all coordinates moving.

    There are springs and dampers on coordinates and between points, elements of both strain measures with preload, loads,
    gravity and a prescribed motion.
    """
    rng = np.random.default_rng(seed)
    kinds: list[Kind] = [
        "revolute",
        *rng.permutation([k for k in SCREWS if k not in ("fixed", "revolute")])[:4],
        "fixed",
    ]
    joints, motions, springs, bodies, names = [], [], [], [], ["ground"]
    for k, kind in enumerate(kinds):
        tensor = rng.normal(size=(3, 3))
        tensor = (np.trace(tensor @ tensor.T) + 0.1) * np.eye(3) - tensor @ tensor.T
        bodies.append(mb.Body(f"b{k}", mb.inertia(rng.uniform(0.5, 2.0), tensor, rng.normal(size=3))))
        parent, child = (names[int(rng.integers(len(names)))] if k else "ground", f"b{k}")[:: int(rng.choice([1, -1]))]
        at_parent, at_child = sp.exp(0.7 * rng.normal(size=(2, 6)))
        joints.append(mb.Joint(f"j{k}", kind, parent, child, at_parent, at_child))
        names.append(f"b{k}")
        for name in coordinate_names(joints[-1]):
            motions.append(mb.Motion(name, None, float(rng.normal()), prescribed=k == 0))
            springs.append(mb.CoordinateSpring(name, *rng.uniform(1.0, 9.0, size=3).tolist()))
    pairs = [rng.choice(names, 2, replace=False).tolist() for _ in range(4)]
    root = rng.normal(size=(2, 6, 6))
    beams = [
        mb.Beam(
            a, b, mb.bushing(sp.exp(0.4 * rng.normal(size=6)), k @ k.T, rng.normal(size=6), measure), at_a=x, at_b=y
        )
        for (a, b), k, measure, x, y in zip(
            pairs[:2], root, ("body_fixed", "corotational"), *sp.exp(0.1 * rng.normal(size=(2, 2, 6))), strict=True
        )
    ]
    points = rng.normal(size=(2, 2, 3))
    return mb.Mechanism(
        tuple(bodies),
        tuple(joints),
        tuple(motions),
        tuple(springs),
        tuple(mb.Spring(a, b, p, r, 5.0, 2.0, 0.3) for (a, b), (p, r) in zip(pairs[2:], points, strict=True)),
        tuple(beams),
        (mb.Load("b3", rng.normal(size=3)), mb.Load("b4", rng.normal(size=3), "b0")),
        gravity=tuple(rng.normal(size=3).tolist()),
    )


@pytest.mark.parametrize("seed", range(8))
def test_the_solver_has_these_terms_on_random_trees(seed: int) -> None:
    """M̂, Q̂, Ĉ and K̂ at random coordinates and rates, and the balance of eq. 1 with the reactions of all joints."""
    m = random_tree(seed)
    t, tree = park2010_input.tree(m), compile_tree(m)
    assert tuple(t.coordinates) == tree.coordinates
    q = 0.4 * np.random.default_rng(seed).normal(size=len(t.coordinates))
    actual, state = oracle.linearize(t, q), state_at(tree, q)
    expected = linearization.about(tree, state)
    for name in ("M", "C", "K"):
        assert_close(getattr(actual, name), getattr(expected, name))
    assert_close(-actual.at.Q_hat, balance_at(tree, q).independent_forces)
    park2010.accelerations(t, actual.at)


def test_complex_steps_are_difference_quotients() -> None:
    """Q̂ at real states alone, extrapolated from two central differences, also of the elements' forces."""
    t = park2010_input.tree(random_tree(0))
    q = 0.4 * np.random.default_rng(0).normal(size=len(t.coordinates))
    linear = oracle.linearize(t, q)
    v_I, free = oracle.rates(t, q)[0][linear.part.I], np.eye(len(q))[linear.part.I]

    def slope(at, directions: Array) -> Array:
        def central(h: float) -> Array:
            return np.stack([(at(h * d).Q_hat - at(-h * d).Q_hat).real / (2 * h) for d in directions], axis=-1)

        return (4.0 * central(5e-4) - central(1e-3)) / 3.0

    K = -slope(lambda d: park2010.equations(t, q + d, v_I, linear.part), free)
    C = -slope(lambda d: park2010.equations(t, q, v_I + d, linear.part), np.eye(len(v_I)))
    assert_close(linear.K, K, 1e-9)
    assert_close(linear.C, C, 1e-9)


# closed loops ---------------------------------------------------------------------------------------------------------


def random_loop(seed: int) -> tuple[mb.Mechanism, dict[str, float]]:
    rng = np.random.default_rng(seed)
    kinds: list[Kind] = [linkages.KINDS[k] for k in rng.integers(len(linkages.KINDS), size=int(rng.integers(2, 4)))]
    loop = linkages.LOOPS[int(rng.integers(len(linkages.LOOPS)))]
    return linkages.random_loop(kinds, loop, rng.integers(2, size=3).astype(bool).tolist(), seed)


LOOPS = {
    "four-bar": (linkages.four_bar(), linkages.FOUR),
    "slider-crank": linkages.slider_crank(),
    "spatial": linkages.spatial_loop(),
    "five-bar": (five_bar(), GUESS),
    **{f"random {seed}": random_loop(seed) for seed in range(12)},
}


@pytest.mark.parametrize("name", LOOPS)
def test_the_solver_has_these_terms_on_closed_loops(name: str) -> None:
    """M̂, Ĉ, K̂ about the steady state, where Q̂ vanishes, the state itself, and all eigenvalues."""
    m, guess = LOOPS[name]
    expected = modal.linearize(m, guess)
    t = park2010_input.tree(at_time(m, 0.0))
    q = expected.state.q
    actual = oracle.linearize(t, q, expected.names)
    for matrix in ("M", "C", "K"):
        assert_close(getattr(actual, matrix), getattr(expected, matrix))
    v_I, dv_I = (a[actual.part.I] for a in oracle.rates(t, q))
    residual = oracle.unbalanced(t, actual.part, q, v_I, dv_I)
    assert np.abs(residual).max(initial=0.0) <= 1e-10 * np.abs(expected.K).max(initial=1e-300)
    assert_close(oracle.steady_state(t, q + 1e-3), q)
    if len(expected.M):
        park2010.accelerations(t, actual.at)
        solution = modal.modes(expected)
        values = getattr(solution, "values", None)
        values = 1j * solution.frequencies if values is None else values
        assert_close(np.sort(np.abs(oracle.modes(actual)[0])), np.sort(np.abs(values)))


# blades ---------------------------------------------------------------------------------------------------------------

BLADES: dict[str, tuple[Case, Variant]] = {
    variant.name: (case, variant) for case in library.load_all()[0].values() for variant in case.variants
}


def test_reactions_of_a_blades_joints_do_no_work() -> None:
    """Bᵀ Φᴶ_Zᵀ = 0, and eq. 1 with the reactions, in a bent blade."""
    t = park2010_input.tree(paper.as_mechanism.mechanism(paper.discretize(PARK, 8, "half_end", "body_fixed"), 10.0))
    rng = np.random.default_rng(2)
    e = terms(t, 0.05 * rng.normal(size=len(t.coordinates)), rng.normal(size=len(t.coordinates) - 1))
    assert np.abs(e.M_hat - e.M_hat.T).max() < 1e-13 * np.abs(e.M_hat).max()
    assert np.abs(park2010.tree_joints(t, e.J) @ e.B).max() < 1e-13
    _, multipliers = park2010.accelerations(t, e)
    assert np.abs(multipliers).max() > 1.0


def test_an_unstable_blade_is_reported() -> None:
    with pytest.raises(UnstableError, match="K̂ is not positive definite"):
        paper.paper_modes(yoo_shin(0.1), 50.0, 20, 3)


@pytest.mark.parametrize("name", BLADES)
def test_the_column_is_there_for_every_blade_and_is_no_witness(name: str) -> None:
    case, variant = BLADES[name]
    (column,) = (c for c in columns(case, variant, [], Limits()) if c.name == PAPER)
    if name not in ("tip-mass", "articulated/both"):  # make verify has the column for all
        return
    speeds = variant.speeds.tolist()[-2:]
    cells, _ = column(speeds, references(variant.blade, speeds, case.text.compare, [column.effects])[column.effects])
    assert [c.mode for c in cells] == list(range(1, case.text.compare.modes + 1))
    assert {(c.verdict, c.omega, c.role, c.shares) for c in cells} == {
        ("pass", speeds[-1], "same discretisation", "everything")
    }
    assert max(abs(c.difference or 0.0) for c in cells) < AGREE
    assert not groups(witnesses(Run(tuple(cells)), cells[0].case))


@pytest.mark.parametrize("name", ["curved-solid", "nrel-5mw", "articulated/sprung"])
def test_shapes_are_those_of_the_solver(name: str) -> None:
    blade, omega = BLADES[name][1].blade, float(BLADES[name][1].speeds[-1])
    actual = paper.paper_modes(blade, omega, 20, 6)
    expected = solve.mesh_modes(blade, omega, 20, 6, mass="half_end", stiffness="body_fixed")
    assert_close(actual.frequencies, expected.frequencies)
    assert mac(actual, expected).min() > 1.0 - 1e-6


def mac(actual: Modes, expected: Modes) -> Array:
    """MAC of complex shapes one by one: 1 if they differ by a complex factor only, so phases too must agree."""
    a, b = (m.shapes.reshape(len(m.frequencies), -1) for m in (actual, expected))
    return np.abs((a.conj() * b).sum(1)) ** 2 / ((np.abs(a) ** 2).sum(1) * (np.abs(b) ** 2).sum(1))


# what goes wrong is reported ------------------------------------------------------------------------------------------


def test_names_that_cannot_be_independent_are_refused() -> None:
    t = park2010_input.tree(slider_crank(0.0, 0.0, prescribed=False))
    with pytest.raises(mb.MechanismError, match=r"independent: crank.rz, guide.z do not determine"):
        park2010.partition(t, closed(t, 0.7), ("crank.rz", "guide.z"))


def test_an_element_with_mass_is_refused() -> None:
    beam = mb.straight_beam(1.0, EA=1e6, GJ=10.0, EI_y=10.0, EI_z=10.0, mass=1.0)
    m = replace(random_tree(0), beams=(mb.Beam("b0", "b1", beam),))
    with pytest.raises(mb.MechanismError, match=r"beam 'b0'–'b1': it has mass inside"):
        park2010_input.tree(m)


def test_a_wrong_velocity_transformation_leaves_a_residual() -> None:
    t = park2010_input.tree(random_tree(1))
    q = 0.4 * np.random.default_rng(1).normal(size=len(t.coordinates))
    e = terms(t, q, oracle.rates(t, q)[0][park2010.partition(t, q).I])
    with pytest.raises(ArithmeticError, match=r"the residual is"):
        park2010.accelerations(t, replace(e, B=e.B + 1e-3 * e.B_dot))
