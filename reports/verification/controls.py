"""Negative controls as text and as a table: each seeded fault, its size, its effect, and the cells that detect it."""

from ...cases.judge.results import Control, Run
from ...cases.judge.verdict import percent

SHOWN = 1
"""Number of cells that a table names; the others are only counted."""


def headline(run: Run) -> str:
    """One sentence on how many faults are detected and which are missed; empty without controls."""
    tried = [c for c in run.controls if not c.needs]
    missed = ", ".join(c.control for c in tried if c.missed)
    if not tried:
        return ""
    if missed:
        return f"**Negative controls not detected: {missed}.**"
    skipped = len(run.controls) - len(tried)
    silent = sum(bool(c.without_effect) for c in tried)
    rest = f"; {skipped} were not run, because a code is missing" if skipped else ""
    count = len(tried) - silent
    rest += f"; {silent} have no effect here" if silent else ""
    return f"Negative controls: {count} of {count} seeded faults, run through the whole pipeline, are detected{rest}."


def said(control: Control) -> str:
    """The outcome of a control: ``✔ detected``, ``✘ missed``, ``– without effect here`` or ``○ needs exudyn-tree``."""
    if control.needs:
        return f"○ needs {control.needs}"
    if control.without_effect:
        return "– without effect here"
    return "✘ missed" if control.missed else "✔ detected"


def overview(run: Run) -> list[dict[str, str]]:
    """One row per fault: what is faulty, its size, the largest difference, and the cells that detect it."""
    return [
        {
            "fault": control.control,
            "in": control.area,
            "what": control.what,
            "size": control.size,
            "outcome": said(control),
            "largest difference": percent(control.change) if control.change is not None else "",
            "detected by": _named(control.detected_by) or control.without_effect,
        }
        for control in run.controls
    ]


def _named(detected_by: tuple[str, ...]) -> str:
    more = f"; and {len(detected_by) - SHOWN} more" if len(detected_by) > SHOWN else ""
    return "; ".join(detected_by[:SHOWN]) + more
