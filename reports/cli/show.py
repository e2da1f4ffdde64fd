"""``southwell show``: the properties of a blade as numbers and a figure, and how its file was read."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter
from numpy.typing import NDArray
from rich import box
from rich.console import Group
from rich.markup import escape
from rich.table import Table

from ...cases.input import atomic
from ...cases.input.errors import CaseError
from ...cases.input.properties import Mass, Sections, about_hub, about_root, sections, tip
from ...core.blade import Blade, straight
from ..shared import not_used
from ..shared.console import output
from ..shared.paths import file_name
from .mounting import Mounting
from .subjects import subjects as find_subjects

Array = NDArray[np.float64]

ROWS = 13
"""Number of stations in the table, unless all are requested."""

COLUMNS = (
    *("s [m]", "mass [kg/m]", "EI flap [N m²]", "EI edge [N m²]", "GJ [N m²]", "EA [N]", "twist [deg]"),
    *("mass y [m]", "mass z [m]", "tension y [m]", "tension z [m]", "shear y [m]", "shear z [m]"),
)
PROPERTIES = 7
"""Number of columns before those of the centres."""

MORE = ("principal axes [deg]", "mass axes [deg]", "axis x [m]", "axis y [m]", "axis z [m]")
"""Further columns of the CSV: angles of axes from the section's y and z, empty if undefined; reference axis."""

CONVENTIONS = (
    "x along the blade, z the rotor axis, y the direction of motion (to the leading edge); sections turn with twist and "
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
    """Show the mass, sections and axes of a blade, and how its file was read.

    Lists every non-zero quantity of the file that is not used.

    Parameters
    ----------
    blade
        Blade file (ElastoDyn, BeamDyn, BModes, HAWC2, windIO, Southwell's TOML or CSV), or a case (`southwell cases`).
    out
        Output folder for a figure of the properties along the span (SVG, PNG) and a CSV table of all stations.
    all
        Print all stations.
    """
    subjects = find_subjects(blade, (mounting or Mounting()).mount())
    console = output()
    for subject in subjects:
        console.print(summary(subject.blade, subject.about))
        not_used.show(subject.unused, console)
        for table in stations(subject.blade, None if all else ROWS):
            console.print(table)
        if out is not None:
            folder = out / file_name(subject.blade.name.partition("/")[2]) if len(subjects) > 1 else out
            try:
                written = write(subject.blade, folder)
            except OSError as error:
                raise CaseError(f"--out {out}: cannot be written ({error.strerror}): give another folder") from error
            console.print(f"{folder}: {', '.join(path.name for path in written)}", markup=False, soft_wrap=True)
    return 0


def facts(blade: Blade) -> dict[str, str]:
    """Facts on a blade by name, including its tip mass."""
    hub, root = about_hub(blade), about_root(blade)
    x, y, z = np.where(np.abs(hub.centre) < 1e-9 * blade.length, 0.0, hub.centre)
    springs = zip(("x", "y", "z", "torsion", "flap", "lag"), blade.root, strict=True)
    loose = [f"{name} {f'spring {k:.6g}' if k else 'free'}" for name, k in springs if np.isfinite(k)]
    bends = f"prebend {_farthest(blade.curve[:, 2]):.5g} m, sweep {_farthest(blade.curve[:, 1]):.5g} m (largest)"
    end, pitch = tip(blade), float(np.degrees(blade.pitch))
    return {
        "mass": f"{hub.mass:.6g} kg" + (f", of which {end.mass:.6g} kg at the tip" if end else ""),
        "tip mass": _body(end) if end else "",
        "centre of mass": f"x {x:.6g}, y {y:.4g}, z {z:.4g} m in the hub's axes",
        "first moment": (
            f"{np.hypot(*hub.first[:2]):.7g} kg m about the rotor's axis, {root.first[0]:.7g} kg m about the root"
        ),
        "second moment": (
            f"{hub.moments[2, 2]:.7g} kg m² about the rotor's axis, {root.moments[2, 2]:.7g} kg m² about the root, edgewise"
        ),
        "length": f"{blade.length:.6g} m along the reference axis",
        "hub radius": f"{blade.hub_radius:.6g} m",
        "precone": f"{np.degrees(blade.precone):.5g}° (positive downwind)",
        "pitch": f"{pitch:.5g}° (positive with the leading edge downwind; as OpenFAST's BlPitch: {0.0 - pitch:.5g}°)",
        "root": "clamped" if not loose else f"{', '.join(loose)}; otherwise clamped",
        "reference axis": f"{'straight' if straight(blade) else bends}; {len(blade.stations)} stations",
        "axes": CONVENTIONS,
    }


def _farthest(values: Array) -> float:
    return float(values[np.abs(values).argmax()]) + 0.0


def _body(found: Mass) -> str:
    (x, y, z), own = found.centre + 0.0, found.own
    moments = ", ".join(f"{k:.5g}" for k in np.where(np.abs(own) < 1e-9 * np.abs(own).max(), 0.0, own).diagonal())
    return f"centre x {x:.5g}, y {y:.5g}, z {z:.5g} m from the tip; moments of inertia about it {moments} kg m²; section axes"


def summary(blade: Blade, about: Sequence[str] = ()) -> Group:
    """A table of facts, followed by how the blade was read."""
    table = Table(
        box=None, show_header=False, pad_edge=False, title=escape(blade.name), title_justify="left", title_style="bold"
    )
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    for name, text in (facts(blade) | {"from": "\n".join(about)}).items():
        if text:
            table.add_row(name, escape(text))
    return Group(table)


def rows(blade: Blade, found: Sections) -> Array:
    """(n, columns) numbers of all stations, columns as in ``COLUMNS``."""
    stiff = (blade.mass[:, 0, 0], found.EI_flap, found.EI_edge, found.GJ, found.EA, np.degrees(blade.twist))
    return np.column_stack([blade.stations, *stiff, found.mass_centre, found.tension_centre, found.shear_centre])


def stations(blade: Blade, most: int | None) -> tuple[Table, Table]:
    """The tables of properties and of centres, with at most ``most`` evenly spaced stations including both ends."""
    values = rows(blade, sections(blade))
    n = len(values)
    picked = np.unique(np.linspace(0, n - 1, min(n, most or n)).round().astype(int))
    properties = _table(values[picked], range(PROPERTIES))
    centres = _table(values[picked], (0, *range(PROPERTIES, len(COLUMNS))))
    if len(picked) < n:
        centres.caption = f"{len(picked)} of {n} stations; --all shows all"
    return properties, centres


def _table(values: Array, columns: Sequence[int]) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for column in columns:
        table.add_column(COLUMNS[column].replace(" [", "\n").replace("]", ""), justify="right", no_wrap=True)
    for row in values:
        table.add_row(*(_cell(column, row[column]) for column in columns))
    return table


def _cell(column: int, x: float) -> str:
    if np.isinf(x):
        return "rigid"
    return f"{x:.4g}" if 0 < column < 6 else f"{round(x, 3) + 0.0:.3f}"


def write(blade: Blade, folder: Path) -> list[Path]:
    """Write the figure (SVG, PNG) and the table of all stations (CSV); return the paths."""
    from ..campbell import span  # not at the top: the figures take half of the start-up time

    folder.mkdir(parents=True, exist_ok=True)
    table = folder / "stations.csv"
    found = sections(blade)
    angles = np.degrees([found.principal, found.mass_axes]).T
    values = np.column_stack([rows(blade, found), angles, blade.curve])
    written = (",".join("" if np.isnan(x) else repr(float(x)) for x in row) for row in values)
    lines = [",".join(COLUMNS + MORE), *written]
    atomic.write(table, "\n".join(lines) + "\n")
    return [*span.write(blade, folder), table]
