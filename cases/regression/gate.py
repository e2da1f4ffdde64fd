"""One run against an earlier one: what moved, what got worse, what is gone; and what took longer, which decides nothing.

Cells are the same where case, code, rotor speed and mode are. What counts against a run: a miss that was none before
(including that of a cell that was not there), an answer that is gone, a wider target, a seeded fault that is not detected any
more. Moved frequencies are listed, and count only if that is asked for: who improves a discretisation moves them and is
right to. Measured data are no answers: they are counted, and nothing about them counts against a run.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..judge.results import Verdict
from .history import Caught, Entry, Key, Point

MOVED = 1e-9
"""Relative change above which a frequency has moved."""

RUNS = 20
"""Earlier runs on the same machine that show how much times vary, at most."""

RANK: dict[Verdict, int] = {"pass": 0, "known difference": 1, "estimate": 2, "inconclusive": 3, "fail": 4}
"""How bad a verdict is; the others are none. ``measured`` is not among them: data are not judged."""

MISS = RANK["inconclusive"]


@dataclass(frozen=True)
class Change:
    """A cell in two runs; ``before`` is None for one that was not there."""

    before: Point | None
    after: Point

    @property
    def moved(self) -> float | None:
        """Relative change of the frequency; None where there are not two."""
        if self.before is None or not self.before.frequency or self.after.frequency is None:
            return None
        return self.after.frequency / self.before.frequency - 1.0


@dataclass(frozen=True)
class Gone:
    """An answer that is there no more, and what stands in its place: the verdict on that code at that speed, or nothing."""

    point: Point
    instead: Verdict | None


@dataclass(frozen=True)
class Timing:
    """What one code's solutions took in both runs; only those that both have.

    Attributes:
        code: its name.
        before: seconds in all.
        after: likewise.
        ratios: after over before, blade by blade and speed by speed: lower quartile, median, upper quartile.
        earlier: least and most seconds in all, in earlier runs on the machine of this one; None where there are not two.
    """

    code: str
    before: float
    after: float
    ratios: tuple[float, float, float]
    earlier: tuple[float, float] | None

    @property
    def noise(self) -> bool:
        """Whether the change is no larger than what times do by themselves."""
        if self.earlier:
            return self.earlier[0] <= self.after <= self.earlier[1]
        return self.ratios[0] <= 1.0 <= self.ratios[2]


@dataclass(frozen=True)
class Comparison:
    """One run against another.

    Attributes:
        before: the earlier run.
        after: the later.
        moved: cells whose frequency moved, most first.
        worse: cells with a worse verdict, worst first.
        loosened: cells that are held to a wider target.
        measured: how many measured points the later run has.
        better: cells with a better one.
        gone: answers that are there no more.
        new: cells with an answer that had none.
        uncaught: seeded faults that were caught and are not now; all of them if none is tried any more.
        timings: by code; they decide nothing.
        missed: seeded faults that this run does not detect.
    """

    before: Entry
    after: Entry
    moved: tuple[Change, ...]
    worse: tuple[Change, ...]
    better: tuple[Change, ...]
    gone: tuple[Gone, ...]
    new: tuple[Point, ...]
    uncaught: tuple[Caught, ...]
    timings: tuple[Timing, ...]
    missed: tuple[str, ...] = ()
    loosened: tuple[Change, ...] = ()
    measured: int = 0

    @property
    def versions(self) -> dict[str, tuple[str, str]]:
        """What was run in another version: name → before, after; ``none`` where it was not there."""
        names = dict.fromkeys([*self.before.versions, *self.after.versions])
        pairs = {n: (self.before.versions.get(n, "none"), self.after.versions.get(n, "none")) for n in names}
        return {name: pair for name, pair in pairs.items() if pair[0] != pair[1]}

    def passed(self, strict: bool = False) -> bool:
        """Whether nothing got worse; ``strict``: nor moved."""
        worse = self.worse or self.loosened or self.gone or self.uncaught or self.missed
        return not (worse or (strict and self.moved))


def nothing(after: Entry) -> Entry:
    """What a first run is compared with: no cells, so that every miss counts."""
    return Entry("nothing", "", after.machine, after.versions, ())


def within(entry: Entry, other: Entry) -> Entry:
    """What ``entry`` has of the cases that ``other`` has."""
    cases = {p.case for p in other.cells}
    return replace(
        entry,
        cells=tuple(p for p in entry.cells if p.case in cases),
        controls=tuple(c for c in entry.controls if c.case in cases),
    )


def compare(
    before: Entry,
    after: Entry,
    earlier: Sequence[Entry] = (),
    tolerance: float = MOVED,
    missed: Sequence[str] = (),
) -> Comparison:
    """What became of ``before`` in ``after``.

    Args:
        missed: names of faults, see ``results.Control``.
        earlier: runs from which the noise of times is taken, where they are of the same machine.
        tolerance: relative change above which a frequency has moved.
    """
    old = {p.key: p for p in before.cells}
    changes = [Change(old.get(p.key), p) for p in after.cells if p.verdict != "measured"]
    moved = [c for c in changes if abs(c.moved or 0.0) > tolerance]
    worse = sorted((c for c in changes if _worse(c)), key=lambda c: -RANK[c.after.verdict])
    listed = {c.after.key for c in worse}
    tried = {c.control: bool(c.caught) for c in after.controls}
    return Comparison(
        before=before,
        after=after,
        moved=tuple(sorted(moved, key=lambda c: -abs(c.moved or 0.0))),
        worse=tuple(worse),
        better=tuple(c for c in changes if _better(c)),
        gone=tuple(g for g in _gone(old, after.cells) if g.point.key not in listed),
        new=tuple(c.after for c in changes if c.after.frequency and not (c.before and c.before.frequency)),
        uncaught=tuple(c for c in before.controls if c.caught and not tried.get(c.control, bool(tried))),
        timings=tuple(_timings(before, after, [e for e in earlier if e.machine == after.machine][-RUNS:])),
        missed=tuple(missed),
        loosened=tuple(c for c in changes if _loosened(c)),
        measured=sum(p.verdict == "measured" for p in after.cells),
    )


def _worse(change: Change) -> bool:
    """Whether the verdict is worse; of a cell that had none, whether it is a miss."""
    then, now = change.before, RANK.get(change.after.verdict, 0)
    return now > RANK[then.verdict] if then and then.verdict in RANK else now >= MISS


def _loosened(change: Change) -> bool:
    """Whether the target is wider than it was, so that the same difference passes more easily."""
    then, now = change.before.target if change.before else None, change.after.target
    return then is not None and now is not None and now > then * (1 + 1e-12)


def _better(change: Change) -> bool:
    if change.before is None or change.before.verdict not in RANK or change.after.verdict not in RANK:
        return False
    return RANK[change.after.verdict] < RANK[change.before.verdict]


def _gone(old: Mapping[Key, Point], now: Sequence[Point]) -> list[Gone]:
    """A code that gives no answer at a speed has one cell there, of mode 0, that says so.

    An answer that is now called a measurement is gone: it was evidence, and is none any more.
    """
    answered = {p.key for p in now if p.frequency is not None and p.verdict != "measured"}
    verdicts: dict[Key, Verdict] = {p.key: p.verdict for p in now}
    due = [p for p in old.values() if p.frequency is not None and p.verdict != "measured"]
    gone = [p for p in due if p.key not in answered]
    return [Gone(p, verdicts.get(p.key) or verdicts.get((p.case, p.code, p.omega, 0))) for p in gone]


Solution = tuple[str, str, float]
"""Code, case, rotor speed: what one time belongs to."""


def _seconds(entry: Entry) -> dict[Solution, float]:
    return {(p.code, p.case, p.omega): p.seconds for p in entry.cells if p.seconds}


def _timings(before: Entry, after: Entry, earlier: Sequence[Entry]) -> list[Timing]:
    then, now = _seconds(before), _seconds(after)
    past = [_seconds(e) for e in earlier]
    out = []
    for code in dict.fromkeys(solution[0] for solution in now):
        both = [s for s in now if s[0] == code and s in then]
        if not both:
            continue
        ratios = [now[s] / then[s] for s in both]
        low, middle, high = np.percentile(ratios, (25, 50, 75)).tolist()
        totals = [sum(run[s] for s in both) for run in past if all(s in run for s in both)]
        spread = (min(totals), max(totals)) if len(totals) > 1 else None
        total = sum(then[s] for s in both), sum(now[s] for s in both)
        out.append(Timing(code, *total, (low, middle, high), spread))
    return out
