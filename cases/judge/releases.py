"""Two releases of one code in a run: how far the other release moves each frequency of the installed one.

A column at another release (``exudyn-ancf@1.10.0``) is judged against core like any column, but it has the engine of
the installed release and is no further witness. Its cells are compared with those of the installed release by case,
speed and mode. A frequency is *moved* if it changes by more than the uncertainties of both answers together; a change
within them may be due to another refinement. What has moved is information and decides nothing: the run fails only if
a cell of either release does.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ...references.protocol.registry import RELEASE

if TYPE_CHECKING:
    from .results import Cell, Run


def installed(code: str) -> str:
    """The column of the installed release of the same code."""
    return code.partition(RELEASE)[0]


def other(code: str) -> bool:
    """Whether a column is that of another release of a code."""
    return RELEASE in code


@dataclass(frozen=True)
class Change:
    """One frequency with two releases.

    Attributes:
        before, after: cells of the installed and of the other release.
        relative: the frequency of ``after`` over that of ``before``, minus 1.
        uncertainty: sum of the relative uncertainties of both; None if one is unknown.
    """

    before: "Cell"
    after: "Cell"
    relative: float
    uncertainty: float | None

    @property
    def moved(self) -> bool:
        """Whether it changes by more than its uncertainty."""
        return self.uncertainty is not None and abs(self.relative) > self.uncertainty


@dataclass(frozen=True)
class Comparison:
    """All answers of a code with two releases.

    Attributes:
        code, other: columns of the installed and of the other release.
        changes: one for each frequency that both give.
        lost: number of frequencies that only the installed release gives.
        gained: number of frequencies that only the other release gives.
    """

    code: str
    other: str
    changes: tuple[Change, ...]
    lost: int
    gained: int

    @property
    def moved(self) -> tuple[Change, ...]:
        """The frequencies that moved."""
        return tuple(change for change in self.changes if change.moved)

    @property
    def largest(self) -> Change | None:
        """The largest change, of those that moved if any did; None without a change to compare."""
        return max(self.moved or self.changes, key=lambda change: abs(change.relative), default=None)


@dataclass(frozen=True)
class Bisection:
    """The search for the first release that moves a frequency, on the question of one case, speed and mode.

    Attributes:
        code, other: as in ``Comparison``.
        distribution: the package whose releases were tried.
        case, omega, mode: as in ``results.Cell``.
        first: the first release whose frequency is not that of ``older``.
        before: the last one tried before it, whose frequency is.
        older: the older of the two releases of the run; its frequency is the one that ``first`` is compared with.
        change: the frequency at ``first`` over that at ``older``, minus 1.
        uncertainty: of this change.
        tried: number of releases that answered, besides those of the run.
        skipped: releases between ``before`` and ``first`` that gave no answer, with the reason.
    """

    code: str
    other: str
    distribution: str
    case: str
    omega: float
    mode: int
    first: str
    before: str
    older: str
    change: float
    uncertainty: float
    tried: int
    skipped: dict[str, str] = field(default_factory=dict)


def comparisons(run: "Run") -> list[Comparison]:
    """One comparison for each column of another release, in the order of the run."""
    columns: dict[str, dict[tuple[str, float, int], Cell]] = {}
    for cell in run.cells:
        columns.setdefault(cell.code, {})[cell.case, cell.omega, cell.mode] = cell
    return [_compared(code, columns.get(installed(code), {}), cells) for code, cells in columns.items() if other(code)]


def _compared(
    code: str, before: dict[tuple[str, float, int], "Cell"], after: dict[tuple[str, float, int], "Cell"]
) -> Comparison:
    old, new = ({key for key, cell in cells.items() if cell.frequency} for cells in (before, after))
    changes = tuple(change(before[key], after[key]) for key in after if key in old & new)
    return Comparison(installed(code), code, changes, len(old - new), len(new - old))


def change(before: "Cell", after: "Cell") -> Change:
    """The change of a frequency, other than zero, between two cells of the same question."""
    assert before.frequency
    assert after.frequency is not None
    sizes = (before.uncertainty, after.uncertainty)
    known = None if None in sizes else sum(size or 0.0 for size in sizes)
    return Change(before, after, after.frequency / before.frequency - 1.0, known)


def smallest(moved: Sequence[Change]) -> Change:
    """The change whose question (all modes of one blade at one speed) is answered fastest; of its modes, the largest."""

    def cost(one: Change) -> tuple[float, float]:
        return (one.before.seconds or 0.0) + (one.after.seconds or 0.0), -abs(one.relative)

    return min(moved, key=cost)
