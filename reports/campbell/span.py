"""The figure of a blade's properties along the span: mass, stiffness, twist, centres, and the reference axis."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...cases.input.properties import SectionProperties, sections
from ...core.blade import Blade
from ..shared.style import COLOURS, MUTED, WIDTH, decades, plot_style, power, save

Array = NDArray[np.float64]
Lines = list[tuple[str, Array]]

DECADES = 30.0
"""Ratio of the largest to the smallest stiffness above which their axis is logarithmic."""


def draw(blade: Blade) -> Figure:
    """Draw six panels over the arc length, one quantity each; rigid stiffness is labelled, not drawn."""
    sampled = sections(blade)
    y, z = (blade.curve[:, k] for k in (1, 2))
    stiffness: Lines = [("flap EI", sampled.EI_flap), ("edge EI", sampled.EI_edge), ("torsion GJ", sampled.GJ)]
    panels: list[tuple[str, str, Lines, bool]] = [
        ("Mass", "kg/m", [("", blade.mass[:, 0, 0])], False),
        ("Stiffness", "N m²", stiffness, True),
        ("Axial stiffness EA", "N", [("", sampled.EA)], True),
        ("Twist", "degrees, y towards z", [("", np.degrees(blade.twist))], False),
        ("Centres, towards the leading edge", "m from the reference axis", _centres(sampled, 0), False),
        (
            "Reference axis",
            "m from the blade's axis",
            [("prebend z, downwind", z), ("sweep y, leading edge", y)],
            False,
        ),
    ]
    with plot_style():
        figure = Figure(figsize=(WIDTH, 7.2))
        figure.suptitle(f"{blade.name}: properties along the span", x=0.01, ha="left", fontweight="bold", fontsize=11.5)
        figure.subplots_adjust(0.095, 0.07, 0.985, 0.91, 0.24, 0.34)
        for axes, (title, unit, lines, log) in zip(figure.subplots(3, 2).flat, panels, strict=True):
            exponent = _exponent(lines) if log else 0
            _panel(axes, blade.stations, [(name, values / 10.0**exponent) for name, values in lines], log)
            axes.set_title(title)
            axes.set_ylabel(f"{power(exponent)} {unit}" if exponent else unit)
        for axes in figure.axes[-2:]:
            axes.set_xlabel("arc length from the root, m")
    return figure


def _centres(sampled: SectionProperties, k: int) -> Lines:
    return [(name, getattr(sampled, f"{name}_centre")[:, k]) for name in ("mass", "tension", "shear")]


def _finite(lines: Lines) -> Array:
    return np.concatenate([values[np.isfinite(values)] for _, values in lines])


def _exponent(lines: Lines) -> int:
    """The power of ten of an axis's unit; 0 for short labels, and for a logarithmic axis, whose labels are powers of ten."""
    finite = _finite(lines)
    if not finite.size or _logarithmic(finite) or 0.1 <= finite.max() < 1e4:
        return 0
    return int(np.floor(np.log10(finite.max())))


def _logarithmic(values: Array) -> bool:
    return bool(values.max() > DECADES * values.min())


def _panel(axes: Axes, s: Array, lines: Lines, log: bool) -> None:
    dashes = ("-", (0, (5, 2)), (0, (1, 1.5)))
    for k, (name, values) in enumerate(lines):
        is_finite = np.isfinite(values)
        label = name if is_finite.all() else f"{name} rigid".strip()
        axes.plot(s[is_finite], values[is_finite], color=COLOURS[k], linestyle=dashes[k], linewidth=1.5, label=label)
    finite = _finite(lines)
    if log and finite.size:
        if _logarithmic(finite):
            axes.set_yscale("log")
            decades(axes.yaxis, 6)
        else:
            axes.set_ylim(0, 1.1 * finite.max())
    elif not log and finite.size and np.abs(finite).max() < 1e-9:
        axes.set_ylim(-1, 1)
        axes.text(0.5, 0.6, "zero throughout", transform=axes.transAxes, ha="center", color=MUTED)
    if not finite.size:
        axes.set_yticks([])
        axes.text(0.5, 0.5, "rigid", transform=axes.transAxes, ha="center", color=MUTED)
    axes.set_xlim(0, s[-1])
    if any(name for name, _ in lines):
        axes.legend(loc="best", fontsize=8)


def write(blade: Blade, folder: Path) -> tuple[Path, Path]:
    """Write ``span.svg`` and ``span.png`` and return their paths."""
    return save(draw(blade), folder / "span")
