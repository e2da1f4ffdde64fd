"""The error budget of a case as a table: one row per cause, one column per mode."""

from ...cases.judge.results import BudgetEntry, Run
from ...cases.judge.verdict import percent, unsigned
from ..shared.units import Units

TINY = 1e-9
"""Smaller relative changes are shown as 0."""


def rows(run: Run, case: str) -> list[dict[str, str]]:
    """One row per cause (discretisation, model form, rounding) with its effect on each mode."""
    entries = [s for s in run.error_budget if s.case == case]
    modes = list(dict.fromkeys(s.mode for s in entries))
    by = {(s.cause, s.part, s.mode): s for s in entries}
    order = {cause: k for k, cause in enumerate(("discretisation", "model form", "rounding"))}
    parts = sorted(dict.fromkeys((s.cause, s.part) for s in entries), key=lambda p: order[p[0]])
    return [
        {"cause": cause, "what": part} | {mode: _shown(by.get((cause, part, mode))) for mode in modes}
        for cause, part in parts
    ]


def heading(run: Run, case: str, units: Units) -> str:
    """The speed of the error budget; empty for a case without one."""
    return next((units.at(s.omega) for s in run.error_budget if s.case == case), "")


def _shown(share: BudgetEntry | None) -> str:
    if share is None:
        return ""
    if share.change is None:
        return "no such mode"
    if abs(share.change) < TINY:
        return "0"
    return f"± {unsigned(share.change)}" if share.bound else percent(share.change)
