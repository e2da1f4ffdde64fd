"""Columns of tables in the terminal: words are wrapped, numbers and words are never broken.

A table whose columns do not fit is continued below, with the columns repeated that name a row, by default the first.
"""

import re
from collections.abc import Iterator, Sequence
from textwrap import fill
from typing import Literal

from rich import box
from rich.markup import escape
from rich.table import Table

NUMBER = re.compile(r"(far|none|at rest|\de[+-]?\d|[^A-Za-z,])*( ?(rad/s|rpm|Hz|m|kg))?|[a-z]+ \d+")
"""Text that stays on one line: numbers with exponents and units, and names of modes such as ``flapwise 2``."""

LONG = 20
"""Characters of a word, such as a path, that may be broken."""

BETWEEN = 2
"""Characters between two columns, and at the ends of a table."""


def fitting(widths: Sequence[int], width: int) -> Iterator[list[int]]:
    """Numbers of consecutive columns whose ``widths`` add up to at most ``width`` characters, at least one each time."""
    part: list[int] = []
    for k, own in enumerate(widths):
        if part and sum(widths[j] for j in part) + own > width:
            yield part
            part = []
        part.append(k)
    if part:
        yield part


def parts(head: Sequence[str], rows: Sequence[Sequence[str]], width: int, keys: int = 1) -> Iterator[list[int]]:
    """Numbers of the columns of each part of a table that fits into ``width`` characters; all begin with the ``keys`` first."""
    widths = [_least(h, [row[k] for row in rows]) + BETWEEN for k, h in enumerate(head)]
    movable, space = widths[keys:], width - sum(widths[:keys])
    yield from ([*range(keys), *(k + keys for k in part)] for part in (fitting(movable, space) if movable else [[]]))


def tables(head: Sequence[str], rows: Sequence[Sequence[str]], width: int, title: str | None = None) -> Iterator[Table]:
    """A table of plain text for a console of ``width`` characters; ``title`` is repeated where it is continued."""
    for part in parts(head, rows, width):
        out = Table(
            box=box.SIMPLE_HEAD,
            title=escape(title) if title else None,
            title_justify="left",
            title_style="bold",
            padding=(0, 1, 0, 0),
            pad_edge=False,
        )
        columns = [[row[k] for row in rows] for k in part]
        minimum = [_least(head[k], fields) for k, fields in zip(part, columns, strict=True)]
        maximum = [max(map(len, (head[k], *fields))) for k, fields in zip(part, columns, strict=True)]
        widths = shares(minimum, maximum, width - BETWEEN * len(part))
        for k, fields, own in zip(part, columns, widths, strict=True):
            add_column(out, head[k], fields, width=own)
        for row in rows:
            out.add_row(*(escape(row[k]) for k in part))
        yield out


def shares(minimum: Sequence[int], maximum: Sequence[int], space: int) -> list[int]:
    """Widths from ``minimum`` to ``maximum`` that share ``space``; columns that lack little are widened first.

    Rich itself narrows a column below its least width, and cuts what then exceeds the terminal.
    """
    widths, spare = list(minimum), space - sum(minimum)
    order = sorted(range(len(minimum)), key=lambda k: maximum[k] - minimum[k])
    for count, k in zip(range(len(order), 0, -1), order, strict=True):
        extra = max(0, min(maximum[k] - minimum[k], spare // count))
        widths[k] += extra
        spare -= extra
    return widths


def _least(head: str, fields: Sequence[str]) -> int:
    """Width of a column without broken words, except long ones."""
    words = [min(len(word), LONG) for text in (head, *fields) for word in text.split()]
    return max([*words, *(len(field) for field in fields if _numbers(fields))], default=1)


def _numbers(fields: Sequence[str]) -> bool:
    return all(NUMBER.fullmatch(field) for field in fields)


def add_column(
    table: Table,
    head: str,
    fields: Sequence[str],
    justify: Literal["left", "right"] = "left",
    width: int | None = None,
) -> None:
    """Add a column to a table; if all its fields are numbers, only its head is wrapped.

    Args:
        table: the table.
        head: of the column.
        fields: text of all its rows.
        justify: side at which fields are aligned.
        width: of a column with words; by default what Rich gives it.
    """
    minimum = _least(head, fields)
    if _numbers(fields):
        table.add_column(fill(head, minimum, break_long_words=False), justify=justify, no_wrap=True)
    else:
        table.add_column(head, justify=justify, overflow="fold", min_width=minimum, width=width)
