"""A report's Markdown as tokens of markdown-it, from which the HTML page and the PDF are made."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.rules_block import StateBlock
from markdown_it.rules_inline import StateInline
from markdown_it.token import Token

from ...core.regular_files import read_bytes
from ..shared.markdown import anchor
from .colours import NAMES

SIGNS = re.escape("".join(NAMES))

VERDICT = re.compile(rf"(?:[\d.e+-]+\n)?([{SIGNS}]) ")
"""Start of a table cell: an optional frequency on its own line, then the sign of the verdict."""

ANSWER = {"Yes": "pass", "No": "fail", "Open": "inconclusive"}
"""First word of a report's headline → the verdict whose colour it has."""

FOLD = re.compile(r"<details(?: open)?><summary>([^<>]*)</summary>|</details>")
"""The only HTML block in a report; anything else that looks like HTML is text."""

TOGETHER = re.compile(
    rf"(?<=\d) (?=%|rad/s|rpm|Hz|[{SIGNS}](?!\w))|(?<=γ) (?==)|(?<=γ =) (?=\d)|(?<=[±{SIGNS}]) (?=[+−\d]|<\d|known)"
)
"""Spaces at which a line must not break: between a number and its unit or sign, and after a verdict's sign or ±."""

BREAK = "<br>"


@dataclass(frozen=True)
class Document:
    """Tokens of a report; headings have an ``id``, table cells that begin with a verdict and the headline its ``class``."""

    tokens: list[Token]
    title: str
    reader: MarkdownIt


def parse(text: str) -> Document:
    """Parse the Markdown of a report."""
    reader = MarkdownIt("commonmark", {"html": False}).enable("table")
    reader.inline.ruler.before("text", "line_break", _line_break)
    reader.block.ruler.before("paragraph", "fold", _fold, {"alt": ["paragraph"]})
    tokens = reader.parse(text)
    _anchors(tokens)
    _verdicts(tokens)
    _answers(tokens)
    titles = (words(inline) for token, inline in pairwise(tokens) if token.type == "heading_open")
    title = next(titles, "Southwell")
    for child in (child for token in tokens for child in token.children or () if child.type == "text"):
        child.content = TOGETHER.sub("\u00a0", child.content)
    return Document(tokens, title, reader)


def words(inline: Token) -> str:
    """Text of a heading, paragraph or table cell without its markup."""
    breaks = {"html_inline": "\n", "softbreak": " ", "hardbreak": "\n"}
    return "".join(breaks.get(child.type, child.content) for child in inline.children or ())


def figure(address: str, folder: Path) -> str | None:
    """The SVG of a figure in ``folder`` or below it; None for any other address.

    Raises:
        OSError: if it cannot be read.
    """
    path = (folder / address).resolve()
    if path.suffix != ".svg" or not path.is_relative_to(folder.resolve()):
        return None
    return read_bytes(path).decode("utf-8")


def _line_break(state: StateInline, silent: bool) -> bool:
    """Parse the report's ``<br>`` in table cells; any ``<`` from results is escaped."""
    if not state.src.startswith(BREAK, state.pos):
        return False
    if not silent:
        state.push("html_inline", "", 0).content = BREAK
    state.pos += len(BREAK)
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
    repeats: dict[str, int] = {}
    for token, inline in pairwise(tokens):
        if token.type == "heading_open":
            name = unique = anchor(words(inline))
            while unique in repeats:
                repeats[name] += 1
                unique = f"{name}-{repeats[name]}"
            repeats[unique] = 0
            token.attrSet("id", unique)


def _verdicts(tokens: Sequence[Token]) -> None:
    """Give each table cell that begins with a verdict the verdict's class."""
    for token, inline in pairwise(tokens):
        if token.type in ("th_open", "td_open"):
            token.attrs.pop("style", None)  # all are left-aligned
            sign = VERDICT.match(words(inline))
            if sign and token.type == "td_open":
                token.attrSet("class", NAMES[sign[1]])


def _answers(tokens: Sequence[Token]) -> None:
    """Give a paragraph that begins with a bold Yes, No or Open the class of the verdict."""
    for token, inline in pairwise(tokens):
        bold = any(child.type == "strong_open" for child in (inline.children or [])[:2])
        answer = words(inline).partition(":")[0] if token.type == "paragraph_open" and bold else ""
        if answer in ANSWER:
            token.attrSet("class", ANSWER[answer])
