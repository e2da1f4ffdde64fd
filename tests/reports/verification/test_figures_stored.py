"""Figures taken from the store of answers: the same bytes, and drawn again when a row of their case changes."""

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from southwell.cases.judge.results import Run
from southwell.references.protocol import store
from southwell.reports.shared.units import Units
from southwell.reports.verification import drawing, report
from southwell.reports.verification.figures import differences

from ...support import samples

DRAWN: Counter[str] = Counter()


def counted(run: Run, case: str, units: Units, among: tuple[str, ...]) -> Figure | None:
    DRAWN[case] += 1
    return differences(run, case, units, among)


@pytest.fixture(autouse=True)
def stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(store.FRESH, raising=False)
    monkeypatch.setenv("SOUTHWELL_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(drawing, "FIGURES", {"differences": counted})
    DRAWN.clear()


def written(run: Run, folder: Path) -> dict[str, bytes]:
    report.write(run, folder)
    return {path.name: path.read_bytes() for path in (folder / "figures").iterdir()}


def test_figures_are_drawn_once(tmp_path: Path) -> None:
    first, second = (written(samples.run(), tmp_path / name) for name in ("first", "second"))
    assert first
    assert first == second
    assert set(DRAWN.values()) == {1}


def test_a_changed_row_and_a_further_column_are_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the case of the row is drawn again; a further column may change the colours of all."""
    run = samples.run()
    before = written(run, tmp_path / "before")
    moved = [replace(c, difference=3.0 * c.difference) if c.case == "beam" and c.difference else c for c in run.cells]
    after = written(replace(run, cells=tuple(moved)), tmp_path / "after")
    assert before["beam-differences.svg"] != after["beam-differences.svg"]
    assert {case for case, times in DRAWN.items() if times == 2} == {"beam"}
    written(replace(run, cells=(samples.cell(case="another", code="a code before all"), *run.cells)), tmp_path / "more")
    assert DRAWN["beam"] == 3
    monkeypatch.setenv(store.FRESH, "1")
    written(run, tmp_path / "fresh")
    assert DRAWN["beam"] == 4
