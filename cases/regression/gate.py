"""Comparison of a run with an earlier one: moved, worse and missing answers.

Cells are identified by case, code, rotor speed, mode and quantity. A run fails for a new miss (including that of a new cell), a
missing answer, a wider target, a seeded fault that is no longer detected or tried, or a property of a blade that is wrong or no
longer checked. Moved frequencies are listed and fail
a run only on request, since an improved discretisation also moves them. Measured data are not answers: they are counted but
cannot fail a run.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ..judge.quantities import difference
from ..judge.results import Key, Verdict
from . import properties
from .history import Detection, Entry, Point
from .properties import PropertyChange

MOVED = 1e-9
"""Relative change above which a frequency counts as moved."""

RANK: dict[Verdict, int] = {
    "pass": 0,
    "coarse": 1,
    "known difference": 2,
    "estimate": 3,
    "inconclusive": 4,
    "fail": 5,
}
"""Severity of a verdict; other verdicts are not answers. ``measured`` is absent: data are not judged."""

MISS = RANK["inconclusive"]


@dataclass(frozen=True)
class CellChange:
    """A cell in two runs; ``before`` is None for a new cell."""

    before: Point | None
    after: Point

    @property
    def moved(self) -> float | None:
        """Change of the value, relative to the scale of its quantity; None unless both runs have one."""
        if self.before is None or self.before.value is None or self.after.value is None:
            return None
        if not self.before.value and self.before.quantity == "frequency":
            return None
        return difference(self.after.quantity, self.after.value, self.before.value)


@dataclass(frozen=True)
class MissingAnswer:
    """A missing answer and its replacement: the verdict on that code at that speed, or nothing."""

    point: Point
    replacement: Verdict | None


@dataclass(frozen=True)
class Comparison:
    """Comparison of two runs.

    Attributes:
        before: the earlier run.
        after: the later run.
        moved: cells whose value moved, largest change first.
        worse: cells with a worse verdict, worst first.
        loosened: cells with a wider target.
        measured: number of measured points in the later run.
        properties: properties that are worse, wrong for the first time, or no longer checked.
        better: cells with a better verdict.
        gone: missing answers.
        new: cells with an answer that had none.
        undetected: seeded faults that the earlier run detected and this one does not, or does not try.
        missed: seeded faults that this run does not detect.
    """

    before: Entry
    after: Entry
    moved: tuple[CellChange, ...]
    worse: tuple[CellChange, ...]
    better: tuple[CellChange, ...]
    gone: tuple[MissingAnswer, ...]
    new: tuple[Point, ...]
    undetected: tuple[Detection, ...]
    missed: tuple[str, ...] = ()
    loosened: tuple[CellChange, ...] = ()
    measured: int = 0
    properties: tuple[PropertyChange, ...] = ()

    @property
    def versions(self) -> dict[str, tuple[str, str]]:
        """Changed versions: name → before, after; ``none`` if absent."""
        names = dict.fromkeys([*self.before.versions, *self.after.versions])
        pairs = {n: (self.before.versions.get(n, "none"), self.after.versions.get(n, "none")) for n in names}
        return {name: pair for name, pair in pairs.items() if pair[0] != pair[1]}

    def passed(self, strict: bool = False) -> bool:
        """Whether nothing got worse; with ``strict``, also whether nothing moved."""
        worse = self.worse or self.loosened or self.gone or self.undetected or self.missed or self.properties
        return not (worse or (strict and self.moved))


def misses(entry: Entry) -> int:
    """Number of cells of a run that failed or were inconclusive, of seeded faults not detected, and of wrong properties."""
    cells = sum(RANK.get(p.verdict, 0) >= MISS for p in entry.cells)
    failed_properties = sum(p.verdict == "fail" for p in entry.properties)
    return cells + failed_properties + sum(not c.detected_by for c in entry.controls)


def nothing(after: Entry) -> Entry:
    """The baseline of a first run: no cells, so that every miss counts."""
    return Entry("no baseline", "", after.machine, after.versions, ())


def within(entry: Entry, scope: Entry) -> Entry:
    """``entry`` restricted to the cases and the seeded faults of ``scope``."""
    cases = {p.case for p in scope.cells}
    controls = {c.control for c in scope.controls}
    return replace(
        entry,
        cells=tuple(p for p in entry.cells if p.case in cases),
        controls=tuple(c for c in entry.controls if c.case in cases and c.control in controls),
        properties=tuple(p for p in entry.properties if p.case in cases),
    )


def compare(
    before: Entry,
    after: Entry,
    tolerance: float = MOVED,
    missed: Sequence[str] = (),
) -> Comparison:
    """Compare the run ``after`` with the earlier run ``before``.

    Args:
        missed: names of undetected faults, see ``results.Control``.
        tolerance: relative change above which a frequency counts as moved.
    """
    old = {p.key: p for p in before.cells}
    changes = [CellChange(old.get(p.key), p) for p in after.cells if p.verdict != "measured"]
    moved_cells = [c for c in changes if abs(c.moved or 0.0) > tolerance]
    worse = sorted((c for c in changes if _worse(c)), key=lambda c: -RANK[c.after.verdict])
    listed = {c.after.key for c in worse}
    detected = {c.control: bool(c.detected_by) for c in after.controls}
    return Comparison(
        before=before,
        after=after,
        moved=tuple(sorted(moved_cells, key=lambda c: -abs(c.moved or 0.0))),
        worse=tuple(worse),
        better=tuple(c for c in changes if _better(c)),
        gone=tuple(g for g in _gone(old, after.cells) if g.point.key not in listed),
        new=tuple(
            c.after for c in changes if c.after.value is not None and not (c.before and c.before.value is not None)
        ),
        undetected=tuple(c for c in before.controls if c.detected_by and not detected.get(c.control, False)),
        missed=tuple(missed),
        loosened=tuple(c for c in changes if _loosened(c)),
        measured=sum(p.verdict == "measured" for p in after.cells),
        properties=properties.changes(before.properties, after.properties),
    )


def _worse(change: CellChange) -> bool:
    """Whether the verdict is worse; for a new cell, whether it is a miss."""
    earlier, rank = change.before, RANK.get(change.after.verdict, 0)
    return rank > RANK[earlier.verdict] if earlier and earlier.verdict in RANK else rank >= MISS


def _loosened(change: CellChange) -> bool:
    """Whether the target is wider than before."""
    earlier, current = change.before.target if change.before else None, change.after.target
    return earlier is not None and current is not None and current > earlier * (1 + 1e-12)


def _better(change: CellChange) -> bool:
    if change.before is None or change.before.verdict not in RANK or change.after.verdict not in RANK:
        return False
    return RANK[change.after.verdict] < RANK[change.before.verdict]


def _gone(old: Mapping[Key, Point], current: Sequence[Point]) -> list[MissingAnswer]:
    """Missing answers. A code without an answer at a speed has one cell there, of mode 0, with the reason.

    An answer that has become a measurement counts as missing: it is no longer evidence.
    """
    answered = {p.key for p in current if p.value is not None and p.verdict != "measured"}
    verdicts: dict[Key, Verdict] = {p.key: p.verdict for p in current}
    due = [p for p in old.values() if p.value is not None and p.verdict != "measured"]
    gone = [p for p in due if p.key not in answered]
    return [
        MissingAnswer(p, verdicts.get(p.key) or verdicts.get((p.case, p.code, p.omega, 0, "frequency", p.where)))
        for p in gone
    ]
