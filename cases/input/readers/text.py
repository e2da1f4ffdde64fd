"""Text files of numbers with labels: lines, values by name, tables; every error names file and line.

Tabs, CRLF, commas between numbers, Fortran's ``1.0D+03`` and trailing comments are supported.
"""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import files
from ..errors import CaseError
from ..toml import MAX_NUMBER

Array = NDArray[np.float64]

ROUNDING = 1e-9
"""Tolerance on the position of root and tip, as a fraction of the blade's length, for rounding in files."""

MAX_LINES = 250_000
"""Maximum number of lines of an input file; the longest public one has a few thousand."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?")
_NO_NUMBER = re.compile(r"[+-]?(nan|inf(inity)?)(\(\w*\))?", re.IGNORECASE)
_KEYED = re.compile(r"""\s*(?!-{2}|={2})("[^"]*"|'[^']*'|[^\s,]+)[\s,]+([A-Za-z]\w*)(?:\((\d+)\))?""")


@dataclass(frozen=True)
class Text:
    """A file's lines; ``lines[k]`` is line k + 1."""

    path: Path
    lines: tuple[str, ...]

    def at(self, k: int) -> str:
        """Position of line ``k`` (from 0), for a message."""
        return f"{self.path}: line {min(k, len(self.lines) - 1) + 1}"

    def blank(self, k: int) -> bool:
        """Whether line ``k`` is blank."""
        return not self.lines[k].strip()


def load(path: Path) -> Text:
    """Read the lines of a file.

    Raises:
        CaseError: if it cannot be read, is not text, is empty, or has more than ``MAX_LINES`` lines.
    """
    content = files.text(path, older=True)
    if content.count("\n") + content.count("\r") > 2 * MAX_LINES or len(lines := content.splitlines()) > MAX_LINES:
        raise CaseError(f"{path}: more than {MAX_LINES} lines: check that it is the right file")
    return Text(path, tuple(lines))


def number(token: str) -> float | None:
    """Convert a token to a number, including NaN and infinities; None if it is not a number."""
    if _NUMBER.fullmatch(token):
        return float(token.lower().replace("d", "e"))
    return math.nan if _NO_NUMBER.fullmatch(token) else None


def tokens(line: str) -> list[str]:
    """Split a line at blanks, tabs and commas."""
    return line.replace(",", " ").split()


def leading(line: str) -> list[float]:
    """The numbers at the beginning of a line."""
    out: list[float] = []
    for token in tokens(line):
        value = number(token)
        if value is None:
            break
        out.append(value)
    return out


def first_numbers(text: Text, k: int) -> int:
    """The first line from ``k`` on that begins with a number; the number of lines if there is none."""
    return next((j for j in range(k, len(text.lines)) if leading(text.lines[j])), len(text.lines))


def row(text: Text, k: int, columns: Sequence[str]) -> list[float]:
    """The numbers on line ``k``, one per column; words may follow.

    Raises:
        CaseError: if there are fewer or more numbers, or one is not finite.
    """
    if k >= len(text.lines):
        raise CaseError(f"{text.at(k)}: the file ends here, before {columns[0]}: give the whole file")
    numbers, words = leading(text.lines[k]), tokens(text.lines[k])
    if len(numbers) != len(columns):
        remaining_words = words[len(numbers) :]
        cause = (
            f"{remaining_words[0]!r} is not a number:"
            if remaining_words and len(numbers) < len(columns)
            else "check for commas in place of decimal points;"
            if len(numbers) == 2 * len(columns)
            else "check for a missing or an additional column;"
        )
        raise CaseError(
            f"{text.at(k)}: {len(numbers)} numbers instead of {len(columns)} ({', '.join(columns[:6])}"
            f"{', …' if len(columns) > 6 else ''}): {cause} correct the line"
        )
    for name, value, word in zip(columns, numbers, words, strict=False):
        if not math.isfinite(value):
            raise CaseError(f"{text.at(k)}: {name}: {word}: not a finite number: fill gaps in the data")
        if not believable(value):
            raise CaseError(f"{text.at(k)}: {name}: {word}: implausibly large; check the exponent")
    return numbers


def believable(value: float) -> bool:
    """Whether a number is finite and not implausibly large in any unit."""
    return abs(value) <= MAX_NUMBER


@dataclass(frozen=True)
class Table:
    """Rows of numbers by column, and the line of each row."""

    text: Text
    columns: dict[str, Array]
    lines: tuple[int, ...]

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    def need(self, condition: ArrayLike, name: str, value: Array, remedy: str) -> None:
        """Check that ``condition`` is true in all rows.

        Raises:
            CaseError: with the line and value of the first row where it is false.
        """
        if not np.all(condition):
            k = int(np.argmin(condition))
            raise CaseError(f"{self.text.at(self.lines[k])}: {name}: {value[k]:g}: {remedy}")

    def positive(self, *names: str, zero: bool = False) -> None:
        """Reject negative values in columns (and zeros, unless allowed).

        Raises:
            CaseError: naming the first such value.
        """
        for name in names:
            valid = self[name] >= 0 if zero else self[name] > 0
            self.need(valid, name, self[name], "it must be positive: check its sign and column")


def table(text: Text, first: int, count: int, columns: Sequence[str]) -> Table:
    """Read ``count`` rows from line ``first``, skipping blank lines.

    Raises:
        CaseError: as ``row``, and if the table has fewer or more rows.
    """
    rows, lines, k = [], [], first
    while len(rows) < count:
        while k < len(text.lines) and text.blank(k):
            k += 1
        if k >= len(text.lines) or not leading(text.lines[k]):
            raise CaseError(
                f"{text.at(k)}: the table ends after {len(rows)} of {count} rows: give all rows, or correct the count"
            )
        rows.append(row(text, k, columns))
        lines.append(k)
        k += 1
    if k < len(text.lines) and len(leading(text.lines[k])) == len(columns) > 1:
        raise CaseError(f"{text.at(k)}: another row after the {count} announced: correct the count or remove rows")
    values = np.array(rows).reshape(count, len(columns))
    return Table(text, dict(zip(columns, values.T, strict=True)), tuple(lines))


def fractions(sections: Table, name: str) -> Array:
    """The stations as fractions of the length: from 0 to 1, strictly increasing.

    Raises:
        CaseError: naming the line of the first invalid fraction.
    """
    eta = sections[name]
    if len(eta) < 2:
        raise CaseError(
            f"{sections.text.at(sections.lines[0])}: {len(eta)} station: a blade needs at least a root and a tip"
        )
    for k in (0, -1):
        eta[k] = round(eta[k]) if abs(eta[k] - round(eta[k])) <= ROUNDING else eta[k]
    ends = np.ones(len(eta), bool)
    ends[0], ends[-1] = eta[0] == 0, eta[-1] == 1
    sections.need(ends, name, eta, "stations are fractions of the length: begin at 0 and end at 1")
    rises = np.concatenate([[True], np.diff(eta) > ROUNDING])
    sections.need(rises, name, eta, "not beyond the previous station: sort them and remove duplicates")
    return eta


def keys(text: Text) -> dict[str, tuple[int, str]]:
    """Values of lines ``value name …``: lower-case name → (line, value); ``BldFile(1)`` is ``bldfile1``.

    Headings such as ``---- FURLING ----`` have no value.
    """
    out: dict[str, tuple[int, str]] = {}
    for k, line in enumerate(text.lines):
        match = _KEYED.match(line)
        if match:
            out.setdefault(match[2].lower() + (match[3] or ""), (k, match[1].strip("\"'")))
    return out


def value(text: Text, entries: dict[str, tuple[int, str]], *names: str) -> float:
    """The number under the first of ``names`` that is present.

    Raises:
        CaseError: if none is present, or the value is not a finite number.
    """
    k, token = entries[_name(text, entries, names)]
    out = number(token)
    if out is None or not believable(out):
        raise CaseError(f"{text.at(k)}: {names[0]}: {token!r} is not a finite number: correct it")
    return out


def integer(text: Text, entries: dict[str, tuple[int, str]], name: str) -> int:
    """The count under ``name``, at least 1.

    Raises:
        CaseError: as ``value``, and if it is not an integer.
    """
    out = value(text, entries, name)
    if out != int(out) or out < 1:
        raise CaseError(f"{text.at(entries[name.lower()][0])}: {name}: {out:g}: it is a count; give a whole number")
    return int(out)


def word(text: Text, entries: dict[str, tuple[int, str]], *names: str) -> str:
    """The word under the first of ``names`` that is present, without quotes.

    Raises:
        CaseError: if none is present.
    """
    return entries[_name(text, entries, names)][1]


def _name(text: Text, entries: dict[str, tuple[int, str]], names: Iterable[str]) -> str:
    names = tuple(names)
    for name in names:
        if name.lower() in entries:
            return name.lower()
    matches = get_close_matches(names[0].lower(), entries, 1, cutoff=0.75)
    match = matches[0] if matches else ""
    cause = f"{match!r} at line {entries[match][0] + 1} may be meant for it;" if match else "give the whole file, or"
    raise CaseError(
        f"{text.path}: {names[0]}: missing: {cause} add it, the value before its name (`1.0 {names[0]} - …`)"
    )


def number_or(text: Text, name: str, otherwise: float) -> float:
    """The finite number under a name, or ``otherwise`` if there is none."""
    entry = keys(text).get(name.lower())
    out = number(entry[1]) if entry else None
    return out if out is not None and math.isfinite(out) else otherwise


def flag(text: Text, name: str) -> bool:
    """Whether the value under a name is true; False if it is missing."""
    entry = keys(text).get(name.lower())
    return entry is not None and entry[1].lower().strip(".") in ("true", "t")


def path_named(text: Text, *names: str) -> Path:
    """The path under the first of ``names`` that is present, relative to the folder of the file.

    Raises:
        CaseError: if none is present.
    """
    return text.path.parent / word(text, keys(text), *names).replace("\\", "/")


def fortran(x: float) -> str:
    """Format a number with all its digits."""
    return f"{x:.17E}"
