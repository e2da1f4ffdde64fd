"""``southwell campbell`` of a whole turbine."""

from pathlib import Path

import numpy as np

from ....cases.campbell.machine import MachineRequest, machine_diagram
from ....cases.input import files
from ....cases.input.errors import CaseError
from ....cases.input.machines import turbines as reader
from ....cases.input.readers.source import Mount
from ....cases.input.writing import writable
from ...campbell import interactive, moving_machine
from ...campbell import machine as pages
from ...campbell.cover import InputOrigin
from ...documents import html as as_html
from ...shared import not_used, sheets
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
    speed_option: tuple[tuple[float, ...], Units] | None,
    request: MachineRequest,
    mount: Mount,
    out: Path,
    html: bool,
) -> bool:
    """Compute, print and write the diagram; return whether the required margins are kept.

    Args:
        name: the primary file, or a TOML file.
        speed_option: speeds (rad/s) and their unit; by default from rest to ``BEYOND`` times the deck's rotor speed.
        request: the settings; its speeds are ignored.
        mount: overrides of the blade's mounting.
        out: output folder.
        html: also write campbell.html, and the interactive page if Plotly is installed.

    Raises:
        CaseError: the deck cannot be read, or a speed has no steady state.
    """
    path = Path(name)
    reading = reader.read(path, mount)
    if speed_option is None:
        if reading.speed <= 0:
            raise CaseError(f"--rpm: missing: {name} has no rotor speed: give speeds, as in 0:15:0.5")
        top = np.ceil(BEYOND * reading.speed * RPM.speeds)
        count, lowest = SPEEDS_OF_TWO_BLADES if reading.turbine.blades == 2 else (SPEEDS, 0.0)
        first = lowest * reading.speed * RPM.speeds
        speed_option = tuple((np.linspace(first, top, count) / RPM.speeds).tolist()), RPM
    speeds, units = speed_option
    settings = MachineRequest(speeds, request.modes, request.per_rev, request.operating, request.margin)
    diagram = machine_diagram(reading.turbine, settings, at=units.at)
    ground = "on rigid ground" if reading.turbine.support.rigid else "on springs"
    facts = (
        f"{path.name}: the whole turbine {ground}: tower, nacelle, drivetrain, hub and {reading.turbine.blades} blades",
        *reading.source.about,
    )
    console = output()
    console.print(facts[0], style="bold", markup=False, soft_wrap=True)
    for sheet in pages.sheets(diagram, units):
        console.print(sheets.terminal(sheet, console.width))
        console.print()
    for line in facts[1:]:
        console.print(line, style="dim", markup=False)
    not_used.show(reading.source.unused, console)
    origin = InputOrigin(facts, reading.source.files, not_used.lines(reading.source.unused))
    with writable(f"--out {out}"):
        paths = pages.write(diagram, out, units, typed(), origin, facts[:1])
        if html:
            paths = (*paths, as_html.write(paths[0]))
            if interactive.installed():
                paths = (*paths, moving_machine.write(diagram, out, units))
    console.print(f"{out}: {', '.join(p.name for p in paths)}", markup=False, soft_wrap=True)
    return diagram.kept
