"""Close-ups of a Campbell diagram: one panel per veering and crossing."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from scipy.interpolate import PchipInterpolator

from ...cases.campbell.diagram import Campbell
from ...cases.campbell.encounters import Encounter
from ..shared.style import INK, MUTED, WIDTH, plot_style, title
from ..shared.units import Units
from .marks import blend
from .tables import gap

ACROSS = 3

WIDE = 0.96
"""Fraction of the figure's width that the panels take."""

MAX_PANELS = 9
"""Largest number of panels; the table has all encounters."""


def draw(diagram: Campbell, units: Units, heading: str) -> Figure | None:
    """Draw one panel per encounter, the first ``MAX_PANELS`` by speed; None if there are no encounters.

    Colours are those of the motion, as in the diagram; dots are solved speeds.
    """
    encounters = diagram.encounters[:MAX_PANELS]
    if not encounters:
        return None
    across = min(ACROSS, len(encounters))
    rows, panel, low = -(-len(encounters) // across), 2.35 + 0.5 * (ACROSS - across), 0.25
    with plot_style():
        height = low + 0.35 + rows * panel
        figure = Figure((WIDTH, height))
        for position, e in enumerate(encounters):
            row, column = divmod(position, across)
            bottom = (low + (rows - 1 - row) * panel + 0.3) / height
            axes = figure.add_axes(
                (0.085 + column * WIDE / across, bottom, WIDE / across - 0.095, (panel - 1.0) / height)
            )
            _panel(axes, diagram, e, units)
        remaining = len(diagram.encounters) - len(encounters)
        below = "dots: speeds solved; colours as in the diagram" + (
            f"; {remaining} more in the table" if remaining else ""
        )
        title(figure, heading, below)
    return figure


def _panel(axes: Axes, diagram: Campbell, e: Encounter, units: Units) -> None:
    tracks = diagram.tracks
    low, high = _window(diagram, e)
    values: list[float] = []
    for t in e.tracks:
        k = np.flatnonzero(tracks.mode_index[:, t] >= 0)
        omega, squares = tracks.omega[k], tracks.frequencies[k, t] ** 2
        x = np.linspace(max(low, omega[0]), min(high, omega[-1]), 161)
        y = np.sqrt(PchipInterpolator(omega**2, squares)(x**2))
        fractions = np.stack([np.interp(x, omega, diagram.energy_fractions[k, t, i]) for i in range(4)], axis=1)
        points = np.stack([x * units.speeds, y * units.frequencies], axis=1)
        segments = np.stack([points[:-1], points[1:]], axis=1)
        colours = [blend(s) for s in 0.5 * (fractions[1:] + fractions[:-1])]
        axes.add_collection(LineCollection(list(segments), colors=colours, linewidths=1.8, capstyle="round", zorder=3))
        inside = (omega >= low) & (omega <= high)
        axes.scatter(
            omega[inside] * units.speeds,
            np.sqrt(squares[inside]) * units.frequencies,
            s=9,
            c=[blend(s) for s in diagram.energy_fractions[k, t][inside]],
            edgecolors="white",
            linewidths=0.5,
            zorder=4,
        )
        values += points[:, 1].tolist()
    axes.set_xlim(low * units.speeds, high * units.speeds)
    room = 0.08 * (max(values) - min(values))
    axes.set_ylim(min(values) - room, max(values) + room)
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.ticklabel_format(useOffset=False)
    axes.tick_params(labelsize=7.5)
    axes.set_xlabel(units.speed_label, size=8, labelpad=2)
    axes.set_ylabel(units.frequency, size=8, labelpad=2)
    axes.set_title(_named(e, units), size=9.5, pad=17)
    axes.annotate(_words(diagram, e, units), (0, 1), (0, 6), "axes fraction", "offset points", size=7.5, color=MUTED)
    if e.kind == "veering":
        at, middle, half_gap = e.omega * units.speeds, e.frequency * units.frequencies, 0.5 * e.gap * units.frequencies
        axes.plot([at, at], [middle - half_gap, middle + half_gap], color=INK, lw=1.0, zorder=2, marker="_", ms=5)


def _window(diagram: Campbell, e: Encounter) -> tuple[float, float]:
    """The range of speeds shown (rad/s): the width of a veering, or one step of the speeds around a crossing."""
    speeds = diagram.request.speeds
    past = max(e.window[1] - e.omega, e.omega - e.window[0])
    half_width = 0.75 * past if e.kind == "veering" else float(np.diff(speeds).max())
    return max(speeds[0], e.omega - half_width), min(speeds[-1], e.omega + half_width)


def _named(e: Encounter, units: Units) -> str:
    return f"{e.kind}, {e.omega * units.speeds:.4g} {units.speed}"


def _words(diagram: Campbell, e: Encounter, units: Units) -> str:
    names = " and ".join(diagram.labels.at(t, e.window[0]) for t in e.tracks)
    return f"{names}, gap {gap(e, units, 2)} {units.frequency}" if e.kind == "veering" else names
