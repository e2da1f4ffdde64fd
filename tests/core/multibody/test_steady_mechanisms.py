"""Every mechanism reaches the same steady state from many nearby guesses."""

import math

import pytest

from southwell.core.multibody import equilibrium
from southwell.core.multibody.mechanism import at_time
from southwell.core.multibody.tree import compile_tree
from southwell.tests.support import guesses
from southwell.tests.support.mechanisms import CASES

pytestmark = pytest.mark.numerical


@pytest.mark.parametrize("name", CASES)
def test_many_guesses_reach_one_state(name: str) -> None:
    """20 of 200 guesses, all of them every night (SOUTHWELL_GUESSES); for the other mechanisms, see ``guesses``."""
    mechanism, guess = CASES[name]()
    tree = compile_tree(at_time(mechanism, 0.0))
    chosen = guesses.CHOSEN if len(guesses.CHOSEN) > 20 else list(range(0, guesses.GUESSES, 10))
    guesses.same(tree, guess, equilibrium.steady(tree, guess), chosen)


def test_another_state_is_detected() -> None:
    """A pendulum that hangs to one side, and one that stands on its head."""
    mechanism, guess = CASES["pendulum, conical"]()
    tree = compile_tree(at_time(mechanism, 0.0))
    there = equilibrium.steady(tree, guess)
    with pytest.raises(AssertionError, match="another state"):
        guesses.same(tree, {"swing.rz": math.pi}, there, [100])
