"""The verification matrix: in one run of ``southwell verify``, every cell is what ``capabilities`` says.

``SOUTHWELL_RUN`` names the results of a complete run of these sources: the matrix is solved once per push, by ``make verify``.
"""

import os
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.faults.table import BY_NAME, FAST
from southwell.cases.input import library
from southwell.cases.judge import witnesses
from southwell.cases.judge.results import Cell, Run
from southwell.cases.plan import mechanism
from southwell.cases.store import results_file
from southwell.tests.support.codes import BLADE_CODES, MECHANISM_CODES

from ..support.capabilities import BLADES, CODES, TABLES, allowed, solves

needs_run = pytest.mark.skipif(
    "SOUTHWELL_RUN" not in os.environ,
    reason="needs a complete run: make verify, then SOUTHWELL_RUN=reports/out/results.jsonl make test",
)

RPM = np.pi / 30

CASES = {variant.name: (case, variant) for case in library.load_all()[0].values() for variant in case.variants}


@pytest.fixture(scope="module")
def run() -> Run:
    complete = results_file.read(Path(os.environ["SOUTHWELL_RUN"]))
    assert not complete.unfinished
    return complete


def cells_of(run: Run, blade: str, code: str) -> dict[float, list[Cell]]:
    """A code's cells of a blade, by speed (rad/s)."""
    cells: dict[float, list[Cell]] = {}
    for cell in run.cells:
        if (cell.case, cell.code) == (blade, code):
            cells.setdefault(cell.omega, []).append(cell)
    return cells


def within_target(cell: Cell) -> bool:
    """Whether the cell's own numbers are within its target."""
    if cell.value is None or cell.reference is None or cell.uncertainty is None:
        return False
    return abs(cell.value / cell.reference - 1.0) + cell.uncertainty <= cell.target


def test_every_code_and_every_blade_is_in_the_table() -> None:
    assert set(CODES) == set(BLADE_CODES)
    assert set(BLADES) == set(CASES) | set(library.load_all()[1])


@needs_run
@pytest.mark.parametrize("code", CODES)
def test_a_code_solves_what_it_can(run: Run, code: str) -> None:
    for blade in CASES:
        check_cells(cells_of(run, blade, code), code, blade)


def check_cells(by_speed: dict[float, list[Cell]], code: str, blade: str) -> None:
    """Assert that a code's cells of one blade are those that the table of capabilities allows."""
    can, asks, (case, variant) = CODES[code], BLADES[blade], CASES[blade]
    if any(cell.verdict == "not run" for cells in by_speed.values() for cell in cells):
        pytest.skip(next(iter(by_speed.values()))[0].reason)
    assert sorted(by_speed) == sorted(variant.speeds.tolist()), blade
    for omega, cells in by_speed.items():
        if not solves(can, asks):
            assert [(c.verdict, bool(c.reason)) for c in cells] == [("not applicable", True)], blade
            continue
        assert [c.mode for c in cells] == list(range(1, case.text.compare.modes + 1)), blade
        for cell in cells:
            assert cell.verdict in allowed(can, asks, omega), cell
            assert cell.role == ("same discretisation" if can.twin else "code")
            assert cell.target == (1e-8 if can.twin else 1e-3)
            if cell.verdict in ("pass", "known difference"):  # a known difference is compared like with like
                assert within_target(cell), cell
            if cell.verdict == "known difference":
                assert any(f"no {effect}" in cell.reason for effect in can.lacks), cell
            if cell.verdict == "not applicable":
                assert cell.family in ("axial", "mixed")


@needs_run
@pytest.mark.parametrize(("table", "blade"), TABLES.items())
def test_a_printed_table_agrees(run: Run, table: str, blade: str) -> None:
    cells = [cell for cell in run.cells if cell.code == table]
    assert {cell.case for cell in cells} == {blade}
    for cell in cells:
        assert cell.role == "table"
        assert cell.verdict in (("coarse",) if cell.target > 5e-3 else ("pass", "known difference")), cell
        assert within_target(cell) or "discretisation error of 50 elements" in cell.reason, cell


@needs_run
def test_the_discretisation_of_the_source_is_explained(run: Run) -> None:
    cells = [cell for cell in run.cells if cell.role == "discretisation"]
    assert {cell.case for cell in cells} == {blade for blade in BLADES if blade.startswith("park")}
    for cell in cells:
        assert cell.verdict in ("pass", "known difference"), cell
        assert within_target(cell) or "discretisation error of" in cell.reason, cell


@needs_run
def test_the_discretisation_of_the_source_gives_the_printed_digits(run: Run) -> None:
    """Park et al. (2010), Table 1, column Present: 11.71, 70.37, 189.7."""
    cells = [c for c in run.cells if (c.case, c.role, c.omega) == ("park-cantilever", "discretisation", 10.0)]
    assert [f"{c.value:.4g}" for c in cells if c.family == "edgewise"] == ["11.71", "70.37", "189.7"]


@needs_run
def test_the_surrogate_rises_as_the_papers_blade_does(run: Run) -> None:
    """Park et al. (2010), Fig. 3: 8 % at 20 rpm, 16.5 % at 30 rpm at most, which imply 1.06 Hz at rest."""
    by_speed = cells_of(run, "park-blade/surrogate", "exudyn-tree")
    first = {round(omega / RPM): cells[0].reference for omega, cells in by_speed.items()}
    rest, twenty, thirty = (first[rpm] for rpm in (0, 20, 30))
    assert rest
    assert twenty
    assert thirty
    assert rest / (2 * np.pi) == pytest.approx(1.06, abs=0.01)
    assert twenty / rest - 1.0 == pytest.approx(0.08, abs=0.005)
    assert thirty / rest - 1.0 == pytest.approx(0.165, abs=0.01)


@needs_run
@pytest.mark.parametrize("name", library.mechanisms())
def test_every_code_agrees_on_a_mechanism(run: Run, name: str) -> None:
    """Exudyn is given core's spanning tree, and is no group; Pinocchio reads the mechanism itself."""
    cells = [cell for cell in run.cells if cell.case == name]
    assert {cell.code for cell in cells} == {*MECHANISM_CODES, "closed form"}
    if any(cell.verdict == "not run" for cell in cells):
        pytest.skip("not every code is installed")
    subject = mechanism.subject(library.mechanism(name))
    assert len(cells) == subject.cells * len(subject.points) * (len(MECHANISM_CODES) + 1)
    families = {"hinged-blade": {"flap", "lag"}, "coleman-feingold": {"X", "Y", "lag0", "lag2"}}
    assert {cell.family for cell in cells} == families.get(name, {"flap", "pitch"})
    for cell in cells:
        assert (cell.verdict, cell.role, cell.target, cell.reason) == ("pass", "same discretisation", 1e-8, ""), cell
        assert cell.mac
        assert cell.mac > 1 - 1e-9
    standing = witnesses.witnesses(run, name)
    assert {w.name: w.kind for w in standing}["exudyn-loops"] == "Southwell's model"
    assert [[w.name for w in group] for group in witnesses.groups(standing)] == [["pinocchio-loops"], ["closed form"]]


@needs_run
def test_verdicts_follow_from_the_numbers(run: Run) -> None:
    judged = [c for c in run.cells if c.value and c.reference and c.uncertainty is not None]
    assert len(judged) > 100
    for cell in judged:
        value, reference = cell.value or 0.0, cell.reference or 1.0
        difference = value - reference if cell.quantity == "damping" else value / reference - 1.0
        assert cell.difference == pytest.approx(difference, abs=1e-12), cell
        within = abs(difference) + (cell.uncertainty or 0.0) <= cell.target
        if cell.verdict in ("pass", "coarse", "fail", "inconclusive"):
            assert within == (cell.verdict in ("pass", "coarse")), cell


@needs_run
@pytest.mark.parametrize("name", FAST)
def test_a_fast_fault_is_detected_by_a_named_cell(run: Run, name: str) -> None:
    (control,) = (control for control in run.controls if control.control == name)
    assert control.detected_by
    trial = BY_NAME[name].trial
    assert trial
    assert all(line.startswith(trial.case) for line in control.detected_by)
    assert all(line.endswith(("fail", "inconclusive")) for line in control.detected_by)
