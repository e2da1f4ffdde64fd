"""A report as one HTML file that needs nothing else, and as a PDF; both from the Markdown, so that all say the same."""

import re
from base64 import b64encode
from collections.abc import Sequence
from hashlib import sha256
from html import escape
from itertools import pairwise
from pathlib import Path
from urllib.parse import quote

from markdown_it import MarkdownIt
from markdown_it.rules_block import StateBlock
from markdown_it.rules_inline import StateInline
from markdown_it.token import Token

from ...cases.input import atomic
from ...core.regular_files import read_bytes
from ...references.protocol import install
from ..shared.markdown import anchor
from ..shared.summary import SYMBOL

SAFE = "/:;=,()' \n.-+*<>"
"""Of an SVG's characters those that may stand in a data address inside an attribute as they are."""

CLASSES = {sign: verdict.replace(" ", "-") for verdict, sign in SYMBOL.items()}
"""Of table cells that begin with a verdict's sign."""

VERDICT = re.compile(rf"<td[^>]*>((?:[\d.e+-]+<br ?/?>)?([{re.escape(''.join(CLASSES))}]))(?= )")
"""A cell's beginning: a frequency above it where there is one, then the sign."""

STYLE = """
:root { color-scheme: light; --ink: #1a1a1a; --faint: #d8d8d8; --link: #0b57a4; }
* { box-sizing: border-box; }
body { font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: var(--ink); background: white;
  max-width: 1500px; margin: 0 auto; padding: 1rem 1.5rem 4rem; }
p, li, h1, h2, h3, summary { max-width: 62rem; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.35rem; margin-top: 2.5rem; border-bottom: 1px solid var(--faint); }
h3 { font-size: 1.08rem; } a { color: var(--link); }
.wide { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: 12.5px; line-height: 1.35; font-variant-numeric: tabular-nums; }
th, td { border: 1px solid var(--faint); padding: 3px 6px; text-align: left; vertical-align: top; }
td.pass { background: #b7e3d3; } td.fail { background: #f3b08f; font-weight: 700; } td.inconclusive { background: #f9dd9a; }
td.known-difference { background: #bfe0f7; } td.not-run, td.not-applicable, td.estimate { color: #6b6b6b; }
td.measured { background: #ead9f0; }
th { background: #f3f4f6; } td:first-child { font-weight: 500; }
img { display: block; max-width: min(100%, 60rem); height: auto; margin: 1rem 0; }
details { margin: 0.8rem 0; } summary { cursor: pointer; font-weight: 600; }
pre { background: #f6f7f8; padding: 0.7rem; overflow-x: auto; } code { font-size: 0.92em; }
@page { size: A4 landscape; margin: 12mm; @bottom-right { content: counter(page) " / " counter(pages); font-size: 8pt; } }
@media print {
  html { font-size: 9pt; }
  body { font-size: 9pt; padding: 0; max-width: none; } p, li, h1, h2, h3, summary { max-width: none; }
  table { font-size: 6.6pt; } th, td { padding: 1px 3px; } tr, img { break-inside: avoid; } h2, h3 { break-after: avoid; }
  .wide { overflow: visible; } img { max-width: 62%; } a { color: inherit; text-decoration: none; }
}
"""
"""Of screen and of paper; verdicts have the dashboard's colours, beside signs and words. Closed parts are printed closed,
by a PDF's maker open."""


POLICY = (
    "default-src 'none'; img-src data:; base-uri 'none'; form-action 'none'; "
    f"style-src 'sha256-{b64encode(sha256(STYLE.encode()).digest()).decode()}'"
)
"""What a browser may do with the page: show figures that lie in it, and use this style, no other."""

FOLD = re.compile(r"<details(?: open)?><summary>([^<>]*)</summary>|</details>")
"""The only block of HTML in a report; everything else that looks like HTML is text."""


class PdfError(RuntimeError):
    """No PDF can be made: says why, and the remedy."""


def write(report: Path) -> Path:
    """Write ``report.html`` beside ``report.md``, its figures inside it.

    Raises:
        OSError: if a figure cannot be read or the file cannot be written.
    """
    path = report.with_suffix(".html")
    atomic.write(path, render(report.read_text(encoding="utf-8"), report.parent))
    return path


def pdf(report: Path) -> Path:
    """Write ``report.pdf`` beside ``report.md``, everything opened.

    Raises:
        PdfError: if WeasyPrint, or the system's Pango that it needs, is not there.
    """
    try:
        from weasyprint import HTML  # pyright: ignore[reportMissingImports]
    except (ImportError, OSError) as error:
        raise PdfError(
            f"--pdf: WeasyPrint cannot be used ({error}): {install.extra('pdf')}, and the system's Pango; or print "
            "report.html from a browser"
        ) from error
    path = report.with_suffix(".pdf")
    page = HTML(string=render(report.read_text(encoding="utf-8"), report.parent))
    atomic.through(path, page.write_pdf)
    return path


def render(text: str, folder: Path) -> str:
    """The Markdown of a report as a whole HTML page; figures are read from ``folder``."""
    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    reader.inline.ruler.before("text", "line_break", _line_break)
    reader.block.ruler.before("paragraph", "fold", _fold, {"alt": ["paragraph"]})
    tokens = reader.parse(text)
    _anchors(tokens)
    for token in tokens:
        if token.type in ("th_open", "td_open"):
            token.attrs.pop("style", None)  # all are left-aligned, by STYLE
        for child in token.children or ():
            if child.type == "image":
                _inline(child, folder)
    body = reader.renderer.render(tokens, reader.options, {})
    body = VERDICT.sub(lambda m: f'<td class="{CLASSES[m[2]]}">{m[1]}', body)
    body = re.sub(r"(?<=\d) %", "&nbsp;%", body)
    body = re.sub(rf"([±{re.escape(''.join(CLASSES))}]) (?=[+−\d]|&lt;\d|known)", r"\1&nbsp;", body)
    body = body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")
    found = re.search(r"^# (.*)$", text, re.M)
    title = escape(found[1] if found else "Southwell")
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )


def _line_break(state: StateInline, silent: bool) -> bool:
    """The report's own ``<br>``, in a table's cells; what comes from results has its ``<`` escaped."""
    if not state.src.startswith("<br>", state.pos):
        return False
    if not silent:
        state.push("html_inline", "", 0).content = "<br>"
    state.pos += len("<br>")
    return True


def _fold(state: StateBlock, first: int, last: int, silent: bool) -> bool:
    """The report's own parts that open and close."""
    line = state.src[state.bMarks[first] : state.eMarks[first]].rstrip()
    if not FOLD.fullmatch(line):
        return False
    if not silent:
        state.push("html_block", "", 0).content = f"{line}\n"
        state.line = first + 1
    return True


def _anchors(tokens: Sequence[Token]) -> None:
    """An id for each heading, as GitHub has it: one that comes again gets a number."""
    seen: dict[str, int] = {}
    for token, words in pairwise(tokens):
        if token.type == "heading_open":
            name = anchor("".join(c.content for c in words.children or ()))
            token.attrSet("id", f"{name}-{seen[name]}" if name in seen else name)
            seen[name] = seen.get(name, 0) + 1


def _inline(image: Token, folder: Path) -> None:
    """A figure in the place of its address."""
    path = (folder / str(image.attrs["src"])).resolve()
    if path.suffix != ".svg" or not path.is_relative_to(folder.resolve()):
        image.attrSet("src", "data:,")  # its words are left
        return
    svg = read_bytes(path).decode("utf-8")
    svg = re.sub(r"<\?xml.*?\?>|<!DOCTYPE.*?>|<metadata>.*?</metadata>", "", svg, flags=re.S)
    image.attrSet("src", f"data:image/svg+xml,{quote(' '.join(svg.split()), safe=SAFE)}")
    image.attrSet("loading", "lazy")
