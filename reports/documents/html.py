"""A report as one self-contained HTML file, rendered from its Markdown."""

import re
from base64 import b64encode
from hashlib import sha256
from html import escape
from pathlib import Path
from urllib.parse import quote

from markdown_it.token import Token

from ...cases.input import atomic
from . import document
from .colours import BACKGROUND, FAINT, GREY, HEAD, INK, MUTED

SAFE = "/:;=,()' \n.-+*<>"
"""Characters of an SVG that need no escape in a data URL inside an attribute."""

PALETTE = "\n".join(
    [
        f":root {{ color-scheme: light; --ink: {INK}; --faint: {FAINT}; --head: {HEAD}; --link: #0b57a4; }}",
        *[f"td.{name}, p.{name} {{ background: {colour}; }}" for name, colour in BACKGROUND.items()],
        f"{', '.join(f'td.{name}' for name in MUTED)} {{ color: {GREY}; }}",
    ]
)

STYLE = (
    PALETTE
    + """
td.fail { font-weight: 700; } p[class] { padding: 0.4rem 0.8rem; border-radius: 4px; font-size: 1.1em; }
* { box-sizing: border-box; }
body { font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: var(--ink); background: white;
  max-width: 1500px; margin: 0 auto; padding: 1rem 1.5rem 4rem; }
p, li, h1, h2, h3, summary { max-width: 62rem; overflow-wrap: anywhere; } td code { overflow-wrap: anywhere; }
td:nth-child(2):last-child { overflow-wrap: anywhere; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.35rem; margin-top: 2.5rem; border-bottom: 1px solid var(--faint); }
h3 { font-size: 1.08rem; } a { color: var(--link); }
.wide { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: 12.5px; line-height: 1.35; font-variant-numeric: tabular-nums; }
th, td { border: 1px solid var(--faint); padding: 3px 6px; text-align: left; vertical-align: top; }
th { background: var(--head); } td:first-child { font-weight: 500; }
img { display: block; max-width: min(100%, 60rem); height: auto; margin: 1rem 0; }
details { margin: 0.8rem 0; } summary { cursor: pointer; font-weight: 600; }
@media screen and (max-width: 600px) { p:has(> img) { overflow-x: auto; } p > img { max-width: none; width: 38rem; } }
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
)
"""Style for screen and paper. Verdicts have the dashboard's colours in addition to signs and words.

A browser prints closed sections closed; the PDF has them open.
"""


POLICY = (
    "default-src 'none'; img-src data:; base-uri 'none'; form-action 'none'; "
    f"style-src 'sha256-{b64encode(sha256(STYLE.encode()).digest()).decode()}'"
)
"""Content security policy of the page: only embedded figures and this style are allowed."""


def write(report: Path) -> Path:
    """Write ``report.html`` next to ``report.md`` with its figures embedded; return its path.

    Raises:
        OSError: if a figure cannot be read or the file cannot be written.
    """
    path = report.with_suffix(".html")
    atomic.write(path, render(report.read_text(encoding="utf-8"), report.parent))
    return path


def render(text: str, folder: Path) -> str:
    """Render the Markdown of a report as an HTML page; figures are read from ``folder``."""
    read = document.parse(text)
    for token in read.tokens:
        for child in token.children or ():
            if child.type == "image":
                _inline(child, folder)
    body = read.reader.renderer.render(read.tokens, read.reader.options, {})
    body = body.replace("<table>", '<div class="wide"><table>').replace("</table>", "</table></div>")
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(read.title)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )


def _inline(image: Token, folder: Path) -> None:
    """Embed a figure in place of its address."""
    svg = document.figure(str(image.attrs["src"]), folder)
    if svg is None:
        image.attrSet("src", "data:,")  # the alternative text remains
        return
    svg = re.sub(r"""="([^"']*)\"""", r"='\1'", svg)  # a double quote takes three characters in a data URL
    image.attrSet("src", f"data:image/svg+xml,{quote(' '.join(svg.split()), safe=SAFE)}")
    image.attrSet("loading", "lazy")
