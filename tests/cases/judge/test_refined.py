"""A mode that the solver does not have and damping that a blade does not have make an answer inconclusive."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.judge.cells import Head
from southwell.cases.judge.convergence import Refinements
from southwell.cases.judge.reference import Reference
from southwell.cases.judge.refined import refined
from southwell.cases.judge.results import Cell
from southwell.cases.judge.spectrum import of_blade
from southwell.cases.solve.reference import references
from southwell.core.effects import ALL_EFFECTS
from southwell.core.modes import Modes
from southwell.core.solve import mesh_modes

CASE = library.load("park-cantilever")
BLADE, OMEGA = CASE.variants[0].blade, 10.0


@cache
def reference() -> Reference:
    (result,) = references(BLADE, [OMEGA], CASE.text.compare, [ALL_EFFECTS])[ALL_EFFECTS]
    assert isinstance(result, Reference)
    return result


def cells(alter: Callable[[Modes], Modes]) -> list[Cell]:
    """Of a code that answers as Southwell's own solver with three meshes, altered."""
    answers = (mesh_modes(BLADE, OMEGA, n, reference().core.count) for n in (8, 16, 32))
    solved = Refinements(tuple(of_blade(alter(modes)) for modes in answers))
    head = Head("park-cantilever", "a-code", "1", "code", 1e-3, "nothing")
    return refined(head, OMEGA, reference(), solved, 4)[0]


def spurious(modes: Modes) -> Modes:
    """With a mode unlike all others between the second and the third."""
    saw = np.zeros_like(modes.shapes[:1])
    saw[0, 1:, 1:3] = (-1.0) ** np.arange(1, saw.shape[1])[:, None]
    frequencies = np.insert(modes.frequencies, 2, modes.frequencies[1:3].mean())[: len(modes.frequencies)]
    shapes = np.concatenate([modes.shapes[:2], saw, modes.shapes[2:]])[: len(modes.frequencies)]
    return replace(modes, frequencies=frequencies, shapes=shapes)


def damped(modes: Modes) -> Modes:
    return replace(modes, damping=np.where(np.arange(len(modes.frequencies)) == 2, 0.03, 0.0))


def test_a_right_answer_passes() -> None:
    assert {cell.verdict for cell in cells(lambda modes: modes)} == {"pass"}


@pytest.mark.parametrize(
    ("alter", "reason"),
    [(spurious, "do not match any mode of"), (damped, "damping ratio 0.03: the blade has no damping")],
)
def test_what_a_blade_does_not_have_is_inconclusive(alter: Callable[[Modes], Modes], reason: str) -> None:
    result = cells(alter)
    assert {cell.verdict for cell in result} == {"inconclusive"}
    assert all(reason in cell.reason for cell in result)
