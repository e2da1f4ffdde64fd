"""A column of one subject: what it is called, what its references keep, and the work that gives its rows.

The work of a column is a picklable function of the speeds and core's references; it returns the rows of the column.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

from ...core.effects import ALL_EFFECTS, Effects
from ...references.protocol.description import Description
from ...references.protocol.interface import Independence
from ...references.protocol.process import Failure
from ..judge.cells import Head, Rows, empty, failing, without_reference
from ..solve.works import References


class ColumnError(Exception):
    """The work of a column raised an exception, the cause, that ends the run instead of costing the column's cells."""


@dataclass(frozen=True)
class Column:
    """A column of one blade.

    Attributes:
        name: as shown while it is being solved.
        effects: effects that its references keep.
        head: fields common to its cells.
        work: function that returns its rows from core's references.
        origin: declared origin of its answers; None if undeclared.
        due: where cells are required: at every speed for every mode, at the highest speed, or where it has numbers.
        adapter: digest of the source of the code; empty for a column of this package.
        bundled: whether the adapter of the code is part of this package.
        solves: whether there is anything to solve; not for a code that is absent, broken or declines the blade.
    """

    name: str
    effects: Effects
    head: Head
    work: Callable[[Any], Rows]
    origin: Independence | None = None
    due: Literal["everywhere", "highest speed", "somewhere"] = "everywhere"
    adapter: str = ""
    bundled: bool = True
    solves: bool = True

    @property
    def storable(self) -> bool:
        """Whether its digest determines its answer: not for a code of another package or of unknown version."""
        return self.bundled and bool(self.head.version or self.head.role == "table")

    @property
    def code(self) -> str:
        """Name of the code."""
        return self.head.code

    def __call__(self, speeds: Sequence[float], core: Sequence[Any]) -> Rows:
        """Rows at all speeds; where core has no reference, the reason. Nothing is solved there."""
        pairs = list(zip(speeds, core, strict=True))
        if not self.solves:
            return self.work(pairs)
        unreferenced = [without_reference(self.head, omega, r) for omega, r in pairs if isinstance(r, Failure)]
        solvable = [(omega, r) for omega, r in pairs if not isinstance(r, Failure)]
        cells, levels = self.work(solvable) if solvable else ([], [])
        return unreferenced + cells, levels


def declined(head: Head, effects: Effects, reason: str) -> Column:
    """The column of a code that does not take the subject."""
    return Column(head.code, effects, head, partial(_absent, head, reason), solves=False)


def unasked(head: Head, code: Description, refusal: str) -> Column | None:
    """The column of a code that failed before its first question, declines the subject or is not installed.

    None if the code can be asked. ``refusal``: why it declines the subject; empty if it takes it.
    """
    if refusal and not code.failure:
        return declined(head, ALL_EFFECTS, refusal)
    missing = Failure("not installed", f"not installed: {code.hint}") if code.version is None else None
    failure = code.failure or missing
    return failure and Column(head.code, ALL_EFFECTS, head, partial(_failing, head, failure), solves=False)


def _failing(head: Head, failure: Failure, core: References) -> Rows:
    return failing(head, failure, [omega for omega, _ in core])


def _absent(head: Head, reason: str, core: References) -> Rows:
    return [empty(head, omega, "not applicable", reason) for omega, _ in core], []
