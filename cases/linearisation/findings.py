"""Findings about linearisations, as data."""

from dataclasses import dataclass

DEFECT, LIMIT, NOTE = "defect", "limit", "note"
"""A defect makes the verdict No; a limit of the evidence makes it Open; a note does not change it."""


@dataclass(frozen=True)
class Finding:
    """A finding about a set.

    Attributes:
        name: kind of the finding, as ``frame flag``.
        level: ``DEFECT``, ``LIMIT`` or ``NOTE``.
        observation: what was measured, with the number.
        remedy: what to do.
        value: the number.
        where: name of the set or the table; the judgement adds it.
    """

    name: str
    level: str
    observation: str
    remedy: str
    value: float
    where: str = ""

    def __str__(self) -> str:
        return f"{self.name}: {self.observation}: {self.remedy}"


def listed(items: list[str]) -> str:
    """The first three items, and how many there are more."""
    remainder = f" and {len(items) - 3} more" if len(items) > 3 else ""
    return ", ".join(items[:3]) + remainder


def count(n: int, name: str, several: str = "") -> str:
    """A number of things of this name, which takes an s unless there is one of them, or is replaced by ``several``."""
    return f"{n} {name if n == 1 else several or name + 's'}"
