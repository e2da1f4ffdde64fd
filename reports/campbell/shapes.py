"""Mode shapes of a Campbell diagram: figures, polynomial coefficients, and CSV."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ...cases.campbell.diagram import Campbell
from ...cases.input import atomic
from ...cases.writers.elastodyn_shapes import ELASTODYN_NAMES, POWERS, Polynomial
from ...core.modes import STATIONS
from ...core.participation import describe_fractions, gyration, in_blade_axes
from ..shared.certain import certain
from ..shared.sheets import Sheet
from ..shared.style import FAINT, MUTED, WIDTH, key, plot_style, spread, title
from ..shared.units import Units
from .marks import DASHES, FAMILY_COLOURS

Complex = NDArray[np.complex128]

ACROSS = 3

FINE = np.linspace(0.0, 1.0, 141)
"""Fractions of span at which lines are drawn, by cubic splines through the common stations."""

LAGGING = 0.02
"""Smallest imaginary part of a shape that is drawn."""

SEEN = 0.01
"""Smallest torsion that gets an axis, as a fraction of the panel's largest motion."""


def scaled(diagram: Campbell, k: int, arm: float = 0.0) -> tuple[list[int], Complex]:
    """The tracks at speed number ``k`` by frequency, and their shapes, complex (m, 21, 4), in the blade's axes.

    Each shape is scaled so that the largest component of any point is 1 m, real and positive: of the displacements, and of
    the rotation times ``arm`` (m).
    """
    tracks = diagram.tracks
    tracked = np.flatnonzero(tracks.mode_index[k] >= 0)
    order = tracked[np.argsort(tracks.mode_index[k, tracked])]
    shapes = in_blade_axes(tracks.solved[k], diagram.blade)[tracks.mode_index[k, order]]
    motions = shapes * [1.0, 1.0, 1.0, arm]
    farthest = np.abs(motions).reshape(len(order), -1).argmax(1)
    station, column = np.unravel_index(farthest, motions.shape[1:])
    pivot = motions[np.arange(len(order)), station, column]
    return order.tolist(), shapes * (np.exp(-1j * np.angle(pivot)) / np.abs(pivot))[:, None, None]


def draw(diagram: Campbell, k: int, units: Units, heading: str) -> Figure:
    """Draw one panel per mode: flapwise, edgewise and torsional motion along the span, at speed number ``k``.

    Torsion is a rotation, on an axis of its own at the right, in degrees. The scales of the two axes differ by the blade's
    radius of gyration: the square of each line, weighted with mass, is its fraction of the kinetic energy. Dotted lines are the
    part of a motion that is 90° out of phase.
    """
    arm = gyration(diagram.blade)
    order, shapes = scaled(diagram, k, arm)
    rows = -(-len(order) // ACROSS)
    with plot_style():
        low, panel = 0.75, 1.9
        height = low + 0.5 + rows * panel
        figure = Figure((WIDTH, height))
        for position, t in enumerate(order):
            row, column = divmod(position, ACROSS)
            left = 0.05 + column * 0.325
            bottom = (low + (rows - 1 - row) * panel + 0.12) / height
            axes = figure.add_axes((left, bottom, 0.205, (panel - 0.72) / height))
            _panel(axes, shapes[position], arm)
            hertz = diagram.tracks.frequencies[k, t] * units.frequencies
            name = diagram.labels.at(t, float(diagram.tracks.omega[k]))
            frequency = certain(float(hertz), float(diagram.tracks.uncertainty[k, t]), 4)
            axes.set_title(f"{name}   {frequency} {units.frequency}", size=9.5, pad=17)
            axes.annotate(
                describe_fractions(diagram.energy_fractions[k, t]),
                (0, 1),
                (0, 6),
                "axes fraction",
                "offset points",
                size=7.5,
                color=MUTED,
            )
            if row == rows - 1 or position + ACROSS >= len(order):
                axes.set_xlabel("fraction of span", size=8, labelpad=2)
            else:
                axes.set_xticklabels([])
        turns = "no torsional inertia in this file"
        if arm:
            turns = (
                f"torsion in degrees; {np.degrees(1.0 / arm):.3g}° is 1 m of arc at the radius of gyration, {arm:.3g} m"
            )
        title(figure, heading, f"{units.at(float(diagram.tracks.omega[k]))}; largest motion 1 m; {turns}")
        handles = [
            Line2D([], [], color=FAMILY_COLOURS[f], ls=DASHES[f], lw=1.6, label=f) for f in ("flapwise", "edgewise")
        ]
        if arm:
            handles.append(
                Line2D([], [], color=FAMILY_COLOURS["torsion"], ls=DASHES["torsion"], lw=1.6, label="torsion")
            )
        if np.abs(shapes.imag * [0.0, 1.0, 1.0, arm]).max() > LAGGING:
            handles.append(Line2D([], [], color=MUTED, ls=(0, (1, 2)), lw=1.0, label="90° out of phase"))
        key(figure, handles, 0.065)
    return figure


def _panel(axes: Axes, shape: Complex, arm: float) -> None:
    axes.axhline(0.0, color=FAINT, lw=0.8, zorder=1)
    axes.set_xlim(0, 1)
    axes.set_ylim(-1.12, 1.12)
    axes.set_yticks([-1, 0, 1])
    axes.tick_params(labelsize=8)
    ends: list[tuple[float, str]] = []
    for family, line in (("flapwise", shape[:, 2]), ("edgewise", shape[:, 1]), ("torsion", arm * shape[:, 3])):
        colour = FAMILY_COLOURS[family]
        if family == "torsion" and not arm:
            continue
        smooth = CubicSpline(STATIONS, line)(FINE)
        axes.plot(FINE, smooth.real, color=colour, lw=1.6, ls=DASHES[family], zorder=3, clip_on=False)
        if np.abs(line.imag).max() > LAGGING:
            axes.plot(FINE, smooth.imag, color=colour, lw=1.0, ls=(0, (1, 2)), zorder=2)
        ends.append((float(line[-1].real), family))
    heights = spread([y for y, _ in ends], 0.24)
    offset = 4
    if arm and np.abs(arm * shape[:, 3]).max() > SEEN:
        _degrees(axes, arm)
        offset = 28
    for y, (value, family) in zip(heights, ends, strict=True):
        text = f"{np.degrees(value / arm):+.2g}°" if family == "torsion" else f"{value:+.2f}"
        axes.annotate(
            text.replace("-", "−") if abs(value) >= 0.005 else "0",
            (1.0, y),
            (offset, 0),
            textcoords="offset points",
            va="center",
            size=7.5,
            color=FAMILY_COLOURS[family],
            annotation_clip=False,
        )


def _degrees(axes: Axes, arm: float) -> None:
    """An axis of rotations (degrees) at the right of a panel of displacements (m); ``arm`` (m) relates the two."""
    right = axes.twinx()
    right.set_ylim(*np.degrees(np.array(axes.get_ylim()) / arm))
    right.yaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 3, 5, 10], symmetric=True))
    right.yaxis.set_major_formatter(lambda value, _: f"{value:.3g}°".replace("-", "−"))
    right.spines["right"].set_visible(True)
    right.spines["right"].set_color(FAMILY_COLOURS["torsion"])
    right.tick_params(colors=FAMILY_COLOURS["torsion"], labelsize=7.5)


def coefficients(fitted: Sequence[Polynomial], blade_shapes: Sequence[Polynomial], units: Units, omega: float) -> Sheet:
    """The table of ElastoDyn's coefficients: of the principal blade, and for comparison of the unchanged blade."""
    rows = []
    for kind, group in (("for ElastoDyn", fitted), ("of the given blade", blade_shapes)):
        for p in group:
            numbers = [f"{c:.6f}".replace("-", "−") for c in p.coefficients]
            frequency = certain(p.frequency * units.frequencies, p.uncertainty)
            rows.append(
                (ELASTODYN_NAMES[p.mode], kind, frequency, *numbers, f"{100 * p.largest:.2f} %", f"{p.condition:.0f}")
            )
    head = ("shape", "which", units.frequency, *[f"x{'⁰¹²³⁴⁵⁶'[n]}" for n in POWERS], "fit error", "condition")
    note = (
        f"φ(x) = Σ c xᵏ over the fraction x of the flexible blade, {units.at(omega)}. φ(1) = 1: the printed coefficients add "
        "up to 1. For ElastoDyn: shapes of the blade without twist, pitch, torsion, shear, stretch, offsets and sectional "
        "inertia, because ElastoDyn applies the structural twist to the shapes itself. Of the given blade: displacement out "
        "of the plane of rotation (flap) or in it (edge). Positive is ElastoDyn's positive tip deflection. Fit error: the "
        "largest, relative to the tip displacement; condition: the largest factor by which an error of the shape grows in a "
        "coefficient."
    )
    return Sheet("ElastoDyn mode shapes", head, tuple(rows), note)


def write_csv(diagram: Campbell, k: int, folder: Path) -> Path:
    """Write ``shapes.csv``: one row per mode and station, in the blade's axes; return its path.

    Displacements are in m (largest 1), rotations in rad.

    Raises:
        OSError: if the file cannot be written.
    """
    order, shapes = scaled(diagram, k)
    path = folder / "shapes.csv"
    parts = [f"{component}_{part}" for component in ("axial", "edge", "flap", "torsion") for part in ("re", "im")]
    head = ["name", "frequency_rad_s", "relative_uncertainty", "omega_rad_s", "fraction", "span_m", *parts]
    rows: list[list[object]] = []
    for t, shape in zip(order, shapes, strict=True):
        uncertainty = f"{diagram.tracks.uncertainty[k, t]:.6g}"
        omega = float(diagram.tracks.omega[k])
        mode_facts = (diagram.labels.at(t, omega), float(diagram.tracks.frequencies[k, t]), uncertainty, omega)
        for x, motion in zip(STATIONS, shape, strict=True):
            numbers = [f"{v:.9g}" for z in motion for v in (z.real, z.imag)]
            rows.append([*mode_facts, f"{x:.2f}", f"{x * diagram.blade.length:.9g}", *numbers])
    atomic.write_csv(path, head, rows)
    return path
