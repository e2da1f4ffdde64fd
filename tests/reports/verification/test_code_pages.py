"""A page for each code: every number is the run's and every refusal its adapter's."""

import re
from pathlib import Path

import pytest

from southwell.cases.judge.results import Cell, Run, Verdict
from southwell.cases.store import results_file
from southwell.references.protocol import registry
from southwell.references.protocol.description import Description
from southwell.reports.cli import app as cli
from southwell.reports.cli import arguments
from southwell.reports.verification import code_pages


def described(name: str) -> Description:
    (description,) = code_pages.described([name])
    return description


def cell(code: str, case: str, difference: float | None, verdict: Verdict, mode: int = 1, reason: str = "") -> Cell:
    f = None if difference is None else 100.0 * (1 + difference)
    return Cell(
        case=case,
        omega=10.0,
        mode=0 if difference is None else mode,
        family="" if difference is None else "flapwise",
        ordinal=0 if difference is None else mode,
        code=code,
        version="9.9",
        role="code",
        value=f,
        reference=None if f is None else 100.0,
        difference=difference,
        uncertainty=None if f is None else 1e-5,
        target=1e-3,
        verdict=verdict,
        reason=reason,
        full=None if f is None else 100.0,
    )


RUN = Run(
    cells=(
        cell("scikit-fem", "first", 2e-4, "pass"),
        cell("scikit-fem", "first", -5e-4, "pass", mode=2),
        cell("scikit-fem", "second", 0.25, "fail", reason="25 % exceeds 0.1 %"),
        cell("scikit-fem", "third", None, "not applicable", reason="prebend or sweep"),
        cell("exudyn-tree", "first", 7e-4, "pass"),
    ),
    versions={"scikit-fem": "9.9", "drake": "not installed"},
    command="southwell verify first",
)


def rows(text: str) -> list[list[str]]:
    return [[f.strip() for f in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]


def test_the_largest_difference_of_each_blade_is_the_runs() -> None:
    head, _, *body = rows(code_pages.differences(RUN, code_pages.own(RUN, "scikit-fem")))
    assert head == ["blade", "cells", "worst difference", "where", "why"]
    assert body == [
        ["first", "2 ✔", "✔ −0.0500 % ± 0.0010 %", "flapwise 2, 10 rad/s", ""],
        ["second", "1 ✘", "✘ +25 % ± 0.0010 %", "flapwise 1, 10 rad/s", "25 % exceeds 0.1 %"],
        ["third", "1 –", "", "", "prebend or sweep"],
    ]


def test_a_failure_does_not_hide_behind_a_larger_known_difference() -> None:
    cells = (cell("scikit-fem", "first", 0.3, "known difference"), cell("scikit-fem", "first", 0.002, "fail"))
    _, _, (_, counted, output, *_) = rows(code_pages.differences(Run(cells), cells))
    assert counted == "1 ✘, 1 ≈"
    assert output.startswith("✘ +0.200 %")


def test_a_page_has_version_and_refusals() -> None:
    text = code_pages.page(RUN, described("scikit-fem"))
    assert text.startswith(
        "# scikit-fem, prestressed beam\n\n`scikit-fem`, 9.9. Shares with Southwell's own solver: **nothing**."
    )
    taken = {row[0]: row[1] for row in rows(text.partition("## Accepted properties")[2])}
    assert taken["twist"] == "taken"
    assert taken["shear flexibility"].startswith("refused: finite shear stiffness")


def test_neglected_properties_are_not_listed_as_included() -> None:
    taken = {row[0]: row[1] for row in rows(code_pages.properties(described("exudyn-ancf")))}
    assert taken["rotary inertia"] == "left out, as declared"


def test_a_code_without_cells_is_reported() -> None:
    text = code_pages.page(RUN, described("exact-beam"))
    assert "This run has no cells of this code." in text


def test_every_code_has_a_page_and_the_index_leads_to_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results_file.write(tmp_path / arguments.RESULTS, RUN)
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["codes", "--pages", str(tmp_path)])
    assert exit_info.value.code == 0
    index = tmp_path / "codes" / "index.md"
    assert capsys.readouterr().out.strip() == str(index)
    text = index.read_text(encoding="utf-8")
    linked = re.findall(r"\]\(([^)]+)\)", text)
    assert linked == [f"{name}.md" for name in registry.names()]
    assert all((tmp_path / "codes" / name).read_text(encoding="utf-8").startswith("# ") for name in linked)
    (line,) = (row for row in rows(text) if "(scikit-fem.md)" in row[0])
    assert line[3:] == [
        "1 ✘, 2 ✔, 1 –",
        "✘ +25 % ± 0.0010 % (second)",
    ]


def test_a_folder_without_results_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as exit_info:
        cli.main(["codes", "--pages", str(tmp_path)])
    assert exit_info.value.code == 2
    assert "No such file" in capsys.readouterr().err
