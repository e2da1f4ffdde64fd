"""The data of a run's pages: one object for the matrix, one per case and one per code."""

import hashlib
import re
from dataclasses import asdict, replace
from functools import lru_cache
from typing import Any

from ...cases.judge.quantities import QUANTITIES
from ...cases.judge.results import Cell, Control, Run
from ...references.protocol import registry as registry
from ...references.protocol.description import Description, describe
from ..shared import summary
from ..shared.summary import SYMBOL, WORST_FIRST, columns, plus_minus, size, table_column
from ..shared.units import Units
from ..verification import code_pages, controls, evidence, paper_table, witnesses
from ..verification.figures import core_lines
from . import properties
from .moving import moving

MAX_NAME = 80
"""Largest number of characters before the hash in a page's name; file systems allow 255 bytes."""


def page(name: str, kind: str = "case") -> str:
    """File name of a case's or code's page; a changed name gets part of its hash.

    Names are unique, also on file systems that ignore case.
    """
    plain = re.sub(r"[^a-z0-9.-]", "_", name.lower())[:MAX_NAME]
    number = "" if plain == name else "-" + hashlib.sha256(name.encode()).hexdigest()[:8]
    return f"{kind}-{plain}{number}.html"


def verdicts() -> list[dict[str, str]]:
    """Names and signs of the verdicts, worst first; cells refer to positions in this list."""
    return [{"name": v, "sign": SYMBOL[v]} for v in WORST_FIRST]


def first(run: Run, name: str) -> dict[str, Any]:
    """The matrix: cells, cases, columns, and results of the seeded faults."""
    cases, heads, pages = summary.cases(run), columns(run.cells, table_column), code_names(run)
    titles = {s.case: s.title for s in run.settings}
    return {
        "run": name,
        "command": run.command,
        "headline": headline(run),
        "evidence": evidence.rows(run),
        "answer": WORST_FIRST.index(evidence.VERDICT_OF[evidence.word(run)]),
        "verdicts": verdicts(),
        "cases": [
            {"name": c, "title": titles.get(c, ""), "page": page(c), "unit": summary.units(run, c).speed} for c in cases
        ],
        "columns": [
            {"name": h, "shares": shared(run, h), "page": page(h, "code") if h in pages else None} for h in heads
        ],
        "versions": run.versions,
        "cells": [
            [
                cases.index(c.case),
                heads.index(table_column(c)),
                round(c.omega * summary.units(run, c.case).speeds, 6),
                c.name,
                WORST_FIRST.index(c.verdict),
                size(c),
                plus_minus(c) if size(c) is not None else "",
                c.reason,
                target(c),
            ]
            for c in run.cells
        ],
        "controls": [_control(c) for c in run.controls],
        "properties": properties.of_matrix(run),
    }


def headline(run: Run) -> list[str]:
    """The headline of the report."""
    lines = [
        summary.incomplete(run),
        *evidence.first(run),
        paper_table.line(run),
        witnesses.headline(run),
        *witnesses.missing(run),
        controls.headline(run),
    ]
    return [line for line in lines if line]


def _seen(control: Control) -> str:
    return "without effect" if control.without_effect else "detected"


def _control(control: Control) -> dict[str, Any]:
    return {
        "name": control.control,
        "status": "missed" if control.missed else "needs a code" if control.needs else _seen(control),
        "change": control.change,
        "where": control.what,
        "detected_by": list(control.detected_by),
        "cases": [control.case] if control.case else [],
    }


def shared(run: Run, head: str) -> str:
    """What the codes of a column share with core."""
    return ", ".join(dict.fromkeys(c.shares for c in run.cells if table_column(c) == head and c.shares))


def of_case(run: Run, case: str) -> dict[str, Any]:
    """The data of one case: setting, cells, refinements, and core's shapes at the lowest and highest speed."""
    u = summary.units(run, case)
    cells = [c for c in run.cells if c.case == case]
    setting = summary.setting(run, case)
    checks = tuple(c for c in run.property_checks if c.case == case)
    settings = (setting,) if setting else ()
    case_run = replace(run, cells=tuple(cells), controls=(), settings=settings, property_checks=checks)
    return {
        "name": case,
        "setting": asdict(setting) if setting else None,
        "answer": evidence.verdict(case_run),
        "answered": WORST_FIRST.index(evidence.VERDICT_OF[evidence.word(case_run)]),
        "verdict_counts": verdict_counts(run, case),
        "speed": u.speed,
        "frequency": u.frequency,
        "perSpeed": u.frequencies / u.speeds,
        "verdicts": verdicts(),
        "columns": columns(cells),
        "cells": [_cell(c, u) for c in cells],
        "properties": properties.of_case(run, case),
        "lines": _lines(cells, u),
        "levels": [
            [v.code, v.omega * u.speeds, v.mode, v.elements, v.frequency * u.frequencies]
            for v in run.levels
            if v.case == case
        ],
        "shapes": moving(case, [c for c in cells if c.role != "measured"] or cells, u),
    }


def _lines(cells: list[Cell], u: Units) -> list[dict[str, Any]]:
    """Core's frequencies with all effects against speed, as in the report's Campbell diagram."""
    curves = core_lines([c for c in cells if c.role not in ("same discretisation", "measured")] or cells)
    scaled = {name: [[o * u.speeds, line[o] * u.frequencies] for o in sorted(line)] for name, line in curves.items()}
    return [{"name": name, "points": points} for name, points in scaled.items()]


def verdict_counts(run: Run, case: str) -> list[dict[str, Any]]:
    """The cells of a case by verdict, worst first: their number, and the largest difference relative to its target."""
    out, cells = [], [c for c in run.cells if c.case == case]
    for verdict, n in summary.counts(cells).items():
        matches = [c for c in cells if c.verdict == verdict]
        worst = summary.largest(matches) if verdict == "known difference" else evidence.farthest(matches)
        text = plus_minus(worst) if worst and size(worst) is not None else ""
        parts = (summary.column(worst), worst.name, summary.units(run, case).at(worst.omega)) if worst else ()
        where = ", ".join(part for part in parts if part)
        target = f"; target {summary.allowed(worst.target)}" if worst and verdict != "known difference" else ""
        out.append({"verdict": WORST_FIRST.index(verdict), "count": n, "text": text, "where": f"{where}{target}"})
    return out


def _cell(c: Cell, u: Units) -> dict[str, Any]:
    factor = u.frequencies if c.quantity == "frequency" else 1.0
    values = {"f": c.value, "full": c.full, "ref": c.reference}
    scaled = {name: None if value is None else value * factor for name, value in values.items()}
    return {
        **scaled,
        "code": summary.column(c),
        "speed": c.omega * u.speeds,
        "mode": c.mode,
        "name": c.name,
        "quantity": c.quantity,
        "unit": u.frequency if c.quantity == "frequency" else QUANTITIES[c.quantity].unit,
        "verdict": WORST_FIRST.index(c.verdict),
        "text": plus_minus(c) if size(c) is not None else "",
        "reason": c.reason,
        "target": target(c),
        "bar": (c.uncertainty or 0.0) * (c.reference or 0.0) * u.frequencies if c.verdict == "measured" else None,
        "elements": c.elements,
        "order": c.order,
    }


def target(c: Cell) -> str:
    """The target of a cell as text; measured data have none."""
    return "none" if c.role == "measured" else summary.allowed(c.target)


def code_names(run: Run) -> list[str]:
    """Codes that have a page: all with an answer, or with a reason for none."""
    return list(dict.fromkeys(c.code for c in run.cells if c.role in code_pages.ROLES))


def codes(run: Run) -> list[dict[str, Any]]:
    """One row per code: cells by verdict, the worst difference relative to its target, the largest known difference."""
    out = []
    for name in code_names(run):
        cells = code_pages.own(run, name)
        worst, explained = (
            evidence.farthest(cells),
            summary.largest(c for c in cells if c.verdict == "known difference"),
        )
        out.append(
            {
                "name": name,
                "page": page(name, "code"),
                "title": _known(name).get("title", ""),
                "version": run.versions.get(name, ""),
                "shares": shared(run, name),
                "counts": [[WORST_FIRST.index(v), n] for v, n in summary.counts(cells).items()],
                "worst": _placed(worst),
                "known": _placed(explained),
            }
        )
    return out


def _placed(cell: Cell | None) -> list[Any] | None:
    """Verdict, size and case of a cell; None without a cell."""
    return [WORST_FIRST.index(cell.verdict), plus_minus(cell), cell.case] if cell else None


def of_code(run: Run, name: str) -> dict[str, Any]:
    """One code: version, what it shares with core and lacks, its worst difference on every blade."""
    cells = code_pages.own(run, name)
    worst = []
    for case in dict.fromkeys(c.case for c in cells):
        of_case_ = [c for c in cells if c.case == case]
        worst_cell = summary.worst(of_case_)
        where = f"{worst_cell.name}, {summary.units(run, case).at(worst_cell.omega)}" if worst_cell else ""
        reason = worst_cell.reason if worst_cell else "; ".join(dict.fromkeys(c.reason for c in of_case_))
        verdict = WORST_FIRST.index(summary.worst_verdict(of_case_))
        worst.append(
            [case, page(case), verdict, len(of_case_), plus_minus(worst_cell) if worst_cell else "", where, reason]
        )
    return {
        "name": name,
        "version": run.versions.get(name, ""),
        "shares": shared(run, name),
        "verdicts": verdicts(),
        "worst": worst,
        "title": name,
        **_known(name),
    }


def _known(name: str) -> dict[str, str]:
    """The description of a code by its adapter; empty if the code is not registered here."""
    code = _described().get(name)
    return {"title": code.title, "lacks": ", ".join(code.effects.lacks()), "hint": code.hint} if code else {}


@lru_cache
def _described() -> dict[str, Description]:
    return {code.asked: code for code in describe(registry.names()) if not code.failure}
