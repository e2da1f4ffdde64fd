"""The tables of one case in the report: differences by mode and column, reasons, verdicts and measured points."""

from collections import Counter
from collections.abc import Sequence
from itertools import groupby

from ...cases.judge.quantities import QUANTITIES
from ...cases.judge.results import Cell, Run
from ..shared import summary
from ..shared.markdown import plain, table
from ..shared.summary import SYMBOL, column, columns
from ..shared.units import Units


def measured(run: Run, case: str, unit: Units) -> str:
    """The table of a case's measured points and the model errors they show; empty without any."""
    cells = [c for c in run.cells if c.case == case and c.role == "measured"]
    rows = [
        {
            "data": plain(c.code),
            "mode": plain(c.name),
            "speed": unit.at(c.omega),
            f"measured, {unit.frequency}": f"{c.value * unit.frequencies:.5g}" if c.value else "",
            f"Southwell, {unit.frequency}": f"{c.reference * unit.frequencies:.5g}" if c.reference else "",
            "measured against Southwell": f"{SYMBOL[c.verdict]} {summary.plus_minus(c)}".strip(),
            "model error": plain(c.reason),
        }
        for c in sorted(cells, key=lambda c: (c.code, c.mode, c.omega))
    ]
    return table(rows) if rows else ""


def verdicts(cells: Sequence[Cell]) -> str:
    """The number of cells by verdict, with the largest difference of each verdict."""
    parts = []
    for verdict, n in summary.counts(cells).items():
        largest = summary.largest(c for c in cells if c.verdict == verdict)
        parts.append(f"{n} {SYMBOL[verdict]} {verdict}{f', up to {summary.plus_minus(largest)}' if largest else ''}")
    return "; ".join(parts)


def comparison(cells: Sequence[Cell], unit: Units) -> str:
    """The table modes × columns at one speed: core's frequency, and each column's difference ± uncertainty.

    Published tables and the source's discretisation also show their frequencies. Rows are core's modes with all effects: a code
    that lacks effects is compared with core without them, and its modes may come in another order or have other names, which
    are then shown.
    """
    at, rows = _rows(cells), []
    for key in dict.fromkeys(at[c] for c in sorted(cells, key=lambda c: (c.full is None, c.full or 0.0))):
        row_cells = sorted((c for c in cells if at[c] == key), key=lambda c: c.reference != c.full)
        mode, core = row_cells[0].name, row_cells[0].full
        own = f"{core * unit.frequencies:.7g}" if core else _plain_value(row_cells[0])
        row = {"mode": plain(mode), f"Southwell, {unit.frequency}": own}
        for name in columns(cells):
            cell = next((c for c in row_cells if column(c) == name), None)
            other_name = f"<br>{plain(cell.name)}" if cell and cell.name != mode else ""
            row[plain(name)] = f"{_entry(cell, unit)}{other_name}" if cell else ""
        rows.append(row)
    return table(rows)


def _plain_value(cell: Cell) -> str:
    """The reference of a quantity that is no frequency, with its unit."""
    if cell.quantity == "frequency" or cell.reference is None:
        return ""
    return f"{cell.reference:.7g} {QUANTITIES[cell.quantity].unit}".rstrip()


def _rows(cells: Sequence[Cell]) -> dict[Cell, tuple[float | str, int]]:
    """The row of each cell: core's frequency with all effects, and the place among the column's cells with that frequency."""
    rows: dict[Cell, tuple[float | str, int]] = {}
    counts: Counter[tuple[str, float | str]] = Counter()
    for c in sorted(cells, key=lambda c: c.mode):
        key = c.name if c.full is None else c.full
        rows[c] = (key, counts[column(c), key])
        counts[column(c), key] += 1
    return rows


def _entry(cell: Cell, unit: Units) -> str:
    frequency = ""
    if cell.role in ("discretisation", "table") and cell.value is not None:
        frequency = f"{cell.value * unit.frequencies:.6g}<br>"
    return f"{frequency}{SYMBOL[cell.verdict]} {summary.plus_minus(cell)}{summary.wide(cell)}".strip()


def why(cells: Sequence[Cell], unit: Units) -> list[dict[str, str]]:
    """One row per cell that needs a reason; neighbours that differ only in speed share one."""
    grave = [
        c for verdict in summary.WORST_FIRST for c in cells if c.verdict == verdict and (verdict != "pass" or c.reason)
    ]
    rows = []
    for (verdict, name, mode, reason), group in groupby(grave, lambda c: (c.verdict, column(c), c.name, c.reason)):
        at = [unit.at(c.omega) for c in group]
        where = at[0] if len(at) == 1 else f"{len(at)} speeds" if not mode else ", ".join(at)
        rows.append(
            {
                "verdict": f"{SYMBOL[verdict]} {verdict}",
                "code": plain(name),
                "mode": plain(mode),
                "speed": where,
                "reason": plain(reason),
            }
        )
    return rows
