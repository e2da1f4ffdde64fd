"""``southwell modes`` and ``southwell mechanism``: natural frequencies by Southwell's own solver."""

from collections.abc import Sequence

import msgspec
import numpy as np
from rich.console import Console

from ....cases.campbell import interpolation
from ....cases.campbell.changes import changes as blade_changes
from ....cases.campbell.diagram import CampbellRequest
from ....cases.campbell.sweep import NamedMode
from ....cases.campbell.tracked import TrackedMode, tracked
from ....cases.input import library
from ....cases.input.changes import parse
from ...campbell import changes as changes_table
from ...shared import not_used, sheets
from ...shared.certain import NUMERICAL, remarks
from ...shared.console import output
from ...shared.statuses import PASSED
from ...shared.units import Units
from ...verification import terminal
from ..arguments import Accuracy, Changes, Elements, NumberOfModes
from ..errors import UsageError
from ..mounting import Mounting
from . import campbell_options, subjects
from . import mechanism_text as answer
from . import tower as tower_text


def modes(
    case: str,
    /,
    *,
    omega: str | None = None,
    rpm: str | None = None,
    elements: Elements | None = None,
    accuracy: Accuracy = 1e-6,
    modes: NumberOfModes = 10,
    allow_large_strain: bool = False,
    json: bool = False,
    changes: Changes = (),
    against: str | None = None,
    tower: bool = False,
    mounting: Mounting | None = None,
) -> int:
    """Compute the natural frequencies of a blade and name its modes.

    Each row is one mode, tracked from speed to speed by its shape and named at its first speed.

    Parameters
    ----------
    case
        Blade file (ElastoDyn, BeamDyn, BModes, HAWC2, windIO, Southwell's TOML or CSV), tower file (ElastoDyn, BModes,
        Southwell's TOML), or a case (listed by `southwell cases`), one of its blades as `case/blade`, or its TOML file.
    omega
        Rotor speeds in rad/s: one speed, a range `first:last:step` or a list `0,5,10`. Default: the speeds of the file or case.
    rpm
        Rotor speeds in rpm, in the same form.
    elements
        Number of beam elements of equal length. Default: as many as --accuracy requires.
    accuracy
        Largest relative uncertainty of a frequency; not used with --elements.
    modes
        Number of modes, from the lowest.
    allow_large_strain
        Accept steady strains above 20 %.
    json
        Print JSON: case, omega_rad_s, mode, label (of the mode tracked through the speeds), name (at this speed),
        frequency_rad_s, frequency_hz, relative_uncertainty (null: unknown), steady_strain.
    changes
        Change a property: `EI_flap=*1.1`, also EI_edge, GJ, EA, mass, tip_mass, twist, hub_radius, precone, pitch. May be
        repeated.
    against
        Another blade; prints the change of every frequency relative to it.
    tower
        Solve the tower in a file that also has a blade (HAWC2 htc, windIO, Southwell's TOML).
    """
    if tower or tower_text.is_tower(case):
        tower_text.run(
            case,
            modes,
            json,
            omega=omega is not None,
            rpm=rpm is not None,
            elements=elements is not None,
            changes=bool(changes),
            against=against is not None,
            mounting=mounting is not None and mounting != Mounting(),
        )
        return PASSED
    speeds, units = campbell_options.speeds(rpm, omega) or (None, None)
    rows: list[dict[str, object]] = []
    mount, property_changes = (mounting or Mounting()).mount(), [parse(text) for text in changes]
    if json and against:
        raise UsageError(
            f"--against {against}: with --json: the table of changes is not part of the JSON: leave one out"
        )
    rotating = speeds is None or any(speeds)
    baseline = subjects.single(against, mount, rotating) if against else None
    for subject in subjects.changed(subjects.subjects(case, mount, rotating), property_changes):
        if speeds is None and not subject.speeds:
            raise UsageError(f"--rpm: missing: {case} does not define rotor speeds: give them, as in 0:15:5")
        blade = subject.blade
        at = subject.speeds if speeds is None else speeds
        display_units = units or subject.units
        request = CampbellRequest(
            tuple(at), modes, elements=elements, accuracy=accuracy, allow_large_strain=allow_large_strain
        )
        computed = tracked(blade, request, display_units.at)
        by_speed = sorted((row for mode in computed for row in mode.at), key=lambda row: (row.omega, row.mode))
        labels = {(row.omega, row.mode): mode.label for mode in computed for row in mode.at}
        rows += [_tidy(blade.name, row, labels[row.omega, row.mode]) for row in by_speed]
        console = Console(stderr=True, highlight=False) if json else output()
        for note in subject.notes:
            console.print(note, style="dim", markup=False, soft_wrap=True)
        not_used.show(subject.unused, console)
        for line in interpolation.warnings(blade, modes):
            console.print(line, style="yellow", markup=False, soft_wrap=True)
        if not json:
            mesh = f"accuracy {accuracy:g}" if elements is None else f"{elements} elements"
            title = f"{blade.name}: {len(blade.stations)} stations, {mesh}"
            for table in terminal.frequencies(computed, title, display_units, console.width):
                console.print(table)
            if subject.files:
                console.print(NUMERICAL, style="dim", markup=False, soft_wrap=True)
            for line in (
                *remarks(by_speed, accuracy if elements is None else None, display_units),
                *_doubts(computed, display_units),
            ):
                console.print(line, markup=False, soft_wrap=True)
            if baseline:
                compared = blade_changes(blade, baseline.blade, at, modes, elements)
                console.print(
                    sheets.terminal(changes_table.sheet(compared, baseline.blade.name, display_units), console.width)
                )
    if json:
        print(msgspec.json.format(msgspec.json.encode(rows)).decode())
    return PASSED


def mechanism(
    name: str,
    /,
    *,
    modes: NumberOfModes = 10,
    time: float = 0.0,
    allow_large_strain: bool = False,
    json: bool = False,
) -> int:
    """Compute the steady state and the modes of any mechanism.

    Prints frequencies, damping ratios, the steady state, the independent coordinates and the redundant constraints.

    Parameters
    ----------
    name
        Name of a mechanism (listed by `southwell cases`), or a TOML file of bodies and joints.
    modes
        Number of modes, from the lowest.
    time
        Time in seconds at which motions that depend on time are evaluated.
    allow_large_strain
        Accept steady strains of beams above 20 %.
    json
        Print JSON. relative_uncertainty is the effect of rounding on a frequency (relative) and its damping ratio (absolute).
    """
    description = library.mechanism(name)
    solution = description.solve(modes, time, allow_large_strain)
    if json:
        plain = msgspec.json.encode(answer.plain(description.text.name, solution))
        print(msgspec.json.format(plain).decode())
        return PASSED
    console = output()
    console.print(answer.modes(solution, description.text.title or description.text.name))
    console.print(answer.state(solution))
    console.print(answer.redundant(solution), markup=False, soft_wrap=True)
    for line in answer.notes(solution):
        console.print(line, markup=False, soft_wrap=True)
    return PASSED


def _doubts(modes: Sequence[TrackedMode], units: Units) -> list[str]:
    """One line for each step of speed over which the shapes do not identify a mode."""
    return [
        f"{mode.label}: between {units.at(d.omega[0])} and {units.at(d.omega[1])} the shape does not identify the mode "
        f"(MAC {d.mac:.2f}): its row may join two modes; give closer speeds"
        for mode in modes
        for d in mode.doubts
        if d.mac
    ]


def _tidy(case: str, row: NamedMode, label: str) -> dict[str, object]:
    return {
        "case": case,
        "omega_rad_s": row.omega,
        "mode": row.mode,
        "label": label,
        "name": row.name,
        "frequency_rad_s": row.frequency,
        "frequency_hz": row.frequency / (2 * np.pi),
        "relative_uncertainty": row.uncertainty if np.isfinite(row.uncertainty) else None,
        "steady_strain": row.strain,
    }
