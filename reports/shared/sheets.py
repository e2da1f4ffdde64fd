"""Tables for the console and for Markdown."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from rich import box
from rich.console import Group
from rich.markup import escape
from rich.table import Table
from rich.text import Text
from tabulate import tabulate

from ...core.participation import MIXED
from . import table_columns

TOO_NEAR = "✘"

STYLES = {"flapwise": "blue", "edgewise": "dark_orange3", "torsion": "green4", "axial": "magenta", MIXED: "purple"}
"""Colours of mode names on the console."""

_MODE = re.compile(rf"\b({'|'.join(STYLES)}) \d+′*")


@dataclass(frozen=True)
class Sheet:
    """A table.

    Attributes:
        title: heading above the table.
        head: headings of the columns.
        rows: fields as printed; one that begins with ``TOO_NEAR`` is highlighted.
        note: explanation below the table; may be empty.
        keys: number of first columns that name a row, repeated where the table is continued.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""
    keys: int = 1


def terminal(sheet: Sheet, width: int) -> Group:
    """The table for a console of ``width`` characters, with violated margins in red; continued below if it is wider."""
    parts = list(table_columns.parts(sheet.head, sheet.rows, width, sheet.keys))
    note = [Text(f"{sheet.note}\n", style="dim italic")] if sheet.note else []
    return Group(*(_part(sheet, part, part is parts[0]) for part in parts), *note)


def _part(sheet: Sheet, part: Sequence[int], first: bool) -> Table:
    out = Table(
        box=box.SIMPLE_HEAD,
        title=escape(sheet.title) if first else None,
        title_justify="left",
        title_style="bold",
        padding=(0, 1, 0, 0),
        pad_edge=False,
    )
    for k in part:
        fields = [row[k] for row in sheet.rows]
        table_columns.add_column(out, sheet.head[k], fields, "right" if k else "left")
    for row in sheet.rows:
        out.add_row(*[_styled(row[k]) for k in part])
    return out


def _styled(field: str) -> str:
    if field.startswith(TOO_NEAR):
        return f"[bold red]{field}[/]"
    return _MODE.sub(lambda name: f"[{STYLES[name[1]]}]{name[0]}[/]", field)


def markdown(sheet: Sheet) -> str:
    """The heading, the table and the note in Markdown, with violated margins in bold."""
    rows = [[f"**{field}**" if field.startswith(TOO_NEAR) else field for field in row] for row in sheet.rows]
    table = tabulate(rows, [h.replace("|", "\\|") for h in sheet.head], tablefmt="pipe", disable_numparse=True)
    note = f"\n\n{sheet.note}" if sheet.note else ""
    return f"## {sheet.title}\n\n{table}{note}\n"
