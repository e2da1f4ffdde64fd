"""``southwell campbell`` of a whole turbine."""

from pathlib import Path

import numpy as np

from ....cases.campbell.machine import MachineRequest, machine_diagram
from ....cases.input import files
from ....cases.input.errors import CaseError
from ....cases.input.machines import turbines as reader
from ....cases.input.readers.source import Mount
from ....cases.input.writing import writable
from ...campbell import interactive, moving_machine, tables
from ...campbell import machine as pages
from ...campbell.cover import InputOrigin
from ...documents import html as as_html
from ...shared import not_used
from ...shared.console import output
from ...shared.units import RPM, Units
from ..arguments import typed

SPEEDS = 31
"""Number of speeds by default."""

SPEEDS_OF_TWO_BLADES = 10, 0.5
"""The same of two blades, whose equations are periodic, and the lowest relative to the deck's rotor speed."""

BEYOND = 1.25
"""Highest speed by default, relative to the deck's rotor speed."""


def is_turbine(name: str) -> bool:
    """Whether a file names the tower and the blades of a turbine."""
    path = Path(name)
    with files.reading(path, deck=True):
        return reader.is_turbine(path)


def run(
    name: str,
    given: tuple[tuple[float, ...], Units] | None,
    request: MachineRequest,
    mount: Mount,
    out: Path,
    html: bool,
) -> bool:
    """Compute, print and write the diagram; return whether the required margins are kept.

    Args:
        name: the primary file, or a TOML file.
        given: speeds (rad/s) and their unit; by default from rest to ``BEYOND`` times the deck's rotor speed.
        request: the settings; its speeds are ignored.
        mount: overrides of the blade's mounting.
        out: output folder.
        html: also write campbell.html, and the interactive page if Plotly is installed.

    Raises:
        CaseError: the deck cannot be read, or a speed has no steady state.
    """
    path = Path(name)
    read = reader.read(path, mount)
    if given is None:
        if read.speed <= 0:
            raise CaseError(f"--rpm: missing: {name} has no rotor speed: give speeds, as in 0:15:0.5")
        top = np.ceil(BEYOND * read.speed * RPM.speeds)
        count, lowest = SPEEDS_OF_TWO_BLADES if read.turbine.blades == 2 else (SPEEDS, 0.0)
        first = lowest * read.speed * RPM.speeds
        given = tuple((np.linspace(first, top, count) / RPM.speeds).tolist()), RPM
    speeds, units = given
    settings = MachineRequest(speeds, request.modes, request.per_rev, request.operating, request.margin)
    diagram = machine_diagram(read.turbine, settings, at=units.at)
    ground = "on rigid ground" if read.turbine.support.rigid else "on springs"
    about = (
        f"{path.name}: the whole turbine {ground}: tower, nacelle, drivetrain, hub and {read.turbine.blades} blades",
        *read.source.about,
    )
    console = output()
    console.print(about[0], style="bold", markup=False, soft_wrap=True)
    for sheet in pages.sheets(diagram, units):
        console.print(tables.terminal(sheet, console.width))
        console.print()
    for line in about[1:]:
        console.print(line, style="dim", markup=False)
    not_used.show(read.source.unused, console)
    origin = InputOrigin(about, read.source.files, not_used.lines(read.source.unused))
    with writable(f"--out {out}"):
        written = pages.write(diagram, out, units, typed(), origin, about[:1])
        if html:
            written = (*written, as_html.write(written[0]))
            if interactive.installed():
                written = (*written, moving_machine.write(diagram, out, units))
    console.print(f"{out}: {', '.join(p.name for p in written)}", markup=False, soft_wrap=True)
    return diagram.kept
