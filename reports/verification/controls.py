"""Seeded faults in words and in a table: what was made faulty, how large its effect is, and who noticed."""

from ...cases.judge.results import Control, Run
from ...cases.judge.verdict import percent

SHOWN = 3
"""Cells that a table names; of the others it says how many."""


def headline(run: Run) -> str:
    """How many faults are detected, in a sentence; which are missed. Empty for a run without any."""
    tried = [c for c in run.controls if not c.needs]
    missed = ", ".join(c.control for c in tried if c.missed)
    if not tried:
        return ""
    if missed:
        return f"**Negative controls not detected: {missed}.**"
    left = len(run.controls) - len(tried)
    rest = f"; {left} were not run, for want of a code" if left else ""
    return f"Negative controls: {len(tried)} of {len(tried)} seeded faults, run through the whole pipeline, are detected{rest}."


def said(control: Control) -> str:
    """What became of one: ``✔ detected``, ``○ needs exudyn-tree``."""
    if control.needs:
        return f"○ needs {control.needs}"
    return "✘ missed" if control.missed else "✔ detected"


def overview(run: Run) -> list[dict[str, str]]:
    """A row a fault: what is faulty, its size, the largest difference it made, and the cells that say so."""
    return [
        {
            "fault": control.control,
            "in": control.area,
            "what": control.what,
            "size": control.size,
            "outcome": said(control),
            "largest difference": percent(control.change) if control.change is not None else "",
            "noticed by": _named(control.caught),
        }
        for control in run.controls
    ]


def _named(caught: tuple[str, ...]) -> str:
    more = f"; and {len(caught) - SHOWN} more" if len(caught) > SHOWN else ""
    return "; ".join(caught[:SHOWN]) + more
