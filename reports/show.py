"""``southwell show``: what a blade is, in numbers and a figure, and how its file was read."""

from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter
from numpy.typing import NDArray
from rich import box
from rich.console import Group
from rich.table import Table

from ..cases.errors import CaseError
from ..cases.properties import Centres, Totals, centres, totals
from ..cases.readers.source import Source
from ..core.blade import Blade, straight
from . import terminal
from .blade_argument import Mounting, choose

Array = NDArray[np.float64]

ROWS = 13
"""Stations in the table, unless all are wanted."""

COLUMNS = (
    *("s [m]", "mass [kg/m]", "EI flap [N m²]", "EI edge [N m²]", "GJ [N m²]", "EA [N]", "twist [deg]"),
    *("mass y [m]", "mass z [m]", "tension y [m]", "tension z [m]", "shear y [m]", "shear z [m]"),
)
CONVENTIONS = (
    "x along the blade, z the rotor's axis, y the direction of motion (to the leading edge); sections turn with twist and "
    "pitch from y towards z (leading edge downwind)"
)


def command(
    blade: str,
    /,
    *,
    out: Annotated[Path | None, Parameter(name=["--out", "-o"])] = None,
    all: Annotated[bool, Parameter(negative=())] = False,
    mounting: Mounting | None = None,
) -> int:
    """A blade's mass, centre, moments, sections and axes, and how its file was read.

    Parameters
    ----------
    blade
        A blade file (ElastoDyn, BeamDyn, HAWC2, BModes, windIO, TOML, CSV), or a case (`southwell cases`).
    out
        Folder for a figure of the properties along the span (SVG, PNG) and a CSV of all stations.
    all
        Every station in the table.
    """
    chosen = choose(blade, mounting)
    for variant in chosen.variants:
        console = terminal.output()
        console.print(summary(variant.blade, chosen.source))
        console.print(stations(variant.blade, None if all else ROWS))
        if out is not None:
            folder = out / variant.name.partition("/")[2] if len(chosen.variants) > 1 else out
            try:
                written = write(variant.blade, folder)
            except OSError as error:
                raise CaseError(f"--out {out}: cannot be written ({error.strerror}): give another folder") from error
            console.print(f"{folder}: {', '.join(path.name for path in written)}", markup=False, soft_wrap=True)
    return 0


def facts(blade: Blade, found: Totals) -> dict[str, str]:
    """What is said of a blade, by name."""
    x, y, z = np.where(np.abs(found.centre) < 1e-9 * blade.length, 0.0, found.centre)
    springs = zip(("x", "y", "z", "torsion", "flap", "lag"), blade.root, strict=True)
    loose = [f"{name} {f'spring {k:.6g}' if k else 'free'}" for name, k in springs if np.isfinite(k)]
    curve = (
        "straight"
        if straight(blade)
        else (f"prebend {_farthest(blade.curve[:, 2]):.5g} m, sweep {_farthest(blade.curve[:, 1]):.5g} m (largest)")
    )
    out = {
        "mass": f"{found.mass:.6g} kg" + (f", of which {found.tip_mass:.6g} kg at the tip" if found.tip_mass else ""),
        "centre of mass": f"x {x:.6g}, y {y:.4g}, z {z:.4g} m in the hub's axes",
        "first moment": f"{found.first_moment:.7g} kg m about the rotor's axis, {found.root_first:.7g} kg m about the root",
        "second moment": (
            f"{found.second_moment:.7g} kg m² about the rotor's axis, {found.root_second:.7g} kg m² about the root"
        ),
        "length": f"{blade.length:.6g} m along the reference axis, tip at radius {found.tip_radius:.6g} m",
        "hub radius": f"{blade.hub_radius:.6g} m",
        "precone": f"{np.degrees(blade.precone):.5g}° (positive downwind)",
        "pitch": f"{0.0 - np.degrees(blade.pitch):.5g}° (positive with the leading edge upwind)",
        "root": "clamped" if not loose else f"{', '.join(loose)}; the rest held",
        "reference axis": f"{curve}; {len(blade.stations)} stations",
        "axes": CONVENTIONS,
    }
    return out


def _farthest(values: Array) -> float:
    return float(values[np.abs(values).argmax()])


def summary(blade: Blade, source: Source | None) -> Group:
    """Facts in a table, and how the file was read."""
    table = Table(
        box=None, show_header=False, pad_edge=False, title=blade.name, title_justify="left", title_style="bold"
    )
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    told = facts(blade, totals(blade))
    if source is not None:
        told["read from"] = f"{source.format}: {', '.join(str(p) for p in source.files)}"
        told["its axes"] = source.axes
        told["notes"] = "\n".join(source.notes)
    for name, text in told.items():
        if text:
            table.add_row(name, text.replace("[", r"\["))
    return Group(table)


def rows(blade: Blade, found: Centres) -> Array:
    """A row a station, columns as in ``COLUMNS``."""
    stiff = (found.per_length, found.EI_y, found.EI_z, found.GJ, found.EA, np.degrees(blade.twist))
    return np.column_stack([blade.stations, *stiff, found.mass, found.tension, found.shear])


def stations(blade: Blade, most: int | None) -> Table:
    """The sections in a table: at most so many stations, evenly picked, first and last among them."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for column in COLUMNS:
        table.add_column(column.replace(" [", "\n").replace("]", ""), justify="right", no_wrap=True)
    values = rows(blade, centres(blade))
    n = len(values)
    picked = np.unique(np.linspace(0, n - 1, min(n, most or n)).round().astype(int))
    for row in values[picked]:
        table.add_row(*(_cell(k, x) for k, x in enumerate(row)))
    if len(picked) < n:
        table.caption = f"{len(picked)} of {n} stations; --all shows every one"
    return table


def _cell(column: int, x: float) -> str:
    if np.isinf(x):
        return "rigid"
    return f"{x:.4g}" if 0 < column < 6 else f"{round(x, 3) + 0.0:.3f}"


def write(blade: Blade, folder: Path) -> list[Path]:
    """Write the figure (SVG, PNG) and the table of all stations (CSV)."""
    from . import span  # with its figures half of a command's time to start

    folder.mkdir(parents=True, exist_ok=True)
    table = folder / "stations.csv"
    values = rows(blade, centres(blade))
    lines = [",".join(COLUMNS), *(",".join(repr(float(x)) for x in row) for row in values)]
    table.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return [*span.write(blade, folder), table]
