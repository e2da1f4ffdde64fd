"""A PDF of text that would be code in Typst, and of figures that would read files."""

from dataclasses import replace
from pathlib import Path
from string import punctuation

import pytest
from matplotlib.figure import Figure

from southwell.cases.judge.results import Setting
from southwell.reports.documents import pdf
from southwell.reports.verification import report as matrix_report

from ...support import samples
from ...support.printed import missing, read, rendered, words
from ..verification.test_markdown import HOSTILE

SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="{0}pt" height="{1}pt"><text x="5" y="20">{2}</text></svg>'

TYPST = (
    '#read("/etc/passwd")',
    "$x$ *_ ] [ ) \" ' \\ \\u{41} \\n // /* @a <b> = - + ~ `",
    '#panic("a") #import "@preview/cetz:0.3.4" \\#',
    '"); #panic("b',
)
"""Text that would be code, markup or the end of a string in Typst."""


@pytest.mark.parametrize("text", TYPST)
def test_text_is_never_executed_as_typst(tmp_path: Path, text: str) -> None:
    literal = "".join(f"\\{sign}" if sign in punctuation else sign for sign in text)
    (tmp_path / "f.svg").write_text(SVG.format(90, 30, "x"), encoding="utf-8")
    page = (
        f"# {literal}\n\n{literal} **{literal}** [{literal}](#here)\n\n```\n{text}\n```\n\n![{literal}](f.svg)\n\n"
        f"| {literal} |\n|:--|\n| ✔ {literal} |\n\n- {literal}\n"
    )
    reader = rendered(page, tmp_path)
    assert words(reader).count("".join(text.split())) == 8
    assert reader.metadata.title == text


@pytest.mark.slow
def test_names_and_reasons_are_escaped(tmp_path: Path) -> None:
    run = samples.run()
    hostile = f"{HOSTILE} {' '.join(TYPST)}"
    cells = tuple(replace(c, reason=hostile, code=f"alpha {HOSTILE}") if c.code == "alpha" else c for c in run.cells)
    settings = (Setting("beam", hostile, hostile, hostile, "rad_s", {"length": hostile}),)
    report = matrix_report.write(replace(run, cells=cells, settings=settings), tmp_path)
    reader = read(pdf.write(report))
    assert missing(report.read_text(encoding="utf-8"), reader) == []
    assert "".join(hostile.split()) in words(reader)


def test_only_figures_of_the_folder_are_read(tmp_path: Path) -> None:
    inside = tmp_path / "report"
    inside.mkdir()
    for path in (tmp_path / "secret.svg", inside / "secret.txt"):
        path.write_text(SVG.format(90, 30, "secret"), encoding="utf-8")
    (inside / "linked.svg").symlink_to(tmp_path / "secret.svg")
    for address in ("../secret.svg", str(tmp_path / "secret.svg"), "linked.svg", "secret.txt"):
        assert words(rendered(f"![shown]({address})\n", inside)) == "shown"
    with pytest.raises(FileNotFoundError, match=r"absent\.svg"):
        pdf.render("![x](absent.svg)\n", inside)


@pytest.mark.parametrize("inner", ['<image href="{0}" width="9" height="9"/>', "<broken"])
def test_a_figure_that_reads_a_file_or_is_damaged_is_an_error(tmp_path: Path, inner: str) -> None:
    Figure((1, 1)).savefig(tmp_path / "secret.png")
    for address in ("secret.png", str(tmp_path / "secret.png"), "https://example.org/x.png"):
        svg = f'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">{inner.format(address)}</svg>'
        (tmp_path / "f.svg").write_text(svg, encoding="utf-8")
        with pytest.raises(pdf.PdfError, match=r"--pdf: .*SVG.*--html") as error:
            pdf.render("![x](f.svg)\n", tmp_path)
        assert "\n" not in str(error.value)
