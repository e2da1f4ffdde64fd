"""Elements of another program with constant or linear properties are recognised if its nodes are known."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.diagnosis import hypotheses, own_elements
from southwell.cases.diagnosis.diagnose import explain
from southwell.cases.diagnosis.model import ELEMENTS
from southwell.cases.diagnosis.spectra import Problem, labelled
from southwell.cases.diagnosis.spectra import reference as solved
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.solve import mesh_sweep

S = np.linspace(0.0, 20.0, 3)
NODES = np.array([0.0, 3.0, 8.0, 12.0, 15.0, 20.0])
MEANS = (NODES[:-1] + NODES[1:]) / 2
"""Where a mass that is linear along the whole blade has its mean over an element."""


def tapered(s: np.ndarray, mass: np.ndarray) -> Blade:
    stiffness = section_stiffness(1e9, 1e7, 5e7 * (1.0 - 0.04 * s), 2e8 * (1.0 - 0.04 * s))
    return Blade("tapered", s, stiffness, section_mass(mass, 2.0, 8.0), 0.3 - 0.01 * s, 1.0)


def mass(s: np.ndarray) -> np.ndarray:
    return 200.0 - 9.0 * s


def stepped() -> Blade:
    """Written down by hand: the mass at the middle of each element from its first node to its last."""
    first, last = NODES[:-1] + 1e-6, NODES[1:]
    s = np.sort(np.concatenate([first, last]))
    s[0] = 0.0
    return tapered(s, np.repeat(mass(MEANS), 2))


def problem(*extra: hypotheses.Hypothesis) -> Problem:
    kinds = (*hypotheses.INPUT[:14], *hypotheses.FACTORS[:1], *extra)
    return Problem(tapered(S, mass(S)), (0.0,), (1, 2, 3, 4, 5), hypotheses={kind.name: kind for kind in kinds})


def given(of: Problem) -> np.ndarray:
    answers = list(mesh_sweep(stepped(), list(of.speeds), 3 * ELEMENTS, of.count))
    return labelled(of, answers, stepped())


def test_a_mass_spread_over_elements_is_named_if_the_nodes_are_known() -> None:
    of = problem(*own_elements.hypotheses(NODES.tolist()))
    diagnosis = explain(of, given(of))
    assert diagnosis.largest > 2e-3
    assert diagnosis.sentence.startswith(
        "as Southwell's own solver with the mass of each of its 5 elements spread evenly (remains 0.0"
    )
    assert explain(problem(), given(of)).cause is None


@pytest.mark.parametrize("k", [0, 1, 2])
def test_nothing_changes_where_properties_are_as_the_hypothesis_says(k: int) -> None:
    """Constant along the blade, or linear between two nodes: the altered blade is the same."""
    kind = own_elements.hypotheses([0.0, 1.0] if k == 2 else NODES.tolist())[k]
    uniform = replace(tapered(S, mass(0.0 * S)), stiffness=tapered(S, mass(S)).stiffness[[0, 0, 0]])
    of = Problem(tapered(S, mass(S)) if k == 2 else uniform, (0.0,), (1, 2, 3), hypotheses={kind.name: kind})
    frequencies = solved(of)
    altered = kind.change(hypotheses_model(of), 1.0).blade
    (modes,) = mesh_sweep(altered, [0.0], 3 * ELEMENTS, of.count)
    assert modes.frequencies[:3] == pytest.approx(frequencies[0], rel=1e-6)


def hypotheses_model(of: Problem) -> own_elements.Model:
    return own_elements.Model(of.blade)


def test_nodes_ascend() -> None:
    with pytest.raises(ValueError, match="at least two nodes, ascending"):
        own_elements.hypotheses([0.0, 2.0, 1.0])
