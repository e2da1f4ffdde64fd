"""Steady states that do not depend on luck: the same one from 200 guesses near each other, of every mechanism there is."""

from collections.abc import Callable

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.cases.closed_forms import linkages, pendulums
from southwell.cases.input import library
from southwell.cases.verify import mechanism_case
from southwell.core.multibody import equilibrium
from southwell.core.multibody.linear import about
from southwell.core.multibody.mechanism import at_time
from southwell.core.multibody.tree import compile_tree
from southwell.tests.core.multibody import test_mechanism_loops as loops
from southwell.tests.core.multibody import test_mechanisms as plain
from southwell.tests.references.exudyn import test_exudyn_mechanism as exudyn

pytestmark = pytest.mark.numerical

Case = tuple[mb.Mechanism, dict[str, float]]


def of_case(name: str) -> Case:
    described = library.mechanism(name)
    (turning,) = mechanism_case.case(described).variants
    return turning.at(float(turning.speeds[-1])), described.guess


CASES: dict[str, Callable[[], Case]] = {
    "turntable, unstable": lambda: (pendulums.turntable(6.0), {}),
    "pendulum, hanging": lambda: (pendulums.pendulum(2.0, True), {}),
    "pendulum, conical": lambda: (pendulums.pendulum(4.0, True), {"swing.rz": -1.0}),
    "pendulum, conical and free": lambda: (pendulums.pendulum(4.0, False), {"swing.rz": -1.0}),
    "top": lambda: (pendulums.top(5.0), {"nutation.rz": pendulums.TILT}),
    "double pendulum": lambda: (pendulums.double_pendulum(2.0), {}),
    "slider-crank": lambda: (linkages.slider_crank(3.0), {"guide.z": linkages.CRANK + linkages.CONNECTING}),
    "parallelogram": lambda: (linkages.parallelogram(3.0), {"A.rz": 1.2, "B.rz": -1.2, "C.rz": 1.2, "D.rz": 1.2}),
    "four-bar": lambda: (plain.four_bar("C", table_rate=1.5), plain._guess()),
    "four-bar in gravity": lambda: (exudyn.four_bar("C"), exudyn.FOUR),
    "five-bar that moves": lambda: (loops.five_bar(), loops.GUESS),
    "five-bar, undamped": lambda: (loops.undamped(), loops.GUESS),
    "ring": lambda: (linkages.ring(1.5, 4), {}),
    **{name: lambda name=name: of_case(name) for name in library.mechanisms()},
}


def perturbed(coordinates: list[str], guess: dict[str, float], k: int) -> dict[str, float]:
    """The k-th of 200 guesses, each coordinate moved by 1e-12 to 1e-2 rad or m."""
    rng = np.random.default_rng(k)
    size = 10.0 ** (-12.0 + 10.0 * k / 199)
    return {name: guess.get(name, 0.0) + size * float(rng.uniform(-1.0, 1.0)) for name in coordinates}


def shape(state: equilibrium.State) -> np.ndarray:
    """Distances of the bodies from each other."""
    at = state.kinematics.poses[:, :3, 3]
    return np.linalg.norm(at[:, None] - at, axis=-1)[1:, 1:]


@pytest.mark.parametrize("name", CASES)
def test_two_hundred_guesses_reach_one_state(name: str) -> None:
    """Compared by the stiffness about it, which knows nothing of a top's azimuth; a ring, which drifts, by its shape."""
    mechanism, guess = CASES[name]()
    tree = compile_tree(at_time(mechanism, 0.0))
    held = {m.coordinate for m in mechanism.motions if m.held}
    names = [c for c in tree.coordinates if c not in held]
    expected = equilibrium.steady(tree, guess)
    linear = about(tree, expected)
    for k in range(200):
        found = equilibrium.steady(tree, perturbed(names, guess, k))
        if name == "ring":
            np.testing.assert_allclose(shape(found), shape(expected), rtol=1e-8, err_msg=f"guess {k}")
            continue
        again = about(tree, found, linear.names)
        np.testing.assert_allclose(again.K, linear.K, atol=1e-8 * np.abs(linear.K).max(), err_msg=f"guess {k}")
