"""The paper's equations: in the functions named in docs/theory.md; the terms of the reduction against closed forms."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest

import southwell
from southwell.core.mechanism.description import Body, CoordinateSpring, Mechanism, Motion, inertia
from southwell.core.mechanism.joints import Joint, at
from southwell.core.spectrum import modal
from southwell.core.tree.reduced import accelerations, reduced
from southwell.core.tree.spanning import compile_tree

ROOT = Path(southwell.__file__).parent
NUMBERS = range(1, 26)
G = 9.81

Table = dict[int, tuple[str, str]]


def table(text: str) -> Table:
    """Equation → file and function, from the rows ``| 10 | … | `core/x.py` `function` |``; each once."""
    rows = re.findall(r"^\| (\d+) \|.*\| `([\w/]+\.py)` `(\w+)` \|$", text, flags=re.MULTILINE)
    assert len({n for n, _, _ in rows}) == len(rows)
    return {int(n): (file, function) for n, file, function in rows}


def source(file: str, function: str) -> str:
    text = (ROOT / file).read_text(encoding="utf-8")
    found = [n for n in ast.parse(text).body if isinstance(n, ast.FunctionDef) and n.name == function]
    assert found, f"{file}: no function {function}"
    return "\n".join(text.splitlines()[found[0].lineno - 1 : found[0].end_lineno])


def missing(rows: Table, read=source) -> list[int]:
    """Equations that have no row, or whose number is not in a comment of the function named."""

    def marked(n: int) -> bool:
        comments = [line.partition("#")[2] for line in read(*rows[n]).splitlines()]
        return any(f"(eq. {n})" in comment for comment in comments)

    return [n for n in NUMBERS if n not in rows or not marked(n)]


ROWS = table((ROOT / "docs" / "theory.md").read_text(encoding="utf-8"))


def test_every_equation_is_where_the_table_says() -> None:
    assert missing(ROWS) == []


@pytest.mark.parametrize("n", NUMBERS)
def test_a_number_that_is_removed_is_detected(n: int) -> None:
    without_row = {k: v for k, v in ROWS.items() if k != n}
    assert missing(without_row) == [n]
    assert missing(ROWS, lambda *where: source(*where).replace(f"(eq. {n})", "")) == [n]


# the terms of eq. 8–25 ------------------------------------------------------------------------------------------------


def double_pendulum() -> Mechanism:
    """Two point masses, 2 kg at 1.5 m and 1 kg at 0.8 m, hanging along −y in the plane z = 0; angles relative."""
    return Mechanism(
        (Body("upper", inertia(2.0, 0.0, (0, -1.5, 0))), Body("lower", inertia(1.0, 0.0, (0, -0.8, 0)))),
        (Joint("a", "revolute", "ground", "upper"), Joint("b", "revolute", "upper", "lower", at(y=-1.5))),
        gravity=(0.0, -G, 0.0),
    )


def test_a_double_pendulum_in_full_swing() -> None:
    """Lagrange's equations (Landau and Lifshitz, *Mechanics*, § 5, problem 1) in absolute angles θ, ψ."""
    m1, m2, l1, l2 = 2.0, 1.0, 1.5, 0.8
    theta, psi, dtheta, dpsi = 0.7, -1.1, 2.0, -3.5
    s, c = np.sin(theta - psi), np.cos(theta - psi)
    M = np.array([[(m1 + m2) * l1**2, m2 * l1 * l2 * c], [m2 * l1 * l2 * c, m2 * l2**2]])
    Q = np.array(
        [
            -m2 * l1 * l2 * s * dpsi**2 - (m1 + m2) * G * l1 * np.sin(theta),
            m2 * l1 * l2 * s * dtheta**2 - m2 * G * l2 * np.sin(psi),
        ]
    )
    absolute = np.linalg.solve(M, Q)
    r = reduced(compile_tree(double_pendulum()), np.array([theta, psi - theta]), np.array([dtheta, dpsi - dtheta]))
    relative = np.array([[1.0, 0.0], [1.0, 1.0]])  # absolute angles from relative ones
    np.testing.assert_allclose(relative @ accelerations(r)[0], absolute, rtol=1e-12)
    np.testing.assert_allclose(r.M_star, relative.T @ M @ relative, rtol=1e-12)
    np.testing.assert_allclose(r.Q_star, relative.T @ Q, rtol=1e-12)
    np.testing.assert_allclose(r.R, np.eye(2), atol=0)
    assert not r.gamma_bar.any()


def slider_crank(rate: float, acceleration: float, prescribed: bool) -> Mechanism:
    """Crank of 0.3 m, massless rod of 1 m, slider of 2 kg along x; the loop is closed at the slider's pin."""
    return Mechanism(
        (Body("crank"), Body("rod"), Body("slider", inertia(2.0))),
        (
            Joint("crank", "revolute", "ground", "crank"),
            Joint("knee", "revolute", "crank", "rod", at(x=0.3)),
            Joint("guide", "prismatic", "ground", "slider", at(axis="x")),
            Joint("pin", "revolute", "rod", "slider", at(x=1.0), at(), cut=True),
        ),
        (Motion("crank.rz", 0.7, rate, acceleration),) if prescribed else (),
    )


def slider(theta: float, rate: float, acceleration: float) -> tuple[float, float, float]:
    """x, ẋ and ẍ of the slider by differentiating x = r cos θ + √(l² − r² sin² θ) twice."""
    r, rod = 0.3, 1.0
    s, c = np.sin(theta), np.cos(theta)
    root = np.sqrt(rod**2 - (r * s) ** 2)
    slope = -r * s - r**2 * s * c / root
    bend = -r * c - r**2 * (c**2 - s**2) / root - (r**2 * s * c) ** 2 / root**3
    return r * c + root, slope * rate, slope * acceleration + bend * rate**2


def closed(tree, theta: float) -> np.ndarray:
    """Coordinates of the closed slider-crank, by trigonometry."""
    swing = -np.arcsin(0.3 * np.sin(theta))  # of the rod, absolute
    values = {"crank.rz": theta, "knee.rz": swing - theta, "guide.z": slider(theta, 0, 0)[0], "pin.rz": -swing}
    return np.array([values[name] for name in tree.coordinates])


def test_a_slider_crank_follows_its_crank() -> None:
    """A prescribed crank leaves nothing free: γ̄ is the whole acceleration, and λ of Φᴹ the driving torque (reversed)."""
    rate, acceleration = 5.0, -2.0
    tree = compile_tree(slider_crank(rate, acceleration, prescribed=True))
    r = reduced(tree, closed(tree, 0.7), np.zeros(0))
    _, v, a = slider(0.7, rate, acceleration)
    at_guide = tree.coordinates.index("guide.z")
    assert r.R.shape[1] == 0
    assert r.v[at_guide] == pytest.approx(v, rel=1e-12)
    assert r.gamma_bar[at_guide] == pytest.approx(a, rel=1e-12)
    dv, multipliers = accelerations(r)
    np.testing.assert_array_equal(dv, r.gamma_bar)
    assert -multipliers[-1] * rate == pytest.approx(2.0 * a * v, rel=1e-9)  # power of the torque: that of the slider


def test_a_free_slider_crank_keeps_its_energy() -> None:
    """½ m ẋ² is constant: m ẍ ẋ = 0, so the acceleration of the crank makes ẍ = 0."""
    tree = compile_tree(slider_crank(0.0, 0.0, prescribed=False))
    r = reduced(tree, closed(tree, 0.7), np.array([5.0]), ("crank.rz",))
    dv, _ = accelerations(r)
    at_crank, at_guide = (tree.coordinates.index(name) for name in ("crank.rz", "guide.z"))
    _, slope, bend = slider(0.7, 1.0, 0.0)
    assert dv[at_crank] == pytest.approx(-bend * 25.0 / slope, rel=1e-9)
    assert abs(dv[at_guide]) < 1e-9 * abs(bend * 25.0)
    assert r.M_hat[0, 0] == pytest.approx(2.0 * slope**2, rel=1e-12)
    assert r.Q_hat[0] == pytest.approx(-2.0 * slope * bend * 25.0, rel=1e-9)


def test_Q_hat_vanishes_in_the_steady_state() -> None:
    """A swung mass on a spring: 4 (x − 1) = Ω² x; there Q̂ = 0 and M̂ is that of the linearisation; elsewhere Q̂ is the force."""
    swung = Mechanism(
        (Body("hub"), Body("mass", inertia(1.0))),
        (Joint("shaft", "revolute", "ground", "hub"), Joint("slot", "prismatic", "hub", "mass", at(axis="x"))),
        (Motion("shaft.rz", 0.0, 1.0),),
        (CoordinateSpring("slot.z", stiffness=4.0, neutral=1.0),),
    )
    linear = modal.linearize(swung)
    here = reduced(linear.tree, linear.state.q, np.zeros(1))
    assert linear.state.q[1] == pytest.approx(4.0 / 3.0, rel=1e-12)
    assert abs(here.Q_hat[0]) < 1e-12
    np.testing.assert_allclose(here.M_hat, linear.M, rtol=1e-14)
    moved = reduced(linear.tree, np.array([0.0, 1.5]), np.zeros(1))
    assert moved.Q_hat[0] == pytest.approx(1.5 - 4.0 * 0.5, rel=1e-12)
