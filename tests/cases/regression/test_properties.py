"""Checks of properties reach the history, the gate, JUnit and the dashboard."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import get_args
from xml.etree import ElementTree

import pytest

from southwell.cases.judge.results import PropertyCheck, Run, Verdict
from southwell.cases.regression import gate, history
from southwell.cases.store import results_file
from southwell.reports.ci import gate_text, junit
from southwell.reports.dashboard.data import of_case
from southwell.reports.dashboard.past import of_history
from southwell.reports.dashboard.write import write

from ...reports.cli.test_cli import southwell
from .test_history import CELL, RUN

READING = PropertyCheck(
    "beam", "weio", "2.0.0", "reading", "edgewise stiffness", 1e-6, "pass", "", 3.0, 3.0, "N m²", 0.0
)
MODEL = replace(READING, code="southwell", quantity="fingerprint", part="mass", unit="kg")
TURNED = replace(READING, code="southwell", quantity="invariance", part="section axes turned", unit="rad/s")
CHECKS = (READING, MODEL, TURNED)
RIGHT = replace(RUN, cells=(CELL,), property_checks=CHECKS)
EXCHANGED = replace(READING, value=30.0, difference=0.9, verdict="fail", reason="edgewise stiffness: reader 30, weio 3")
WRONG = replace(RIGHT, property_checks=(EXCHANGED, MODEL, TURNED))


def compared(after: Run, before: Run = RIGHT) -> gate.Comparison:
    return gate.compare(history.entry(before, "before", "m"), history.entry(after, "after", "m"))


def test_a_history_keeps_the_checks(tmp_path: Path) -> None:
    history.append(tmp_path / "history.jsonl", history.entry(WRONG, "abc"))
    (entry,) = history.read(tmp_path / "history.jsonl").entries
    assert [(p.code, p.part, p.verdict) for p in entry.properties] == [
        (c.code, c.part, c.verdict) for c in WRONG.property_checks
    ]
    assert gate.misses(entry) == 1
    assert [(r["wrong"], r["properties"]) for r in of_history(history.read(tmp_path / "history.jsonl"))["runs"]] == [
        (1, 3)
    ]


CHECKED = ("pass", "inconclusive", "fail")


@pytest.mark.parametrize("before", [None, *get_args(Verdict)[:1], "inconclusive", "fail", "not run", "not applicable"])
@pytest.mark.parametrize("after", [None, "pass", "inconclusive", "fail", "not run", "not applicable"])
def test_a_worse_or_missing_check_fails(before: Verdict | None, after: Verdict | None) -> None:
    runs = [replace(RIGHT, property_checks=(replace(READING, verdict=v),) if v else ()) for v in (before, after)]
    comparison = compared(runs[1], runs[0])
    order = [*CHECKED, None, "not run", "not applicable"]
    now = min(order.index(after), len(CHECKED))
    counts = now > order.index(before) if before in CHECKED else after == "fail"
    assert (len(comparison.properties), comparison.passed()) == (int(counts), not counts)


def test_a_partial_run_is_compared_in_its_own_cases() -> None:
    other = tuple(replace(c, case="another") for c in CHECKS)
    before = history.entry(replace(RIGHT, property_checks=(*CHECKS, *other)), "before")
    after = history.entry(RIGHT, "after")
    assert len(gate.compare(before, after).properties) == 3
    assert gate.compare(gate.within(before, after), after).passed()


def test_a_fault_without_effect_is_no_failure_of_a_baseline() -> None:
    (control,) = RUN.controls
    blind = replace(control, control="reader: precone's sign", detected_by=(), without_effect="changes no property")
    entry = history.entry(replace(RIGHT, controls=(control, blind)), "before")
    assert gate.misses(entry) == 0
    assert [c.control for c in entry.controls] == [control.control]
    missed = history.entry(replace(RIGHT, controls=(replace(blind, without_effect=""),)), "before")
    assert gate.misses(missed) == 1


def test_the_gate_says_which_property() -> None:
    comparison = compared(WRONG)
    assert gate_text.verdict(comparison, False).endswith("1 properties wrong or no longer checked")
    ((title, (row,)),) = gate_text.sections(comparison, {})
    assert title == "Properties that are wrong or no longer checked"
    assert row == {
        "case": "beam", "check": "reading, weio", "property": "edgewise stiffness", "difference": "+0.9",
        "verdict": "pass → fail",
    }  # fmt: skip
    (line,) = gate_text.annotations(comparison, Path("/none"), {})
    assert line == "::error title=beam::reading by weio: edgewise stiffness (pass → fail)"
    lost = compared(replace(RIGHT, property_checks=()))
    assert [row["verdict"] for row in gate_text.sections(lost, {})[0][1]] == ["pass → not there"] * 3


def test_junit_has_a_test_case_for_each_check_and_for_each_that_is_gone() -> None:
    root = ElementTree.fromstring(junit.render(WRONG, compared(WRONG)))
    (suite,) = root
    assert (suite.get("tests"), suite.get("failures")) == ("4", "1")
    failed = suite.find("testcase[@name='reading by weio: edgewise stiffness']/failure")
    assert failed is not None
    assert failed.get("message") == "fail: edgewise stiffness: reader 30, weio 3"
    absent = replace(READING, part="", verdict="not run", reason="weio is not installed")
    lost = replace(RIGHT, property_checks=(absent, MODEL, TURNED))
    root = ElementTree.fromstring(junit.render(lost, compared(lost)))
    suites = {s.get("name"): s for s in root}
    assert suites["beam"].get("skipped") == "1"
    (gone,) = suites["against the earlier run"]
    assert gone.get("name") == "reading by weio: edgewise stiffness"


def test_a_wrong_reading_fails_the_gate_of_a_user(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, run in (("right", RIGHT), ("wrong", WRONG)):
        results_file.write(tmp_path / f"{name}.jsonl", run)
    for against in (f" --against {tmp_path}/right.jsonl", ""):
        status, out, _ = southwell(f"gate {tmp_path}/wrong.jsonl{against}", capsys)
        assert (status, "edgewise stiffness" in out) == (1, True)
    status, _, err = southwell(f"gate {tmp_path}/right.jsonl --against {tmp_path}/wrong.jsonl", capsys)
    assert (status, "has 1 failure:" in err) == (2, True)


def test_the_dashboard_shows_them(tmp_path: Path) -> None:
    other = replace(CELL, case="another")
    run = replace(WRONG, cells=(CELL, other), property_checks=(*WRONG.property_checks, replace(MODEL, case="another")))
    page = write({"a run": run}, None, tmp_path).read_text(encoding="utf-8")
    text = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)
    assert text
    rows = json.loads(text[1])["properties"]
    assert [(r["case"], r["check"], r["count"], r["properties"]) for r in rows] == [
        ("beam", "Second reading", "1 of 1", ["edgewise stiffness"]),
        ("beam", "Model of Southwell's own solver", "1 of 1", []),
        ("beam", "Invariance", "1 of 1", []),
        ("another", "Model of Southwell's own solver", "1 of 1", []),
    ]
    assert [r["property"] for r in of_case(run, "beam")["properties"]] == [c.part for c in CHECKS]
    assert of_case(run, "beam")["answer"].startswith("No: 1 property of the blade differs in a second reading")
    assert not of_case(run, "another")["answer"].startswith("No")
