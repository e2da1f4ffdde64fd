"""The history as data: numbers and differences by run, and where they changed.

A cell's number and its difference from core also give core's number. If core changed, the change is attributed to core.
Changes are relative to the scale of the quantity, as differences are, see ``cases.judge.quantities``.
"""

from collections import defaultdict
from collections.abc import Sequence
from math import inf
from typing import Any

from ...cases.judge.quantities import QUANTITIES, difference, reference
from ...cases.judge.results import Key, described
from ...cases.regression.gate import MOVED
from ...cases.regression.history import Entry, History, Point
from ...cases.regression.properties import CHECKED
from ..shared.summary import WORST_FIRST
from .data import verdicts

CORE = "Southwell"


def of_history(history: History) -> dict[str, Any]:
    """All numbers of a history; a number that is the same in every run is stored once."""
    entries = history.entries
    return {
        "runs": [_run(e) for e in entries],
        "truncated": list(history.truncated),
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


def _by_key(entries: Sequence[Entry]) -> dict[Key, list[Point | None]]:
    """Every cell by run."""
    series: dict[Key, list[Point | None]] = defaultdict(lambda: [None] * len(entries))
    for k, entry in enumerate(entries):
        for point in entry.cells:
            series[point.key][k] = point
    return series


def _cells(entries: Sequence[Entry]) -> list[list[Any]]:
    """Case, code, speed (rad/s), mode, family; values, differences and verdicts, as one value or one per run; quantity and
    point in words, empty for a frequency; whether differences are absolute."""
    out = []
    for (case, code, omega, mode, quantity, where), points in _by_key(entries).items():
        values = [None if p is None else p.value for p in points]
        differences = [None if p is None else p.difference for p in points]
        verdicts = [None if p is None else WORST_FIRST.index(p.verdict) for p in points]
        family = [p.family for p in points if p is not None][-1]
        scale = QUANTITIES[quantity].scale
        row = [case, code, omega, mode, family, _short(values, scale), _short(differences, 1.0), _short(verdicts)]
        out.append([*row, described("", quantity, where), scale is not None])
    return out


def _short(values: Sequence[float | None], scale: float | None = None) -> Any:
    """One value if all runs agree within rounding, else the list; ``scale``: scale of rounding, if not the value."""
    first = values[0]
    if first is None:
        return None if all(v is None for v in values) else list(values)
    limit = MOVED * abs(first if scale is None else scale)
    return first if all(v is not None and abs(v - first) <= limit for v in values) else list(values)


def moves(entries: Sequence[Entry]) -> list[dict[str, Any]]:
    """Changes of numbers: one row per run, case, code (or core) and quantity."""
    changes: dict[tuple[int, str, str, str], dict[tuple[float, int, str], float | None]] = defaultdict(dict)
    for (case, code, omega, mode, quantity, where), points in _by_key(entries).items():
        own = [None if p is None else p.value for p in points]
        core = [
            None if p is None or p.value is None or p.difference is None else reference(quantity, p.value, p.difference)
            for p in points
        ]
        for source, values in ((code, own), (CORE, core)):
            for k in steps(values, quantity):
                before = next(v for v in reversed(values[:k]) if v is not None)
                at = omega, mode, described("", quantity, where)
                changes[k, source, case, quantity][at] = _change(quantity, before, values[k])
    families = {(p.case, p.omega, p.mode): p.family for entry in entries for p in entry.cells}
    out = []
    for (k, source, case, quantity), by_cell in changes.items():
        (omega, mode, quantity_of_cell), change = max(by_cell.items(), key=_size)
        numbers = f"{len(by_cell)} {QUANTITIES[quantity].plural if len(by_cell) > 1 else QUANTITIES[quantity].name}"
        step = {
            "run": k,
            "who": source,
            "case": case,
            "count": len(by_cell),
            "numbers": numbers,
            "what": quantity_of_cell,
        }
        out.append({**step, "change": change, "omega": omega, "mode": mode, "family": families[case, omega, mode]})
    return out


def _change(quantity: str, before: float | None, after: float | None) -> float | None:
    """The change relative to the scale of the quantity; None if there is no earlier value, or it is a frequency of zero."""
    if before is None or after is None or (not before and QUANTITIES[quantity].scale is None):
        return None
    return difference(quantity, after, before)


def _size(item: tuple[Any, float | None]) -> float:
    return inf if item[1] is None else abs(item[1])


def steps(values: Sequence[float | None], quantity: str = "frequency") -> list[int]:
    """Positions at which a number differs from its previous value by more than rounding; results have no noise."""
    out, last, scale = [], None, QUANTITIES[quantity].scale
    for k, value in enumerate(values):
        if value is None:
            continue
        if last is not None and abs(value - last) > MOVED * (abs(last) if scale is None else scale):
            out.append(k)
        last = value
    return out
