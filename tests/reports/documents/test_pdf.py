"""The report as a PDF: all words of the Markdown are in it, as words; links lead somewhere."""

import re
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from markdown_it.token import Token

from southwell.cases.input.errors import CaseError
from southwell.cases.store.results_file import write
from southwell.reports.cli import arguments
from southwell.reports.cli import report as command
from southwell.reports.documents import colours, document, pdf, print_nodes
from southwell.reports.verification import report as matrix_report

from ...support import samples
from ...support.printed import annotations, missing, read, rendered, words

SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="{0}pt" height="{1}pt"><text x="5" y="20">{2}</text></svg>'


MARGIN = 12 / 25.4 * 72
"""Of the page, points."""


@pytest.mark.slow
def test_every_word_of_a_report_is_in_its_pdf(tmp_path: Path) -> None:
    run = samples.run()
    rough = replace(run.cells[0], code="rough", verdict="estimate", reason="its own bracket")
    datum = replace(run.cells[0], code="rig", role="measured", verdict="measured", reason="model error not visible")
    report = matrix_report.write(replace(run, cells=(*run.cells, rough, datum)), tmp_path)
    reader = read(pdf.write(report))
    text = report.read_text(encoding="utf-8")
    assert missing(text, reader) == []
    assert reader.metadata.title == text.splitlines()[0].removeprefix("# ")
    assert {page.mediabox.width > page.mediabox.height for page in reader.pages} == {True}
    assert f"1/{len(reader.pages)}" in "".join(reader.pages[0].extract_text().split())
    assert missing(f"{text}\n\nAnother line.\n", reader) == ["Another line."]


def test_every_markup_of_markdown_has_a_layout(tmp_path: Path) -> None:
    text = (
        "# All\n\nA [link](https://example.org/a?b=c), <https://example.org>, *em*, **strong**, `code`,  \n"
        "a break, [empty]().\n\n> quote\n\n1. one\n2. two\n   - inner\n\n3. loose\n\n   paragraph\n\n---\n\n"
        "    indented  code\n\n```sh\nfenced `code` $x\n```\n\n"
        "<details><summary>More &lt;b&gt;</summary>\n\nin it\n\n</details>\n\n"
        "| a | b |\n|:--|:--|\n| 1<br>2 | **x** *y* `z` |\n\n#\n\n![not shown](../other.svg)\n"
    )
    reader = rendered(text, tmp_path)
    assert missing(text, reader) == []
    printed = words(reader)
    for message in ("indentedcode", "fenced`code`$x", "More<b>", "1.one", "3.loose", "notshown"):
        assert message in printed
    assert {a["/A"]["/URI"] for a in annotations(reader)} == {"https://example.org/a?b=c", "https://example.org"}


@pytest.mark.parametrize("place", ["block", "inline"])
def test_markup_without_a_layout_is_an_error(tmp_path: Path, place: str) -> None:
    read = document.parse("# A\n\ntext\n")
    inline = read.tokens[-2]
    odd = Token("footnote", "", 0)
    if place == "block":
        read.tokens.append(odd)
    else:
        assert inline.children is not None
        inline.children.append(odd)
    with pytest.raises(NotImplementedError, match="footnote"):
        print_nodes.nodes(read, tmp_path)


def test_links_and_bookmarks_lead_to_headings(tmp_path: Path) -> None:
    text = "# A\n\n[one](#twice-1) [two](#twice-2) [none](#nowhere)\n\n## Twice 1\n\n## Twice\n\n## Twice\n"
    reader = rendered(text, tmp_path)
    targets = [a["/Dest"] if "/Dest" in a else a["/A"]["/D"] for a in annotations(reader)]
    places = [reader.named_destinations[name] if isinstance(name, str) else name for name in targets]
    heights = [round(float(place["/Top"] if "/Top" in place else place[3])) for place in places]
    assert len(heights) == 2
    assert heights[0] > heights[1], "the second Twice is below Twice 1"
    top, below = reader.outline
    assert top.title == "A"
    assert [mark.title for mark in below] == ["Twice 1", "Twice", "Twice"]


def test_links_of_a_report_lead_somewhere(tmp_path: Path) -> None:
    text = matrix_report.write(samples.run(), tmp_path).read_text(encoding="utf-8")
    tokens = [c for t in document.parse(text).tokens for c in t.children or () if c.type == "link_open"]
    assert len(annotations(rendered(text, tmp_path))) == len(tokens) > 3


@pytest.mark.parametrize("verdict", colours.NAMES.values())
def test_a_verdict_has_its_colour_in_a_cell(tmp_path: Path, verdict: str) -> None:
    sign = {name: sign for sign, name in colours.NAMES.items()}[verdict]
    colour = colours.BACKGROUND.get(verdict, colours.GREY)
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]

    def coloured(cell: str) -> bool:
        data = rendered(f"| a |\n|:--|\n| {cell} |\n", tmp_path).pages[0].get_contents().get_data().decode("latin1")
        used = re.findall(r"([\d.]+) ([\d.]+) ([\d.]+) scn", data)
        return any([float(x) for x in rgb] == pytest.approx(parts, abs=1e-3) for rgb in used)

    assert coloured(f"{sign} word")
    assert coloured(f"11.7<br>{sign} word")
    assert not coloured(f"word {sign} word")


def test_figures_are_drawn_at_their_size_wherever_they_stand(tmp_path: Path) -> None:
    """An image of Typst shrinks to what is left of the page; one that is too high or too wide fits on a page."""
    for name, size in {"x": (300, 300), "y": (300, 3000), "z": (3000, 300)}.items():
        (tmp_path / f"{name}.svg").write_text(SVG.format(*size, name), encoding="utf-8")
    above = "\n\n".join(["line"] * 15)
    reader = rendered(f"{above}\n\n![a](x.svg)\n\n![b](y.svg)\n\n![c](z.svg)\n", tmp_path)
    assert ["line" in page.extract_text() for page in reader.pages][:2] == [True, False]
    scales: dict[str, float] = {}

    def visit(text: str, cm: list[float], tm: list[float], font: object, size: float) -> None:
        scales.setdefault(text, cm[0] / 0.75)  # points to pixels of an SVG

    for page in reader.pages[1:]:
        page.extract_text(visitor_text=visit)
    assert scales["x"] == pytest.approx(1.0)
    assert scales["z"] == pytest.approx(0.62 * (297 - 24) / 25.4 * 72 / 3000)
    assert 0.9 < scales["y"] * 3000 / ((210 - 24) / 25.4 * 72) < 1


def places(text: str, folder: Path) -> dict[str, tuple[float, float]]:
    """Where each piece of text on the first page begins, from the left edge, and its font size, points."""
    out: dict[str, tuple[float, float]] = {}

    def note(piece: str, cm: list[float], tm: list[float], font: object, size: float) -> None:
        if piece.strip():
            out.setdefault(piece.strip(), (cm[4] + tm[4], size))

    rendered(text, folder).pages[0].extract_text(visitor_text=note)
    return out


def rows(*cells: list[str]) -> str:
    head, *others = (f"| {' | '.join(row)} |\n" for row in cells)
    return f"{head}{'|:--' * len(cells[0])}|\n{''.join(others)}"


def test_a_table_stays_on_its_pages(tmp_path: Path) -> None:
    heads = [f"column{k}" for k in range(30)]
    text = rows(heads, ["✘ <0.0001 % ± <0.0001 %"] * 30)
    assert missing(text, rendered(text, tmp_path)) == []
    printed = places(text, tmp_path)
    starts = [printed[head][0] for head in heads]
    steps = [b - a for a, b in pairwise(starts)]
    assert min(steps) > 0
    assert starts[-1] - print_nodes.PADDING / 2 + min(steps) <= MARGIN + print_nodes.WIDTH + 0.1
    assert printed["column0"][1] < print_nodes.SIZE, "the text is smaller if the longest words do not fit side by side"
    digests = places(rows(["a", "b"], ["0123456789abcdef" * 8, "fedcba9876543210" * 8]), tmp_path)
    assert digests["b"] == pytest.approx((MARGIN + print_nodes.WIDTH / 2, print_nodes.SIZE), abs=5), (
        "overlong words break"
    )


def test_columns_share_the_page_as_in_css(tmp_path: Path) -> None:
    (a, _), (b, _) = (places(rows(["a", "b"], ["mm", "m " * 400]), tmp_path)[head] for head in "ab")
    assert b - a == pytest.approx(17.5, abs=1)
    (a, _), (b, _) = (places(rows(["a", "b"], ["m m m", "x"]), tmp_path)[head] for head in "ab")
    assert b - a == pytest.approx(28, abs=3), "as wide as the longest line if all fit"


def test_a_cell_in_bold_is_measured_in_bold(tmp_path: Path) -> None:
    bold, regular = (places(rows(["a", "b"], [f"{sign} wide word", "x"]), tmp_path)["b"][0] for sign in "✘✔")
    assert bold - MARGIN > 1.05 * (regular - MARGIN)


def test_a_row_is_broken_only_if_it_may_be_higher_than_a_page(tmp_path: Path) -> None:
    lines = "\n\n".join(["line"] * 25)
    pages, heights = {}, []

    def note(text: str, cm: list[float], *_: object) -> None:
        if "word" in text:
            heights.append(cm[5])

    for count, word in ((40, "word<br>"), (4000, "word ")):
        reader = rendered(f"{lines}\n\n| head | b |\n|:--|:--|\n| x | {word * count} |\n", tmp_path)
        texts = [page.extract_text() for page in reader.pages]
        pages[count] = [text.count("word") for text in texts]
        assert [text.count("head") for text in texts] == [int(n > 0) for n in pages[count]]
        for page in reader.pages:
            page.extract_text(visitor_text=note)
    assert pages[40] == [0, 40]
    assert sum(pages[4000]) == 4000
    assert min(heights) > 12 / 25.4 * 72


def test_every_sign_of_a_report_has_a_glyph(tmp_path: Path) -> None:
    text = matrix_report.write(samples.run(), tmp_path).read_text(encoding="utf-8")
    assert pdf.covered(text + "".join(colours.NAMES) + "ω₀² αγκνρφ ≤ ≥ − · × ½ ° … x⁶ Ω")
    assert not pdf.covered("中")
    reader = rendered(text, tmp_path)
    fonts = {f.get_object()["/BaseFont"] for page in reader.pages for f in page["/Resources"]["/Font"].values()}
    assert all("+DejaVuSans" in font for font in fonts), "the same on every machine"


def test_the_same_report_gives_the_same_bytes(tmp_path: Path) -> None:
    assert pdf.render("# A\n", tmp_path) == pdf.render("# A\n", tmp_path)
    assert rendered("# A\n", tmp_path).metadata.creation_date is None


def test_the_command_writes_a_pdf(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path / arguments.RESULTS, samples.run())
    command.command(tmp_path, pdf=True)
    assert "report.pdf" in capsys.readouterr().out
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF-")


def test_without_typst_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write(tmp_path / arguments.RESULTS, samples.run())
    monkeypatch.setitem(sys.modules, "typst", None)
    with pytest.raises(CaseError, match=r"pip install '\.\[pdf\]'") as error:
        command.command(tmp_path, pdf=True)
    assert "\n" not in str(error.value)
    assert not (tmp_path / "report.pdf").exists()
    assert not (tmp_path / "report.md").exists()  # refused before the work
