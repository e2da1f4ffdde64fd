"""Comparison of the checks of properties of two runs: which are wrong, or no longer made."""

from collections.abc import Sequence
from dataclasses import dataclass

import msgspec

from ..judge.results import PropertyCheck, Verdict

CHECKED: tuple[Verdict, ...] = ("pass", "inconclusive", "fail")
"""Verdicts of a property that was compared, the best first."""


class Property(msgspec.Struct, frozen=True, array_like=True):
    """One check of a property of one run; an array in the file, in this order. Fields as in ``results.PropertyCheck``."""

    case: str
    code: str
    quantity: str
    part: str
    difference: float | None
    verdict: Verdict

    @property
    def key(self) -> tuple[str, str, str, str]:
        """What identifies the check in another run; one whose property is not compared has no name of a property."""
        return self.case, self.quantity, self.code, self.part


@dataclass(frozen=True)
class PropertyChange:
    """A check in two runs; ``before`` or ``after`` is None if the run does not have it."""

    before: Property | None
    after: Property | None

    @property
    def check(self) -> Property:
        """The later of both."""
        check = self.after or self.before
        assert check is not None
        return check

    @property
    def counts(self) -> bool:
        """Whether the check is worse, is no longer made, or is new and fails."""
        now = _rank(self.after)
        return (
            now > _rank(self.before) if self.before and self.before.verdict in CHECKED else now == CHECKED.index("fail")
        )


def _rank(check: Property | None) -> int:
    """Position in ``CHECKED``; behind all of them for a check that is not made."""
    return CHECKED.index(check.verdict) if check and check.verdict in CHECKED else len(CHECKED)


def entries(checks: Sequence[PropertyCheck]) -> tuple[Property, ...]:
    """The checks of a run as they are kept in a history."""
    return tuple(Property(c.case, c.code, c.quantity, c.part, c.difference, c.verdict) for c in checks)


def changes(before: Sequence[Property], after: Sequence[Property]) -> tuple[PropertyChange, ...]:
    """The changes that count against the later run, in its order; then those of checks that it does not have."""
    old, new = {p.key: p for p in before}, {p.key: p for p in after}
    pairs = [PropertyChange(old.get(key), p) for key, p in new.items()]
    pairs += [PropertyChange(p, None) for key, p in old.items() if key not in new]
    return tuple(pair for pair in pairs if pair.counts)
