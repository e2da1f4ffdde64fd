"""The Campbell diagram as a figure: modes coloured by motion, rays of n per revolution, violated margins in red."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from ...cases.campbell.diagram import Campbell
from ...cases.plan.user_results import UserResults
from ...core.participation import FAMILIES
from ..shared.certain import certain
from ..shared.rays import rays
from ..shared.style import MUTED, WIDTH, key, label_ends, plot_style, title
from ..shared.units import Units
from . import points
from .marks import DASHES, band, band_label, blend, legend, marks, near

PURE = 0.85
"""Smallest energy fraction at which a line has its family's dashes; below it, a solid line of blended colours."""

SQUEEZED = 0.5
"""Fraction of the height: if the rays would take less than this, the modes they reach get a separate scale."""

LOWER, GAP = 0.6, 0.04
"""Fractions of the height: the separate lower scale, and the gap above it."""

LETTER = 0.066
"""Width of a letter of the labels at the line ends, inches."""


def draw(diagram: Campbell, units: Units, heading: str, user_results: Sequence[UserResults] = ()) -> Figure:
    """Draw the diagram.

    Lines are modes, coloured by their motion at each speed; in a veering, two lines exchange colours. The operating
    range is shaded. A mode that violates the margin to n per revolution within it is underlaid in red. If the rays
    reach only the lowest of many modes, these have a separate scale and the higher modes are above it on a coarser
    one. Points of ``user_results``, such as those of a test rig, are drawn over the lines.
    """
    with plot_style():
        low, height = 0.95, 5.9
        figure = Figure((WIDTH, height))
        longest = max(len(_label(diagram, t, units)) for t in range(diagram.tracks.count))
        room = (0.15 + LETTER * max(longest, 18)) / WIDTH
        left, bottom, width, tall = 0.07, low / height, 0.93 - room, 1 - (low + 0.66) / height
        ranges = _ranges(diagram, units)
        if len(ranges) == 1:
            panels = [figure.add_axes((left, bottom, width, tall))]
        else:
            panels = [
                figure.add_axes((left, bottom, width, LOWER * tall)),
                figure.add_axes((left, bottom + (LOWER + GAP) * tall, width, (1 - LOWER - GAP) * tall)),
            ]
        for axes, limits in zip(panels, ranges, strict=True):
            _panel(axes, diagram, units, limits)
            points.draw(axes, user_results, diagram.blade.name, units)
        lowest, highest = panels[0], panels[-1]
        _rays(lowest, diagram, units)
        band_label(highest, diagram, units)
        highest.annotate(
            f"{units.frequency} at {diagram.request.speeds[-1] * units.speeds:.4g} {units.speed}",
            (1.0, 1.0),
            (6, 6),
            "axes fraction",
            "offset points",
            size=7.5,
            color=MUTED,
        )
        lowest.set_xlabel(units.speed_label, labelpad=3)
        lowest.set_ylabel(units.frequency_label)
        for axes in panels[1:]:
            axes.spines["bottom"].set_visible(False)
            axes.tick_params(bottom=False, labelbottom=False)
        hidden = points.outside(user_results, diagram, ranges[-1][1] / units.frequencies)
        title(figure, heading, "; ".join(part for part in (_below(diagram, units), hidden) if part))
        handles = [*legend(diagram), *points.legend(user_results, diagram.blade.name)]
        key(figure, handles, 0.07, across=-(-len(handles) // (1 + (len(handles) > 5))))
    return figure


def lines(axes: Axes, diagram: Campbell, units: Units) -> Axes:
    """Draw modes, rays of n per revolution and the operating range on given axes, on one scale; return the axes."""
    top = 1.06 * float(np.nanmax(diagram.tracks.frequencies)) * units.frequencies
    _panel(axes, diagram, units, (0.0, top))
    _rays(axes, diagram, units)
    axes.set_xlabel(units.speed_label)
    axes.set_ylabel(units.frequency_label)
    return axes


def _rays(axes: Axes, diagram: Campbell, units: Units) -> None:
    request, tracks = diagram.request, diagram.tracks
    veerings = [(e.omega, e.frequency) for e in diagram.encounters if e.kind == "veering"]
    rays(axes, units, request.per_rev, tracks.omega, tracks.frequencies, request.operating, veerings)


def _ranges(diagram: Campbell, units: Units) -> list[tuple[float, float]]:
    """The ranges of frequency, from below: two if the rays stay in the lower part of the frequencies, else one."""
    tracks, request = diagram.tracks, diagram.request
    top = 1.06 * float(np.nanmax(tracks.frequencies))
    ray = max(request.per_rev, default=0) * request.speeds[-1]
    highest = np.nanmax(tracks.frequencies, axis=0)
    reached = highest[np.nanmin(tracks.frequencies, axis=0) < 1.1 * ray]
    split = 1.1 * max(ray, float(reached.max(initial=0.0)))
    lowest = np.sort(np.nanmin(tracks.frequencies, axis=0))
    if not len(reached) or split > SQUEEZED * top or not (lowest > split).any():
        return [(0.0, top * units.frequencies)]
    top = highest.max() + 0.18 * (highest.max() - split)  # room for the labels
    return [(0.0, split * units.frequencies), (split * units.frequencies, float(top) * units.frequencies)]


def _panel(axes: Axes, diagram: Campbell, units: Units, limits: tuple[float, float]) -> None:
    """Draw the modes within the given limits of frequency, labelled at their right ends."""
    speeds = np.array(diagram.request.speeds) * units.speeds
    axes.set_xlim(speeds[0], speeds[-1])
    axes.set_ylim(*limits)
    band(axes, diagram, units)
    ends = [end for t in range(diagram.tracks.count) for end in _mode(axes, diagram, t, units)]
    marks(axes, diagram, units)
    label_ends(axes, [end for end in ends if limits[0] < end[0] <= limits[1]])


def _below(diagram: Campbell, units: Units) -> str:
    request = diagram.request
    mesh = f"accuracy {request.accuracy:g}" if request.elements is None else f"{request.elements} elements"
    words = [f"{len(request.speeds)} speeds, {mesh}"]
    if len(diagram.tracks.omega) > len(request.speeds):
        inserted = len(diagram.tracks.omega) - len(request.speeds)
        words[0] += f", {inserted} intermediate {'speed' if inserted == 1 else 'speeds'} where modes come close"
    if request.operating:
        low, high = (o * units.speeds for o in request.operating)
        words.append(f"operating {low:.4g} to {high:.4g} {units.speed}, margin {request.margin}")
    if any(request.gravity):
        words.append("under gravity")
    if request.load:
        words.append("under the load given")
    return "; ".join(words)


def _mode(axes: Axes, diagram: Campbell, t: int, units: Units) -> list[tuple[float, str, str]]:
    """Draw one track; return the label at its end, or nothing if the track ends earlier."""
    tracks = diagram.tracks
    k = np.flatnonzero(tracks.mode_index[:, t] >= 0)
    omega, frequency = tracks.omega[k], tracks.frequencies[k, t]
    x, y = _fine(omega, frequency)
    fractions = np.stack([np.interp(x, omega, diagram.energy_fractions[k, t, i]) for i in range(4)], axis=1)
    near(axes, diagram, x, y, units)
    places = np.stack([x * units.speeds, y * units.frequencies], axis=1)
    for start, stop, pure in _stretches(fractions):
        part, share = places[start : stop + 1], fractions[start : stop + 1]
        if pure:
            axes.plot(*part.T, color=blend(share.mean(0)), lw=1.8, ls=DASHES[pure], zorder=4)
        else:
            segments = np.stack([part[:-1], part[1:]], axis=1)
            colours = [blend(s) for s in 0.5 * (share[1:] + share[:-1])]
            axes.add_collection(
                LineCollection(list(segments), colors=colours, linewidths=1.8, capstyle="round", zorder=4)
            )
    if k[-1] != len(tracks.omega) - 1:
        return []
    return [(places[-1, 1], _label(diagram, t, units), to_hex(blend(diagram.energy_fractions[-1, t])))]


def _label(diagram: Campbell, t: int, units: Units) -> str:
    frequency, uncertainty = diagram.tracks.frequencies[-1, t], diagram.tracks.uncertainty[-1, t]
    return f"{diagram.labels[t]}  {certain(float(frequency * units.frequencies), float(uncertainty), 4)}"


def _fine(omega: np.ndarray, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Interpolate between the solved points, linearly in the squares (Southwell)."""
    x = np.unique(np.concatenate([omega, np.linspace(omega[0], omega[-1], 241)]))
    return x, np.sqrt(np.interp(x**2, omega**2, frequency**2))


def _stretches(fractions: np.ndarray) -> list[tuple[int, int, str]]:
    """(first point, last point, family) of each stretch of a line; the family is empty where motions are mixed."""
    kind = np.where(fractions.max(1) >= PURE, fractions.argmax(1), -1)
    breaks = [0, *(np.flatnonzero(np.diff(kind)) + 1).tolist(), len(kind) - 1]
    return [(a, b, FAMILIES[kind[a]] if kind[a] >= 0 else "") for a, b in pairwise(breaks) if b > a]
