"""The history as plain data: what every frequency, difference and timing was, run by run, and where they stepped."""

from collections import defaultdict
from typing import Any

from ...cases.history import Entry, History
from .steps import frequency_steps, timing_steps


def of_history(history: History) -> dict[str, Any]:
    """Frequencies that never moved are one number; those that did are a number a run."""
    entries = history.entries
    return {
        "runs": [{"commit": e.commit, "date": e.date, "machine": e.machine, "versions": e.versions} for e in entries],
        "torn": list(history.torn),
        "frequencies": _frequencies(entries),
        "timings": _timings(entries),
        "verdicts": [_verdicts(e) for e in entries],
        "controls": [sorted({c.control for c in e.controls if c.caught}) for e in entries],
    }


def _frequencies(entries: tuple[Entry, ...]) -> list[dict[str, Any]]:
    series: dict[tuple[str, str, float, int], list[Any]] = defaultdict(lambda: [None] * len(entries))
    for k, entry in enumerate(entries):
        for c in entry.cells:
            if c.frequency is not None:
                series[c.case, c.code, c.omega, c.mode][k] = c
    out = []
    for (case, code, omega, mode), points in series.items():
        values = [None if p is None else p.frequency for p in points]
        steps = frequency_steps(values)
        gone = [k for k, p in enumerate(points) if p is None]
        if not steps and not gone:
            continue
        out.append(
            {
                "case": case,
                "code": code,
                "omega": omega,
                "mode": mode,
                "values": values,
                "differences": [None if p is None else p.difference for p in points],
                "steps": steps,
            }
        )
    return out


def _timings(entries: tuple[Entry, ...]) -> list[dict[str, Any]]:
    """Seconds of each code on each case: of all its speeds."""
    series: dict[tuple[str, str], list[float | None]] = defaultdict(lambda: [None] * len(entries))
    for k, entry in enumerate(entries):
        spent: dict[tuple[str, str], dict[float, float]] = defaultdict(dict)
        for c in entry.cells:
            if c.seconds is not None:
                spent[c.case, c.code][c.omega] = c.seconds
        for key, by_speed in spent.items():
            series[key][k] = round(sum(by_speed.values()), 4)
    return [
        {"case": case, "code": code, "values": values, "steps": timing_steps(values)}
        for (case, code), values in series.items()
    ]


def _verdicts(entry: Entry) -> dict[str, int]:
    out: dict[str, int] = defaultdict(int)
    for c in entry.cells:
        out[c.verdict] += 1
    return dict(out)
