"""Markdown: text without markup, tables, heading anchors."""

import re
from collections.abc import Sequence
from html import escape

import pandas as pd

TEXT = re.compile(r"([\\`*_{}\[\]|~])")
"""What Markdown could take for markup."""


def plain(text: object) -> str:
    """Text as text in a line or a table's cell, whatever a case file or a code put into it."""
    return TEXT.sub(r"\\\1", escape(" ".join(str(text).split()), quote=False))


def table(rows: Sequence[dict[str, str]]) -> str:
    """A Markdown table of ready-made cells; numbers stay as they are written, columns are not filled up with spaces."""
    text = pd.DataFrame(list(rows)).to_markdown(index=False, disable_numparse=True)
    return re.sub(r":-+\|", ":--|", re.sub(r" +\|", " |", text))


def anchor(heading: str) -> str:
    """The fragment that GitHub, and this package's HTML, give a heading: ``park-blade/windpact`` → ``park-bladewindpact``."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
