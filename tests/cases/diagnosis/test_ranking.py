"""A cause is named only if it explains more than chance."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.diagnosis import spectra
from southwell.cases.diagnosis.diagnose import diagnose, explain
from southwell.cases.diagnosis.hypotheses import Hypothesis
from southwell.cases.diagnosis.ranking import chance, freedom
from southwell.cases.diagnosis.spectra import Problem
from southwell.core.blade import uniform_blade
from southwell.core.solve import mesh_sweep

BLADE = uniform_blade("beam", 6.0, 0.6, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=1.2, I_y=1e-3, I_z=2e-3)
FEW = (
    Hypothesis("without hub radius", lambda m, _: replace(m, blade=replace(m.blade, hub_radius=0.0))),
    Hypothesis("with precone reversed", lambda m, _: replace(m, blade=replace(m.blade, precone=-m.blade.precone))),
    Hypothesis("without softening", lambda m, _: replace(m, softening=0.0)),
)
PROBLEM = Problem(BLADE, (0.0, 10.0, 20.0), (1, 2, 3, 4), hypotheses={kind.name: kind for kind in FEW})


def test_chance_is_the_part_of_directions_within_a_cap() -> None:
    rng = np.random.default_rng(0)
    random = rng.standard_normal((200_000, 5))
    random /= np.linalg.norm(random, axis=1)[:, None]
    share = 0.3  # what remains at the rim of the cap: the squared sine of its angle
    within = np.mean((random[:, 0] > 0) & (1 - random[:, 0] ** 2 < share))
    assert chance(share, 5, 1) == pytest.approx(within * min(1, 2 * np.sqrt(share)), rel=0.05)
    assert chance(share, 5, 1, fitted=1) == pytest.approx(2 * within, rel=0.05)
    assert chance(0.0, 1, 40, fitted=1) == 1.0


def test_a_mode_counts_twice_only_if_its_difference_moves_with_speed() -> None:
    assert freedom(np.array([[0.01, 0.00, np.nan], [0.01, 0.02, 0.01]])) == 4


def test_a_seeded_cause_is_named_and_causes_without_effect_are_listed() -> None:
    altered = replace(BLADE, hub_radius=0.0)
    frequencies = np.array([modes.frequencies[:4] for modes in mesh_sweep(altered, PROBLEM.speeds, 40, 4)])
    diagnosis = explain(PROBLEM, frequencies)
    assert diagnosis.sentence.startswith("agrees with Southwell's own solver without hub radius (0.0000")
    assert diagnosis.without_effect == ("with precone reversed",)
    assert "without softening" not in diagnosis.sentence


def test_a_pair_is_named_if_one_cause_does_not_suffice() -> None:
    prediction = spectra.effect(PROBLEM, (("without hub radius", 1.0), ("without softening", 1.0)))
    frequencies = spectra.reference(PROBLEM) * np.exp(prediction)
    assert "without hub radius and without softening (" in explain(PROBLEM, frequencies).sentence


def test_equal_and_random_numbers_have_no_cause() -> None:
    reference = spectra.reference(PROBLEM)
    assert explain(PROBLEM, reference * (1 + 1e-5)).sentence.startswith("all frequencies agree within 0.001 %")
    rng = np.random.default_rng(3)
    altered = [explain(PROBLEM, reference * np.exp(0.01 * rng.standard_normal(reference.shape))) for _ in range(8)]
    assert not any(diagnosis.cause for diagnosis in altered)
    assert altered[0].sentence.startswith("no known cause of ")


def test_causes_that_the_numbers_do_not_tell_apart_are_stated_as_ties() -> None:
    near = Hypothesis("with a hub of 1 mm", lambda m, _: replace(m, blade=replace(m.blade, hub_radius=1e-3)))
    problem = Problem(BLADE, (0.0, 20.0), (1, 2, 3, 4), hypotheses={kind.name: kind for kind in (*FEW, near)})
    altered = replace(BLADE, hub_radius=0.0005)
    frequencies = np.array([modes.frequencies[:4] for modes in mesh_sweep(altered, problem.speeds, 40, 4)])
    diagnosis = explain(problem, frequencies, 1e-4)
    assert {cause.changes[0][0] for cause in (diagnosis.causes[0], *diagnosis.ties)} == {
        "without hub radius",
        "with a hub of 1 mm",
    }
    assert "; or with" in diagnosis.sentence


def test_arrays_of_other_shapes_are_refused() -> None:
    with pytest.raises(ValueError, match="speeds × modes"):
        diagnose(BLADE, [0.0, 1.0], [[1.0, 2.0]])
    with pytest.raises(ValueError, match="none is finite"):
        diagnose(BLADE, [0.0], [[np.nan]])


def test_modes_may_be_named_by_family() -> None:
    altered = replace(BLADE, hub_radius=0.0)
    (modes,) = mesh_sweep(altered, [20.0], 40, 4)
    problem = replace(PROBLEM, speeds=(20.0,), labels=("edgewise 1", "flapwise 1"))
    order = [0, 1] if spectra.names(problem)[0][0] == "edgewise 1" else [1, 0]
    diagnosis = explain(problem, modes.frequencies[None, order])
    assert diagnosis.causes[0].changes == (("without hub radius", 1.0),)


def test_modes_may_be_paired_by_shape_where_frequencies_cross() -> None:
    square = replace(BLADE, stiffness=BLADE.stiffness[:, [0, 1, 2, 3, 5, 4]][:, :, [0, 1, 2, 3, 5, 4]])
    exchange = Hypothesis("exchanged", lambda m, _: replace(m, blade=square))
    problem = replace(PROBLEM, speeds=(0.0,), by_shape=True, hypotheses={"exchanged": exchange})
    first, second, *_ = spectra.reference(problem)[0]
    ratio = np.sqrt(1.4)  # EI_z over EI_y: the flapwise mode is the lowest at rest
    assert np.exp(spectra.effect(problem, (("exchanged", 1.0),))[0, :2]) == pytest.approx([ratio, 1 / ratio], rel=1e-3)
    assert second / first == pytest.approx(ratio, rel=1e-3)
