"""``southwell show``: the properties of a blade as numbers and a figure, and how its file was read."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter
from numpy.typing import NDArray
from rich import box
from rich.console import Group
from rich.markup import escape
from rich.table import Table

from ....cases.input import atomic
from ....cases.input.errors import NO_STATE, unsteady
from ....cases.input.properties import sections
from ....cases.input.writing import writable
from ....core.blade import Blade
from ....core.root_loads import RootLoads, root_loads
from ...campbell.properties import COLUMNS, MORE, PROPERTIES, ROWS, cell, facts, picked, rows
from ...shared import not_used
from ...shared.console import output
from ...shared.paths import file_name
from ...shared.sheets import terminal
from ...shared.units import Units
from ..errors import UsageError
from ..mounting import Mounting
from . import campbell_options, root_tables
from .subjects import subjects as find_subjects

Array = NDArray[np.float64]

ON_AXIS = 5e-4
"""Largest distance from the axis, m, that the digits of the table show as zero."""


def command(
    blade: str,
    /,
    *,
    out: Annotated[Path | None, Parameter(name=["--out", "-o"])] = None,
    all: bool = False,
    steady: bool = False,
    rpm: str | None = None,
    omega: str | None = None,
    mounting: Mounting | None = None,
) -> int:
    """Show the mass, sections and axes of a blade, and how its file was read.

    Every non-zero quantity of the file that is not used is listed.

    Parameters
    ----------
    blade
        Blade file (ElastoDyn, BeamDyn, BModes, HAWC2, windIO, Southwell's TOML or CSV), or a case (listed by
        `southwell cases`).
    out
        Output folder for a figure of the properties along the span (SVG, PNG) and CSV tables of all stations and loads.
    all
        Print all stations.
    steady
        Print the steady force and moment at the root at the speeds of --rpm or --omega, or of the case, in vacuo and without
        gravity.
    rpm
        Rotor speeds in rpm: one speed, a range `first:last:step` or a list `0,5,10`.
    omega
        Rotor speeds in rad/s, in the same form.
    """
    speeds, units = campbell_options.speeds(rpm, omega) or (None, None)
    if speeds is not None and not steady:
        raise UsageError("--steady: missing: show uses speeds for the loads at the root: add --steady")
    subjects = find_subjects(blade, (mounting or Mounting()).mount(), rotating=steady)
    if steady and speeds is None and any(not subject.speeds for subject in subjects):
        raise UsageError(f"--rpm: missing: {blade} does not define rotor speeds: give them, as in 0:15:5")
    console = output()
    for subject in subjects:
        console.print(summary(subject.blade, subject.about))
        not_used.show(subject.unused, console)
        display_units = units or subject.units
        loads = list(_loads(subject.blade, speeds or subject.speeds, display_units)) if steady else []
        for table in stations(subject.blade, None if all else ROWS):
            console.print(table)
        if loads:
            for sheet in root_tables.sheets(loads, display_units):
                console.print(terminal(sheet, console.width))
        if out is not None:
            folder = out / file_name(subject.blade.name.partition("/")[2]) if len(subjects) > 1 else out
            with writable(f"--out {out}"):
                paths = write(subject.blade, folder, loads)
            console.print(f"{folder}: {', '.join(path.name for path in paths)}", markup=False, soft_wrap=True)
    return 0


def _loads(blade: Blade, speeds: Sequence[float], units: Units) -> Iterator[RootLoads]:
    for omega in speeds:
        try:
            yield root_loads(blade, omega)
        except NO_STATE as error:
            raise unsteady(blade.name, omega, error, units.at) from error


def summary(blade: Blade, origin: Sequence[str] = ()) -> Group:
    """A table of facts, followed by how the blade was read."""
    table = Table(
        box=None, show_header=False, pad_edge=False, title=escape(blade.name), title_justify="left", title_style="bold"
    )
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    for name, text in (facts(blade) | {"from": "\n".join(origin)}).items():
        if text:
            table.add_row(name, escape(text))
    return Group(table)


def stations(blade: Blade, limit: int | None) -> list[Table]:
    """The tables of properties and of centres, with at most ``limit`` evenly spaced stations including both ends.

    Centres that are all on the axis are one line under the table of properties.
    """
    values = rows(blade, sections(blade))
    n = len(values)
    indices = picked(n, limit)
    properties = _table(values[indices], range(PROPERTIES))
    centres = _table(values[indices], (0, *range(PROPERTIES, len(COLUMNS))))
    on_axis = bool(np.all(np.abs(values[:, PROPERTIES:]) < ON_AXIS))
    tables = [properties] if on_axis else [properties, centres]
    captions = (
        on_axis and "All centres are on the axis, within 0.5 mm.",
        len(indices) < n and f"{len(indices)} of {n} stations; --all shows all",
    )
    tables[-1].caption = "\n".join(caption for caption in captions if caption) or None
    return tables


def _table(values: Array, columns: Sequence[int]) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for column in columns:
        table.add_column(COLUMNS[column].replace(" [", "\n").replace("]", ""), justify="right", no_wrap=True)
    for row in values:
        table.add_row(*(cell(column, row[column]) for column in columns))
    return table


def write(blade: Blade, folder: Path, loads: Sequence[RootLoads] = ()) -> list[Path]:
    """Write the figure (SVG, PNG), the table of all stations and that of the loads at the root (CSV); return the paths."""
    from ...campbell import span  # not at the top: the figures take half of the start-up time

    folder.mkdir(parents=True, exist_ok=True)
    table = folder / "stations.csv"
    sampled = sections(blade)
    angles = np.degrees([sampled.principal, sampled.mass_axes]).T
    values = np.column_stack([rows(blade, sampled), angles, blade.curve])
    table_rows = (",".join("" if np.isnan(x) else repr(float(x)) for x in row) for row in values)
    lines = [",".join(COLUMNS + MORE), *table_rows]
    atomic.write(table, "\n".join(lines) + "\n")
    if not loads:
        return [*span.write(blade, folder), table]
    at_root = folder / root_tables.CSV
    atomic.write(at_root, root_tables.table(loads))
    return [*span.write(blade, folder), table, at_root]
