"""The run, end to end, with made-up codes whose right verdict is known; and its results on disk."""

import re
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input.schema import Case, read
from southwell.cases.judge.results import Cell, Run
from southwell.cases.plan.blade import blades
from southwell.cases.plan.blade_columns import PAPER
from southwell.cases.store import results_file
from southwell.cases.verify.matrix import Progress
from southwell.reports.shared import summary
from southwell.reports.shared.statuses import FAILED

from ...support import matrix_runs

CASE = """
name = "rest"
title = "At rest"
description = "A slender uniform beam, at rest, where the frequencies are in every textbook."
source = "Rayleigh (1877)"

[blade]
kind = "dimensionless"
slenderness = 1000

[speeds]
gamma = SPEEDS

[compare]
motions = ["edgewise", "flapwise"]
modes = 4

[discretisation]
elements = 10
mass = "half_end"
stiffness = "body_fixed"
"""


ANALYTIC, MISBEHAVING = ("southwell.tests.support.analytic:", "southwell.tests.support.misbehaving:")
AT_REST = ("GOOD", "ROUGH", "WRONG", "SLOW", "CRUDE", "LYING", "SPECTRAL", "PLANAR", "BACKWARDS", "SIDEWAYS", "ABSENT")


def write(folder: Path, speeds: str = "[0]", old: str = "", new: str = "") -> Case:
    path = folder / "rest.toml"
    path.write_text(CASE.replace("SPEEDS", speeds).replace(old, new) if old else CASE.replace("SPEEDS", speeds))
    return read(path)


@pytest.fixture
def case(tmp_path: Path):
    return partial(write, tmp_path)


def solve(case: Case, *codes: str, timeout: float = 60.0, parts: bool = False) -> Run:
    with ThreadPoolExecutor(2) as executor:
        return matrix_runs.solve(blades(case), codes, executor, seconds=timeout, parts=parts)


@pytest.fixture(scope="module")
def at_rest(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """The made-up codes on the blade at rest."""
    return solve(write(tmp_path_factory.mktemp("rest")), *(ANALYTIC + code for code in AT_REST), parts=True)


def of(run: Run, code: str) -> list[Cell]:
    return [c for c in run.cells if c.code == code]


@pytest.mark.slow
def test_a_correct_code_passes_with_its_numbers(at_rest: Run) -> None:
    cells = of(at_rest, "good")
    assert [c.verdict for c in cells] == ["pass"] * 4
    assert [c.mode for c in cells] == [1, 2, 3, 4]
    assert sorted(c.family for c in cells[:2]) == ["edgewise", "flapwise"]
    for c in cells:
        assert c.uncertainty is not None
        assert c.difference is not None
        assert abs(c.difference) < 1e-6 + 1e-5  # slenderness 1000: no stretch at rest
        assert c.order == pytest.approx(2.0, abs=0.01)
        assert c.uncertainty <= 2e-4
        assert c.mac == pytest.approx(1.0, abs=1e-3)
        assert c.full == pytest.approx(c.reference)
    exact = np.repeat([3.51601527, 22.03449156], 2)  # Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1
    assert [c.value for c in cells] == pytest.approx(exact.tolist(), rel=1e-7)
    assert {(v.mode, v.elements) for v in at_rest.levels if v.code == "good"} >= {
        (m, n) for m in (1, 4) for n in (10, 20, 40)
    }
    assert at_rest.versions["good"] == "1.0"
    assert at_rest.settings[0].case == "rest"


@pytest.mark.slow
def test_a_code_is_refined_until_its_uncertainty_is_small(at_rest: Run) -> None:
    """Error 5 n⁻²·⁵ of a code said to be of order 2: GCI with factor 3 is 2.3e-3 at 40, 4.1e-4 at 80, 7e-5 at 160 elements."""
    assert {c.elements for c in of(at_rest, "good")} == {40}
    assert len(of(at_rest, "rough")) == 4
    for cell in of(at_rest, "rough"):
        assert cell.elements == 160
        assert cell.uncertainty == pytest.approx(5 * (80**-2.5 - 160**-2.5), rel=1e-2)
        assert cell.verdict == "pass"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "verdict", "phrase"),
    [
        ("WRONG", "fail", "+0.20 % ±"),
        ("SLOW", "inconclusive", "observed order 0.20 instead of 2"),
        ("CRUDE", "estimate", "estimate with a stated bound of 4.00 %"),
        ("LYING", "fail", "beyond the bound"),
        ("SPECTRAL", "pass", ""),
    ],
)
def test_verdicts(at_rest: Run, code: str, verdict: str, phrase: str) -> None:
    cells = of(at_rest, code.lower())
    assert len(cells) == 4
    for cell in cells:
        assert cell.verdict == verdict
        assert phrase in cell.reason


@pytest.mark.slow
def test_a_motion_that_a_code_does_not_have_is_not_applicable(at_rest: Run) -> None:
    by_family = {c.family: c for c in of(at_rest, "planar")[:2]}
    assert by_family["flapwise"].verdict == "pass"
    assert by_family["edgewise"].verdict == "not applicable"
    assert by_family["edgewise"].reason == "this code declares that its modes have no edgewise motion"


@pytest.mark.slow
def test_modes_without_a_partner_fail(at_rest: Run) -> None:
    assert len(of(at_rest, "backwards")) == 4
    for cell in of(at_rest, "backwards"):
        assert cell.verdict == "fail"
        assert cell.reason.startswith("no partner: its most similar mode, at")
        assert cell.value is None
    assert {c.verdict for c in of(at_rest, "sideways")} == {"fail"}


def test_unsupported_blades_and_missing_codes_have_a_reason_at_every_speed(case) -> None:
    run = solve(case("[0, 1]"), f"{ANALYTIC}UNABLE", f"{ANALYTIC}ABSENT")
    assert [(c.verdict, c.reason) for c in of(run, "unable")] == [("not applicable", "blades only on Sundays")] * 2
    assert [(c.verdict, c.reason) for c in of(run, "absent")] == [("not run", "not installed: pip install nothing")] * 2


@pytest.mark.slow
def test_the_same_discretisation_is_held_to_rounding(case) -> None:
    run = solve(case("[0, 2]"), f"{ANALYTIC}TWIN", f"{ANALYTIC}BAD_TWIN")
    assert {(c.role, c.verdict, c.target) for c in of(run, "twin")} == {("same discretisation", "pass", 1e-8)}
    assert len(of(run, "twin")) == 8
    assert {c.verdict for c in of(run, "bad-twin")} == {"fail"}


def test_the_discretisation_of_the_source_has_a_column_with_its_error(case) -> None:
    cells = [c for c in solve(case()).cells if c.role == "discretisation"]
    assert [c.verdict for c in cells] == ["known difference"] * 4
    assert all(c.elements == 10 for c in cells)
    assert "discretisation error of 10 elements, half-end masses, body-fixed stiffness: −" in cells[0].reason


@pytest.mark.slow
@pytest.mark.parametrize(
    ("code", "verdict", "phrase"),
    [
        ("SEGFAULT", "fail", "SIGSEGV"),
        ("HANG", "inconclusive", "no answer within 8 s"),
        ("NOT_A_NUMBER", "fail", "not finite"),
        ("GIVE_UP", "fail", "no steady state"),
    ],
)
def test_a_failing_code_does_not_affect_others(case, code: str, verdict: str, phrase: str) -> None:
    run = solve(case("[2]"), MISBEHAVING + code, f"{ANALYTIC}UNABLE", timeout=8.0 if code == "HANG" else 60.0)
    (cell,) = of(run, "misbehaving")
    assert (cell.verdict, cell.mode, cell.value) == (verdict, 0, None)
    assert phrase in cell.reason
    assert {c.verdict for c in of(run, "unable")} == {"not applicable"}


def test_what_was_solved_before_a_failure_still_counts(case) -> None:
    cells = of(solve(case("[0, 2]"), f"{MISBEHAVING}SEGFAULT"), "misbehaving")
    assert len(cells) > 1  # at rest it answers first, at 2 it crashes


@pytest.mark.slow
def test_progress_counts_solved_and_remaining_rows(case) -> None:
    steps: list[Progress] = []
    with ThreadPoolExecutor(1) as executor:
        run = matrix_runs.solve(
            blades(case()), [f"{ANALYTIC}GOOD", f"{ANALYTIC}UNABLE"], executor, steps.append, parts=False
        )
    assert [p.done for p in steps] == [0, 1, 2, 3, 4, 5]
    assert {p.total for p in steps} == {5}
    assert steps[0].running == ("rest × Southwell",)
    assert sorted((c.code, c.mode) for p in steps for c in p.cells) == sorted((c.code, c.mode) for c in run.cells)


@pytest.mark.slow
def test_processes_and_threads_agree(case, at_rest: Run) -> None:
    with ProcessPoolExecutor(1) as executor:
        far = matrix_runs.solve(blades(case()), [f"{ANALYTIC}GOOD"], executor, parts=False)
    codes = {cell.code for cell in far.cells}
    assert "good" in codes
    assert [(c.code, c.mode, c.value, c.verdict) for c in far.cells] == [
        (c.code, c.mode, c.value, c.verdict) for c in at_rest.cells if c.code in codes
    ]


def test_a_speed_without_steady_state_affects_its_own_cells_only(case) -> None:
    """Stretching resonates with the rotation where γ = α π/2: past it nothing holds the beam together."""
    fast, other = case("[0, 1600]"), case("[0]", "rest", "beside")
    with ThreadPoolExecutor(2) as executor:
        run = matrix_runs.solve(blades(fast, other), [f"{ANALYTIC}GOOD", f"{ANALYTIC}ABSENT"], executor, parts=False)
    failures = [c for c in run.cells if c.omega == 1600]
    assert {(c.code, c.verdict, c.mode) for c in failures} == {
        (PAPER, "fail", 0),
        ("southwell", "fail", 0),
        ("good", "fail", 0),
        ("absent", "not run", 0),
    }
    reason = r"speeds: 1600 rad/s: no steady state: .*: give lower speeds"
    assert all(re.fullmatch(reason, c.reason) for c in failures if c.verdict == "fail")
    answers = {
        name: [(c.omega, c.mode, c.value, c.verdict) for c in run.cells if (c.case, c.code) == (name, "good")]
        for name in ("rest", "beside")
    }
    assert [c for c in answers["rest"] if c[0] == 0] == answers["beside"]
    assert [c[3] for c in answers["beside"]] == ["pass"] * 4
    assert summary.status(run) == FAILED


def test_more_modes_than_the_blade_has_fail_the_case(case) -> None:
    many = case("[0]", 'motions = ["edgewise", "flapwise"]', 'motions = ["torsion"]')  # without rotary inertia: none
    run = solve(many, f"{ANALYTIC}GOOD")
    assert {(c.verdict, c.reason) for c in run.cells} == {
        ("fail", "compare.modes: 4: at 0 rad/s only 0 of the lowest 36 modes qualify; reduce it")
    }


@pytest.mark.slow
def test_results_are_read_as_written(at_rest: Run, tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    results_file.write(path, at_rest)
    assert results_file.read(path) == at_rest
    assert [p.name for p in tmp_path.iterdir()] == ["results.jsonl"]


def test_a_foreign_line_is_named(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    path.write_text('{"kind": "cell", "case": "x"}\n')
    with pytest.raises(ValueError, match=r"results\.jsonl: line 1: not a result"):
        results_file.read(path)
