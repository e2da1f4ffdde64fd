"""Tables of modes over operating points, from CSV; what a table alone shows of its modes."""

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..input import files
from ..input.errors import CaseError
from ..input.readers.text import number
from .findings import DEFECT, LIMIT, Finding, count, listed
from .orders import order_lines

Array = NDArray[np.float64]

SPEEDS = {"rpm": 1 / 60, "omega_rad_s": 1 / (2 * np.pi), "rotor_speed_hz": 1.0}
"""Columns of the rotor speed, and their factors to Hz."""

MAX_ROWS = 100_000
"""Maximum number of rows of a table."""


@dataclass(frozen=True)
class ModeTable:
    """Frequencies and damping ratios of modes at operating points.

    Attributes:
        name: name of the file.
        points: operating points.
        unit: unit of ``points``; ``Hz`` is a rotor speed.
        names: of the modes.
        frequencies: Hz (mode, operating point); NaN where the table has none.
        damping: damping ratios; NaN where the table has none.
        shares: share of the motion that names each mode, between 0 and 1; empty if the table has no shapes.
    """

    name: str
    points: Array
    unit: str
    names: tuple[str, ...]
    frequencies: Array
    damping: Array
    shares: tuple[float, ...] = ()


def read_csv(path: Path) -> ModeTable:
    """Read a table of modes with one row for each mode and rotor speed.

    Raises:
        CaseError: one line with the file and the line, the value, the likely cause and the remedy.
    """
    (_, head), *rows = files.table(path, "correct the path")
    columns = {name.strip().lower(): k for k, name in enumerate(head)}
    speed = next((name for name in SPEEDS if name in columns), None)
    complex_ = {"real_rad_s", "imag_rad_s"} <= set(columns)
    if speed is None or not (complex_ or "frequency_hz" in columns) or "mode" not in columns:
        raise CaseError(
            f"{path}: header: {','.join(head)[:80]}: a table of modes has the columns rpm (or omega_rad_s), mode, and "
            "frequency_hz with damping_ratio, or real_rad_s with imag_rad_s: name them so"
        )
    if len(rows) > MAX_ROWS:
        raise CaseError(f"{path}: more than {MAX_ROWS} rows: check that it is the right file")
    values: dict[str, dict[float, tuple[float, float]]] = defaultdict(dict)
    for k, row in rows:
        if len(row) != len(head):
            raise CaseError(f"{path}: line {k}: {len(row)} fields instead of {len(head)}: correct the line")

        def at(name: str, row: list[str] = row, k: int = k) -> float:
            value = number(row[columns[name]])
            if value is None or not math.isfinite(value) or abs(value) > 1e100:
                raise CaseError(
                    f"{path}: line {k}: {name}: {row[columns[name]][:20]!r} is not a finite number: correct it"
                )
            return value

        if complex_:
            root = complex(at("real_rad_s"), at("imag_rad_s"))
            f, zeta = abs(root) / (2 * np.pi), -root.real / abs(root) if root else math.nan
        else:
            f, zeta = at("frequency_hz"), at("damping_ratio") if "damping_ratio" in columns else math.nan
        point, name = at(speed) * SPEEDS[speed], row[columns["mode"]]
        if point in values[name]:
            raise CaseError(f"{path}: line {k}: mode {name[:40]!r} is given twice at this speed: give it once")
        values[name][point] = f, zeta
    if not values:
        raise CaseError(f"{path}: a header without rows: give the modes")
    points = sorted({point for mode in values.values() for point in mode})
    grid = np.array([[mode.get(point, (math.nan, math.nan)) for point in points] for mode in values.values()])
    return ModeTable(path.name, np.array(points), "Hz", tuple(values), grid[:, :, 0], grid[:, :, 1])


def findings(table: ModeTable) -> Iterator[Finding]:
    """Multiples of the rotor speed, negative frequencies and growing modes in a table."""
    negative = [name for name, f in zip(table.names, table.frequencies, strict=True) if (f < 0).any()]
    if negative:
        yield Finding(
            "negative frequency",
            DEFECT,
            f"{count(len(negative), 'mode')} with negative frequencies ({listed(negative)})",
            "give the eigenvalue with a positive imaginary part of each pair",
            float(len(negative)),
        )
    if table.unit == "Hz":
        yield from order_lines(table.names, table.points, table.frequencies)
    grow = [name for name, d in zip(table.names, table.damping, strict=True) if (d < 0).any()]
    if grow:
        yield Finding(
            "negative damping",
            LIMIT,
            f"{count(len(grow), 'mode')} with negative damping ({listed(grow)}; least {100 * np.nanmin(table.damping):.2g} %)",
            "an instability of the turbine, or of the linearisation: give its .lin files to find the cause",
            float(np.nanmin(table.damping)),
        )
    yield Finding(
        "modes only",
        LIMIT,
        "a table of modes does not show the equations it comes from",
        "give the linearisations themselves to have them judged",
        float(len(table.names)),
    )
