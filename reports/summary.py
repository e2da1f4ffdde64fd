"""What a reader wants to know first: how many cells, the verdict on each code, the worst difference and where.

Pure functions of a run, shared by terminal, Markdown and figures, so that all three say the same.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import get_args

from ..cases.results import Cell, Run, Verdict
from ..cases.verdict import percent, unsigned

SYMBOL: dict[Verdict, str] = {
    "pass": "✔",
    "fail": "✘",
    "inconclusive": "?",
    "known difference": "≈",
    "not applicable": "–",
    "not run": "○",
}
"""A sign beside each verdict's name; never instead of it."""

GRAVEST_FIRST: tuple[Verdict, ...] = ("fail", "inconclusive", "known difference", "pass", "not run", "not applicable")

BAD: frozenset[Verdict] = frozenset({"fail", "inconclusive"})
"""Verdicts that make a run end with status 1."""


def status(run: Run) -> int:
    """Exit status: 1 if any cell fails or is inconclusive, or there is none at all; else 0."""
    return int(not run.cells or any(c.verdict in BAD for c in run.cells))


def gravest(cells: Iterable[Cell]) -> Verdict:
    """The verdict that stands for several cells."""
    found = {c.verdict for c in cells}
    return next(v for v in GRAVEST_FIRST if v in found)


def size(cell: Cell) -> float | None:
    """How far the code is from the answer, relative: from core with all effects where the difference is a known one."""
    if cell.verdict == "known difference" and cell.frequency is not None and cell.full is not None:
        return cell.frequency / cell.full - 1.0
    return cell.difference


def largest(cells: Iterable[Cell]) -> Cell | None:
    """The cell that is farthest from the answer; None if none has numbers."""
    return max((c for c in cells if size(c) is not None), key=lambda c: abs(size(c) or 0.0), default=None)


def worst(cells: Iterable[Cell]) -> Cell | None:
    """The farthest from the answer of the cells with the gravest verdict; None if those have no numbers."""
    cells = list(cells)
    grave = gravest(cells)
    return largest(c for c in cells if c.verdict == grave)


def counts(cells: Iterable[Cell]) -> dict[Verdict, int]:
    """How many cells have each verdict; all verdicts, gravest first."""
    found = Counter(c.verdict for c in cells)
    assert set(found) <= set(get_args(Verdict))
    return {v: found[v] for v in GRAVEST_FIRST}


def cases(run: Run) -> list[str]:
    """Names of the cases' blades, in the run's order."""
    return list(dict.fromkeys(c.case for c in run.cells))


def columns(cells: Iterable[Cell]) -> list[str]:
    """Names of columns, in the run's order: a code's name, with its role where that is not simply to be a code."""
    return list(dict.fromkeys(column(c) for c in cells))


def column(cell: Cell) -> str:
    """The column a cell stands in."""
    return {"discretisation": "source's discretisation", "table": f"{cell.code} (table)"}.get(cell.role, cell.code)


def labels(cells: Sequence[Cell]) -> dict[Cell, str]:
    """Mode names ``flapwise 2``: the family, and the ordinal within it at that speed.

    Counted among all modes the case compares, so that a printed table's gaps do not shift its numbers; a code that
    lacks effects is compared with core lacking them, whose modes may come in another order, and is counted by itself.
    """
    groups: dict[tuple[str, float, str], dict[int, str]] = {}
    for cell in cells:
        groups.setdefault(_basis(cell), {})[cell.mode] = cell.family
    ordinals = {}
    for group, families in groups.items():
        seen: Counter[str] = Counter()
        for mode in sorted(families):
            seen[families[mode]] += 1
            ordinals[group, mode] = seen[families[mode]]
    return {c: f"{c.family} {ordinals[_basis(c), c.mode]}" for c in cells if c.mode}


def _basis(cell: Cell) -> tuple[str, float, str]:
    return cell.case, cell.omega, "" if cell.reference == cell.full else column(cell)


def plus_minus(cell: Cell) -> str:
    """``+0.0021 % ± 0.0004 %``; an unknown uncertainty is said to be unknown."""
    shown = size(cell)
    if shown is None:
        return ""
    known = f"± {unsigned(cell.uncertainty)}" if cell.uncertainty is not None else "± unknown"
    return f"{percent(shown)} {known}"
