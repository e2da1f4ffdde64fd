"""The gate: what counts against a run and what does not, as tables, JUnit, a summary and annotations."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from rich.table import Table

from southwell.cases.judge.results import Cell, Run
from southwell.cases.regression import gate, history
from southwell.cases.regression.gate import compare
from southwell.cases.regression.properties import Property
from southwell.cases.store import codec, results_file
from southwell.cases.store.unfinished import Unfinished
from southwell.reports.ci import gate_text, junit
from southwell.reports.shared.units import BY_KEY

from ...reports.cli.test_cli import southwell
from .test_history import CELL, RUN

BEAM = tuple(replace(CELL, mode=k, value=10.0 * k) for k in (1, 2, 3))
OTHER = tuple(replace(c, code="other") for c in BEAM)
BEFORE = replace(RUN, cells=BEAM + OTHER)


def at(cells: tuple[Cell, ...], k: int, **changes) -> tuple[Cell, ...]:
    return tuple(replace(c, **changes) if i == k else c for i, c in enumerate(cells))


def compared(after: Run, before: Run = BEFORE, **options) -> gate.Comparison:
    return compare(history.entry(before, "before", "m"), history.entry(after, "after", "m"), **options)


def test_an_unchanged_run_passes() -> None:
    comparison = compared(BEFORE)
    assert comparison.passed(strict=True)
    assert (
        comparison.moved,
        comparison.worse,
        comparison.gone,
        comparison.undetected,
        comparison.better,
        comparison.new,
    ) == ((),) * 6


@pytest.mark.parametrize(("change", "listed"), [(0.9e-9, False), (1.1e-9, True), (-1.1e-9, True), (1e-3, True)])
def test_a_changed_frequency_is_listed_and_fails_if_strict(change: float, listed: bool) -> None:
    comparison = compared(replace(BEFORE, cells=at(BEFORE.cells, 1, value=20.0 * (1 + change))))
    assert [(c.after.mode, c.moved) for c in comparison.moved] == (
        [(2, pytest.approx(change, rel=1e-6))] if listed else []
    )
    assert comparison.passed()
    assert comparison.passed(strict=True) is not listed


def test_moved_frequencies_are_listed_with_the_largest_change_first() -> None:
    cells = at(at(BEFORE.cells, 0, value=10.0 * (1 + 1e-6)), 1, value=20.0 * (1 - 1e-3))
    assert [c.after.mode for c in compared(replace(BEFORE, cells=cells)).moved] == [2, 1]


def test_measured_points_and_misses_are_counted() -> None:
    cells = (*at(BEFORE.cells, 0, verdict="measured"), replace(CELL, mode=9, verdict="fail"))
    assert compared(replace(BEFORE, cells=cells)).measured == 1
    entry = history.entry(replace(BEFORE, cells=cells, controls=()), "x", "m")
    correct, altered = (Property("beam", "core", "fingerprint", "mass", 0.1, verdict) for verdict in ("pass", "fail"))
    assert gate.misses(entry) == 1
    assert gate.misses(replace(entry, properties=(correct, correct, altered))) == 2


DAMPING = replace(CELL, mode=1, quantity="damping", value=0.14, reference=0.14, difference=0.0, full=None)


@pytest.mark.parametrize(("value", "moved"), [(0.14 + 0.9e-9, False), (0.14 + 1.1e-9, True), (0.0, True)])
def test_a_damping_ratio_is_another_cell_and_moves_by_its_difference(value: float, moved: bool) -> None:
    before = replace(BEFORE, cells=(*BEFORE.cells, DAMPING))
    comparison = compared(replace(BEFORE, cells=(*BEFORE.cells, replace(DAMPING, value=value))), before)
    changes = [pytest.approx(value - 0.14, rel=1e-6)] if moved else []
    assert [c.moved for c in comparison.moved] == changes
    lost = compared(BEFORE, before)
    assert [(g.point.mode, g.point.quantity) for g in lost.gone] == [(1, "damping")]
    worse = compared(replace(before, cells=(*BEFORE.cells, replace(DAMPING, verdict="fail"))), before)
    assert [(c.after.mode, c.after.quantity) for c in worse.worse] == [(1, "damping")]


VERDICTS = ("pass", "coarse", "known difference", "estimate", "inconclusive", "fail")


@pytest.mark.parametrize("before", VERDICTS)
@pytest.mark.parametrize("after", VERDICTS)
def test_only_a_worse_verdict_fails(before, after) -> None:
    old = replace(BEFORE, cells=at(BEFORE.cells, 0, verdict=before))
    comparison = compared(replace(BEFORE, cells=at(BEFORE.cells, 0, verdict=after)), old)
    steps = VERDICTS.index(after) - VERDICTS.index(before)
    assert (len(comparison.worse), len(comparison.better), comparison.passed()) == (
        int(steps > 0),
        int(steps < 0),
        steps <= 0,
    )


@pytest.mark.parametrize("verdict", VERDICTS)
def test_a_new_cell_fails_only_if_it_is_a_miss(verdict) -> None:
    new = replace(CELL, mode=4, verdict=verdict)
    comparison = compared(replace(BEFORE, cells=(*BEFORE.cells, new)))
    assert comparison.passed() is (verdict not in ("inconclusive", "fail"))
    assert [p.mode for p in comparison.new] == [4]


@pytest.mark.parametrize("verdict", ["not run", "not applicable", "fail"])
def test_a_code_without_answers_any_more_fails(verdict) -> None:
    silent = replace(CELL, code="other", mode=0, family="", value=None, verdict=verdict)
    comparison = compared(replace(BEFORE, cells=(*BEAM, silent)))
    assert [(g.point.code, g.point.mode, g.replacement) for g in comparison.gone] == [
        ("other", k, verdict) for k in (1, 2, 3)
    ]
    assert not comparison.passed()


def test_a_removed_case_fails_only_if_it_had_answers() -> None:
    assert [g.replacement for g in compared(replace(BEFORE, cells=BEAM)).gone] == [None] * 3
    silent = replace(BEFORE, cells=(*BEAM, replace(CELL, code="other", mode=0, value=None, verdict="not run")))
    assert compared(replace(BEFORE, cells=BEAM), silent).passed()
    installed = compared(BEFORE, silent)
    assert installed.passed()
    assert len(installed.new) == 3


def test_a_seeded_fault_no_longer_detected_fails() -> None:
    (control,) = BEFORE.controls
    other = replace(BEFORE, controls=(replace(control, detected_by=("another",)),))
    assert compared(other).passed()  # somebody does
    blind = replace(BEFORE, controls=(replace(control, detected_by=()),))
    assert [c.control for c in compared(blind).undetected] == ["frozen frame"]
    assert not compared(blind).passed()
    assert not compared(replace(BEFORE, controls=())).passed()  # nor is it tried any more
    assert compared(BEFORE, blind).passed()


def test_an_undetected_fault_fails_whatever_the_baseline() -> None:
    comparison = compared(BEFORE, missed=["frozen frame"])
    assert not comparison.passed()
    assert "1 seeded faults missed" in gate_text.verdict(comparison, strict=False)


def test_only_a_wider_target_fails() -> None:
    wide = replace(BEFORE, cells=at(BEFORE.cells, 0, target=2e-3))
    comparison = compared(wide)
    assert [(c.after.mode, c.after.target) for c in comparison.loosened] == [(1, 2e-3)]
    assert not comparison.passed()
    assert "1 with a wider target" in gate_text.verdict(comparison, strict=False)
    assert any(title.startswith("Wider target") for title, _ in gate_text.sections(comparison, {}))
    assert compared(BEFORE, wide).passed()


def test_every_fault_of_the_baseline_is_required_unless_the_run_is_partial() -> None:
    """One fault run instead of seven once passed, even with --strict."""
    (control,) = BEFORE.controls
    longer = replace(BEFORE, controls=(control, replace(control, control="one more")))
    absent = replace(control, control="one more", detected_by=(), needs="some-code")
    for after in (BEFORE, replace(BEFORE, controls=(control, absent))):
        assert [c.control for c in compared(after, longer).undetected] == ["one more"]
        assert not compared(after, longer).passed()
        now = history.entry(after, "after", "m")
        assert compare(gate.within(history.entry(longer, "before", "m"), now), now).passed()


HOSTILE = "50 %: a|b, <c> & \x00d\n::error::e"
BAD = replace(
    RUN,
    cells=(
        *at(BEAM, 0, verdict="fail", reason=HOSTILE)[:2],
        replace(CELL, case="beam/odd", code="other", mode=1, verdict="inconclusive", reason="unsure"),
    ),
    controls=(),
)


def test_junit_has_a_test_case_a_cell_and_one_for_what_is_gone() -> None:
    root = ElementTree.fromstring(junit.render(BAD, compared(BAD)))
    suites = {s.get("name"): s for s in root}
    assert {name: (s.get("tests"), s.get("failures")) for name, s in suites.items()} == {
        "beam": ("2", "1"),
        "beam/odd": ("1", "1"),
        "against the earlier run": ("5", "5"),  # mode 3, three of the other code, and the control
    }
    failure = suites["beam"].find("testcase/failure")
    assert failure is not None
    assert failure.get("type") == "worse"
    assert "50 %: a|b, <c> & \ufffdd" in (failure.text or "")


def test_junit_of_a_run_alone_and_what_is_skipped() -> None:
    root = ElementTree.fromstring(junit.render(RUN))
    (suite,) = root
    assert (suite.get("tests"), suite.get("failures"), suite.get("skipped")) == ("2", "0", "1")


def test_junit_when_moves_count() -> None:
    after = replace(BEFORE, cells=at(BEFORE.cells, 1, value=20.1))
    for strict in (False, True):
        root = ElementTree.fromstring(junit.render(after, compared(after), strict))
        assert len(root.findall(".//failure")) == int(strict)


def test_annotations_name_the_case_s_file_and_are_escaped(tmp_path: Path) -> None:
    (tmp_path / "some").mkdir()
    (tmp_path / "some" / "a,b.toml").write_text('name = "beam"\n')
    (tmp_path / ".hidden").mkdir()
    (tmp_path / ".hidden" / "x.toml").write_text('name = "beam"\n')
    (tmp_path / "broken.toml").write_text("name = \n")
    lines = gate_text.annotations(compared(BAD), tmp_path, {})
    assert lines[0].startswith("::error file=some/a%2Cb.toml,title=beam::some-code: mode 1, 10 rad/s: pass → fail")
    assert [line.split(" ")[0] for line in lines] == ["::error"] * len(lines)
    assert all("\n" not in line for line in lines)
    assert sum("answers missing" in line for line in lines) == 2
    assert sum("no longer detected" in line for line in lines) == 1
    old = gate_text.annotations(compared(BAD, BAD), tmp_path, {})
    assert [line.split(" ")[0] for line in old] == ["::warning"] * 2  # misses, but old ones


def test_a_summary_s_tables_are_cut_and_say_so() -> None:
    many = tuple(replace(CELL, mode=k, value=float(k)) for k in range(1, 72))
    after = tuple(replace(c, value=(c.value or 0.0) * (1 + 1e-6)) for c in many)
    comparison = compared(replace(RUN, cells=after), replace(RUN, cells=many))
    output = gate_text.markdown(comparison, False, {})
    assert "✔ gate passed: 71 cells" in output
    assert "… and 21 more" in output
    assert output.count("+1.0e-06") == 50
    assert "| 1.000001 " in output


@pytest.fixture
def folders(tmp_path: Path) -> Callable[[str], str]:
    for name, run in {"before": BEFORE, "after": BAD}.items():
        (tmp_path / name).mkdir()
        results_file.write(tmp_path / name / "results.jsonl", run)
    moved = replace(BEFORE, cells=at(BEFORE.cells, 1, value=20.1))
    results_file.write(tmp_path / "moved.jsonl", moved)
    more = replace(BEFORE, cells=(*BEAM, *(replace(c, case="another") for c in BEAM)))
    results_file.write(tmp_path / "two.jsonl", more)
    results_file.write(tmp_path / "one.jsonl", replace(BEFORE, cells=BEAM))
    for commit in ("good1", "bad2"):
        run = BEFORE if commit == "good1" else BAD
        history.append(tmp_path / "history.jsonl", history.entry(run, commit))
    (tmp_path / "empty").write_bytes(b"")
    return lambda line: line.format(tmp_path)


@pytest.mark.parametrize(
    ("line", "expected", "phrase"),
    [
        ("{0}/before --against {0}/before", 0, "✔ gate passed: 6 cells against .*before: nothing moved"),
        ("{0}/before --against {0}/before/results.jsonl", 0, "nothing moved"),
        ("{0}/after --against {0}/before", 1, "✘ gate failed: 3 cells .*: 2 worse, 4 gone, 1 seeded faults no longer"),
        ("{0}/after --against {0}/history.jsonl --failed-baseline", 0, "against bad2"),
        ("{0}/after", 1, "3 cells against no baseline: 2 worse, 3 new"),
        ("{0}/before", 0, "✔ gate passed: 6 cells against no baseline: 6 new"),
        ("{0}/one.jsonl --against {0}/two.jsonl", 1, "3 cells .*: 3 gone"),
        ("{0}/one.jsonl --against {0}/two.jsonl --partial", 0, "nothing moved"),
        ("{0}/after --against {0}/history.jsonl --commit goo", 1, "against good1"),
        ("{0}/moved.jsonl --against {0}/before", 0, r"20 rad.s +20.1 rad.s +\+5.0e-03"),
        ("{0}/moved.jsonl --against {0}/before --strict", 1, "✘ gate failed: 6 cells .*: 1 moved"),
        ("{0}/moved.jsonl --against {0}/before --strict --tolerance 0.01", 0, "nothing moved"),
    ],
)
def test_the_command_compares_two_runs(
    folders, capsys: pytest.CaptureFixture[str], line: str, expected: int, phrase: str
) -> None:
    status, out, err = southwell(f"gate {folders(line)}", capsys)
    assert (status, err) == (expected, "")
    assert re.search(phrase, out)


def test_a_failed_baseline_is_refused_unless_it_is_accepted(folders, capsys: pytest.CaptureFixture[str]) -> None:
    """Compared with a run that failed, every failure is as before."""
    status, out, err = southwell(f"gate {folders('{0}/after --against {0}/after')}", capsys)
    assert (status, out) == (2, "")
    assert "has 2 failures" in err
    assert "--failed-baseline" in err


def test_the_verdict_comes_first_and_tables_are_short_and_in_the_units_of_the_case() -> None:
    many = tuple(replace(CELL, mode=k, omega=np.pi, value=2.0 * np.pi * k) for k in range(1, 72))
    after = tuple(replace(c, value=(c.value or 0.0) * (1 + 1e-3)) for c in many)
    comparison = compared(replace(RUN, cells=after), replace(RUN, cells=many))
    (table,) = gate_text.tables(comparison, {CELL.case: BY_KEY["rpm"]}, 120)
    assert isinstance(table, Table)
    assert table.row_count == 10
    assert "the first 10 of 71" in str(table.title)
    assert [next(iter(c.cells)) for c in table.columns[2:6]] == ["30 rpm", "1 (edgewise)", "1 Hz", "1.001 Hz"]


def test_the_command_writes_what_ci_shows(folders, tmp_path: Path, capsys, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "summary.md").write_text("before\n")
    line = "gate after --against before --junit j.xml --summary summary.md --annotations"
    status, out, _ = southwell(line, capsys)
    assert status == 1
    assert "::error title=beam::some-code" in out
    output = (tmp_path / "summary.md").read_text()
    assert output.startswith(
        "before\n### Southwell\n\n**No: 1 answer contradicts Southwell's own solver.** 3 cells: 1 ✘ fail"
    )
    assert "**✘ gate failed" in output
    assert len(ElementTree.parse(tmp_path / "j.xml").findall(".//testcase")) == 8


@pytest.mark.parametrize(
    ("line", "phrase"),
    [
        ("{0}/none --against {0}/before", "none: cannot be read"),
        ("{0}/after --against {0}/none", "none: cannot be read"),
        ("{0}/after --against {0}/empty", "contains no runs"),
        ("{0}/after --against {0}/history.jsonl --commit god1", "did you mean good1"),
        ("{0}/after --against {0}/before --commit x", "one run, not a history"),
        ("{0}/after --against {0}/before --junit {0}/none/j.xml", "--junit .*cannot be written"),
        ("{0}/after --against {0}/before --tolerance -1", "tolerance"),
        ("{0}/after --commit x", "no history"),
    ],
)
def test_bad_input_is_one_line(folders, capsys: pytest.CaptureFixture[str], line: str, phrase: str) -> None:
    status, _, err = southwell(f"gate {folders(line)}", capsys)
    assert (status, err.count("\n")) == (2, 1)
    assert re.search(phrase, err)


@pytest.mark.slow
def test_verify_writes_junit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "j.xml"
    line = f"verify rotating-cable --codes southwell-equation --faults none --workers 1 --out {tmp_path} --junit {file}"
    status, _, _ = southwell(line, capsys)
    run = results_file.read(tmp_path / "results.jsonl")
    root = ElementTree.parse(file)
    assert status == 0
    assert min(len(run.cells), len(run.property_checks)) > 0
    assert len(root.findall(".//testcase")) == len(run.cells) + len(run.property_checks)


def test_an_incomplete_run_does_not_pass(folders, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Every cell that is there is as it was; the last line is missing."""
    (tmp_path / "cut.jsonl").write_bytes(
        (tmp_path / "before" / "results.jsonl").read_bytes().rpartition(b'{"kind":"end"')[0]
    )
    for strict in ("", "--strict"):
        line = folders(f"gate {{0}}/cut.jsonl --against {{0}}/before --junit {{0}}/j.xml {strict}")
        status, out, _ = southwell(line, capsys)
        assert status == 3
        assert out.startswith("Incomplete: the file does not end with the completion record of the run.\n")
    suite = ElementTree.parse(tmp_path / "j.xml").getroot()[0]
    assert (suite.get("errors"), suite.get("failures")) == ("1", "0")
    assert "Incomplete: " in (suite[0][0].get("message") or "")
    status, out, _ = southwell(folders(f"dashboard {{0}}/cut.jsonl --out {tmp_path / 'site'}"), capsys)
    assert (status, out.splitlines()[0].startswith("cut.jsonl: Incomplete: ")) == (3, True)
    assert "Incomplete: " in (tmp_path / "site" / "index.html").read_text()


def test_a_folder_with_an_unfinished_run_has_no_finished_one(
    folders, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """An earlier complete run lies in the folder, and a later one was killed in it."""
    with Unfinished(tmp_path / "before") as file:
        file.begin(BEFORE)
        file.put("x", True, codec.encode((list(BEFORE.cells), [])))
    status, out, _ = southwell(folders("gate {0}/before"), capsys)
    assert (status, out.splitlines()[0]) == (3, "Incomplete: the run was stopped before its results were written.")
    earlier = (tmp_path / "before" / "results.jsonl").read_bytes()
    assert southwell(folders("report {0}/before"), capsys)[0] == 3
    assert (tmp_path / "before" / "results.jsonl").read_bytes() == earlier
    assert not (tmp_path / "before" / "report.md").exists()
    assert southwell(folders("gate {0}/before/results.jsonl"), capsys)[0] == 0
