"""The checks of properties as data of pages: one row for each check of a blade, or for each of its properties."""

from itertools import groupby
from typing import Any

from ...cases.judge.results import PropertyCheck, Run
from ..shared.summary import WORST_FIRST
from ..verification.properties import size, subject

WORST = ("fail", "inconclusive", "not run", "pass", "not applicable")
"""Verdicts of properties, the worst first."""


def of_matrix(run: Run) -> list[dict[str, Any]]:
    """One row for each check of each blade: its worst verdict, the properties with it, and the first reason."""
    out = []
    for (case, subject_name), group in groupby(run.property_checks, key=lambda c: (c.case, subject(c))):
        checks = list(group)
        worst = min((c.verdict for c in checks), key=WORST.index)
        worst_checks = [c for c in checks if c.verdict == worst]
        out.append(
            {
                "case": case,
                "check": subject_name,
                "verdict": WORST_FIRST.index(worst),
                "count": f"{len(worst_checks)} of {len(checks)}",
                "properties": [c.part for c in worst_checks if c.part] if worst in ("fail", "inconclusive") else [],
                "reason": next((c.reason for c in worst_checks if c.reason), ""),
            }
        )
    return out


def of_case(run: Run, case: str) -> list[dict[str, Any]]:
    """One row for each property of a blade."""
    return [_row(c) for c in run.property_checks if c.case == case]


def _row(check: PropertyCheck) -> dict[str, Any]:
    return {
        "check": subject(check),
        "property": check.part,
        "value": check.value,
        "reference": check.reference,
        "unit": check.unit,
        "difference": size(check),
        "verdict": WORST_FIRST.index(check.verdict),
        "reason": check.reason,
    }
