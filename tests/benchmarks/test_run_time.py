"""The benchmark: every code is timed, core with as few elements as are as accurate; ratios and powers of the page."""

import pytest

from southwell.benchmarks import run_time
from southwell.benchmarks.run_time import CORE, EXACT, Cost, Growth
from southwell.cases.run.executors import Serial
from southwell.references.protocol import registry

CODE = "yoo-shin"


@pytest.mark.slow
def test_core_is_also_timed_with_the_fewest_elements_that_are_as_accurate(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in {"ROUNDS": 1, "SWEEPS": 1, "SWEEP": (0.0, 10.0)}.items():
        monkeypatch.setattr(run_time, name, value)
    exact = run_time._answer(EXACT, registry.code(EXACT).levels[-1])[1]
    costs, as_accurate = run_time.measure({CORE: Serial(), CODE: Serial()}, exact)
    core, code = costs
    assert code.code == f"{CODE} {registry.code(CODE).version()}"
    assert 0.0 < core.error < 1e-6 < code.error
    assert all(c.single > 0.0 and c.sweep > 0.0 for c in costs)
    fewest = as_accurate[code.code]
    assert fewest
    fewer, enough = (
        run_time._error(run_time._answer(CORE, n)[1], exact) for n in (fewest.elements - 1, fewest.elements)
    )
    assert enough <= code.error < fewer


def rows(text: str, name: str) -> list[list[str]]:
    lines = [line for line in text.splitlines() if line.startswith(f"| {name}")]
    return [[cell.strip() for cell in line.split("|")][2:-1] for line in lines]


def test_the_page_has_ratios_to_core_and_powers_of_the_number_of_elements() -> None:
    costs = [Cost(CORE, 50, 0.02, 0.01, 1e-7), Cost("slow 2.0", 50, 0.5, 0.2, 1e-3), Cost("exact 1.0", 50, 1, 1, 1e-12)]
    as_accurate = {"slow 2.0": Cost(CORE, 6, 0.01, 0.004, 1e-3), "exact 1.0": None}
    growth = [Growth(50, 0.02, 0), Growth(500, 0.2, 20 * 2**20), Growth(5000, 20.0, 200 * 2**20)]
    text = run_time.page(costs, as_accurate, growth, ["absent"])
    assert rows(text, "slow 2.0") == [
        ["500.0 ms", "25.0", "200.0 ms", "20.0", "0.1 %"],
        ["0.1 %", "6 elements", "10.0 ms", "50.0", "4.0 ms", "50.0"],
    ]
    assert rows(text, "exact 1.0")[1][:2] == ["1e-10 %", "more than 50 elements"]
    assert len(rows(text, CORE)) == 1
    assert "Not compared, because it is not installed or failed: absent." in text
    assert "Time grows as N^1.00 from 50 to 500, N^2.00 from 500 to 5000; memory as N^1.00 from 500 on." in text
