"""Tables, figure and page of a whole turbine's Campbell diagram."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ...cases.campbell.machine import MachineDiagram, ModeLine
from ...cases.input import atomic
from ..shared.certain import certain, relative
from ..shared.rays import rays
from ..shared.sheets import TOO_NEAR, Sheet, markdown
from ..shared.style import COLOURS, WIDTH, label_ends, plot_style, save, title
from ..shared.units import Units
from . import cover
from .cover import InputOrigin

PAGE = "campbell.md"

UNSTABLE = 1e-5
"""Growth rate, as a fraction of the frequency, above which a mode is unstable."""

FRAME = (
    "Frequencies are in the ground's frame: a blade sees a backward whirl 1P higher and a forward whirl 1P lower (of m "
    "diameters: mP)."
)

OF_TWO_BLADES = (
    "Frequencies of the tower are in the ground's frame, those of the two blades in the rotor's: each side sees a mode of the "
    "other 1P higher and lower. A mode moves at several such frequencies; that of the motion that names it is given."
)

NAMED = (
    "A mode is named by the motion with the largest part of its elastic energy, which is the confidence; below 50 % "
    "the name says little."
)

_DASHES = {"tower": "-", "collective": (0, (5, 2)), "forward": (0, (4, 1.5, 1, 1.5)), "backward": (0, (1, 1.2))}


def frame(diagram: MachineDiagram) -> str:
    """In which frame the frequencies are."""
    return FRAME if diagram.turbine.blades > 2 else OF_TWO_BLADES


def sheets(diagram: MachineDiagram, units: Units) -> tuple[Sheet, ...]:
    """All tables that have rows."""
    parts = _modes(diagram, units), _unstable(diagram, units), _margins(diagram, units), _crossings(diagram, units)
    return tuple(part for part in parts if part.rows)


def _modes(diagram: MachineDiagram, units: Units) -> Sheet:
    rows = []
    for line in diagram.lines:
        ends = [certain(float(line.frequencies[k]) * units.frequencies, line.uncertainty) for k in (0, -1)]
        low, high = 100 * line.confidence.min(), 100 * line.confidence.max()
        part = f"{high:.0f} %" if high - low < 1 else f"{low:.0f} to {high:.0f} %"
        rows.append((line.name, *ends, relative(line.uncertainty), part, _changes(diagram, line, units)))
    first, last = (units.at(float(diagram.omega[k])) for k in (0, -1))
    head = (
        "mode",
        f"{units.frequency} {first}",
        f"{units.frequency} at {last}",
        "± relative",
        "confidence",
        "name changes",
    )
    return Sheet("Modes", head, tuple(rows), f"{frame(diagram)} {NAMED}")


def _unstable(diagram: MachineDiagram, units: Units) -> Sheet:
    rows = []
    for line in diagram.lines:
        growth = [float(modes.growth[k]) for modes, k in zip(diagram.solved, line.places, strict=True)]
        worst = int(np.argmax(growth))
        if growth[worst] > UNSTABLE * line.frequencies[worst]:
            speed = units.at(float(diagram.omega[worst]))
            rows.append((f"{TOO_NEAR} {line.name}", f"{growth[worst]:.2g} 1/s", speed))
    note = "Largest growth at the solved speeds; without damping. It can lie between them too."
    return Sheet("Unstable modes", ("mode", "growth", "at"), tuple(rows), note)


def _changes(diagram: MachineDiagram, line: ModeLine, units: Units) -> str:
    """Where a line takes another name, after the first speed."""
    own = line.name.partition(" (")[0]
    changes = [k for k, name in enumerate(line.names) if name != own and diagram.omega[k]]
    if not changes:
        return "–"
    k = changes[0]
    remainder = f" and {len(changes) - 1} more" if len(changes) > 1 else ""
    return f"{line.names[k]} at {units.at(float(diagram.omega[k]))}{remainder}"


def _margins(diagram: MachineDiagram, units: Units) -> Sheet:
    request = diagram.request
    rows = []
    for n in diagram.nearest:
        if n.kept:
            continue
        name = diagram.lines[n.line].name
        rows.append((f"{TOO_NEAR} {name}", f"{n.per_rev}P", f"{100 * n.distance:.2g} %", units.at(n.omega)))
    return Sheet(
        "Margins violated", ("mode", "excitation", "distance", "at"), tuple(rows), f"Required: {request.margin}."
    )


def _crossings(diagram: MachineDiagram, units: Units) -> Sheet:
    rows = [
        (
            diagram.lines[c.line].name,
            f"{c.per_rev}P",
            units.at(c.omega),
            f"{c.per_rev * c.omega * units.frequencies:.5g}",
        )
        for c in sorted(diagram.crossings, key=lambda c: c.omega)
    ]
    return Sheet(
        "Crossings", ("mode", "excitation", "at", units.frequency), tuple(rows), "Interpolated between the speeds."
    )


def draw(diagram: MachineDiagram, units: Units, heading: str) -> Figure:
    """Draw the lines over speed, labelled at their ends, with rays of n per revolution."""
    with plot_style():
        figure = Figure((WIDTH, 5.9))
        axes = figure.add_axes((0.07, 0.1, 0.62, 0.78))
        speeds, request = diagram.omega * units.speeds, diagram.request
        frequencies = np.array([line.frequencies for line in diagram.lines])
        for k, line in enumerate(diagram.lines):
            dashes = next((d for word, d in _DASHES.items() if word in line.name), "-")
            axes.plot(speeds, line.frequencies * units.frequencies, color=COLOURS[k % 8], ls=dashes, lw=1.5)
        if request.operating:
            axes.axvspan(*(s * units.speeds for s in request.operating), color="#f0f0f0", zorder=0)
        axes.set_xlim(float(speeds[0]), float(speeds[-1]))
        axes.set_ylim(0.0, 1.05 * float(frequencies.max()) * units.frequencies)
        rays(axes, units, request.per_rev, diagram.omega, frequencies.T, request.operating)
        ends = frequencies[:, -1] * units.frequencies
        label_ends(axes, [(ends[k], line.name, COLOURS[k % 8]) for k, line in enumerate(diagram.lines)])
        axes.set_xlabel(units.speed_label)
        axes.set_ylabel(units.frequency_label)
        title(figure, heading, "ground's frame" if diagram.turbine.blades > 2 else "ground's and rotor's frame")
    return figure


def write(
    diagram: MachineDiagram, folder: Path, units: Units, command: str, origin: InputOrigin, notes: Sequence[str]
) -> tuple[Path, ...]:
    """Write the figure (SVG and PNG), ``campbell.csv`` and the page; return the paths.

    Raises:
        OSError: if a file cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    name = diagram.turbine.name
    vector, raster = save(draw(diagram, units, f"{name}: natural frequencies versus rotor speed"), folder / "campbell")
    table = folder / "campbell.csv"
    atomic.write_csv(table, CSV, _rows(diagram))
    parts = [
        f"# Campbell diagram of {name}\n",
        *[f"{note}.\n" for note in notes],
        cover.cover(origin),
        "![Natural frequencies versus rotor speed](campbell.svg)\n",
        *[markdown(sheet) for sheet in sheets(diagram, units)],
        cover.unused(origin),
        f"## Reproduce\n\n```\n{command}\n```\n",
    ]
    page = folder / PAGE
    atomic.write(page, "\n".join(parts))
    return page, vector, raster, table


CSV = (
    *("omega_rad_s", "rotor_speed_rpm", "mode", "name", "frequency_rad_s", "frequency_hz"),
    *("relative_uncertainty", "confidence"),
)
"""Columns of ``campbell.csv``."""


def _rows(diagram: MachineDiagram) -> Iterator[tuple[str, ...]]:
    """One row per mode and speed, in SI units."""
    for k, omega in enumerate(diagram.omega.tolist()):
        for line in diagram.lines:
            f = float(line.frequencies[k])
            numbers = f"{f / (2 * np.pi):.9g}", f"{line.uncertainty:.6g}", f"{line.confidence[k]:.6f}"
            yield repr(omega), f"{omega * 30 / np.pi:.9g}", line.name, line.names[k], repr(f), *numbers
