"""Results without an adapter: frequencies in a CSV file, from any program or a test rig, as one more column of the matrix.

The file has a header, a line a frequency, and comments after ``#``::

    speed [rpm], frequency [Hz], mode
    0,           0.932,          flapwise 1
    15,          0.9586,         flapwise 1

Speed may be in rad/s, rpm or gamma (of dimensionless cases), frequency in rad/s, Hz or gamma. A mode is called by its family
(edgewise and lag mean chordwise) and the ordinal within it, as everywhere, or by its number from the lowest of all modes of
the blade; the family may have a column of its own. Two more columns are optional: ``blade`` (as in ``southwell cases``:
``park-blade/windpact``), needed if several are compared, and ``uncertainty [%]``. Without that one a number is as sure as its
digits: half a unit of the last.
"""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ...core.effects import ALL_EFFECTS
from ...core.participation import MIXED
from ..input import files
from ..input.errors import CaseError, nearest
from ..input.schema import Variant
from ..judge.pairing import MOTIONS, numbered
from ..judge.uncertainty import Estimate, from_print
from .cells import Head, empty, printed
from .columns import Column, References, Rows
from .reference import Reference

SPEED = {"speed [rad/s]": 1.0, "speed [rpm]": math.pi / 30, "speed [gamma]": 1.0}
FREQUENCY = {"frequency [rad/s]": 1.0, "frequency [Hz]": 2 * math.pi, "frequency [gamma]": 1.0}
OTHERS = ("mode", "family", "blade", "uncertainty [%]")
FAMILIES = (*MOTIONS, MIXED)
ALIASES = {"edgewise": "chordwise", "edge": "chordwise", "lag": "chordwise", "flap": "flapwise"}
"""Names that other programs give the families."""

NUMBER = re.compile(r"\d+(\.\d*)?([eE][+-]?\d+)?|\.\d+([eE][+-]?\d+)?")


MOST, DIGITS = 1e9, 40
"""The largest speed or frequency in any unit, and the characters of a number."""


@dataclass(frozen=True)
class Given:
    """One frequency of the file.

    Attributes:
        line: in the file, from 1.
        blade: as in ``southwell cases``; empty if the file has no such column.
        omega: rotor speed, rad/s.
        slack: half a unit of the speed's last digit, rad/s.
        family: empty where the mode is called by its number among all.
        mode: ordinal within the family, or among all, from 1.
        value: rad/s, and how sure it is.
    """

    line: int
    blade: str
    omega: float
    slack: float
    family: str
    mode: int
    value: Estimate


@dataclass(frozen=True)
class Added:
    """A file of results and what to call them."""

    name: str
    path: str
    rows: tuple[Given, ...]


def read(name: str, path: Path) -> Added:
    """The results in a CSV file.

    Raises:
        CaseError: one line naming the file, the line, the field, the value, the likely cause and the remedy.
    """
    (first, header), *table = files.table(path, absent="give NAME=FILE.csv")
    speed, frequency = _header(header, f"{path}: line {first}")
    if not table:
        raise CaseError(
            f"{path}: no results in it, only a header: add a line for every frequency, as `0, 0.932, flapwise 1`"
        )
    rows = []
    for k, cells in table:
        where = f"{path}: line {k}"
        if len(cells) != len(header):
            raise CaseError(f"{where}: {len(cells)} columns instead of {len(header)}: a missing or stray comma?")
        rows.append(_given(where, k, dict(zip(header, cells, strict=True)), speed, frequency))
    _no_repeats(rows, path)
    return Added(name, str(path), tuple(rows))


def _header(header: Sequence[str], where: str) -> tuple[str, str]:
    """The names of the columns of speed and frequency."""
    known = (*SPEED, *FREQUENCY, *OTHERS)
    for column in header:
        if column not in known:
            raise CaseError(f"{where}: unknown column {column!r}: {nearest(column, known)}")
        if header.count(column) > 1:
            raise CaseError(f"{where}: column {column!r} is there {header.count(column)} times: once is enough")
    found = []
    for what, units in (("speed", SPEED), ("frequency", FREQUENCY)):
        mine = [column for column in header if column in units]
        if len(mine) != 1:
            raise CaseError(f"{where}: {len(mine)} columns of {what}: give exactly one of {', '.join(units)}")
        found.append(mine[0])
    if "mode" not in header:
        raise CaseError(f"{where}: column 'mode' is missing: which mode a frequency is of, as flapwise 1, or 3")
    return found[0], found[1]


def _given(where: str, line: int, row: dict[str, str], speed: str, frequency: str) -> Given:
    def number(column: str, least: float = 0.0, most: float = MOST) -> float:
        text = row[column]
        if len(text) > DIGITS or not NUMBER.fullmatch(text) or not least <= float(text) <= most:
            wanted = "a number above 0" if least else "a number, 0 or more"
            raise CaseError(
                f"{where}: {column}: {text!r} is not {wanted}, and at most {most:g}: correct it, with a point for decimals"
            )
        return float(text)

    omega = number(speed)
    number(frequency, least=1e-9)
    value = from_print(row[frequency], FREQUENCY[frequency])
    if row.get("uncertainty [%]", ""):
        value = Estimate(value.value, number("uncertainty [%]", most=100.0) / 100.0)
    family, mode = _mode(where, row.get("family", ""), row["mode"])
    slack = from_print(row[speed]).uncertainty if omega else 0.0
    unit = SPEED[speed]
    return Given(line, row.get("blade", ""), omega * unit, (slack or 0.0) * omega * unit, family, mode, value)


def _mode(where: str, family: str, text: str) -> tuple[str, int]:
    words = text.split()
    if not family and len(words) == 2:
        family, text = words[0], words[1]
    family = ALIASES.get(family, family)
    if family and family not in FAMILIES:
        raise CaseError(f"{where}: mode: {family!r} is no family: {nearest(family, FAMILIES)}")
    if not re.fullmatch(r"[1-9]\d*", text):
        raise CaseError(f"{where}: mode: {text!r}: give a family and a whole number from 1, as flapwise 1, or a number")
    return family, int(text)


def _no_repeats(rows: Sequence[Given], path: Path) -> None:
    seen: dict[tuple[str, float, str, int], int] = {}
    for row in rows:
        key = row.blade, row.omega, row.family, row.mode
        if key in seen:
            what = f"{row.family} {row.mode}".strip()
            raise CaseError(f"{path}: line {row.line}: mode: {what} at this speed is in line {seen[key]} too: keep one")
        seen[key] = row.line


def check(added: Sequence[Added], variants: Sequence[Variant], codes: Iterable[str]) -> None:
    """Every name is free, and every row is of a blade and a speed that the run has.

    Raises:
        CaseError: one line, as for ``read``.
    """
    taken = set(codes)
    for one in added:
        if one.name in taken:
            raise CaseError(f"--add {one.name}: there is a code or another file of that name: call it something else")
        taken.add(one.name)
        for row in one.rows:
            where = f"{one.path}: line {row.line}"
            names = [v.name for v in variants]
            mine = [v for v in variants if v.name == (row.blade or v.name)]
            if not mine:
                raise CaseError(f"{where}: blade: {row.blade!r} is not in this run: {nearest(row.blade, names)}")
            if len(mine) > 1:
                raise CaseError(f"{where}: blade: not given, and the run has {len(mine)}: add a column, or choose one")
            if not any(_at(row, omega) for omega in mine[0].speeds.tolist()):
                listed = ", ".join(f"{s:.6g}" for s in mine[0].speeds)
                raise CaseError(
                    f"{where}: speed: {row.omega:.6g} rad/s is not among the speeds of {mine[0].name} ({listed} rad/s): "
                    "add it to the case, or leave the line out"
                )


def _at(row: Given, omega: float) -> bool:
    return abs(row.omega - omega) <= max(row.slack * (1 + 1e-9), 1e-9 * omega)


def columns(variant: Variant, added: Sequence[Added], target: float) -> list[Column]:
    """A column for each file that has something about a blade."""
    out = []
    for one in added:
        mine = [row for row in one.rows if row.blade in ("", variant.name)]
        if mine:
            head = Head(variant.name, one.name, f"from {Path(one.path).name}", "code", target, "nothing")
            out.append(Column(one.name, ALL_EFFECTS, head, partial(_rows, head, mine), due="somewhere"))
    return out


def _rows(head: Head, given: Sequence[Given], core: References) -> Rows:
    cells = []
    for omega, reference in core:
        for row in (row for row in given if _at(row, omega)):
            k = _place(row, reference)
            if k is None:
                called, names = f"{row.family} {row.mode}".strip(), ", ".join(_names(reference))
                reason = f"line {row.line}: the case does not compare mode {called} here: it compares {names}"
                cells.append(empty(head, omega, "not applicable", reason))
            else:
                cells.append(printed(head, omega, k, reference, _surely(row, omega), ""))
    return cells, []


def _surely(row: Given, omega: float) -> Estimate:
    """The value, less sure where the speed is not quite the case's.

    By f² = f₀² + K Ω² a frequency changes, relatively, no more than the speed does (Southwell 1921; K not negative).
    """
    off = abs(row.omega / omega - 1.0) if omega else 0.0
    return Estimate(row.value.value, (row.value.uncertainty or 0.0) + off)


def _names(reference: Reference) -> list[str]:
    return numbered(reference.core.names)


def _place(row: Given, reference: Reference) -> int | None:
    """Which of the modes that the case compares a row is of."""
    if row.family:
        name = f"{row.family} {row.mode}"
        return _names(reference).index(name) if name in _names(reference) else None
    indices = reference.core.wanted.indices
    return indices.index(row.mode - 1) if row.mode - 1 in indices else None
