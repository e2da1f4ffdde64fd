"""The report: verdict first, every cell that is not a plain pass with its reason, nothing lost, nothing smuggled in."""

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from markdown_it import MarkdownIt

from southwell.cases.judge.results import Cell, Control, Origin, Run, Setting
from southwell.cases.store.results_file import read, write
from southwell.reports.documents import document, html, print_nodes
from southwell.reports.shared import summary
from southwell.reports.shared.markdown import plain
from southwell.reports.shared.units import RAD_S
from southwell.reports.verification import evidence, paper_table
from southwell.reports.verification import report as matrix_report
from southwell.reports.verification.case_tables import comparison

from ...support import samples

TWIN = Origin("beam", "alpha", "other", "other", "other", "other", "other")

HOSTILE = "<script>alert(1)</script> | ![x](y) `a` *b* [c](d)\n# head ~~e~~"


def rendered(text: str) -> str:
    return MarkdownIt("commonmark").enable(["table", "strikethrough"]).render(text)


class Tables(HTMLParser):
    """Rows of all tables, as lists of text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tables: list[list[list[str]]] = []
        self.inside = False
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        if tag == "table":
            self.tables.append([])
        elif tag == "tr":
            self.tables[-1].append([])
        elif tag in ("td", "th"):
            self.tables[-1][-1].append("")
            self.inside = True
        elif tag == "br" and self.inside:
            self.tables[-1][-1][-1] += " "

    def handle_endtag(self, tag: str) -> None:
        self.inside = self.inside and tag not in ("td", "th")

    def handle_data(self, data: str) -> None:
        if self.inside:
            self.tables[-1][-1][-1] += data


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of the sample run, with its figures."""
    return matrix_report.write(samples.run(), tmp_path_factory.mktemp("report")).parent


@pytest.fixture(scope="module")
def report(folder: Path) -> str:
    return (folder / "report.md").read_text(encoding="utf-8")


def test_the_verdict_comes_first_with_counts_that_add_up(report: str) -> None:
    first, second, third = report.split("\n\n")[1:4]
    verdict, _, counts = first.partition("** ")
    assert verdict == "**No: 1 answer contradicts Southwell's own solver."
    numbers = [int(n) for n in re.findall(r"\d+", counts)]
    assert numbers[0] == sum(numbers[1:]) == len(samples.run().cells)
    assert "1 ✘ fail" in counts
    assert second == "Worst failure: +0.500 % ± 0.0100 % (blade/stiff, alpha, edgewise 1, 10 rad/s)."
    assert third.startswith("Largest inconclusive difference: +0.0500 %")


@pytest.mark.parametrize(
    ("verdicts", "says"),
    [
        ([], "Open: nothing was compared."),
        (["not run", "not applicable"], "Open: nothing was compared."),
        (["pass", "known difference", "not run"], "Yes: nothing contradicts Southwell's own solver."),
        (["pass", "inconclusive"], "Open: 1 answer is inconclusive."),
        (["pass", "inconclusive", "fail", "fail"], "No: 2 answers contradict Southwell's own solver."),
    ],
)
def test_the_verdict_is_that_of_the_gravest_cell(verdicts: list[str], says: str) -> None:
    cells = tuple(samples.cell(verdict=v, mode=k) for k, v in enumerate(verdicts, 1))
    assert evidence.answer(Run(cells)).startswith(says)


@pytest.mark.parametrize(
    ("cells", "changes", "says"),
    [
        ([samples.cell()], {}, "Yes: nothing contradicts"),
        ([samples.cell()], {"unfinished": "interrupted"}, "Open: the run was stopped before its end."),
        (
            [samples.cell()],
            {"controls": (Control("no hub radius", "solver", "", "", "beam", 1.0, ()),)},
            "Open: 1 seeded fault is not detected.",
        ),
        (
            [samples.cell(shares="discretisation")],
            {"origins": (TWIN,)},
            "Open: too few independent groups confirm beam.",
        ),
        ([samples.cell(shares="nothing")], {"origins": (TWIN,)}, "Yes: nothing contradicts"),
    ],
)
def test_the_verdict_yes_needs_groups_faults_and_a_complete_run(
    cells: list[Cell], changes: dict[str, Any], says: str
) -> None:
    run = Run(tuple(cells), **changes)
    assert evidence.verdict(run).startswith(says)
    assert evidence.word(run) == says.partition(":")[0]


@pytest.mark.parametrize(("answer", "colour"), [("Yes", "pass"), ("No", "fail"), ("Open", "inconclusive")])
def test_the_answer_has_its_colour_on_the_page_and_in_print(answer: str, colour: str, tmp_path: Path) -> None:
    text = f"# Title\n\n**{answer}: said.** More.\n\n{answer}: not in bold.\n"
    assert html.render(text, tmp_path).count(f'<p class="{colour}">') == 1
    first, second = print_nodes.nodes(document.parse(text), tmp_path)[1:]
    assert (first["answer"], second["answer"]) == (colour, "")


def test_the_papers_table_is_one_line_that_counts_the_values_it_rounds_to() -> None:
    """As printed: 11.71, 70.37 and 189.7 rad/s; a discretisation that gives 189.76 does not round to the last."""
    given = {"case": "park-cantilever", "omega": 10.0}
    printed = (11.71, 0.005), (70.37, 0.005), (189.7, 0.05)
    solved = (11.7057599, 70.3721955, 189.76)
    cells = [
        *(
            samples.cell(
                **given, code=paper_table.TABLE, role="table", mode=k, ordinal=k, value=f, uncertainty=half / f
            )
            for k, (f, half) in enumerate(printed, 1)
        ),
        *(
            samples.cell(**given, code="southwell", role="discretisation", mode=k, ordinal=k, value=f)
            for k, f in enumerate(solved, 1)
        ),
    ]
    assert paper_table.line(Run(tuple(cells))) == "Table 1 of Park et al. (2010): 2 of 3 printed values reproduced."
    assert paper_table.line(samples.run()) == ""


def test_a_failure_without_a_frequency_is_reported_first() -> None:
    crash = samples.cell(
        code="crashed", verdict="fail", value=None, difference=None, uncertainty=None, reason="exit status 0"
    )
    run = Run((samples.cell(), crash, crash))
    assert evidence.urgent(run) == ["Failed without a frequency: crashed (beam): exit status 0."]
    assert evidence.verdict(run) == "Open: 2 answers are missing."


def test_a_pass_that_discretisation_does_not_explain_is_stated() -> None:
    """A rotor speed wrong by 0.043 % passes within 0.1 %; ± is 55 times smaller."""
    correct = samples.cell(code="right", difference=9e-5, uncertainty=1e-6)
    rough = samples.cell(code="rough", difference=6e-4, uncertainty=3e-4)
    altered = samples.cell(code="wrong", difference=3.87e-4, uncertainty=7e-6)
    less = replace(altered, difference=2e-4)
    assert not evidence.beyond_uncertainty(Run((correct, rough, replace(altered, role="table"))))
    (line,) = [s for s in matrix_report.headline(Run((correct, rough, altered, less))) if "explains" in s]
    assert "+0.0387 % ± 0.0007 % (beam, wrong, " in line
    assert line.count("±") == 1


def test_each_kind_of_evidence_has_its_worst_difference_and_where_it_is() -> None:
    cells = (
        samples.cell(shares="nothing", difference=1e-4, omega=20.0),
        samples.cell(shares="nothing", difference=-3e-4, mode=2),
        samples.cell(
            shares="nothing", mode=3, verdict="known difference", full=11.0, reason="no coriolis: +1 %; without"
        ),
        samples.cell(role="table", difference=2e-3, target=5e-3, code="author2000"),
        samples.cell(role="table", difference=9e-4, target=1e-3, code="author2000", mode=2, ordinal=2),
        samples.cell(role="same discretisation", shares="discretisation", difference=2e-12, target=1e-8, code="twin"),
        samples.empty("fail", "crashed", shares="nothing", code="odd"),
        samples.empty("not run", "not installed", shares="nothing", code="absent"),
    )
    independent, printed, own = evidence.rows(Run(cells))
    assert independent["answers"] == "1 ✘, 1 ≈, 2 ✔"
    assert independent["worst, relative to target"].startswith("✘ beam, odd, 10 rad/s: no answer: crashed")
    assert not any("coriolis" in field for field in independent.values())  # an omission that a code declares
    assert (
        printed["worst, relative to target"]
        == "✔ +0.0900 % ± 0.0002 %: beam, author2000, edgewise 2, 10 rad/s; target 0.10 %"
    )
    assert own["worst, relative to target"].startswith("✔ +2e-12")
    assert own["worst, relative to target"].endswith("target 1e-08")
    passing = evidence.rows(Run(cells[:2]))[0]["worst, relative to target"]
    assert passing.startswith("✔ −0.0300 %")


def test_the_heat_table_has_a_sign_and_a_word_for_every_case_and_code(report: str) -> None:
    head, *rows = Tables(rendered(report)).tables[1]
    assert head == ["case", "alpha", "beta", "gamma"]
    assert [row[0] for row in rows] == ["beam", "blade/stiff"]
    assert rows[0][1].startswith("✔ pass")
    assert rows[0][3] == "≈ known 0.250 %"
    assert rows[1][1:] == ["✘ fail 0.500 %", "? inconclusive 0.0500 %", "– n/a"]
    assert "≈ known difference (known), □ coarse, ~ estimate, ◇ measured, – not applicable (n/a)" in report


def test_a_code_without_any_answer_has_no_column_but_its_name_and_reason(report: str) -> None:
    assert "Omitted columns (no answers): delta (not installed" in report
    only = Run(tuple(c for c in samples.run().cells if c.code == "delta"))
    assert "○ not run" in matrix_report.heat(only)


def test_every_row_of_a_table_has_all_columns(report: str) -> None:
    tables = Tables(rendered(report)).tables
    assert (
        len(tables) == 2 + len(samples.SPEEDS) + 1 + 1 + 1 + 1
    )  # evidence, heat, beam's speeds, reasons, stiff, reasons, versions
    assert all(len({len(row) for row in table}) == 1 for table in tables)


def test_every_cell_that_is_not_a_plain_pass_has_its_reason(report: str) -> None:
    for cell in samples.run().cells:
        if cell.verdict != "pass":
            head = f"| {summary.SYMBOL[cell.verdict]} {cell.verdict} |"
            rows = [line for line in report.splitlines() if line.endswith(f"| {plain(cell.reason)} |")]
            row = next(row for row in rows if row.startswith(head))
            assert cell.code in row


def test_differences_at_a_speed_are_those_of_the_cells(report: str) -> None:
    table = next(t for t in Tables(rendered(report)).tables if t[0][0] == "mode")
    by_name = {row[0]: row for row in table[1:]}
    assert list(by_name) == ["edgewise 1", "flapwise 1", "edgewise 2", "flapwise 2"]
    run = samples.run()
    for cell in run.cells:
        if cell.case == "beam" and cell.omega == 30.0 and cell.mode:
            output = by_name[cell.name][table[0].index(cell.code)]
            assert output == f"{summary.SYMBOL[cell.verdict]} {summary.plus_minus(cell)}"
            assert float(by_name[cell.name][1]) == pytest.approx(cell.full, rel=1e-6)


def test_figures_named_in_the_report_are_there(report: str, folder: Path) -> None:
    links = re.findall(r"!\[.*?\]\((.*?)\)", report)
    assert len(links) == 4
    assert all((folder / link).stat().st_size > 1000 for link in links)


@pytest.mark.slow
def test_the_same_results_give_the_same_bytes(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    run = samples.run()
    write(path, run)
    for folder, source in (("a", run), ("b", read(path))):
        (tmp_path / folder).mkdir()
        matrix_report.write(source, tmp_path / folder)
    first = {p.relative_to(tmp_path / "a"): p.read_bytes() for p in (tmp_path / "a").rglob("*.*")}
    second = {p.relative_to(tmp_path / "b"): p.read_bytes() for p in (tmp_path / "b").rglob("*.*")}
    assert first == second
    assert len(first) == 5


def test_names_and_reasons_are_escaped(tmp_path: Path) -> None:
    run = samples.run()
    cells = tuple(replace(c, reason=HOSTILE, code=f"alpha {HOSTILE}") if c.code == "alpha" else c for c in run.cells)
    settings = (Setting("beam", HOSTILE, HOSTILE, HOSTILE, "rad_s", {"length": HOSTILE}),)
    text = matrix_report.write(replace(run, cells=cells, settings=settings), tmp_path).read_text()
    html = rendered(text)
    assert "<script" not in html
    assert '<img src="y"' not in html
    assert all(len({len(row) for row in table}) == 1 for table in Tables(html).tables)
    assert "alert(1)" in html


def test_a_code_with_fewer_effects_shows_what_it_lacks_in_all_not_like_with_like() -> None:
    cell = samples.cell(
        value=11.82,
        reference=11.8199,
        full=11.7,
        difference=8.5e-6,
        verdict="known difference",
        reason="no coriolis",
    )
    assert summary.plus_minus(cell) == f"+{100 * (11.82 / 11.7 - 1):.2f} % ± 0.0002 %"


def test_a_discretisation_shows_its_own_error_not_the_effects_it_lacks() -> None:
    cell = samples.cell(
        role="discretisation",
        value=189.67,
        reference=189.92,
        full=189.82,
        difference=189.67 / 189.92 - 1,
        verdict="known difference",
        reason="discretisation error",
    )
    assert summary.plus_minus(cell).startswith("−0.132 %")


def test_modes_of_a_code_with_fewer_effects_are_in_the_row_of_the_mode_with_all_effects() -> None:
    full = [
        samples.cell(mode=k, family=f, full=w, reference=w, code="all")
        for k, f, w in ((1, "edgewise", 5.0), (2, "axial", 9.0))
    ]
    less = [
        samples.cell(mode=1, family="mixed", full=9.0, reference=4.0, code="less", verdict="known difference"),
        samples.cell(mode=2, family="edgewise", full=5.0, reference=6.0, code="less", verdict="known difference"),
        samples.cell(mode=3, family="torsion", full=9.0, reference=9.5, code="less", verdict="known difference"),
    ]
    table = comparison([*full, *less], RAD_S)
    assert [row.split("|")[1].strip() for row in table.splitlines()[2:]] == [
        "edgewise 1",
        "axial 1",
        "torsion 1",  # a second mode of one code near the same one: not lost
    ]
    assert [row.split("|")[2].strip() for row in table.splitlines()[2:]] == ["5", "9", "9"]
    less_in_second = table.splitlines()[3].split("|")[4]
    assert less_in_second.strip().endswith("<br>mixed 1")  # its name in that code's own order


@pytest.mark.parametrize(
    ("verdicts", "status"),
    [
        ([], 1),
        (["pass", "known difference", "not applicable", "not run"], 0),
        (["pass", "fail"], 1),
        (["pass", "inconclusive"], 1),
    ],
)
def test_the_exit_status_is_0_only_if_all_is_within_target_or_explained(verdicts: list[str], status: int) -> None:
    assert summary.status(Run(tuple(samples.cell(verdict=v, mode=k) for k, v in enumerate(verdicts, 1)))) == status


def test_the_exit_status_needs_groups_controls_and_a_foreign_answer() -> None:
    """One passing code is enough only if no more groups are required, every fault is detected, and it is not core."""
    alone = Run((samples.cell(shares="nothing"),))
    fault = Control("frozen frame", "solver", "", "+31 %", "beam", 10.0, ("alpha: edgewise 1",), -0.24)
    two = Setting("beam", "", "", "", "rad_s", groups=2)
    assert summary.status(alone) == 0
    assert summary.status(replace(alone, controls=(fault,))) == 0
    assert summary.status(replace(alone, controls=(replace(fault, detected_by=()),))) == 1
    assert summary.status(replace(alone, settings=(two,))) == 1
    assert summary.status(Run((samples.cell(role="discretisation"),))) == 1
    assert summary.status(Run((samples.cell(shares="everything"),))) == 1


def test_a_code_without_an_answer_never_looks_like_a_pass(tmp_path: Path) -> None:
    run = Run((samples.cell(), samples.empty("fail", "crashed", omega=20.0)))
    assert summary.worst_verdict(run.cells) == "fail"
    assert "✘ fail" in matrix_report.heat(run)
    assert "crashed" in matrix_report.write(run, tmp_path).read_text()


def test_the_largest_difference_counts_whatever_its_sign() -> None:
    small, large = samples.cell(difference=1e-4), samples.cell(difference=-2e-4)
    assert summary.largest([small, large, samples.empty("fail", "crashed")]) is large
    assert summary.largest([samples.empty("fail", "crashed")]) is None
