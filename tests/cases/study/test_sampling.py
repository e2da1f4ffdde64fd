"""Samples follow their distributions, and depend on nothing but the study."""

from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from southwell.cases.input.changes import PropertyChange
from southwell.cases.study.plan import tasks
from southwell.cases.study.sampling import Distribution, Normal, Uniform, Values, changes, sample

from ...support.studies import study

N = 500


@pytest.mark.parametrize(
    ("distribution", "exact"),
    [
        (Normal(0.05), stats.norm(1.0, 0.05)),
        (Normal(0.3, mean=2.0, absolute=True), stats.norm(2.0, 0.3)),
        (Uniform(0.9, 1.2), stats.uniform(0.9, 0.3)),
        (Uniform(-2.0, 1.0, absolute=True), stats.uniform(-2.0, 3.0)),
    ],
)
def test_a_latin_hypercube_is_within_one_sample_of_its_distribution(distribution: Distribution, exact: object) -> None:
    """One sample lies in each of n intervals of equal probability, so no distribution function is off by more than 1/n."""
    values = sample({"mass": distribution, "GJ": Normal(0.1)}, N, seed=3)[:, 0]
    assert stats.kstest(values, exact.cdf).statistic <= 1.0 / N + 1e-12  # type: ignore[attr-defined]


def test_each_value_of_a_list_occurs_equally_often() -> None:
    values = sample({"mass": Values((0.5, 1.0, 3.0))}, 301, seed=3)[:, 0]
    result, counts = np.unique(values, return_counts=True)
    assert result.tolist() == [0.5, 1.0, 3.0]
    assert counts.sum() == 301
    assert abs(counts - 301 / 3).max() <= 1.0


def test_properties_are_independent() -> None:
    """The correlation of independent samples has the standard deviation 1/√n; five of them is beyond chance."""
    values = sample({"mass": Normal(0.1), "GJ": Normal(0.1)}, N, seed=3)
    assert np.abs(np.corrcoef(values.T) - np.eye(2)).max() < 5.0 / np.sqrt(N)


def test_the_same_seed_gives_the_same_sample_and_another_another() -> None:
    properties = {"mass": Normal(0.1), "GJ": Uniform(0.9, 1.1)}
    assert (sample(properties, N, seed=3) == sample(properties, N, seed=3)).all()
    assert (sample(properties, N, seed=3) != sample(properties, N, seed=4)).all()


def test_a_task_does_not_depend_on_the_tasks_before_it(tmp_path: Path) -> None:
    design = study(tmp_path, samples=20)
    whole = dict(tasks(design, range(20)))
    drawn = sample(design.properties, 20, design.text.seed)
    assert [[change.value for change in whole[k].changes] for k in range(20)] == drawn.tolist()
    for start in (1, 7, 19):
        for number, task in tasks(design, range(start, 20)):
            assert task.changes == whole[number].changes
            assert task.sample == whole[number].sample == number


def test_every_blade_has_the_same_samples(tmp_path: Path) -> None:
    design = study(tmp_path, samples=4, blade="yoo-shin-chordwise")
    assert len(design.blades) > 1
    result = dict(tasks(design, range(4 * len(design.blades))))
    assert all(task.changes == result[number % 4].changes for number, task in result.items())
    assert [result[4 * k].blade.name for k in range(len(design.blades))] == [blade.name for blade in design.blades]


def test_absolute_values_are_values_and_others_are_factors() -> None:
    properties = {"pitch": Values((2.0,), absolute=True), "mass": Values((1.5,))}
    assert changes(properties, np.array([2.0, 1.5])) == (
        PropertyChange("pitch", 2.0, False),
        PropertyChange("mass", 1.5, True),
    )
