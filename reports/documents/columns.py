"""Widths of the columns of a printed table, from the widths of its words."""

import re
from collections.abc import Sequence
from functools import cache
from itertools import accumulate
from pathlib import Path

from matplotlib import get_data_path
from matplotlib.ft2font import FT2Font

FONTS = Path(get_data_path(), "fonts", "ttf")
"""The fonts that Matplotlib brings along."""

FACES = {"regular": "DejaVuSans.ttf", "bold": "DejaVuSans-Bold.ttf", "mono": "DejaVuSansMono.ttf"}

WORD = re.compile(r"(?:[^ \n\u200b/-]|[/-](?![^\W\d_]))+[/-]?|[/-]")
"""What is not broken: a line breaks at (zero-width) spaces, and after a hyphen or a slash in front of a letter."""

SLACK = 0.02
"""Added to measured widths, em: kerning and rounding are not measured."""

SCALE = 100
"""Font size at which characters are measured, points."""

Pieces = Sequence[tuple[str, str]]
"""Text of a cell: pieces with their face; a line break is a newline."""


def widths(
    rows: Sequence[Sequence[Pieces]], size: float, padding: float, available: float
) -> tuple[list[float], float]:
    """Widths of the columns and the font size, in points.

    Columns are as wide as their longest line if all fit. Otherwise each is at least as wide as its longest word and gets a
    share of what remains in proportion to what it lacks, as in browsers. If even the longest words do not fit side by side,
    the text is smaller.

    Args:
        rows: cells of each row, the head included.
        size: font size of the table, points.
        padding: empty space of a cell, left and right together, points.
        available: width of the page between its margins, points.
    """
    measured = [[_measure(tuple(cell)) for cell in column] for column in zip(*rows, strict=True)]
    least, most = ([max(cell[k] for cell in column) for column in measured] for k in (0, 1))
    room = available - padding * len(measured)
    size = min(size, room / max(sum(least), 1e-9))
    spare = room / size - sum(least)
    share = min(1.0, max(spare, 0.0) / max(sum(most) - sum(least), 1e-9))
    return [padding + size * (low + share * (high - low)) for low, high in zip(least, most, strict=True)], size


def lines(row: Sequence[Pieces], across: Sequence[float], size: float, padding: float) -> int:
    """An upper bound of the number of lines of a row in columns of the widths ``across``."""
    bounds = [1]
    for cell, width in zip(row, across, strict=True):
        text, at = _positions(tuple(cell))
        # any two lines in a row would not fit on one
        bounds.append(sum(1 + int(2 * size * (at[m.end()] - at[m.start()]) / (width - padding)) for m in _lines(text)))
    return max(bounds)


def covered(text: str) -> bool:
    """Whether DejaVu Sans has a glyph for every character of ``text``."""
    return {ord(sign) for sign in set(text) if sign.isprintable()} <= _glyphs()


@cache
def _measure(cell: Pieces) -> tuple[float, float]:
    """Width of the longest word and of the longest line, em."""
    text, at = _positions(cell)
    words, whole = ([at[m.end()] - at[m.start()] for m in matches] for matches in (WORD.finditer(text), _lines(text)))
    return max(words, default=0.0) + SLACK, SLACK + max(whole, default=0.0)


def _positions(cell: Pieces) -> tuple[str, list[float]]:
    """The text of a cell, and the position of each of its characters in one line, em."""
    signs = [(sign, face) for text, face in cell for sign in text]
    return "".join(sign for sign, _ in signs), list(accumulate((_advance(*sign) for sign in signs), initial=0.0))


def _lines(text: str) -> list[re.Match[str]]:
    return list(re.finditer(r"[^\n]+", text))


@cache
def _advance(sign: str, face: str) -> float:
    """Width of a character, em; one that DejaVu lacks is taken as 1 em wide."""
    font = _font(face)
    if ord(sign) not in _glyphs():
        return 1.0
    return font.load_char(ord(sign)).linearHoriAdvance / 65536 / SCALE


@cache
def _glyphs() -> set[int]:
    return set(_font("regular").get_charmap())


@cache
def _font(face: str) -> FT2Font:
    font = FT2Font(str(FONTS / FACES[face]))
    font.set_size(SCALE, 72)
    return font
