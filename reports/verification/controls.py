"""Seeded faults as text and as a table: each with its size, its effect, and the cells that detect it."""

from ...cases.judge.results import Control, Run
from ...cases.judge.verdict import percent

SHOWN = 1
"""Number of cells that a table names; the others are only counted."""


def headline(run: Run) -> str:
    """One sentence on how many faults are detected and which are missed; empty without controls."""
    completed = [c for c in run.controls if not c.needs]
    undetected = ", ".join(c.control for c in completed if c.missed)
    if not completed:
        return ""
    if undetected:
        return f"**Seeded faults not detected: {undetected}.**"
    skipped = len(run.controls) - len(completed)
    silent = sum(bool(c.without_effect) for c in completed)
    exceptions = f"; {skipped} were not run, because a code is missing" if skipped else ""
    count = len(completed) - silent
    exceptions += f"; {silent} have no effect here" if silent else ""
    return f"{count} of {count} seeded faults, run through the whole pipeline, are detected{exceptions}."


def outcome(control: Control) -> str:
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
            "outcome": outcome(control),
            "largest difference": percent(control.change) if control.change is not None else "",
            "detected by": _named(control.detected_by) or control.without_effect,
        }
        for control in run.controls
    ]


def _named(detected_by: tuple[str, ...]) -> str:
    remainder = f"; and {len(detected_by) - SHOWN} more" if len(detected_by) > SHOWN else ""
    return "; ".join(detected_by[:SHOWN]) + remainder
