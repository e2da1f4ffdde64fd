"""Markdown: text without markup, tables, heading anchors."""

import re
from collections.abc import Sequence
from html import escape

from tabulate import tabulate

TEXT = re.compile(r"([\\`*_{}\[\]|~])")
"""Characters and patterns that Markdown could interpret as markup."""


def plain(text: object) -> str:
    """Text with Markdown escaped, for a line or a table cell."""
    return TEXT.sub(r"\\\1", escape(" ".join(str(text).split()), quote=False))


def table(rows: Sequence[dict[str, str]]) -> str:
    """A Markdown table of formatted cells; numbers stay as written, and columns are not padded."""
    text = tabulate(list(rows), headers="keys", tablefmt="pipe", disable_numparse=True)
    return re.sub(r":-+\|", ":--|", re.sub(r" +\|", " |", text))


def plain_table(rows: Sequence[dict[str, str]]) -> str:
    """A table of text without markup; empty without rows."""
    return table([{head: plain(field) for head, field in row.items()} for row in rows]) if rows else ""


def anchor(heading: str) -> str:
    """The fragment of a heading on GitHub and in the HTML report: ``park-blade/windpact`` → ``park-bladewindpact``."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
