"""Figures of core against closed-form solutions of mechanisms: frequencies above, differences below."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullLocator
from numpy.typing import NDArray

from ...cases.closed_forms.closed_forms import ClosedForm, differences
from ..shared.style import COLOURS, FAINT, INK, MARKERS, MUTED, WIDTH, decades, house, title
from ..shared.style import beside as labels

Complex = NDArray[np.complex128]
Array = NDArray[np.float64]

FINE = 600
"""Number of points on the curve of a closed form."""

LEAST = 1e-17
"""Lower limit of the differences drawn, for the log axis."""


def solved(form: ClosedForm) -> tuple[Complex, Array]:
    """Core's eigenvalues and their relative differences, both (speeds, branches)."""
    found = [differences(form, omega) for omega in form.speeds.tolist()]
    return np.array([values for values, _ in found]), np.array([off for _, off in found])


def figure(form: ClosedForm, values: Complex, off: Array) -> Figure:
    """Draw frequencies and growth rates against speed, and below them the differences on a log axis.

    Args:
        form: the closed-form solution.
        values: (speeds, branches) core's eigenvalues, NaN where a branch has none.
        off: (speeds, branches) their relative differences.
    """
    fine = np.linspace(form.speeds[0], form.speeds[-1], FINE)
    exact = np.array([form.exact(omega) for omega in fine.tolist()])
    with house():
        out = Figure((WIDTH, 4.9))
        above, below = out.add_axes((0.09, 0.38, 0.72, 0.5)), out.add_axes((0.09, 0.11, 0.72, 0.19))
        _frequencies(above, form, fine, exact, values)
        _differences(below, form, off)
        for axes in (above, below):
            axes.set_xlim(0.0, 1.02 * form.speeds[-1])
        title(out, form.title, "lines: closed form; points: core")
    return out


def _frequencies(axes: Axes, form: ClosedForm, fine: Array, exact: Complex, values: Complex) -> None:
    top = 1.06 * max(np.nanmax(exact.imag), np.nanmax(exact.real))
    axes.set_ylim(0.0, top)
    axes.set_xlim(0.0, 1.02 * form.speeds[-1])
    for omega in form.critical:
        axes.axvline(omega, color=FAINT, lw=1.0, zorder=1)
        axes.annotate(f"{omega:.3g}", (omega, top), (3, -9), textcoords="offset points", size=7.5, color=MUTED)
    ends = []
    for k, branch in enumerate(form.branches):
        colour, marker = COLOURS[k % len(COLOURS)], MARKERS[k % len(MARKERS)]
        grows, known = exact[:, k].real > 0, np.isfinite(exact[:, k])
        for part, rows, dashes in ((exact.imag, known & ~grows, "-"), (exact.real, known & grows, (0, (4, 2)))):
            axes.plot(fine, np.where(rows, part[:, k], np.nan), color=colour, lw=1.2, ls=dashes, zorder=2)
        there = values[np.isfinite(values[:, k].real), k]
        at = np.where(there.real > 1e-6 * np.abs(there), there.real, there.imag)
        axes.plot(
            form.speeds[np.isfinite(values[:, k].real)],
            at,
            ls="",
            marker=marker,
            ms=4.5,
            mfc="white",
            mec=colour,
            zorder=3,
            clip_on=False,
        )
        ends.append((float(exact[-1, k].imag), branch, colour))
    labels(axes, ends, size=8)
    axes.set_ylabel("|λ|, rad/s")
    if (exact.real > 0).any():
        axes.legend(
            handles=[
                Line2D([], [], color=INK, lw=1.2, label="oscillates"),
                Line2D([], [], color=INK, lw=1.2, ls=(0, (4, 2)), label="grows: 1/s"),
            ],
            loc="upper left",
        )


def _differences(axes: Axes, form: ClosedForm, off: Array) -> None:
    axes.set_yscale("log")
    for k in range(len(form.branches)):
        colour, marker = COLOURS[k % len(COLOURS)], MARKERS[k % len(MARKERS)]
        axes.plot(form.speeds, np.maximum(off[:, k], LEAST), ls="", marker=marker, ms=3.5, mfc="white", mec=colour)
    axes.axhline(form.target, color=INK, lw=1.2, zorder=1)
    axes.annotate(f"target {form.target:.0e}", (0, form.target), (4, -10), textcoords="offset points", size=8)
    axes.set_ylim(max(LEAST, np.nanmin(off)) / 3, 10 * form.target)
    decades(axes.yaxis, 5)
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("speed, rad/s")
    axes.set_ylabel("difference")
