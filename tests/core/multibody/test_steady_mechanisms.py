"""Steady states that do not depend on luck: the same one from guesses near each other, of every mechanism there is."""

import math
from collections.abc import Callable

import pytest

from southwell import multibody as mb
from southwell.cases.closed_forms import linkages, pendulums
from southwell.cases.input import library
from southwell.cases.verify import mechanism_case
from southwell.core.multibody import equilibrium
from southwell.core.multibody.mechanism import at_time
from southwell.core.multibody.tree import compile_tree
from southwell.tests.core.multibody import test_mechanism_loops as loops
from southwell.tests.core.multibody import test_mechanisms as plain
from southwell.tests.references.exudyn import test_exudyn_mechanism as exudyn
from southwell.tests.support import guesses

pytestmark = pytest.mark.numerical

Case = tuple[mb.Mechanism, dict[str, float]]


def of_case(name: str) -> Case:
    described = library.mechanism(name)
    (turning,) = mechanism_case.case(described).variants
    return turning.at(float(turning.speeds[-1])), described.guess


def assembled() -> dict[str, float]:
    """The five-bar's coordinates, those of a joint that is cut included."""
    return mb.solve(loops.five_bar("C"), loops.GUESS).steady


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
    **{f"five-bar cut at {cut}": lambda cut=cut: (loops.five_bar(cut), assembled()) for cut in "BDE"},
    "five-bar, undamped": lambda: (loops.undamped(), loops.GUESS),
    "ring": lambda: (linkages.ring(1.5, 4), {}),
    **{name: lambda name=name: of_case(name) for name in library.mechanisms()},
}


@pytest.mark.parametrize("name", CASES)
def test_many_guesses_reach_one_state(name: str) -> None:
    """Twenty of 200, all of them every night (SOUTHWELL_GUESSES); of the other mechanisms in the tests, see ``guesses``."""
    mechanism, guess = CASES[name]()
    tree = compile_tree(at_time(mechanism, 0.0))
    chosen = guesses.CHOSEN if len(guesses.CHOSEN) > 20 else list(range(0, guesses.GUESSES, 10))
    guesses.same(tree, guess, equilibrium.steady(tree, guess), chosen)


def test_another_state_is_noticed() -> None:
    """A pendulum that hangs to one side, and one that stands on its head."""
    mechanism, guess = CASES["pendulum, conical"]()
    tree = compile_tree(at_time(mechanism, 0.0))
    there = equilibrium.steady(tree, guess)
    with pytest.raises(AssertionError, match="another state"):
        guesses.same(tree, {"swing.rz": math.pi}, there, [100])
