"""The table of stations in ElastoDyn's blade and tower files, and the multipliers above it.

A row of names precedes the rows of numbers from FAST 8 on; tables of FAST 7 have fixed columns.
"""

from dataclasses import dataclass

from ...errors import CaseError
from ..text import Table, Text, first_numbers, integer, keys, table, tokens, value


@dataclass(frozen=True)
class Layout:
    """What a file of one kind has.

    Attributes:
        count: name of the number of stations.
        multipliers: names of the multipliers.
        columns: of a table without a row of names; the first is the position of the station.
        needed: columns that no table may lack.
        spellings: names of all columns that occur, in their spelling.
    """

    count: str
    multipliers: tuple[str, ...]
    columns: tuple[str, ...]
    needed: tuple[str, ...]
    spellings: tuple[str, ...]


def read(text: Text, layout: Layout) -> tuple[Table, dict[str, float]]:
    """The table, and the multipliers by name.

    Raises:
        CaseError: naming the file and line at fault.
    """
    entries = keys(text)
    count = integer(text, entries, layout.count)
    factors = {name: value(text, entries, name) for name in layout.multipliers}
    lines = {name: entries[name.lower()][0] for name in layout.multipliers}
    for name, factor in factors.items():
        if factor <= 0:
            raise CaseError(f"{text.at(lines[name])}: {name}: {factor:g}: a factor must be positive: correct it")
    first = max(lines.values()) + 1
    position = layout.columns[0].lower()
    head = next((k for k in range(first, len(text.lines)) if _first_word(text.lines[k]) == position), None)
    columns = layout.columns
    if head is not None:
        spelling = {name.lower(): name for name in layout.spellings}
        columns = tuple(spelling.get(name.lower(), name) for name in tokens(text.lines[head]))
        if missing := [name for name in layout.needed if name not in columns]:
            needed = ", ".join(layout.needed)
            raise CaseError(f"{text.at(head)}: no column {missing[0]}: the table needs {needed}; add it")
    start = first_numbers(text, first if head is None else head + 1)
    return table(text, start, count, columns), factors


def _first_word(line: str) -> str:
    return next(iter(tokens(line)), "").lower()
