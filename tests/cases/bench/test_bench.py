"""The measurement of cost: what it keeps, what it says; never how long anything took."""

from dataclasses import replace
from pathlib import Path

import pytest

from southwell.cases.bench import cost as measure
from southwell.cases.bench.cost import Bench, Equal, Growth, Timing
from southwell.references.protocol import registry
from southwell.reports.verification import bench

pytestmark = pytest.mark.slow

MADE = Bench(
    (
        Timing("core", "", 0.02, 0.31, 1.1, 1e-7),
        Timing("slow", "2.0", 0.5, 6.2, 1.1, 1e-3, Equal(6, 0.01, 0.124)),
        Timing("absent", "", note="pip install absent"),
    ),
    (Growth(50, 0.02, 0), Growth(500, 0.2, 20 * 2**20), Growth(5000, 2.0, 200 * 2**20)),
    {"python": "3"},
)


@pytest.fixture(scope="module")
def small() -> Bench:
    with pytest.MonkeyPatch.context() as patch:
        for name, value in {"ROUNDS": 1, "SWEEPS": 1, "SIZES": (2, 4), "SWEEP": (0.0, 10.0)}.items():
            patch.setattr(measure, name, value)
        return measure.bench(lambda _: None, ("yoo-shin", "scikit-fem", "nobody"))


def test_every_code_is_timed_and_its_error_told(small: Bench) -> None:
    core, closed, beam, absent = small.timings
    assert [core.code, closed.code, beam.code, absent.code] == ["core", "yoo-shin", "scikit-fem", "nobody"]
    assert 0.0 < (core.error or 0.0) < 1e-6
    assert all(t.single and t.sweep for t in (core, closed))
    assert absent.single is None
    assert "not a known code" in absent.note
    assert [g.elements for g in small.growth] == [2, 4]


def test_core_is_also_timed_with_as_few_elements_as_are_as_accurate(small: Bench) -> None:
    core, _, beam, _ = small.timings
    if beam.error is None:
        pytest.skip(beam.note)
    assert core.equal is None
    assert beam.equal
    n = beam.equal.elements
    exact = measure._answer(measure.EXACT, measure.OMEGA, registry.code(measure.EXACT).levels[-1])[1]
    fewer, enough = (measure._error(measure._answer("core", measure.OMEGA, k)[1], exact) for k in (n - 1, n))
    assert enough <= beam.error < fewer


def test_what_was_measured_is_kept(small: Bench, tmp_path: Path) -> None:
    measure.write(tmp_path / bench.FILE, small)
    assert measure.read(tmp_path / bench.FILE) == small
    assert bench.beside(tmp_path) == bench.render(small)
    assert not bench.beside(tmp_path / "elsewhere")


def rows(text: str, name: str) -> list[list[str]]:
    return [
        [cell.strip() for cell in line.split("|")][2:-1] for line in text.splitlines() if line.startswith(f"| {name}")
    ]


def test_ratios_exponents_and_hints_are_what_the_numbers_say() -> None:
    text = bench.render(MADE)
    assert rows(text, "slow 2.0") == [
        ["500.0 ms", "25.0", "200.0 ms", "20.0", "0.1 %"],
        ["0.1 %", "6 elements", "500.0 ms", "10.0 ms", "50.0", "200.0 ms", "4.0 ms", "50.0"],
    ]
    assert "○ not run: pip install absent" in text
    assert "N^1.00 from 50 to 5000 elements" in text
    assert "memory as N^1.00 from 500 on" in text


def test_equal_accuracy_has_a_table_of_the_codes_that_ran_and_says_what_is_excluded() -> None:
    exact = Timing("closed", "1.0", 0.01, 0.1, 1.1, 1e-12)  # no number of elements makes core as accurate
    text = bench.render(replace(MADE, timings=(*MADE.timings, exact)))
    assert rows(text, "closed 1.0")[1][:2] == ["1e-10 %", "○ more than 50 elements"]
    assert len(rows(text, "core")) == 1
    assert len(rows(text, "absent")) == 1
    said = " ".join(text.partition("Excluded:")[2].split())
    for excluded in ("starting the process", "importing", "compilation", "reading the blade's file", "the uncertainty"):
        assert excluded in said
