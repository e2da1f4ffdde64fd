"""Steady states that do not depend on luck: every one that a test finds is found again from guesses beside its own."""

import os
from collections.abc import Mapping

import numpy as np
import pytest

from southwell.core.mechanism.description import Mechanism, MechanismError, at_time
from southwell.core.spectrum import modal
from southwell.core.steady import equilibrium, periodic
from southwell.core.steady.equilibrium import State
from southwell.core.tree.linearization import Linearization, about
from southwell.core.tree.topology import Tree

GUESSES = 200
"""Of every night (SOUTHWELL_GUESSES=200); by default none but those of ``test_steady_mechanisms``."""

CHOSEN = np.unique(
    np.linspace(0, GUESSES - 1, int(os.environ.get("SOUTHWELL_GUESSES", "0"))).round().astype(int)
).tolist()
"""Numbers of the guesses tried."""

STEADY = equilibrium.steady_state


def perturbed(tree: Tree, guess: Mapping[str, float], k: int) -> dict[str, float]:
    """The k-th guess: each coordinate not prescribed is moved by 1e-12 to 1e-2 rad or m."""
    rng = np.random.default_rng(k)
    size = 10.0 ** (-12.0 + 10.0 * k / (GUESSES - 1))
    held = {m.coordinate for m in tree.mechanism.motions if m.prescribed}
    names = [name for name in tree.coordinates if name not in held]
    return {name: guess.get(name, 0.0) + size * float(rng.uniform(-1.0, 1.0)) for name in names}


def assert_same(tree: Tree, guess: Mapping[str, float] | None, expected: State, chosen: list[int]) -> None:
    """Find the state again from these guesses, or an error that names it.

    Compared by the stiffness about it, which knows nothing of a top's azimuth; of one that drifts, by its shape.
    """
    linear = about(tree, expected)
    drifts = equilibrium.null_motions(linear)[0].shape[1] > 0
    for k in chosen:
        try:
            solution = STEADY(tree, perturbed(tree, guess or {}, k))
        except MechanismError as error:  # nothing near this guess
            if "without a guess, a steady state was found" not in str(error):
                raise
            solution = STEADY(tree)
        second = about(tree, solution, linear.names)
        stiff = np.abs(second.K - linear.K).max(initial=0.0) <= 1e-8 * np.abs(linear.K).max(initial=0.0)
        alike = drifts and np.allclose(_shape(solution), _shape(expected), rtol=1e-8, atol=0.0)
        assert stiff or alike, f"guess {k}: another state"


def _shape(state: State) -> np.ndarray:
    """Distances of the bodies from each other, but for the first, which turns."""
    at = state.kinematics.poses[:, :3, 3]
    return np.linalg.norm(at[:, None] - at, axis=-1)[1:, 1:]


@pytest.fixture(scope="session", autouse=True)
def every_steady_state_again():
    """Wherever a test linearises a mechanism about a steady state that is not refused."""
    guesses: list[Mapping[str, float] | None] = []
    by_law: list[bool] = []

    def frozen(mechanism: Mechanism, time: float) -> Mechanism:
        by_law[:] = [any(m.law is not None for m in mechanism.motions)]
        return at_time(mechanism, time)

    def steady(tree: Tree, guess: Mapping[str, float] | None = None) -> State:
        guesses[:] = [guess]
        return STEADY(tree, guess)

    def checked(tree: Tree, state: State, independent: tuple[str, ...] | None = None) -> Linearization:
        linear = about(tree, state, independent)
        if CHOSEN:
            if not by_law[0]:
                periodic.check_constant(linear)
            assert_same(tree, guesses[0], state, CHOSEN)
        return linear

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(modal, "at_time", frozen)
        patch.setattr(modal, "steady_state", steady)
        patch.setattr(modal, "about", checked)
        yield
