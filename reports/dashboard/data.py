"""What the dashboard's pages show, as plain data: one object for the first page, one for each case, one for the history."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from ...cases import library
from ...cases.controls import outcomes
from ...cases.errors import CaseError
from ...cases.results import Cell, Run
from ...core import sections, solve
from ...core.blade import Blade
from ...core.eigen import UnstableError
from ...core.modes import STATIONS
from .. import summary
from ..code_pages import own
from ..summary import GRAVEST_FIRST, SYMBOL, broad, columns, labels, plus_minus, size
from ..units import BY_KEY, Units

ELEMENTS, MODES = 40, 6
"""Of core's shapes for the moving picture."""


def first(run: Run, name: str) -> dict[str, Any]:
    """The matrix: every cell in short, cases, columns, what became of core made wrong on purpose."""
    known, heads = summary.cases(run), columns(run.cells, broad)
    named = labels(run.cells)
    titles = {s.case: s.title for s in run.settings}
    return {
        "run": name,
        "command": run.command,
        "headline": headline(run),
        "verdicts": [{"name": v, "sign": SYMBOL[v]} for v in GRAVEST_FIRST],
        "cases": [{"name": c, "title": titles.get(c, ""), "page": page(c), "unit": units(run, c).speed} for c in known],
        "columns": [{"name": h, "shares": shared(run, h)} for h in heads],
        "versions": run.versions,
        "cells": [
            [
                known.index(c.case),
                heads.index(broad(c)),
                round(c.omega * units(run, c.case).speeds, 6),
                named.get(c, ""),
                GRAVEST_FIRST.index(c.verdict),
                size(c),
                plus_minus(c) if size(c) is not None else "",
                c.reason,
            ]
            for c in run.cells
        ],
        "controls": [
            {"name": o.mistake.name, "status": o.status, "cases": {name: asdict(c) for name, c in o.cases.items()}}
            for o in outcomes(run.controls)
        ],
    }


def headline(run: Run) -> str:
    """The verdict in one line."""
    counted = ", ".join(f"{n} {v}" for v, n in summary.counts(run.cells).items() if n)
    independent = [c for c in run.cells if c.role == "code" and c.verdict in ("pass", "fail", "inconclusive")]
    far = summary.largest(independent)
    where = f" Largest difference of an independent code: {plus_minus(far)} ({far.case}, {far.code})." if far else ""
    return f"{'Not all is well' if summary.status(run) else 'All is well'}: {len(run.cells)} cells, {counted}.{where}"


def shared(run: Run, head: str) -> str:
    """What the codes of a column share with core."""
    return ", ".join(dict.fromkeys(c.shares for c in run.cells if broad(c) == head and c.shares))


def page(case: str) -> str:
    """File name of a case's page: letters, digits, dots and hyphens of its name, the rest by number."""
    return (
        "case-"
        + "".join(ch if ch.isascii() and (ch.isalnum() or ch in "-.") else f"_{ord(ch):x}_" for ch in case)
        + ".html"
    )


def units(run: Run, case: str) -> Units:
    """Those that the case's speeds are given in."""
    setting = next((s for s in run.settings if s.case == case), None)
    return BY_KEY[setting.unit if setting else "rad_s"]


def of_case(run: Run, case: str) -> dict[str, Any]:
    """Everything of one case: its words, cells, refinements, and core's shapes at its highest speed."""
    u = units(run, case)
    cells = [c for c in run.cells if c.case == case]
    named = labels(run.cells)
    setting = next((s for s in run.settings if s.case == case), None)
    return {
        "name": case,
        "setting": asdict(setting) if setting else None,
        "speed": u.speed,
        "frequency": u.frequency,
        "perSpeed": u.frequencies / u.speeds,
        "verdicts": [{"name": v, "sign": SYMBOL[v]} for v in GRAVEST_FIRST],
        "columns": columns(cells),
        "cells": [_cell(c, named.get(c, ""), u) for c in cells],
        "levels": [
            [v.code, v.omega * u.speeds, v.mode, v.elements, v.frequency * u.frequencies]
            for v in run.levels
            if v.case == case
        ],
        "shapes": shapes(case, max((c.omega for c in cells), default=0.0), u),
    }


def _cell(c: Cell, name: str, u: Units) -> dict[str, Any]:
    frequencies = {"f": c.frequency, "full": c.full, "ref": c.reference}
    scaled = {name: None if value is None else value * u.frequencies for name, value in frequencies.items()}
    return {
        **scaled,
        "code": summary.column(c),
        "speed": c.omega * u.speeds,
        "mode": c.mode,
        "name": name,
        "verdict": GRAVEST_FIRST.index(c.verdict),
        "size": size(c),
        "text": plus_minus(c) if size(c) is not None else "",
        "u": c.uncertainty,
        "target": c.target,
        "reason": c.reason,
        "elements": c.elements,
        "order": c.order,
        "seconds": c.seconds,
    }


def shapes(case: str, omega: float, u: Units) -> dict[str, Any] | None:
    """Core's modes for the moving picture: places at rest (21, 3), and displacements, real and imaginary (21, 3) each.

    None where the case is not one of the package's blades, or its files are not here.
    """
    blade = _blade(case)
    if blade is None:
        return None
    try:
        found = solve.modes(blade, omega, ELEMENTS, MODES)
    except UnstableError:
        return None
    rest = sections.frames(blade, STATIONS * blade.length)[:, :3, 3]
    largest = np.abs(found.shapes[:, :, :3]).max(axis=(1, 2))
    moved = found.shapes[:, :, :3] / np.where(largest > 0, largest, 1.0)[:, None, None] * 0.12 * blade.length
    return {
        "speed": omega * u.speeds,
        "omega": omega,
        "length": blade.length + blade.hub_radius,
        "rest": rest.round(6).tolist(),
        "modes": [
            {"f": f * u.frequencies, "re": m.real.round(6).tolist(), "im": m.imag.round(6).tolist()}
            for f, m in zip(found.frequencies.tolist(), moved, strict=True)
        ],
    }


def _blade(case: str) -> Blade | None:
    stem = case.partition("/")[0]
    if stem not in library.names():
        return None
    try:
        return next((v.blade for v in library.load(stem).variants if v.name == case), None)
    except CaseError:
        return None


def codes(run: Run) -> list[dict[str, Any]]:
    """Of every code: version, what it shares with core, its cells by verdict, and its worst difference on every blade."""
    names = list(dict.fromkeys(c.code for c in run.cells if c.role in ("code", "same discretisation")))
    return [_code(run, name) for name in names]


def _code(run: Run, name: str) -> dict[str, Any]:
    cells: Sequence[Cell] = own(run, name)
    worst = []
    for case in summary.cases(run):
        mine = [c for c in cells if c.case == case]
        far = summary.worst(mine) if mine else None
        if mine:
            verdict = summary.gravest(mine)
            text = plus_minus(far) if far else mine[0].reason
            worst.append([case, page(case), GRAVEST_FIRST.index(verdict), text])
    return {
        "name": name,
        "version": run.versions.get(name, ""),
        "shares": shared(run, name),
        "counts": {v: n for v, n in summary.counts(cells).items() if n},
        "worst": worst,
    }
