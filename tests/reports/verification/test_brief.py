"""The summary on two pages: what its cover, margins and changes say, and that it has no more than two pages."""

import re
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import pytest

from southwell.cases.judge.results import Origin, Run, Setting
from southwell.cases.store.results_file import RESULTS, write
from southwell.reports.documents import pdf
from southwell.reports.verification import brief

from ...support import samples
from ..cli.test_cli import southwell


def many(number: int) -> Run:
    """A run of blades, the first with the smallest margin."""
    cells = [
        samples.cell(case=f"blade-{k}", shares="nothing", difference=(5e-4 if k == 0 else 1e-4), uncertainty=1e-4)
        for k in range(number)
    ]
    settings = [Setting(c.case, "title", "description", "source", "rpm", target=1e-3) for c in cells]
    return Run(tuple(cells), settings=tuple(settings), command="southwell verify", versions={"python": "3.11"})


def test_the_cover_has_number_revision_digests_and_the_page_the_smallest_margins_first(tmp_path: Path) -> None:
    run = many(30)
    write(tmp_path / RESULTS, run)
    text = brief.render(run, tmp_path, brief.Document("SW-001", "B", ["✔ gate passed: nothing moved"]))
    assert re.search(r"\| ?document \| ?SW-001 \|", text)
    assert sha256((tmp_path / RESULTS).read_bytes()).hexdigest() in text
    assert "✔ gate passed: nothing moved" in text
    margins = text[text.index("## Margins") :]
    assert margins.count("blade-") == brief.ROWS
    assert "10 of 30" in margins
    assert "not compared" not in text.lower()


def test_the_margin_is_the_part_of_the_target_that_difference_and_uncertainty_use(tmp_path: Path) -> None:
    """(5e-4 + 1e-4) / 1e-3 = 60 %; only answers of declared origin that share nothing count."""
    run = many(2)
    origins = tuple(Origin(f"blade-{k}", "alpha", *["other"] * 5) for k in range(2))
    write(tmp_path / RESULTS, run)
    rows = brief.render(replace(run, origins=origins), tmp_path, brief.Document()).partition("## Margins")[2]
    first = next(line for line in rows.splitlines() if "blade-0" in line)
    assert "60 %" in first
    assert "20 %" in next(line for line in rows.splitlines() if "blade-1" in line)


def test_two_pages_are_enough_for_many_blades(tmp_path: Path) -> None:
    pytest.importorskip("typst")
    pypdf = pytest.importorskip("pypdf")
    run = many(30)
    write(tmp_path / RESULTS, run)
    (tmp_path / "figures").mkdir()
    svg = '<svg xmlns="http://www.w3.org/2000/svg" width="576pt" height="380pt"></svg>'
    (tmp_path / "figures" / "blade-0-campbell.svg").write_text(svg)
    page = brief.write(run, tmp_path, brief.Document("SW-001", "B", ["✔ gate passed", "moved: 3", "numpy 1 → 2"]))
    assert "figures/blade-0-campbell.svg" in page.read_text(encoding="utf-8")
    assert len(pypdf.PdfReader(pdf.write(page)).pages) == 2


def test_one_command_writes_all_pages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = many(2)
    write(tmp_path / RESULTS, run)
    (tmp_path / "report.md").write_text("# Report\n")
    earlier = tmp_path / "earlier.jsonl"
    write(earlier, replace(run, cells=tuple(replace(c, value=11.8) for c in run.cells)))
    status, out, err = southwell(f"pages {tmp_path} --document SW-001 --since {earlier}", capsys)
    assert (status, err) == (0, "")
    for name in ("summary.md", "report.html", "summary.html", "dashboard/index.html"):
        assert (tmp_path / name).is_file()
        assert name in out
    assert "2 moved" in (tmp_path / "summary.md").read_text(encoding="utf-8")
