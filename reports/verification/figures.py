"""The Campbell diagram and the differences of one blade, drawn from the rows of a run."""

from collections.abc import Mapping, Sequence
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...cases.judge.results import Cell, Run, Verdict
from ..shared.rays import rays
from ..shared.style import (
    FAINT,
    INK,
    LINES,
    MUTED,
    WIDTH,
    Look,
    band,
    decades,
    key,
    label_ends,
    looks,
    plot_style,
    title,
)
from ..shared.summary import allowed, amount, column, columns, counts
from ..shared.units import Units

ORDERS = (1, 2, 3, 4, 5, 6, 8, 10, 12)
"""Orders n per revolution that are drawn as rays."""

NAME_WIDTH = 22
"""Characters of a code's name in one line beside an axis."""


def campbell(run: Run, case: str, units: Units, among: Sequence[str] = ()) -> Figure | None:
    """Draw frequencies against rotor speed: core's as lines, each code's as markers, and rays of n per revolution.

    Core's lines are straight in the squares between the computed points, ``ω² = ω₀² + k Ω²`` (Southwell 1921). Codes
    that use core's discretisation are omitted, because their answers are not converged. Returns None if the case has
    numbers at fewer than two speeds. ``among`` lists the columns whose order gives the colours: by default those of ``run``.
    """
    own = [c for c in run.cells if c.case == case and c.quantity == "frequency"]
    cells = [c for c in own if c.role not in ("same discretisation", "measured")]
    data = [c for c in own if c.verdict == "measured"]
    lines = core_lines(cells)
    speeds = sorted({omega for line in lines.values() for omega in line})
    if len(speeds) < 2:
        return None
    answers = [c.value for c in (*cells, *data) if c.value is not None]
    column_names = columns([c for c in cells if c.value is not None])
    with plot_style():
        low = band(len(column_names) + 1 + len(columns(data)))
        height = 4.6 + low
        figure = Figure((WIDTH, height))
        axes = figure.add_axes((0.08, low / height, 0.78, 1 - (low + 0.68) / height))
        axes.set_xlim(0, 1.03 * speeds[-1] * units.speeds)
        axes.set_ylim(
            0, 1.05 * max([*answers, *(f for line in lines.values() for f in line.values())]) * units.frequencies
        )
        right, top = axes.get_xlim()[1] / units.speeds, axes.get_ylim()[1] / units.frequencies
        per_rev = [n for n in ORDERS if 0.04 * top < n * right < 3.5 * top]
        omega = np.array(speeds)
        frequencies = [np.interp(omega, sorted(line), [line[o] for o in sorted(line)]) for line in lines.values()]
        rays(axes, units, per_rev, omega, np.transpose(frequencies))
        ends = []
        for name, line in lines.items():
            omega = np.array(sorted(line))
            fine = np.linspace(omega[0], omega[-1], 120)
            curve = np.sqrt(np.interp(fine**2, omega**2, np.square([line[o] for o in omega]))) * units.frequencies
            style = LINES.get(name.split()[0], "-")
            axes.plot(fine * units.speeds, curve, color=INK, lw=1.0, ls=style, zorder=3)
            ends.append((float(curve[-1]), name))
        style = looks(among or columns(run.cells))
        handles = [*_markers(axes, style, cells, column_names, units), *_data(axes, data, units)]
        label_ends(axes, ends)
        axes.set_xticks([omega * units.speeds for omega in speeds])
        axes.set_xlabel(units.speed_label)
        axes.set_ylabel(units.frequency_label)
        title(figure, f"{case}: natural frequencies against rotor speed")
        key(figure, handles, 0.08)
    return figure


def core_lines(cells: Sequence[Cell]) -> dict[str, dict[float, float]]:
    """Core's frequencies with all effects (rad/s) by mode and speed.

    Modes go by name if the same names occur at every speed, otherwise by number.
    """
    full = [c for c in cells if c.full is not None and c.reference == c.full]
    full = full or [c for c in cells if c.full is not None]
    speeds = {c.omega for c in full}
    by_name: dict[str, dict[float, float]] = {}
    by_number: dict[str, dict[float, float]] = {}
    for c in sorted(full, key=lambda c: (c.mode, c.omega)):
        by_name.setdefault(c.name, {})[c.omega] = c.full or 0.0
        by_number.setdefault(f"mode {c.mode}", {})[c.omega] = c.full or 0.0
    lasting = all(set(line) == speeds for line in by_name.values())
    return by_name if lasting else by_number


def _markers(
    axes: Axes, style: Mapping[str, Look], cells: Sequence[Cell], column_names: Sequence[str], units: Units
) -> list[Line2D]:
    """Draw hollow nested markers, the first code's the largest, so that codes that agree remain visible."""
    handles = [Line2D([], [], color=INK, lw=1.0, label="Southwell, converged")]
    for rank, name in enumerate(column_names):
        own = [c for c in cells if column(c) == name and c.value is not None]
        handles += axes.plot(
            [c.omega * units.speeds for c in own],
            [(c.value or 0.0) * units.frequencies for c in own],
            ls="",
            marker=style[name].marker,
            ms=10.0 - 7.0 * rank / max(len(column_names) - 1, 1),
            mfc="none",
            mec=style[name].colour,
            mew=1.1,
            label=name,
            clip_on=False,
            zorder=4,
        )
    return handles


def _data(axes: Axes, cells: Sequence[Cell], units: Units) -> list[Line2D]:
    """Draw measured points as filled diamonds; the bars are the validation uncertainty, 2 u_val."""
    handles = []
    for name, face in zip(columns(cells), (INK, MUTED, FAINT) * len(cells), strict=False):
        own = [c for c in cells if column(c) == name]
        axes.errorbar(
            [c.omega * units.speeds for c in own],
            [(c.value or 0.0) * units.frequencies for c in own],
            yerr=[(c.uncertainty or 0.0) * (c.reference or 0.0) * units.frequencies for c in own],
            fmt="D",
            ms=4.5,
            color=face,
            elinewidth=0.9,
            capsize=2.0,
            clip_on=False,
            zorder=5,
        )
        handles.append(Line2D([], [], ls="", marker="D", ms=4.5, color=face, label=f"{name}, measured, ± 2 u_val"))
    return handles


FACES: dict[Verdict, str] = {
    "pass": "full",
    "known difference": "left",
    "coarse": "bottom",
    "estimate": "bottom",
    "inconclusive": "none",
    "fail": "full",
}
"""Fill style of a marker by verdict; a failure is drawn as a cross."""

BELOW = 1e-5
"""Lower limit of the differences drawn, as a fraction of the smallest target; smaller ones are at the left edge."""


def differences(run: Run, case: str, units: Units, among: Sequence[str] = ()) -> Figure | None:
    """Draw every cell's difference ± uncertainty on a log axis, one row per code, one track per mode.

    Measured data have no target and are omitted. Returns None if there are no numbers.
    """
    cells = [c for c in run.cells if c.case == case and c.difference is not None and c.role != "measured"]
    if not cells:
        return None
    names, style = columns(cells), looks(among or columns(run.cells))
    tracks = max(c.mode for c in cells)
    with plot_style():
        low, height = band(1), 1.36 + 0.6 * len(names)
        figure = Figure((WIDTH, height))
        axes = figure.add_axes((0.2, low / height, 0.58, 1 - (low + 0.55) / height))
        axes.set_xscale("log")
        axes.set_xlim(*_decades(cells))
        axes.set_ylim(len(names) - 0.5, -0.5)
        for row, name in enumerate(names):
            own = [c for c in cells if column(c) == name]
            if row % 2:
                axes.axhspan(row - 0.5, row + 0.5, color="#f5f5f5", lw=0, zorder=0)
            _row(axes, row, own, tracks, style[name])
            worst = max(own, key=lambda c: abs(c.difference or 0.0))
            text = f"{amount(worst.difference or 0.0, worst.target)}\n{worst.name}, {units.at(worst.omega)}"
            axes.annotate(text, (1.02, row), xycoords=("axes fraction", "data"), va="center", size=8)
        axes.set_yticks(range(len(names)), [fill(name, NAME_WIDTH) for name in names])
        axes.tick_params(axis="y", length=0, pad=8)
        decades(axes.xaxis, 20)
        axes.set_xlabel("|difference| from Southwell with the same effects, relative, ± uncertainty")
        axes.annotate("largest", (1.02, -0.5), (0, 4), ("axes fraction", "data"), "offset points", size=8, color=MUTED)
        title(figure, f"{case}: differences, every mode and speed")
        present = counts(cells)
        keys = [Line2D([], [], ls="", color=INK, ms=5, label=v, **_face(v, "o", INK)) for v in FACES if present[v]]
        tracked = Line2D([], [], ls="", label=f"in each row, from above: modes 1 to {tracks}")
        key(figure, [*keys, *([tracked] if tracks > 1 else [])], 0.2, across=5)
    return figure


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
    floor = BELOW * min(c.target for c in cells)
    sizes = [abs(c.difference or 0.0) for c in cells] + [c.target for c in cells]
    low = 10.0 ** np.floor(np.log10(max(min(sizes), floor)) + 1e-9)
    return low, 10.0 ** np.ceil(np.log10(2 * max(sizes)))


def _row(axes: Axes, row: int, cells: Sequence[Cell], tracks: int, look: Look) -> None:
    """Draw the targets as vertical lines, and a bar and a marker per cell."""
    left = axes.get_xlim()[0]
    d = np.array([abs(c.difference or 0.0) for c in cells])
    u = np.array([c.uncertainty or 0.0 for c in cells])
    y = row + 0.32 * np.array([2 * (c.mode - 1) / max(tracks - 1, 1) - 1 for c in cells])
    axes.hlines(y, np.maximum(d - u, left), np.maximum(d + u, left), color=look.colour, lw=0.7, alpha=0.5, zorder=2)
    for verdict in FACES:
        k = np.array([c.verdict == verdict for c in cells])
        face = _face(verdict, look.marker, look.colour)
        axes.plot(np.maximum(d, left)[k], y[k], ls="", ms=4.5, zorder=3, clip_on=False, **face)
    targets = sorted({c.target for c in cells})
    axes.vlines(targets, row - 0.5, row + 0.5, color=INK, lw=1.2, zorder=4)
    if row == 0:
        text = f"target {', '.join(allowed(t) for t in targets)}"
        at = axes.transScale.transform((targets[0], 0.0))[0]
        low, high = axes.transScale.transform([(x, 0.0) for x in axes.get_xlim()])[:, 0]
        side = "right" if at > low + 0.85 * (high - low) else "center"  # avoids the next heading
        axes.annotate(text, (targets[0], -0.5), (0, 4), textcoords="offset points", ha=side, size=8)
