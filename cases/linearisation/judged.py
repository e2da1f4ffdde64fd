"""The result of judging linearisations, as data."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from .findings import DEFECT, LIMIT, Finding
from .mode_tables import ModeTable
from .modes import Mode
from .sets import AzimuthSet

YES, NO, OPEN = "Yes", "No", "Open"

AVERAGED, FLOQUET = "mean of the azimuths", "Floquet"


@dataclass(frozen=True)
class JudgedSet:
    """A set with its modes and findings.

    Attributes:
        azimuth_set: the set.
        modes: its modes by frequency, after corrections.
        method: how periodic coefficients were treated, ``AVERAGED`` or ``FLOQUET``.
        findings: defects first.
    """

    azimuth_set: AzimuthSet
    modes: tuple[Mode, ...]
    method: str
    findings: tuple[Finding, ...]


@dataclass(frozen=True)
class TrackedMode:
    """A mode over the operating points.

    Attributes:
        name: name at its first operating point; ``a → b`` if its dominant motion changes.
        at: its mode at each operating point; None where it was not found.
    """

    name: str
    at: tuple[Mode | None, ...]


@dataclass(frozen=True)
class Judgement:
    """The result for all files.

    Attributes:
        sets: by rotor speed and wind speed.
        tracked: modes over the sets.
        tables: tables of modes that were read instead of state matrices.
        findings: of all sets and tables, defects first.
    """

    sets: tuple[JudgedSet, ...]
    tracked: tuple[TrackedMode, ...]
    tables: tuple[ModeTable, ...]
    findings: tuple[Finding, ...]

    @property
    def verdict(self) -> str:
        """``NO`` with a defect, ``OPEN`` if the evidence is limited, else ``YES``."""
        levels = {finding.level for finding in self.findings}
        return NO if DEFECT in levels else OPEN if LIMIT in levels else YES


def located(findings: Iterable[Finding], where: str) -> tuple[Finding, ...]:
    """Findings with the name of their set or table."""
    return tuple(replace(finding, where=where) for finding in findings)


def by_level(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Findings with defects first."""
    levels = (DEFECT, LIMIT)
    return tuple(sorted(findings, key=lambda f: levels.index(f.level) if f.level in levels else len(levels)))
