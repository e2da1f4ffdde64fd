"""Campbell diagram and differences of one blade, from a run's rows alone."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from ..cases.results import Cell, Run, Verdict
from ..cases.verdict import unsigned
from .style import FAINT, INK, LINES, MUTED, Look, beside, house, looks
from .summary import column, columns, labels
from .units import Units

ORDERS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 18, 24, 30, 40, 50)
"""Multiples of the rotor's speed that are worth a ray."""

FLOOR = 1e-12
"""Differences below this are rounding, and are drawn here."""


def campbell(run: Run, case: str, units: Units) -> Figure | None:
    """Frequencies against rotor speed: core's as lines, every code's as markers, rays of n per revolution.

    Core's lines run straight in the squares between its points, ``ω² = ω₀² + k Ω²`` (Southwell 1921). None if the
    case has numbers at fewer than two speeds.
    """
    cells = [c for c in run.cells if c.case == case]
    lines = _lines(cells)
    speeds = sorted({omega for line in lines.values() for omega in line})
    if len(speeds) < 2:
        return None
    with house():
        figure = Figure((7.6, 5.2))
        axes = figure.add_axes((0.085, 0.17, 0.76, 0.74))
        x = [omega * units.speeds for omega in speeds]
        top = 1.06 * max(f for line in lines.values() for f in line.values()) * units.frequencies
        axes.set_xlim(0, 1.03 * x[-1])
        axes.set_ylim(0, top)
        _rays(axes, units)
        ends = []
        for name, line in lines.items():
            omega = np.array(sorted(line))
            squares = np.array([line[o] for o in omega]) ** 2
            fine = np.linspace(omega[0], omega[-1], 200)
            curve = np.sqrt(np.interp(fine**2, omega**2, squares))
            style = LINES.get(name.split()[0], "-")
            axes.plot(fine * units.speeds, curve * units.frequencies, color=INK, lw=1.0, ls=style, zorder=3)
            ends.append((curve[-1] * units.frequencies, name))
        handles = _markers(axes, run, cells, units)
        beside(axes, ends)
        axes.set_xticks(x)
        axes.set_xlabel(units.speed_label)
        axes.set_ylabel(units.frequency_label)
        figure.text(0.015, 0.96, f"{case}: natural frequencies against rotor speed", weight="bold", size=10.5)
        figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.07, 0.0), ncols=4, columnspacing=1.6)
    return figure


def _lines(cells: Sequence[Cell]) -> dict[str, dict[float, float]]:
    """Core's frequencies with all effects (rad/s) by mode and speed; modes by name if the names last, else by number."""
    names = labels(cells)
    full = [c for c in cells if c.full is not None and c.reference == c.full]
    full = full or [c for c in cells if c.full is not None]
    speeds = {c.omega for c in full}
    by_name: dict[str, dict[float, float]] = {}
    by_number: dict[str, dict[float, float]] = {}
    for c in sorted(full, key=lambda c: (c.mode, c.omega)):
        by_name.setdefault(names[c], {})[c.omega] = c.full or 0.0
        by_number.setdefault(f"mode {c.mode}", {})[c.omega] = c.full or 0.0
    lasting = all(set(line) == speeds for line in by_name.values())
    return by_name if lasting else by_number


def _rays(axes: Axes, units: Units) -> None:
    right, top = axes.get_xlim()[1], axes.get_ylim()[1]
    slope = units.frequencies / units.speeds
    for n in ORDERS:
        end = min(right, top / (n * slope))
        if not 0.04 * top < n * slope * right < 3.5 * top:
            continue
        axes.plot([0, end], [0, n * slope * end], color=FAINT, lw=0.8, zorder=1)
        at = (end, n * slope * end) if end < right else (0.93 * end, 0.93 * n * slope * end)
        box = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
        axes.annotate(
            f"{n}P",
            at,
            (0, 3 if end < right else 0),
            textcoords="offset points",
            ha="center",
            va="bottom" if end < right else "center",
            size=7,
            color=MUTED,
            bbox=box,
            zorder=2,
        )


def _markers(axes: Axes, run: Run, cells: Sequence[Cell], units: Units) -> list[Line2D]:
    """Hollow markers, nested: the first code's is the largest, so that codes that agree can all be seen."""
    style = looks(columns(run.cells))
    shown = [name for name in columns(cells) if any(c.frequency for c in cells if column(c) == name)]
    handles = [Line2D([], [], color=INK, lw=1.0, label="core, converged")]
    for rank, name in enumerate(shown):
        mine = [c for c in cells if column(c) == name and c.frequency is not None]
        (line,) = axes.plot(
            [c.omega * units.speeds for c in mine],
            [(c.frequency or 0.0) * units.frequencies for c in mine],
            ls="",
            marker=style[name].marker,
            ms=10.0 - 7.0 * rank / max(len(shown) - 1, 1),
            mfc="none",
            mec=style[name].colour,
            mew=1.1,
            label=name,
            clip_on=False,
            zorder=4,
        )
        handles.append(line)
    return handles


def differences(run: Run, case: str, units: Units) -> Figure | None:
    """Every cell's difference ± uncertainty on a log axis, a row a code, a track a mode; None if there are no numbers."""
    cells = [c for c in run.cells if c.case == case and c.difference is not None]
    if not cells:
        return None
    names, style, modes = columns(cells), looks(columns(run.cells)), labels(cells)
    tracks = max(c.mode for c in cells)
    with house():
        height = 1.6 + 0.62 * len(names)
        figure = Figure((7.6, height))
        axes = figure.add_axes((0.205, 0.9 / height, 0.775, 1 - 1.5 / height))
        axes.set_xscale("log")
        axes.set_xlim(*_decades(cells))
        axes.set_ylim(len(names) - 0.5, -0.5)
        for row, name in enumerate(names):
            mine = [c for c in cells if column(c) == name]
            if row % 2:
                axes.axhspan(row - 0.5, row + 0.5, color="#f5f5f5", lw=0, zorder=0)
            _row(axes, row, mine, tracks, style[name])
            _targets(axes, row, mine)
            _worst(axes, row, mine, tracks, units, modes)
        axes.set_yticks(range(len(names)), names)
        axes.tick_params(axis="y", length=0)
        axes.xaxis.set_major_locator(LogLocator(numticks=20))
        axes.set_xlabel(f"|difference| from core, relative, ± uncertainty; in each row from above: modes 1 to {tracks}")
        figure.text(0.015, 1 - 0.24 / height, f"{case}: differences, every mode and speed", weight="bold", size=10.5)
        present: list[Verdict] = [v for v in FACES if v in {c.verdict for c in cells}]
        keys = [Line2D([], [], ls="", color=INK, ms=5, label=v, **_face(v, "o", INK)) for v in present]
        figure.legend(handles=keys, loc="lower left", bbox_to_anchor=(0.19, 0.0), ncols=4, handletextpad=0.1)
    return figure


FACES: dict[Verdict, str] = {"pass": "full", "known difference": "left", "inconclusive": "none", "fail": "full"}
"""How a marker is filled; a failure is a cross."""


def _face(verdict: Verdict, marker: str, colour: str) -> dict[str, Any]:
    return {
        "marker": "X" if verdict == "fail" else marker,
        "fillstyle": FACES[verdict],
        "markerfacecolor": colour,
        "markerfacecoloralt": "white",
        "markeredgecolor": colour,
        "markeredgewidth": 0.8,
    }


def _decades(cells: Sequence[Cell]) -> tuple[float, float]:
    sizes = [max(abs(c.difference or 0.0), FLOOR) for c in cells] + [c.target for c in cells]
    return 10.0 ** np.floor(np.log10(min(sizes)) - 0.2), 10.0 ** np.ceil(np.log10(2 * max(sizes)))


def _height(row: int, mode: int, tracks: int) -> float:
    return row + 0.32 * (2 * (mode - 1) / max(tracks - 1, 1) - 1)


def _row(axes: Axes, row: int, cells: Sequence[Cell], tracks: int, look: Look) -> None:
    left = axes.get_xlim()[0]
    for c in cells:
        d, u, y = abs(c.difference or 0.0), c.uncertainty or 0.0, _height(row, c.mode, tracks)
        axes.plot([max(d - u, left), max(d + u, left)], [y, y], color=look.colour, lw=0.7, alpha=0.5, zorder=2)
        axes.plot([max(d, FLOOR)], [y], ls="", ms=4.5, zorder=3, **_face(c.verdict, look.marker, look.colour))


def _targets(axes: Axes, row: int, cells: Sequence[Cell]) -> None:
    for target in sorted({c.target for c in cells}):
        axes.plot([target, target], [row - 0.5, row + 0.5], color=INK, lw=1.2, zorder=4)
    if row == 0:
        text = ", ".join(unsigned(t) for t in sorted({c.target for c in cells}))
        axes.annotate(
            f"target {text}", (cells[0].target, -0.5), (0, 4), textcoords="offset points", ha="center", size=8
        )


def _worst(axes: Axes, row: int, cells: Sequence[Cell], tracks: int, units: Units, modes: dict[Cell, str]) -> None:
    c = max(cells, key=lambda c: abs(c.difference or 0.0))
    d = max(abs(c.difference or 0.0), FLOOR)
    low, high = np.log10(axes.get_xlim())
    leftwards = (np.log10(d) - low) / (high - low) > 0.72
    axes.annotate(
        f"{modes[c]}, {units.at(c.omega)}",
        (d if leftwards else d + (c.uncertainty or 0.0), _height(row, c.mode, tracks)),
        (-6 if leftwards else 6, 0),
        textcoords="offset points",
        ha="right" if leftwards else "left",
        va="center",
        size=7.5,
        color=INK,
        zorder=5,
    )
