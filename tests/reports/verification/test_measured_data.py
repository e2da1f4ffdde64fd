"""Measured data wherever results are shown: counted by themselves, explained, and never part of a verdict."""

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from southwell.cases.judge import checks, results
from southwell.cases.judge.results import Planned, Run
from southwell.cases.regression import gate, history
from southwell.cases.store import results_file
from southwell.reports.ci import gate_text, junit
from southwell.reports.dashboard import data
from southwell.reports.shared import summary
from southwell.reports.shared.units import RAD_S
from southwell.reports.verification import evidence, figures, report, terminal

from ...support import samples

VISIBLE = "model error visible (at least 6.0 %): E = +10.00 %, u_val = 2.00 % from u_num 0, u_input 0, u_D 2.00 %"
NOT = "model error not visible at u_val = 20.0 %: E = +10.00 %, u_val from u_num 0, u_input 0, u_D 20.00 %"


def datum(uncertainty: float, reason: str, **changes: object) -> results.Cell:
    values: dict[str, object] = {
        "code": "rig", "version": "measured, in rig.csv", "role": "measured", "verdict": "measured", "shares": "",
        "omega": 13.0, "mode": 2, "family": "flapwise", "ordinal": 1, "value": 18.0, "reference": 20.0, "full": 20.0,
        "difference": -0.1, "uncertainty": uncertainty, "reason": reason, "elements": None, "order": None, "mac": None,
    }  # fmt: skip
    return samples.cell(**{**values, **changes})


SEEN, UNSEEN = datum(0.04, VISIBLE), datum(0.4, NOT, omega=17.0)
PLAIN = Run((samples.cell(), samples.cell(omega=20.0, mode=2, family="flapwise", shares="nothing")))
WITH = replace(PLAIN, cells=(*PLAIN.cells, SEEN, UNSEEN))


def test_measured_data_change_no_status_and_no_verdict() -> None:
    assert summary.status(WITH) == summary.status(PLAIN) == 0
    assert evidence.verdict(WITH) == "Yes: nothing contradicts Southwell's own solver."
    alone = Run((SEEN, UNSEEN))
    assert evidence.verdict(alone) == "Open: nothing was compared."
    assert summary.status(alone) == 1


def test_measured_data_are_counted_separately_and_explained() -> None:
    assert "2 ✔ pass, 2 ◇ measured" in evidence.answer(WITH)
    (line,) = (line for line in report.headline(WITH) if line.startswith("Measured"))
    assert line.startswith("Measured: 2 frequencies, no evidence: model error visible in 1, at least 6.7 % (")
    assert line.endswith("beam, rig, flapwise 1, 13 rad/s); not visible in 1.")
    (row,) = (r for r in evidence.rows(WITH) if r["evidence"].startswith("measured data"))
    assert row["answers"] == "2 ◇"
    assert "at least 6.0 %" in row["worst, relative to target"]
    text = report.render(WITH, {})
    assert "### Measured data" in text
    assert text.count(r"u\_D 2.00 %") == text.count(r"u\_D 20.00 %") == 1
    assert "contradicts Southwell's own solver" not in text.replace("nothing contradicts Southwell's own solver", "")
    assert "◇" in terminal.legend()


def test_measured_data_have_no_target_in_the_dashboard() -> None:
    cells = data.of_case(WITH, "beam")["cells"]
    assert [(c["target"], c["bar"]) for c in cells] == [
        ("0.10 %", None),
        ("0.10 %", None),
        ("none", 0.8),
        ("none", 8.0),
    ]
    names = [v["name"] for v in data.verdicts()]
    assert [names[t["verdict"]] for t in data.verdict_counts(WITH, "beam")] == ["pass", "measured"]
    assert data.of_case(WITH, "beam")["lines"] == data.of_case(PLAIN, "beam")["lines"]


def test_measured_data_are_skipped_in_junit() -> None:
    root = ElementTree.fromstring(junit.render(WITH))
    suite = root.find("testsuite")
    assert suite is not None
    assert (suite.get("tests"), suite.get("failures"), suite.get("skipped")) == ("4", "0", "2")
    messages = [s.get("message", "") for s in suite.iter("skipped")]
    assert all(m.startswith("measured: −10 % ±") for m in messages)


def entry(run: Run) -> history.Entry:
    return history.entry(run, "commit", "machine")


def test_changes_of_measured_data_pass_the_gate() -> None:
    """Not that they come, go, move, or show more of the model's error."""
    moved = replace(WITH, cells=(*PLAIN.cells, replace(SEEN, value=15.0, difference=-0.25, target=0.5)))
    for before, after in ((PLAIN, WITH), (WITH, PLAIN), (WITH, moved), (moved, WITH)):
        comparison = gate.compare(entry(before), entry(after))
        assert comparison.passed(strict=True)
        assert (comparison.worse, comparison.gone, comparison.moved, comparison.loosened, comparison.new) == ((),) * 5
    assert gate_text.verdict(gate.compare(entry(PLAIN), entry(WITH)), False).endswith(
        "nothing moved; 2 measured, not judged"
    )


def test_an_answer_replaced_by_a_measurement_fails_the_gate() -> None:
    renamed = replace(PLAIN.cells[0], role="measured", verdict="measured")
    comparison = gate.compare(entry(PLAIN), entry(replace(PLAIN, cells=(renamed, PLAIN.cells[1]))))
    assert [(g.point.code, g.replacement) for g in comparison.gone] == [("alpha", "measured")]
    assert not comparison.passed()


def test_only_measured_data_are_measured(tmp_path: Path) -> None:
    for cell in (replace(SEEN, role="code"), replace(SEEN, verdict="pass"), replace(SEEN, ordinal=0)):
        with pytest.raises(checks.RowError):
            checks.check(cell)
    checks.check(replace(SEEN, verdict="not applicable"))
    checks.check(replace(SEEN, quantity="damping", value=-0.1))
    for cell in (replace(SEEN, quantity="colour"), replace(SEEN, value=-0.1)):
        with pytest.raises(checks.RowError):
            checks.check(cell)
    path = tmp_path / "results.jsonl"
    results_file.write(path, replace(WITH, plan=(Planned("beam", "rig", 0, 0),)))
    assert results_file.read(path).cells == WITH.cells


def test_measured_points_do_not_change_the_lines() -> None:
    run = samples.run()
    with_data = replace(run, cells=(*run.cells, SEEN, UNSEEN))
    figure = figures.campbell(with_data, "beam", RAD_S)
    assert figure is not None
    axes = figure.axes[0]
    (bars,) = axes.containers
    assert bars.lines[0].get_xdata().tolist() == [13.0, 17.0]  # type: ignore[union-attr]
    assert figures.core_lines([c for c in with_data.cells if c.role != "measured"]) == figures.core_lines(run.cells)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "rig, measured, ± 2 u_val" in labels
    drawing = figures.differences(with_data, "beam", RAD_S)
    assert drawing is not None
    assert "rig" not in [t.get_text() for t in drawing.axes[0].get_yticklabels()]
