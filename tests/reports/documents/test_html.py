"""The report as one HTML file: nothing outside it is needed, links lead somewhere, words stay words."""

import re
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from importlib.resources import files
from pathlib import Path
from urllib.parse import unquote

import pytest

from southwell.cases.judge.results import Setting
from southwell.cases.store.results_file import write
from southwell.reports.cli import arguments
from southwell.reports.documents import colours, html
from southwell.reports.shared import summary
from southwell.reports.verification import report as matrix_report

from ...support import browsers, samples
from ..verification.test_markdown import HOSTILE


class Page(HTMLParser):
    """Elements with their attributes, and classes of table cells with their text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.feed(text)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in ("br", "img", "meta", "hr"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def of(self, tag: str, attribute: str) -> list[str]:
        return [given[attribute] or "" for name, given in self.tags if name == tag and attribute in given]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A report's folder with results."""
    run = samples.run()
    write(tmp_path / arguments.RESULTS, run)
    return tmp_path


def report(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "southwell", "report", *arguments], capture_output=True, text=True)


@pytest.mark.slow
def test_the_html_report_is_one_self_contained_file(folder: Path) -> None:
    done = report(str(folder), "--html")
    assert done.returncode == 0, done.stderr
    text = (folder / "report.html").read_text(encoding="utf-8")
    page = Page(text)
    assert page.open == []
    pictures = page.of("img", "src")
    assert len(pictures) == 4
    for source in pictures:
        kind, _, data = source.partition(",")
        assert kind == "data:image/svg+xml"
        assert unquote(data).startswith("<svg ")
        assert unquote(data).endswith("</svg>")
    assert page.of("script", "src") == page.of("link", "href") == []
    assert not re.search(r"(src|href)=\"(?!data:|#)", text)
    assert text == html.render((folder / "report.md").read_text(encoding="utf-8"), folder)


def test_links_lead_to_headings(folder: Path) -> None:
    page = Page(html.render(matrix_report.write(samples.run(), folder).read_text(encoding="utf-8"), folder))
    names = [given["id"] for tag, given in page.tags if tag in ("h1", "h2", "h3")]
    assert len(names) == len(set(names))
    targets = [address.removeprefix("#") for address in page.of("a", "href")]
    assert {"beam", "bladestiff", "versions", "reproduce"} <= set(targets) <= set(names)


def test_every_verdict_in_a_table_has_its_class_and_keeps_its_word(folder: Path) -> None:
    run = samples.run()
    rough = replace(run.cells[0], code="rough", verdict="estimate", reason="its own bracket")
    datum = replace(run.cells[0], code="rig", role="measured", verdict="measured", reason="model error not visible")
    wide = replace(run.cells[0], code="table", verdict="coarse", reason="a wide target")
    text = html.render(
        matrix_report.write(replace(run, cells=(*run.cells, wide, rough, datum)), folder).read_text(encoding="utf-8"),
        folder,
    )
    for verdict, sign in summary.SYMBOL.items():
        name = verdict.replace(" ", "-")
        cells = re.findall(rf'<td class="{name}">(.*?)</td>', text)
        assert cells
        assert all(re.match(rf"([\d.]+<br>)?{re.escape(sign)}[ \u00a0]", cell) for cell in cells)
        assert f"td.{name}" in html.STYLE, verdict
    plain = re.findall(r"<td>(.*?)</td>", text)
    below = rf"(^|<br>)[{re.escape(''.join(colours.NAMES))}][ \u00a0]"
    assert [cell for cell in plain if re.search(below, cell)] == [], "also where a frequency stands above the verdict"


def test_a_verdict_has_one_colour_in_the_report_and_in_the_dashboard() -> None:
    style = files("southwell.reports.dashboard").joinpath("templates", "dashboard.css").read_text(encoding="utf-8")
    short_names = {"pass": "pass", "known-difference": "known", "inconclusive": "open", "fail": "fail"}
    for name, colour in short_names.items():
        in_report, in_dashboard = (
            re.search(rf"td\.{name}, p\.{name} {{ background: (#\w+)", html.STYLE),
            re.search(rf"--{colour}:(#\w+)", style),
        )
        assert in_report
        assert in_dashboard
        assert in_report[1] == in_dashboard[1]


def test_lines_break_before_an_uncertainty_only(folder: Path) -> None:
    text = html.render(matrix_report.write(samples.run(), folder).read_text(encoding="utf-8"), folder)
    entries = re.findall(r"<td[^>]*>(.*?±.*?)</td>", text)
    assert len(entries) > 10
    assert [e for e in entries if re.search(r"± [\d&]|[✔✘≈?] [+−\d&]|\d %", e)] == []


def test_names_and_reasons_are_escaped(tmp_path: Path) -> None:
    run = samples.run()
    cells = tuple(replace(c, reason=HOSTILE, code=f"alpha {HOSTILE}") if c.code == "alpha" else c for c in run.cells)
    settings = (Setting("beam", HOSTILE, HOSTILE, HOSTILE, "rad_s", {"length": HOSTILE}),)
    written = matrix_report.write(replace(run, cells=cells, settings=settings), tmp_path)
    page = Page(html.render(written.read_text(encoding="utf-8"), tmp_path))
    assert not [tag for tag, _ in page.tags if tag == "script"]
    assert all(source.startswith("data:image/svg+xml,") for source in page.of("img", "src"))
    assert not [name for _, given in page.tags for name in given if name.startswith("on")]


@pytest.mark.slow
@browsers.needed
def test_a_page_fits_a_phone_with_long_names(tmp_path: Path) -> None:
    name = "blade_of_a_research_turbine_" * 4
    page = tmp_path / "page.html"
    digest = "4e" * 32
    text = (
        f"# Diagram of {name}\n\n{name}: verdict\n\n![diagram](wide.svg)\n\n- {name}\n\n"
        f"|file|digest|\n|:--|:--|\n|name|{name}, `{digest}`|\n"
    )
    (tmp_path / "wide.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg" width="900" height="600"/>')
    page.write_text(html.render(text, tmp_path), encoding="utf-8")
    with browsers.browser() as running, browsers.tab(running) as tab:
        tab.set_viewport_size({"width": 390, "height": 800})
        tab.goto(page.as_uri())
        assert tab.evaluate("document.documentElement.scrollWidth") <= 390
        assert tab.evaluate("document.querySelector('.wide').scrollWidth") <= 390
        assert tab.evaluate("document.querySelector('img').width") > 500, "the text of a figure is too small to read"
