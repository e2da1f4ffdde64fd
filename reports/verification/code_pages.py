"""One page per code: version, what it shares with core, its worst difference on every blade.

Numbers are taken from a run. The adapter reports what it refuses.
"""

from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from ...cases.conformance.blades import PROPERTIES
from ...cases.input import atomic
from ...cases.judge.results import Cell, Run
from ...references.protocol import registry as registry
from ...references.protocol.description import Description, describe
from ..shared import summary
from ..shared.markdown import plain, table
from ..shared.summary import SYMBOL

FOLDER = "codes"
"""Sub-folder of the pages."""

ROLES = ("code", "same discretisation")
"""Roles of cells that hold a code's answer."""


def write(run: Run, folder: Path) -> Path:
    """Write ``codes/NAME.md`` for every registered code, and ``codes/index.md``; return the index's path.

    Raises:
        OSError: if a folder or file cannot be written.
    """
    pages = folder / FOLDER
    pages.mkdir(parents=True, exist_ok=True)
    codes = described()
    for code in codes:
        atomic.write(pages / f"{code.name}.md", page(run, code))
    path = pages / "index.md"
    atomic.write(path, index(run, codes))
    return path


def described(names: Sequence[str] | None = None) -> tuple[Description, ...]:
    """The descriptions of codes, by default all, with their answers to a rod with each property."""
    return describe(registry.names() if names is None else names, [p.blade for p in PROPERTIES])


def index(run: Run, codes: Sequence[Description]) -> str:
    """The table of all codes: version, sharing with core, cells by verdict, worst difference."""
    rows = []
    for code in codes:
        cells = own(run, code.name)
        worst = summary.worst(cells)
        rows.append(
            {
                "code": f"[{plain(code.title)}]({code.name}.md)",
                "version": plain(version(run, code)),
                "shares with Southwell": code.shares,
                "cells": plain(summary.tally(cells)),
                "worst difference": f"{SYMBOL[worst.verdict]} {summary.plus_minus(worst)} ({plain(worst.case)})"
                if worst
                else "",
            }
        )
    signs = ", ".join(f"{sign} {verdict}" for verdict, sign in SYMBOL.items())
    return f"# Codes\n\n{table(rows)}\n\nSigns: {signs}. Written by `southwell codes --pages` after `{run.command}`.\n"


def page(run: Run, code: Description) -> str:
    """The page of one code."""
    environment = Environment(
        loader=PackageLoader(__package__ or "", "templates"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["plain"] = plain
    levels = ", ".join(map(str, code.levels))
    return environment.get_template("code.md.jinja").render(
        name=code.name,
        title=code.title,
        version=version(run, code),
        shares=code.shares,
        lacks=", ".join(code.effects.lacks()) or "nothing",
        levels=f"from {levels} elements or terms on, of order {code.order or 'spectral'}" if levels else "",
        how=code.page.replace("``", "`"),
        legend=", ".join(f"{sign} {verdict}" for verdict, sign in SYMBOL.items()),
        differences=differences(run, own(run, code.name)),
        properties=properties(code) if code.refused else "",
    )


def own(run: Run, name: str) -> list[Cell]:
    """The cells of one code."""
    return [c for c in run.cells if c.code == name and c.role in ROLES]


def version(run: Run, code: Description) -> str:
    """The version used in the run; otherwise the installed one, or how to install the code."""
    ran = run.versions.get(code.name)
    if ran and ran != "not installed":
        return ran
    if code.failure:
        return f"cannot be loaded: {code.failure.reason}"
    return code.version or f"not installed: {code.hint}"


def differences(run: Run, cells: Sequence[Cell]) -> str:
    """One row per blade: cells by verdict, the largest difference, where it is and why; empty without cells."""
    rows = []
    for case in dict.fromkeys(c.case for c in cells):
        case_cells = [c for c in cells if c.case == case]
        worst = summary.worst(case_cells)
        where = f"{worst.name}, {summary.units(run, case).at(worst.omega)}" if worst else ""
        reason = worst.reason if worst else "; ".join(dict.fromkeys(c.reason for c in case_cells))
        rows.append(
            {
                "blade": plain(case),
                "cells": plain(summary.tally(case_cells)),
                "worst difference": f"{SYMBOL[worst.verdict]} {summary.plus_minus(worst)}" if worst else "",
                "where": plain(where),
                "why": plain(reason),
            }
        )
    return table(rows) if rows else ""


def properties(code: Description) -> str:
    """How the adapter treats a rod with each property."""
    rows = []
    for p, why in zip(PROPERTIES, code.refused, strict=True):
        answer = f"refused: {plain(why)}" if why else "taken"
        if not why and p.name in code.effects.lacks():
            answer = "left out, as declared"
        rows.append({"property": plain(p.name), "answer": answer})
    return table(rows)
