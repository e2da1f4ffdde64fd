"""Two releases of one code in a run: how far the other release moves each frequency of the installed one.

A column at another release (``exudyn-ancf@1.10.0``) is judged against core like any column, but it has the engine of
the installed release and is no further witness. Its cells are compared with those of the installed release by case,
speed and mode. A frequency is *moved* if it changes by more than the uncertainties of both answers together; a change
within them may be due to another refinement. What has moved is information and decides nothing: the run fails only if
a cell of either release does.
"""

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
        before, after: cells of the two releases; None if that release gives no frequency. At least one is given.
        relative: the frequency of ``after`` over that of ``before``, minus 1; None if one is missing.
        uncertainty: sum of the relative uncertainties of both; None if one is missing or unknown.
    """

    before: "Cell | None"
    after: "Cell | None"
    relative: float | None
    uncertainty: float | None

    @property
    def cell(self) -> "Cell":
        """A cell with a frequency."""
        found = self.before or self.after
        assert found
        return found

    @property
    def moved(self) -> bool:
        """Whether the frequency changes by more than its uncertainty."""
        return self.relative is not None and self.uncertainty is not None and abs(self.relative) > self.uncertainty

    @property
    def differs(self) -> bool:
        """Whether it is moved, or only one of the releases gives it."""
        return self.moved or self.relative is None


def change(before: "Cell | None", after: "Cell | None") -> Change:
    """The change of a frequency, other than zero, between two answers to the same question; at least one is given."""
    if not (before and after and before.frequency and after.frequency):
        return Change(before, after, None, None)
    sizes = (before.uncertainty, after.uncertainty)
    known = None if None in sizes else sum(size or 0.0 for size in sizes)
    return Change(before, after, after.frequency / before.frequency - 1.0, known)


@dataclass(frozen=True)
class Comparison:
    """All frequencies of a code with the installed release (``code``) and with another (``other``): their columns."""

    code: str
    other: str
    changes: tuple[Change, ...]

    @property
    def compared(self) -> tuple[Change, ...]:
        """The frequencies that both releases give."""
        return tuple(one for one in self.changes if one.relative is not None)

    @property
    def moved(self) -> tuple[Change, ...]:
        """The frequencies that moved."""
        return tuple(one for one in self.changes if one.moved)

    @property
    def lost(self) -> tuple[Change, ...]:
        """The frequencies that only the installed release gives."""
        return tuple(one for one in self.changes if one.after is None)

    @property
    def gained(self) -> tuple[Change, ...]:
        """The frequencies that only the other release gives."""
        return tuple(one for one in self.changes if one.before is None)

    @property
    def largest(self) -> Change | None:
        """The largest change, of those that moved if any did; None if nothing is compared."""
        return max(self.moved or self.compared, key=lambda one: abs(one.relative or 0.0), default=None)


@dataclass(frozen=True)
class Bisection:
    """The first release whose answer to one question (case, speed and mode) is not that of the older release of the run.

    Attributes:
        code, other: as in ``Comparison``.
        distribution: the package whose releases were tried.
        case, omega, mode: as in ``results.Cell``.
        first: the release found.
        before: the last release tried before it; its answer is that of ``older``.
        older: the older of the two releases of the run.
        change: the frequency at ``first`` over that at ``older``, minus 1; None if only one of them gives a frequency.
        uncertainty: of this change.
        answers: whether ``first`` gives a frequency.
        reason: why ``first``, or ``before``, gives none.
        tried: number of releases asked, besides those of the run.
        skipped: releases between ``before`` and ``first`` that could not be asked, with the reason.
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
    change: float | None
    uncertainty: float | None
    answers: bool
    reason: str
    tried: int
    skipped: dict[str, str] = field(default_factory=dict)


def comparisons(run: "Run") -> list[Comparison]:
    """One comparison for each column of another release, in the order of the run."""
    columns: dict[str, dict[tuple[str, float, int], Cell]] = {}
    for cell in run.cells:
        mine = columns.setdefault(cell.code, {})
        if cell.frequency:
            mine[cell.case, cell.omega, cell.mode] = cell
    return [_compared(code, columns.get(installed(code), {}), cells) for code, cells in columns.items() if other(code)]


def _compared(
    code: str, before: dict[tuple[str, float, int], "Cell"], after: dict[tuple[str, float, int], "Cell"]
) -> Comparison:
    changes = tuple(change(before.get(key), after.get(key)) for key in dict.fromkeys((*before, *after)))
    return Comparison(installed(code), code, changes)
