"""A report as one self-contained HTML file, and as a PDF; both are rendered from the Markdown."""

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
from .markdown import anchor
from .summary import SYMBOL

SAFE = "/:;=,()' \n.-+*<>"
"""Characters of an SVG that need no escape in a data URL inside an attribute."""

CLASSES = {sign: verdict.replace(" ", "-") for verdict, sign in SYMBOL.items()}
"""CSS class of table cells that begin with a verdict's sign."""

VERDICT = re.compile(rf"<td[^>]*>((?:[\d.e+-]+<br ?/?>)?([{re.escape(''.join(CLASSES))}]))(?= )")
"""Start of a table cell: an optional frequency on its own line, then the sign of the verdict."""

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
  pre { white-space: pre-wrap; overflow-wrap: anywhere; }
  .wide { overflow: visible; } img { max-width: 62%; } a { color: inherit; text-decoration: none; }
}
"""
"""Style for screen and paper. Verdicts have the dashboard's colours in addition to signs and words.

A browser prints closed sections closed; the PDF has them open.
"""


POLICY = (
    "default-src 'none'; img-src data:; base-uri 'none'; form-action 'none'; "
    f"style-src 'sha256-{b64encode(sha256(STYLE.encode()).digest()).decode()}'"
)
"""Content security policy of the page: only embedded figures and this style are allowed."""

FOLD = re.compile(r"<details(?: open)?><summary>([^<>]*)</summary>|</details>")
"""The only HTML block in a report; anything else that looks like HTML is text."""


class PdfError(RuntimeError):
    """No PDF can be made; the message has the reason and the remedy."""


def write(report: Path) -> Path:
    """Write ``report.html`` next to ``report.md`` with its figures embedded; return its path.

    Raises:
        OSError: if a figure cannot be read or the file cannot be written.
    """
    path = report.with_suffix(".html")
    atomic.write(path, render(report.read_text(encoding="utf-8"), report.parent))
    return path


def pdf(report: Path) -> Path:
    """Write ``report.pdf`` next to ``report.md`` with all sections open; return its path.

    Raises:
        PdfError: if WeasyPrint, or the system's Pango that it requires, is missing.
    """
    try:
        from weasyprint import HTML  # pyright: ignore[reportMissingImports]
    except (ImportError, OSError) as error:
        raise PdfError(
            f"--pdf: WeasyPrint cannot be used ({error}): {install.extra('pdf')}, and the system's Pango; or give "
            "--html and print that page from a browser"
        ) from error
    path = report.with_suffix(".pdf")
    page = HTML(string=render(report.read_text(encoding="utf-8"), report.parent))
    atomic.through(path, page.write_pdf)
    return path


def render(text: str, folder: Path) -> str:
    """Render the Markdown of a report as an HTML page; figures are read from ``folder``."""
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
    """Parse the report's ``<br>`` in table cells; any ``<`` from results is escaped."""
    if not state.src.startswith("<br>", state.pos):
        return False
    if not silent:
        state.push("html_inline", "", 0).content = "<br>"
    state.pos += len("<br>")
    return True


def _fold(state: StateBlock, first: int, last: int, silent: bool) -> bool:
    """Parse the collapsible sections of the report."""
    line = state.src[state.bMarks[first] : state.eMarks[first]].rstrip()
    if not FOLD.fullmatch(line):
        return False
    if not silent:
        state.push("html_block", "", 0).content = f"{line}\n"
        state.line = first + 1
    return True


def _anchors(tokens: Sequence[Token]) -> None:
    """Give each heading an id as GitHub does; a repeated heading gets a number."""
    seen: dict[str, int] = {}
    for token, words in pairwise(tokens):
        if token.type == "heading_open":
            name = anchor("".join(c.content for c in words.children or ()))
            token.attrSet("id", f"{name}-{seen[name]}" if name in seen else name)
            seen[name] = seen.get(name, 0) + 1


def _inline(image: Token, folder: Path) -> None:
    """Embed a figure in place of its address."""
    path = (folder / str(image.attrs["src"])).resolve()
    if path.suffix != ".svg" or not path.is_relative_to(folder.resolve()):
        image.attrSet("src", "data:,")  # the alternative text remains
        return
    svg = read_bytes(path).decode("utf-8")
    svg = re.sub(r"""="([^"']*)\"""", r"='\1'", svg)  # a double quote takes three characters in a data URL
    image.attrSet("src", f"data:image/svg+xml,{quote(' '.join(svg.split()), safe=SAFE)}")
    image.attrSet("loading", "lazy")
