"""Marks of a Campbell diagram: the operating range, rays of n per revolution, resonances, the legend, and colours."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D

from ...cases.campbell.diagram import Campbell
from ...core.participation import FAMILIES, MIXED
from ..shared.style import INK, MUTED
from ..shared.units import Units
from .tables import gap

FAMILY_COLOURS = {
    "flapwise": "#0072B2",
    "edgewise": "#D55E00",
    "torsion": "#009E73",
    "axial": "#CC79A7",
    MIXED: "#6b6b6b",
}
"""Colours by Okabe and Ito; a mixed mode has a blend of them."""

DASHES = {
    "flapwise": "-",
    "edgewise": (0, (7, 1.6)),
    "torsion": (0, (2, 1.2)),
    "axial": (0, (6, 1.5, 1.5, 1.5)),
    MIXED: "-",
}

RED, BAND = "#C1121F", "#EDF2F7"


def blend(share: Sequence[float] | np.ndarray) -> tuple[float, float, float]:
    """The colour (RGB) of energy fractions (4,): families weighted by their squares, so that a pure mode looks pure."""
    weight = np.square(np.nan_to_num(np.asarray(share, float)))
    colours = np.array([to_rgb(FAMILY_COLOURS[f]) for f in FAMILIES])
    red, green, blue = weight @ colours / max(float(weight.sum()), 1e-12)
    return float(red), float(green), float(blue)


def band(axes: Axes, diagram: Campbell, units: Units) -> None:
    """Shade the operating range."""
    if diagram.request.operating:
        low, high = (o * units.speeds for o in diagram.request.operating)
        axes.axvspan(low, high, color=BAND, lw=0, zorder=0)


def band_label(axes: Axes, diagram: Campbell, units: Units) -> None:
    """Label the operating range at the top."""
    if diagram.request.operating:
        low, high = (o * units.speeds for o in diagram.request.operating)
        box = {"facecolor": BAND, "edgecolor": "none", "pad": 1.0}
        axes.annotate(
            "operating",
            (0.5 * (low + high), 1.0),
            (0, -4),
            ("data", "axes fraction"),
            "offset points",
            ha="center",
            va="top",
            size=7.5,
            color=MUTED,
            bbox=box,
            zorder=2,
        )


def near(axes: Axes, diagram: Campbell, x: np.ndarray, y: np.ndarray, units: Units) -> None:
    """Underlay the stretches within the operating range that are nearer to n per revolution than the margin."""
    request = diagram.request
    if not request.operating:
        return
    low, high = request.operating
    grid = np.unique(np.concatenate([x[(x > low) & (x < high)], np.linspace(low, high, 401)]))
    line = np.interp(grid, x, y)
    rays = np.outer(request.per_rev, grid)
    is_close = (np.abs(line - rays) < np.vectorize(request.margin.distance)(rays)).any(0)
    marked = np.where(is_close, line, np.nan)
    axes.plot(
        grid * units.speeds, marked * units.frequencies, color=RED, lw=6.5, alpha=0.22, solid_capstyle="butt", zorder=3
    )


def marks(axes: Axes, diagram: Campbell, units: Units) -> None:
    """Draw resonances (filled circles within the operating range), crossings, veerings and unclear tracks."""
    request = diagram.request
    for r in diagram.resonances:
        inside = request.operating is not None and r.distance == 0.0
        axes.plot(
            r.omega * units.speeds,
            r.frequency * units.frequencies,
            marker="o",
            ms=5.5 if inside else 4.0,
            mfc=RED if inside else "white",
            mec="white" if inside else MUTED,
            mew=0.8,
            zorder=6,
        )
    for e in diagram.encounters:
        at = (e.omega * units.speeds, e.frequency * units.frequencies)
        veers = e.kind == "veering"
        axes.plot(
            *at, marker="D" if veers else "x", ms=7.5 if veers else 5, mfc="none", mec=INK, mew=1.0, zorder=5, ls=""
        )
        if veers:
            text = f"veering\ngap {gap(e, units, 2)} {units.frequency}"
            axes.annotate(
                text,
                at,
                (0, 13),
                textcoords="offset points",
                ha="center",
                va="bottom",
                size=7,
                color=INK,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.8},
                zorder=5,
            )
    for d in diagram.tracks.doubts:
        at = (d.omega[0] * units.speeds, d.frequency * units.frequencies)
        axes.annotate("?", at, ha="center", va="center", size=10, weight="bold", color=RED, zorder=7)


def legend(diagram: Campbell) -> list[Line2D]:
    """The legend's entries for what is in the diagram."""
    present = {family for ends in (0, -1) for family in diagram.labels.families[ends]}
    out: list[Line2D] = [
        Line2D([], [], color=FAMILY_COLOURS[f], lw=1.8, ls=DASHES[f], label=f) for f in FAMILIES if f in present
    ]
    if MIXED in present:
        out.append(Line2D([], [], color=blend([0.5, 0.5, 0.0, 0.0]), lw=1.8, label="mixed: blended"))
    dot = {"marker": "o", "ls": "", "mew": 0.8}
    if any(r.distance != 0.0 for r in diagram.resonances):
        out.append(Line2D([], [], ms=4.0, mfc="white", mec=MUTED, label="resonance", **dot))
    if any(r.distance == 0.0 for r in diagram.resonances):
        out.append(Line2D([], [], ms=5.5, mfc=RED, mec="white", label="resonance in operation", **dot))
    if any(not m.kept for m in diagram.margins):
        label = f"within {diagram.request.margin} of n per rev"
        out.append(Line2D([], [], color=RED, lw=6.5, alpha=0.22, label=label))
    for kind, marker, size in (("veering", "D", 6.5), ("crossing", "x", 5)):
        if any(e.kind == kind for e in diagram.encounters):
            label = f"{kind} of modes"
            out.append(Line2D([], [], ls="", marker=marker, ms=size, mfc="none", mec=INK, mew=1.0, label=label))
    if diagram.tracks.doubts:
        out.append(Line2D([], [], ls="", marker="$?$", ms=6, color=RED, label="continuation ambiguous"))
    return out
