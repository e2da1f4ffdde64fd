"""Every mechanism reaches the same steady state from many nearby guesses."""

import math

import pytest

from southwell import multibody as mb
from southwell.core.mechanism.description import at_time
from southwell.core.steady import equilibrium
from southwell.core.steady.relaxation import relaxed
from southwell.core.tree.closure import assemble
from southwell.core.tree.spanning import compile_tree
from southwell.tests.support import guesses
from southwell.tests.support.mechanisms import CASES

pytestmark = pytest.mark.numerical


SLOW = {"five-bar, undamped"}
"""It takes many times as long as the others."""


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.nightly] if n in SLOW else []) for n in CASES])
def test_many_guesses_reach_one_state(name: str) -> None:
    """10 of 200 guesses, all of them every night (SOUTHWELL_GUESSES); for the other mechanisms, see ``guesses``."""
    mechanism, guess = CASES[name]()
    tree = compile_tree(at_time(mechanism, 0.0))
    chosen = guesses.CHOSEN if len(guesses.CHOSEN) > 10 else list(range(9, guesses.GUESSES, 20))
    guesses.assert_same(tree, guess, equilibrium.steady_state(tree, guess), chosen)


def test_another_state_is_detected() -> None:
    """A pendulum that hangs to one side, and one that stands on its head."""
    mechanism, guess = CASES["pendulum, conical"]()
    tree = compile_tree(at_time(mechanism, 0.0))
    state = equilibrium.steady_state(tree, guess)
    with pytest.raises(AssertionError, match="another state"):
        guesses.assert_same(tree, {"swing.rz": math.pi}, state, [100])


def pendulums() -> mb.Mechanism:
    """Two pendulums that hang along x from the ground, independently of each other."""
    bodies = tuple(mb.Body(name, mb.inertia(1.0, 0.1, (0.5, 0.0, 0.0))) for name in ("one", "other"))
    joints = tuple(mb.Joint(f"of {b.name}", "revolute", "ground", b.name) for b in bodies)
    return mb.Mechanism(bodies, joints, gravity=(9.81, 0.0, 0.0))


@pytest.mark.parametrize(("stands", "ends"), [(0.0, True), (math.pi, False)])
def test_relaxation_does_not_end_at_an_unstable_equilibrium(stands: float, ends: bool) -> None:
    """One pendulum falls from 1.2 rad while the other hangs or stands on its head."""
    tree = compile_tree(pendulums())
    result = relaxed(tree, assemble(tree, {"of one.rz": 1.2, "of other.rz": stands}))
    assert (result is not None) == ends


def test_without_a_state_near_the_guess_the_one_elsewhere_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = compile_tree(pendulums())
    monkeypatch.setattr(equilibrium, "_continued", lambda tree, q, grow: (0.25, None))
    monkeypatch.setattr(equilibrium, "relaxed", lambda tree, q, allow_unstable: None)
    with pytest.raises(
        mb.MechanismError, match=r"reached 25 % .* a steady state was found at of other.rz = 0, of one.rz = 0: give a"
    ):
        equilibrium.steady_state(tree, {"of one.rz": 1.2, "of other.rz": math.pi})
