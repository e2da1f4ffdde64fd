"""The result of a gate as text and tables: for the terminal, as Markdown, and as GitHub annotations.

Speeds and frequencies are in the units of the case, with enough digits to show a change of 1e-9.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path

from rich.console import RenderableType

from ...cases.input.errors import CaseError
from ...cases.input.toml import document
from ...cases.judge.quantities import QUANTITIES
from ...cases.judge.results import described
from ...cases.regression.gate import MISS, RANK, CellChange, Comparison, MissingAnswer
from ...cases.regression.history import Detection, Entry, Point
from ...cases.regression.properties import PropertyChange
from ..shared import table_columns
from ..shared.markdown import plain, table
from ..shared.units import RAD_S, Units

ROWS = 50
"""Largest number of rows of a table in Markdown; a job's summary has a size limit."""

SHOWN = 10
"""Largest number of rows of a table in the terminal."""

Row = dict[str, str]
ByCase = Mapping[str, Units]
"""Units by case; rad/s for cases that are not in it."""


def verdict(gate: Comparison, strict: bool) -> str:
    """One line: passed or failed, and why."""
    counts = {
        "worse": len(gate.worse),
        "with a wider target": len(gate.loosened),
        "gone": len(gate.gone),
        "seeded faults no longer detected": len(gate.undetected),
        "seeded faults missed": len(gate.missed),
        "properties wrong or no longer checked": len(gate.properties),
        "moved": len(gate.moved),
        "better": len(gate.better),
        "new": len(gate.new),
    }
    summary = ", ".join(f"{n} {name}" for name, n in counts.items() if n) or "nothing moved"
    summary += f"; {gate.measured} measured, not judged" if gate.measured else ""
    sign = "✔ gate passed" if gate.passed(strict) else "✘ gate failed"
    return f"{sign}: {len(gate.after.cells)} cells against {_named(gate.before)}: {summary}"


def _named(entry: Entry) -> str:
    return f"{entry.commit} ({entry.date})" if entry.date else entry.commit


def sections(gate: Comparison, units: ByCase) -> list[tuple[str, list[Row]]]:
    """Title and rows of each non-empty table; those that can fail the gate come first."""
    all_sections = [
        ("Worse", [_change(c, units) for c in gate.worse]),
        ("Wider target than before", [_loosened(c, units) for c in gate.loosened]),
        ("Gone", _gone(gate.gone, units)),
        ("Seeded faults that are no longer detected, or not tried", [_undetected(c, units) for c in gate.undetected]),
        ("Required seeded faults that are not detected", [{"fault": name} for name in gate.missed]),
        ("Properties that are wrong or no longer checked", [_property(c) for c in gate.properties]),
        ("Moved", [_change(c, units) for c in gate.moved]),
        ("Better", [_change(c, units) for c in gate.better]),
        ("Versions", [{"what": n, "from": a, "to": b} for n, (a, b) in gate.versions.items()]),
    ]
    return [(title, rows) for title, rows in all_sections if rows]


def _place(point: Point, units: ByCase) -> Row:
    family = f" ({point.family})" if point.family else ""
    mode = described(f"{point.mode}{family}", point.quantity, point.where) if point.mode else "none"
    return {"case": point.case, "code": point.code, "speed": _units(point.case, units).at(point.omega), "mode": mode}


def _units(case: str, units: ByCase) -> Units:
    return units.get(case, RAD_S)


def _loosened(change: CellChange, units: ByCase) -> Row:
    earlier = change.before.target if change.before else None
    targets = [f"{100 * t:.3g} %" if t else "" for t in (earlier, change.after.target)]
    return _place(change.after, units) | {
        "target before": targets[0],
        "target now": targets[1],
        "verdict": change.after.verdict,
    }


def _change(change: CellChange, units: ByCase) -> Row:
    before, after = change.before, change.after
    earlier = before.verdict if before else "not there"
    of_case = _units(after.case, units)
    return _place(after, units) | {
        "from": _digits(before, of_case),
        "to": _digits(after, of_case),
        "change": "" if change.moved is None else f"{change.moved:+.1e}",
        "verdict": after.verdict if earlier == after.verdict else f"{earlier} → {after.verdict}",
    }


def _digits(point: Point | None, units: Units) -> str:
    """The value of a point with its unit: a frequency in that of the case."""
    if point is None or point.value is None:
        return "none"
    if point.quantity == "frequency":
        return f"{point.value * units.frequencies:.12g} {units.frequency}"
    return f"{point.value:.12g} {QUANTITIES[point.quantity].unit}".rstrip()


def _gone(gone: Iterable[MissingAnswer], units: ByCase) -> list[Row]:
    """One row per case and code, with the missing speeds and modes."""
    rows = []
    for (case, code), group in groupby(sorted(gone, key=_column), key=_column):
        members = list(group)
        replacements = sorted({g.replacement or "nothing" for g in members})
        rows.append(
            {
                "case": case,
                "code": code,
                "answers": str(len(members)),
                "speeds": ", ".join(_units(case, units).at(w) for w in sorted({g.point.omega for g in members})),
                "modes": ", ".join(str(k) for k in sorted({g.point.mode for g in members})),
                "now": ", ".join(replacements),
            }
        )
    return rows


def _column(gone: MissingAnswer) -> tuple[str, str]:
    return gone.point.case, gone.point.code


def _undetected(control: Detection, units: ByCase) -> Row:
    return {
        "fault": control.control,
        "case": control.case,
        "speed": _units(control.case, units).at(control.omega),
        "was detected by": ", ".join(control.detected_by),
    }


def _property(change: PropertyChange) -> Row:
    check, (earlier, current) = change.check, (p.verdict if p else "not there" for p in (change.before, change.after))
    size = check.difference if change.after else None
    return {
        "case": check.case,
        "check": f"{check.quantity}, {check.code}",
        "property": check.part or "all",
        "difference": "" if size is None else f"{size:+.2g}",
        "verdict": current if earlier == current else f"{earlier} → {current}",
    }


def tables(gate: Comparison, units: ByCase, width: int) -> Iterator[RenderableType]:
    """All tables for a console of ``width`` characters, each cut after ``SHOWN`` rows with the number of further ones."""
    for title, rows_of_section in sections(gate, units):
        heads, rows = list(rows_of_section[0]), [list(row.values()) for row in rows_of_section[:SHOWN]]
        if len(rows_of_section) > SHOWN:
            title += f": the first {SHOWN} of {len(rows_of_section)}"
        yield from table_columns.tables(heads, rows, width, title)


def markdown(gate: Comparison, strict: bool, units: ByCase) -> str:
    """Verdict and tables as Markdown for a job's summary; tables longer than ``ROWS`` are cut, with a note."""
    blocks = [f"**{plain(verdict(gate, strict))}**"]
    for title, rows in sections(gate, units):
        cells = [{head: plain(value) for head, value in row.items()} for row in rows[:ROWS]]
        cut = f"\n\n… and {len(rows) - ROWS} more: see the log." if len(rows) > ROWS else ""
        blocks.append(f"#### {title}\n\n{table(cells)}{cut}")
    return "\n\n".join(blocks) + "\n"


def annotations(gate: Comparison, folder: Path, units: ByCase) -> list[str]:
    """GitHub workflow commands for the files of cases.

    An error for each case and code that got worse, a warning for each that still fails; one each, because GitHub shows
    only ten per step. Case files are searched in ``folder``.
    """
    files = case_files(folder)
    worse = {c.after.key for c in gate.worse}
    standing = [p for p in gate.after.cells if RANK.get(p.verdict, 0) >= MISS and p.key not in worse]
    rows = [
        ("error", p.case, text) for p, text in _by_column([(c.after, _became(c, units)) for c in gate.worse], units)
    ]
    rows += [
        ("error", r["case"], f"{r['code']}: {r['answers']} answers missing, now {r['now']}")
        for r in _gone(gate.gone, units)
    ]
    for control, case in dict.fromkeys((c.control, c.case) for c in gate.undetected):
        rows.append(("error", case, f"{control}: a seeded fault that is no longer detected, or not tried"))
    for case, check in dict.fromkeys((c.check.case, f"{c.check.quantity} by {c.check.code}") for c in gate.properties):
        parts = [
            f"{p.check.part or 'all properties'} ({_property(p)['verdict']})"
            for p in gate.properties
            if (p.check.case, f"{p.check.quantity} by {p.check.code}") == (case, check)
        ]
        rows.append(("error", case, f"{check}: {', '.join(parts)}"))
    rows += [("warning", p.case, text) for p, text in _by_column([(p, f"still {p.verdict}") for p in standing], units)]
    return [_command(level, files.get(case.partition("/")[0]), case, text) for level, case, text in rows]


def _became(change: CellChange, units: ByCase) -> str:
    earlier = change.before.verdict if change.before else "not there"
    return f"{earlier} → {change.after.verdict}, {_digits(change.after, _units(change.after.case, units))}"


def _by_column(points: Sequence[tuple[Point, str]], units: ByCase) -> list[tuple[Point, str]]:
    """The first point of each case and code, and the number of further ones."""
    groups: dict[tuple[str, str], list[tuple[Point, str]]] = {}
    for point, text in points:
        groups.setdefault((point.case, point.code), []).append((point, text))
    out = []
    for (point, text), *others in groups.values():
        remainder = f"; and {len(others)} more" if others else ""
        out.append(
            (point, f"{point.code}: mode {point.mode}, {_units(point.case, units).at(point.omega)}: {text}{remainder}")
        )
    return out


def _command(level: str, file: Path | None, case: str, text: str) -> str:
    """A workflow command, with properties and message escaped as in GitHub's toolkit (actions/toolkit, command.ts)."""
    properties = {"file": file.as_posix()} if file else {}
    properties |= {"title": case}
    joined = ",".join(f"{k}={_escaped(v).replace(':', '%3A').replace(',', '%2C')}" for k, v in properties.items())
    return f"::{level} {joined}::{_escaped(text)}"


def _escaped(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def case_files(folder: Path) -> dict[str, Path]:
    """Case files in a folder by the name that they define; hidden folders and invalid TOML files are skipped."""
    files: dict[str, Path] = {}
    for path in sorted(folder.rglob("*.toml"), key=lambda p: (len(p.parts), p)):
        inside = path.relative_to(folder)
        if any(part.startswith(".") for part in inside.parts):
            continue
        try:
            name = document(path).get("name")
        except CaseError:
            continue
        if isinstance(name, str):
            files.setdefault(name, inside)
    return files
