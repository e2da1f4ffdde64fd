"""The figure of convergence: every code's refinements."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from ...cases.judge.results import Cell, Level, Run
from ..shared.style import FAINT, WIDTH, Look, band, decades, key, looks, plot_style, spread, title
from ..shared.summary import column, columns
from ..shared.units import Units

FLOOR = 1e-12
"""Smallest error drawn; smaller ones are rounding."""

PANELS = 6
"""Number of modes shown, from the lowest."""

REFINED = ("code", "discretisation")
"""Roles of the cells whose refinements are drawn."""


def convergence(run: Run, case: str, units: Units, among: Sequence[str] = ()) -> Figure | None:
    """Draw the distance from Southwell's converged answer against refinement, one panel per mode.

    The speed is the highest at which codes were refined. The number at the end of a line is the order observed at its
    three finest refinements. Returns None if no code was refined.
    """
    rows = [c for c in run.cells if c.case == case and c.reference and c.mode and c.role in REFINED]
    cells = {(c.omega, c.mode, c.code): c for c in rows}
    levels = [v for v in run.levels if (v.omega, v.mode, v.code) in cells and v.case == case and v.mode <= PANELS]
    if not levels:
        return None
    omega = max(v.omega for v in levels)
    levels = [v for v in levels if v.omega == omega]
    style = looks(among or columns(run.cells))
    at_omega = sorted((c for c in rows if c.omega == omega), key=lambda c: (c.reference != c.full, c.mode))
    modes = list(dict.fromkeys(c.name for c in at_omega if c.mode <= PANELS))[:PANELS]
    across = min(3, len(modes))
    down = -(-len(modes) // across)
    column_names = dict.fromkeys(column(cells[v.omega, v.mode, v.code]) for v in levels)
    with plot_style():
        low = band(len(column_names))
        height = low + 0.62 + 2.05 * down
        figure = Figure((WIDTH, height))
        grid = figure.subplots(down, across, sharex=True, sharey=True, squeeze=False)
        figure.subplots_adjust(0.095, low / height, 0.985, 1 - 0.62 / height, 0.08, 0.22)
        _frame(grid[0, 0], levels, cells)
        for axes, mode in zip(grid.flat, modes, strict=False):
            _panel(axes, [c for c in at_omega if c.name == mode], levels, style)
            axes.set_title(mode, size=9, pad=4)
        for k, axes in enumerate(grid.flat):
            axes.set_visible(k < len(modes))
            axes.tick_params(labelbottom=k + across >= len(modes))
        title(figure, f"{case}: distance from Southwell's converged answer, {units.at(omega)}")
        figure.text(
            0.54,
            (low - 0.42) / height,
            "elements, or terms of a series; numbers: observed order; grey: target",
            ha="center",
        )
        figure.text(0.012, 0.55, "|difference|, relative", rotation=90, va="center")
        key(figure, [_line(style[name], label=name) for name in column_names], 0.095)
    return figure


def _line(look: Look, **kwargs: Any) -> Line2D:
    points = kwargs.pop("points", ([], []))
    return Line2D(*points, color=look.colour, marker=look.marker, ms=4, lw=1.1, mfc="white", mew=1.0, **kwargs)


def _frame(axes: Axes, levels: Sequence[Level], cells: dict[tuple[float, int, str], Cell]) -> None:
    errors = [_error(v, cells[v.omega, v.mode, v.code]) for v in levels]
    refinements = [v.elements for v in levels]
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(0.8 * min(refinements), 1.9 * max(refinements))
    axes.set_ylim(10.0 ** np.floor(np.log10(min(errors)) - 0.1), 10.0 ** np.ceil(np.log10(max(errors)) + 0.1))
    axes.xaxis.set_major_locator(FixedLocator(ticks(min(refinements), max(refinements))))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda n, _: f"{n:g}"))
    decades(axes.yaxis, 8)


def ticks(minimum: int, maximum: int) -> list[int]:
    """Round numbers from ``minimum`` to ``maximum``: as few to a decade as give three of them."""
    round_numbers: list[int] = []
    for digits in ((1, 3), (1, 2, 5), (1, 2, 3, 4, 5, 6, 8)):
        round_numbers = [d * 10**k for k in range(len(str(maximum))) for d in digits if minimum <= d * 10**k <= maximum]
        if len(round_numbers) >= 3:
            break
    return round_numbers


def _error(level: Level, cell: Cell) -> float:
    return max(abs(level.frequency / (cell.reference or np.nan) - 1.0), FLOOR)


def _panel(axes: Axes, cells: Sequence[Cell], levels: Sequence[Level], style: dict[str, Look]) -> None:
    axes.axhline(max(c.target for c in cells), color=FAINT, lw=1.2, zorder=1)
    ends = []
    for cell in cells:
        refinements = sorted(
            (v for v in levels if (v.code, v.mode) == (cell.code, cell.mode)), key=lambda v: v.elements
        )
        if not refinements:
            continue
        look, errors = style[column(cell)], [_error(v, cell) for v in refinements]
        axes.add_line(_line(look, points=([v.elements for v in refinements], errors), zorder=3))
        if cell.order is not None:
            ends.append((refinements[-1].elements, errors[-1], f"{cell.order:.1f}", look.colour))
    low, high = np.log10(axes.get_ylim())
    points = 1.7 * 72 / (high - low)  # points per decade; panels are about 1.7 inches high
    heights = spread([np.log10(y) * points for _, y, _, _ in ends], 9.0)
    for (x, y, text, colour), h in zip(ends, heights, strict=True):
        shift = h - np.log10(y) * points
        axes.annotate(text, (x, y), (5, shift), textcoords="offset points", va="center", size=7.5, color=colour)
