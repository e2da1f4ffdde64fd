"""What mkdocs does not do by itself: pages made from the package, and formulas as MathML, which browsers draw unaided."""

import re
from collections.abc import Sequence
from html import unescape
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from southwell.reports import site

FORMULA = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.S)

RUN = Path(__file__).parents[1] / "reports" / "out"
"""Where `make verify` leaves its results; the site shows them if they are there."""

made: dict[str, str] = {}


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Make the pages, and put them into the nav under the index of their folder."""
    made.clear()
    made.update(site.pages(RUN))
    config.nav = [_extended(entry) for entry in config.nav or []]
    return config


def _extended(entry: Any) -> Any:
    """A part of the nav; where it names a made ``folder/index.md``, the folder's other pages follow."""
    if isinstance(entry, dict):
        return {title: _all(part) if isinstance(part, list) else part for title, part in entry.items()}
    return entry


def _all(part: Sequence[Any]) -> list[Any]:
    out: list[Any] = []
    for entry in part:
        out.append(_extended(entry))
        if isinstance(entry, str) and entry in made and entry.endswith("/index.md"):
            folder = entry.removesuffix("index.md")
            out += [name for name in made if name.startswith(folder) and name.endswith(".md") and name != entry]
    return out


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """The pages made, beside those written."""
    for name, content in made.items():
        files.append(File.generated(config, name, content=content))
    return files


def on_page_content(html: str, **_: Any) -> str:
    """LaTeX to MathML."""
    return FORMULA.sub(_mathml, html)


def _mathml(match: re.Match[str]) -> str:
    tag, text = match.groups()
    return convert(unescape(text).strip(), display="block" if tag == "div" else "inline")
