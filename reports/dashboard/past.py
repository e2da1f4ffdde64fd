"""The history as data: frequencies and differences by run, and where they changed.

A difference is ``code/core − 1``, so each cell also gives core's frequency. If core changed, the change is attributed
to core.
"""

from collections import defaultdict
from collections.abc import Sequence
from math import inf
from typing import Any

from ...cases.regression.gate import MOVED
from ...cases.regression.history import Entry, History, Key
from ...cases.regression.properties import CHECKED
from ..shared.summary import WORST_FIRST
from .data import verdicts

CORE = "core"


def of_history(history: History) -> dict[str, Any]:
    """All numbers of a history; a number that is the same in every run is stored once."""
    entries = history.entries
    return {
        "runs": [_run(e) for e in entries],
        "torn": list(history.torn),
        "verdicts": verdicts(),
        "steps": moves(entries),
        "cells": _cells(entries),
    }


def _run(e: Entry) -> dict[str, Any]:
    return {
        "commit": e.commit,
        "date": e.date,
        "machine": e.machine,
        "versions": e.versions,
        "counts": [[k, n] for k, v in enumerate(WORST_FIRST) if (n := sum(p.verdict == v for p in e.cells))],
        "detected": len({c.control for c in e.controls if c.detected_by}),
        "controls": len({c.control for c in e.controls}),
        "wrong": sum(p.verdict == "fail" for p in e.properties),
        "properties": sum(p.verdict in CHECKED for p in e.properties),
    }


def _by_key(entries: Sequence[Entry]) -> dict[Key, list[Any]]:
    """The frequencies of every cell by run; other quantities are left to the gate."""
    series: dict[Key, list[Any]] = defaultdict(lambda: [None] * len(entries))
    for k, entry in enumerate(entries):
        for point in entry.cells:
            if point.quantity == "frequency":
                series[point.key][k] = point
    return series


def _cells(entries: Sequence[Entry]) -> list[list[Any]]:
    """Case, code, speed (rad/s), mode, family; frequencies, differences, verdicts, as one value or one per run."""
    out = []
    for (case, code, omega, mode, *_), points in _by_key(entries).items():
        there = [p for p in points if p is not None]
        values = [None if p is None else p.value for p in points]
        differences = [None if p is None else p.difference for p in points]
        judged = [None if p is None else WORST_FIRST.index(p.verdict) for p in points]
        family = there[-1].family
        out.append([case, code, omega, mode, family, _short(values), _short(differences, 1.0), _short(judged)])
    return out


def _short(values: Sequence[float | None], scale: float | None = None) -> Any:
    """One value if all runs agree within rounding, else the list; ``scale``: scale of rounding, if not the value."""
    one = values[0]
    if one is None:
        return None if all(v is None for v in values) else list(values)
    near = MOVED * abs(one if scale is None else scale)
    return one if all(v is not None and abs(v - one) <= near for v in values) else list(values)


def moves(entries: Sequence[Entry]) -> list[dict[str, Any]]:
    """Changes of frequencies: one row per run, case and code (or core)."""
    found: dict[tuple[int, str, str], dict[tuple[float, int], float | None]] = defaultdict(dict)
    for (case, code, omega, mode, *_), points in _by_key(entries).items():
        own = [None if p is None else p.value for p in points]
        core = [
            None if p is None or p.value is None or p.difference is None else p.value / (1.0 + p.difference)
            for p in points
        ]
        for who, values in ((code, own), (CORE, core)):
            for k in frequency_steps(values):
                before = next(v for v in reversed(values[:k]) if v is not None)
                found[k, who, case][omega, mode] = _change(before, values[k])
    families = {(p.case, p.omega, p.mode): p.family for entry in entries for p in entry.cells}
    out = []
    for (k, who, case), where in found.items():
        (omega, mode), change = max(where.items(), key=_size)
        step = {"run": k, "who": who, "case": case, "count": len(where)}
        out.append({**step, "change": change, "omega": omega, "mode": mode, "family": families[case, omega, mode]})
    return out


def _change(before: float | None, after: float | None) -> float | None:
    """The relative change; None if there is no earlier value."""
    return after / before - 1.0 if before and after is not None else None


def _size(item: tuple[Any, float | None]) -> float:
    return inf if item[1] is None else abs(item[1])


def frequency_steps(values: Sequence[float | None]) -> list[int]:
    """Positions at which a frequency differs from its previous value; frequencies have no noise."""
    out, last = [], None
    for k, value in enumerate(values):
        if value is None:
            continue
        if last is not None and abs(value - last) > MOVED * abs(last):
            out.append(k)
        last = value
    return out
