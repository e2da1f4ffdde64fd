"""Faults in history and gate, and the canaries that must detect them: deliberate changes between two runs.

A canary is a pair of runs, written to a history and read again, with the expected report of the gate. Without a fault
the canaries report nothing.
"""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from southwell.cases.faults.seeding import Seam
from southwell.cases.judge.results import Cell, Control, Run
from southwell.cases.regression import gate, history
from southwell.cases.regression.gate import Comparison
from southwell.cases.regression.history import Entry


def _cell(mode: int, **changes: Any) -> Cell:
    values: dict[str, Any] = {
        "case": "canary", "omega": 10.0, "mode": mode, "family": "flapwise", "code": "bird", "version": "1", "role": "code",
        "value": 10.0 * mode, "reference": 10.0 * mode, "difference": 1e-5, "uncertainty": 1e-6, "target": 1e-3,
        "verdict": "pass", "shares": "nothing",
    }  # fmt: skip
    return Cell(**{**values, **changes})


def _fault(detected_by: tuple[str, ...]) -> Control:
    return Control("cat", "solver", "eats the bird", "all of it", "canary", 10.0, detected_by)


BEFORE = Run((_cell(1), _cell(2), _cell(3)), controls=(_fault(("bird",)),))

AFTER: dict[str, Run] = {
    "a verdict that got worse": replace(BEFORE, cells=(_cell(1, verdict="fail", difference=2e-3), *BEFORE.cells[1:])),
    "an answer that is gone": replace(BEFORE, cells=BEFORE.cells[:2]),
    "a mode that is new and fails": replace(BEFORE, cells=(*BEFORE.cells, _cell(4, verdict="fail", difference=2e-3))),
    "a target that was loosened": replace(BEFORE, cells=(_cell(1, target=2e-3), *BEFORE.cells[1:])),
    "a fault that is no longer detected": replace(BEFORE, controls=(_fault(()),)),
    "a frequency that moved": replace(BEFORE, cells=(_cell(1, value=10.0 * (1 + 1e-6)), *BEFORE.cells[1:])),
    "a code that was not run": replace(BEFORE, cells=(_cell(0, family="", value=None, verdict="not run"),)),
}


def canaries() -> list[str]:
    """Expected reports of history and gate that are missing; empty if all are correct."""
    altered = []
    comparison = _compared(BEFORE, BEFORE)
    if comparison is None or not comparison.passed(strict=True) or not comparison.after.cells:
        altered.append("gate: a run against itself does not pass")
    for kind, after in AFTER.items():
        comparison = _compared(BEFORE, after)
        if comparison is None or comparison.passed(strict=True):
            altered.append(f"gate: not listed: {kind}")
    return altered


def _compared(before: Run, after: Run) -> Comparison | None:
    """The gate's comparison of two runs read from a history; None if it does not reach one."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "history.jsonl"
        try:
            for name, run in (("before", before), ("after", after)):
                history.append(path, history.entry(run, name, "canary"))
            first, second = history.read(path).entries
            return gate.compare(first, second)
        except (ValueError, KeyError):
            return None


def _entry(**changes: Any) -> Any:
    """Set these fields in every point of an entry."""

    def make(original: Any) -> Any:
        def wrong(*args: Any) -> Entry:
            solution = original(*args)
            return replace(solution, cells=tuple(_point(p, **changes) for p in solution.cells))

        return wrong

    return make


def _point(point: Any, **changes: Any) -> Any:
    values = {name: getattr(point, name) for name in point.__struct_fields__}
    return type(point)(**{**values, **changes})


def _rounded(original: Any) -> Any:
    def wrong(*args: Any) -> Entry:
        solution = original(*args)
        return replace(solution, cells=tuple(_point(p, value=p.value and round(p.value, 3)) for p in solution.cells))

    return wrong


def _first_only(original: Any) -> Any:
    return lambda *args: replace(solution := original(*args), cells=solution.cells[:1])


def _never(original: Any) -> Any:
    return lambda change: False


def _none(original: Any) -> Any:
    return lambda old, now: []


FAULTS: dict[str, Seam] = {
    "every verdict is kept as pass": (history, "entry", _entry(verdict="pass")),
    "no targets are kept": (history, "entry", _entry(target=None)),
    "frequencies have three decimals": (history, "entry", _rounded),
    "only the first cell is kept": (history, "entry", _first_only),
    "a run is compared with itself": (gate, "compare", lambda right: lambda before, after: right(after, after)),
    "a worse verdict is not listed": (gate, "_worse", _never),
    "missing answers are not listed": (gate, "_gone", _none),
    "a wider target is not listed": (gate, "_loosened", _never),
}
"""What a wrong program does, and the seam of the fault."""
