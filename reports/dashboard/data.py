"""What the pages of a run show, as plain data: one object for the matrix, one for each case, one for each code."""

import hashlib
import re
from dataclasses import asdict
from typing import Any

from ...cases.controls import Outcome, outcomes
from ...cases.results import Cell, Run
from ...references import codes as registry
from ...references.codes import UnknownCodeError
from .. import code_pages, summary
from ..summary import GRAVEST_FIRST, SYMBOL, broad, columns, labels, plus_minus, size
from ..units import BY_KEY, Units
from .moving import moving

LONGEST = 80
"""Of a page's name before its number: file systems end at 255 bytes."""


def page(name: str, kind: str = "case") -> str:
    """File name of a case's or code's page: what is plain in its name, and a number of its own where not all is.

    Two names never share one, not even where the file system tells no capitals from small letters.
    """
    plain = re.sub(r"[^a-z0-9.-]", "_", name.lower())[:LONGEST]
    number = "" if plain == name else "-" + hashlib.sha256(name.encode()).hexdigest()[:8]
    return f"{kind}-{plain}{number}.html"


def verdicts() -> list[dict[str, str]]:
    """Names and signs, gravest first; cells have their place in this list."""
    return [{"name": v, "sign": SYMBOL[v]} for v in GRAVEST_FIRST]


def first(run: Run, name: str) -> dict[str, Any]:
    """The matrix: every cell in short, cases, columns, what became of core made wrong on purpose."""
    known, heads, pages = summary.cases(run), columns(run.cells, broad), code_names(run)
    named = labels(run.cells)
    titles = {s.case: s.title for s in run.settings}
    return {
        "run": name,
        "command": run.command,
        "headline": headline(run),
        "right": summary.status(run) == 0,
        "verdicts": verdicts(),
        "cases": [{"name": c, "title": titles.get(c, ""), "page": page(c), "unit": units(run, c).speed} for c in known],
        "columns": [
            {"name": h, "shares": shared(run, h), "page": page(h, "code") if h in pages else None} for h in heads
        ],
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
        "controls": [_control(o) for o in outcomes(run.controls)],
    }


def headline(run: Run) -> str:
    """The verdict in one line."""
    counted = ", ".join(f"{n} {v}" for v, n in summary.counts(run.cells).items() if n)
    independent = [c for c in run.cells if c.role == "code" and c.verdict in ("pass", "fail", "inconclusive")]
    far = summary.largest(independent)
    where = f" Largest difference of an independent code: {plus_minus(far)} ({far.case}, {far.code})." if far else ""
    tried = outcomes(run.controls)
    caught = sum(o.status == "caught" for o in tried)
    wrong = f" {caught} of {len(tried)} deliberate mistakes in core are caught." if tried else ""
    return f"{'Not all is well' if summary.status(run) else 'All is well'}: {len(run.cells)} cells: {counted}.{where}{wrong}"


def _control(outcome: Outcome) -> dict[str, Any]:
    rows = outcome.cases.values()
    far = max(rows, key=lambda r: abs(r.change or 0.0), default=None)
    return {
        "name": outcome.mistake.name,
        "status": outcome.status,
        "change": far.change if far else None,
        "where": f"{far.case}, {far.mode}" if far else "",
        "caught": list(dict.fromkeys(name for r in rows for name in r.caught)),
        "cases": [r.case for r in rows if r.caught],
    }


def shared(run: Run, head: str) -> str:
    """What the codes of a column share with core."""
    return ", ".join(dict.fromkeys(c.shares for c in run.cells if broad(c) == head and c.shares))


def units(run: Run, case: str) -> Units:
    """Those that the case's speeds are given in."""
    setting = next((s for s in run.settings if s.case == case), None)
    return BY_KEY[setting.unit if setting else "rad_s"]


def of_case(run: Run, case: str) -> dict[str, Any]:
    """Everything of one case: its words, cells, refinements, and core's shapes at its lowest and highest speed."""
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
        "verdicts": verdicts(),
        "columns": columns(cells),
        "cells": [_cell(c, named.get(c, ""), u) for c in cells],
        "levels": [
            [v.code, v.omega * u.speeds, v.mode, v.elements, v.frequency * u.frequencies]
            for v in run.levels
            if v.case == case
        ],
        "shapes": moving(case, cells, u),
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
        "text": plus_minus(c) if size(c) is not None else "",
        "reason": c.reason,
        "elements": c.elements,
        "order": c.order,
        "seconds": c.seconds,
    }


def code_names(run: Run) -> list[str]:
    """Codes that have a page: all with answers of their own, or a reason for none."""
    return list(dict.fromkeys(c.code for c in run.cells if c.role in code_pages.ROLES))


def codes(run: Run) -> list[dict[str, Any]]:
    """All codes in a line each."""
    out = []
    for name in code_names(run):
        cells = code_pages.own(run, name)
        far = summary.largest(cells)
        out.append(
            {
                "name": name,
                "page": page(name, "code"),
                "title": _known(name).get("title", name),
                "version": run.versions.get(name, ""),
                "shares": shared(run, name),
                "counts": [[GRAVEST_FIRST.index(v), n] for v, n in summary.counts(cells).items() if n],
                "worst": f"{plus_minus(far)} ({far.case})" if far else "",
                "defects": len(code_pages.defects(name)),
            }
        )
    return out


def of_code(run: Run, name: str) -> dict[str, Any]:
    """One code: version, what it shares with core and leaves out, its worst difference on every blade, known defects."""
    cells, named = code_pages.own(run, name), labels(run.cells)
    worst = []
    for case in dict.fromkeys(c.case for c in cells):
        mine = [c for c in cells if c.case == case]
        far = summary.worst(mine)
        where = f"{named[far]}, {units(run, case).at(far.omega)}" if far else ""
        reason = far.reason if far else "; ".join(dict.fromkeys(c.reason for c in mine))
        verdict = GRAVEST_FIRST.index(summary.gravest(mine))
        worst.append([case, page(case), verdict, len(mine), plus_minus(far) if far else "", where, reason])
    return {
        "name": name,
        "version": run.versions.get(name, ""),
        "shares": shared(run, name),
        "verdicts": verdicts(),
        "worst": worst,
        "defects": [
            {"what": d.what, "avoided": d.avoided, "script": f"references/defects/{d.script}.py"}
            for d in code_pages.defects(name)
        ],
        "title": name,
        **_known(name),
    }


def _known(name: str) -> dict[str, str]:
    """What the adapter says of itself; nothing of a code that is not known here, as in another's results."""
    if name not in registry.names():
        return {}
    try:
        code = registry.code(name)
    except UnknownCodeError:
        return {}
    return {"title": code.title, "lacks": ", ".join(code.model.lacks()), "hint": code.hint}
