"""Seeded faults: at least forty, the fast ones detected in every run; a blind harness says so."""

import threading
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from southwell.cases.faults import mechanisms, seeding, table
from southwell.cases.faults.table import ALL, BY_NAME, FAST
from southwell.cases.input.errors import CaseError
from southwell.cases.judge import printed, refined, verdict
from southwell.cases.judge.results import Control, Run
from southwell.cases.store import results_file
from southwell.references.protocol.description import Description
from southwell.reports.shared import summary
from southwell.reports.verification import controls as reported

from ...support import counting_canaries, gate_canaries, samples


def test_the_table_of_faults_is_large_and_names_are_unique() -> None:
    assert len(ALL) == len(BY_NAME) >= 40
    areas = Counter(f.area for f in ALL)
    assert set(areas) == {"solver", "adapter", "pairing", "uncertainty", "verdict", "reader"}
    assert len(FAST) == 7
    assert all(f.description and f.size and f.seams for f in ALL)
    assert all(f.trial or f.blinds for f in ALL)
    assert all(f.blinds in BY_NAME for f in ALL if f.blinds)


@pytest.mark.parametrize("canaries", [counting_canaries, gate_canaries])
def test_checks_of_counting_history_and_gate_pass_without_a_fault(canaries: Any) -> None:
    assert canaries.canaries() == []


@pytest.mark.parametrize(
    ("canaries", "seam"),
    [
        pytest.param(canaries, seam, id=name)
        for canaries in (counting_canaries, gate_canaries)
        for name, seam in canaries.FAULTS.items()
    ],
)
def test_a_fault_in_counting_history_or_gate_is_detected(canaries: Any, seam: seeding.Seam) -> None:
    with seeding.seeded([seam]):
        assert canaries.canaries()


@pytest.mark.slow
def test_one_fault_of_each_other_kind_is_detected() -> None:
    """All of them are seeded every night, by ``verify --faults all``."""
    for control in table.run(["wide bracket", "unsupported() raises", "paired by number", "all is known"]):
        assert control.detected_by, control.control


@pytest.mark.slow
@pytest.mark.parametrize("name", [f.name for f in mechanisms.FAULTS])
def test_a_fault_in_mechanisms_is_detected(name: str) -> None:
    (control,) = table.run([name])
    if control.needs:
        pytest.skip(f"not installed: {control.needs}")
    assert control.detected_by


@pytest.mark.slow
def test_a_fault_that_does_nothing_is_missed() -> None:
    harmless = replace(BY_NAME["no hub radius"], seams=())
    assert seeding.execute(harmless, BY_NAME.__getitem__).missed


@pytest.mark.slow
def test_a_judge_that_passes_everything_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(refined, "judge", lambda *_: ("pass", ""))
    monkeypatch.setattr(printed, "discretised", lambda *_: ("pass", ""))
    seeding.faultless.cache_clear()
    (control,) = table.run(["no hub radius"])
    seeding.faultless.cache_clear()
    assert control.missed


def test_a_fault_that_needs_a_missing_code_is_not_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(seeding, "descriptions", lambda trial: tuple(Description(name, name) for name in trial.codes))
    (control,) = table.run(["no hub radius"])
    assert (control.needs, control.missed) == ("exact-beam", False)


def test_a_fault_acts_in_its_own_thread_only_and_is_removed_afterwards() -> None:
    original = verdict.unsigned
    with seeding.seeded(((verdict, "unsigned", lambda _: lambda value: "wrong"),)):
        assert verdict.unsigned(0.1) == "wrong"
        with ThreadPoolExecutor(1) as pool:
            assert pool.submit(lambda: (threading.get_ident(), verdict.unsigned(0.1))).result()[1] == "10.00 %"
    assert verdict.unsigned is original


def test_a_fault_in_a_missing_function_is_an_error() -> None:
    with pytest.raises(AttributeError), seeding.seeded(((verdict, "nothing_like_it", lambda original: original),)):
        pass


def test_faults_are_chosen_by_name() -> None:
    assert table.chosen("fast") == FAST
    assert table.chosen("all") == tuple(BY_NAME)
    assert table.chosen("none") == ()
    assert table.chosen("crash, no twist") == ("crash", "no twist")
    with pytest.raises(CaseError, match="no hub radius"):
        table.chosen("no hub radios")


def control(**changes: object) -> Control:
    fields: dict = {
        "control": "no hub radius", "area": "solver", "what": "it lies on the axis", "size": "−3 %", "case": "beam",
        "omega": 10.0, "detected_by": ("beam, exact-beam: fail",), "change": 0.03,
    }  # fmt: skip
    return Control(**{**fields, **changes})


def test_a_missed_fault_is_status_1_and_is_named() -> None:
    good = Run((samples.cell(),), controls=(control(), control(control="x", detected_by=(), needs="exudyn-tree")))
    assert summary.status(good) == 0
    headline = reported.headline(good)
    assert headline.startswith("1 of 1 seeded faults, run through")
    assert headline.endswith("detected; 1 were not run, because a code is missing.")
    blind = replace(good, controls=(control(detected_by=()),))
    assert summary.status(blind) == 1
    assert "not detected: no hub radius" in reported.headline(blind)
    assert [row["outcome"] for row in reported.overview(replace(good, controls=(*good.controls, *blind.controls)))] == [
        "✔ detected", "○ needs exudyn-tree", "✘ missed",
    ]  # fmt: skip
    assert reported.headline(Run(())) == ""


def test_results_of_faults_are_read_as_written(tmp_path: Path) -> None:
    written = Run((samples.cell(),), controls=(control(), control(control="x", detected_by=(), change=None)))
    results_file.write(tmp_path / "results.jsonl", written)
    assert results_file.read(tmp_path / "results.jsonl") == written
