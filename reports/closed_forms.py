"""Core against mechanisms that are known in closed form: a figure each, and the page that shows them."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullLocator
from numpy.typing import NDArray

from ..references.closed_forms import FORMS, ClosedForm, differences
from .markdown import plain, table
from .style import COLOURS, FAINT, INK, MARKERS, MUTED, WIDTH, beside, house, svg, title

Complex = NDArray[np.complex128]
Array = NDArray[np.float64]

FOLDER = "closed-forms"
"""Where the figures go, beside the page."""

FINE = 600
"""Points of a closed form's line."""

LEAST = 1e-17
"""Differences of nothing are drawn here."""


def pages() -> dict[str, str]:
    """The page, and its figures as SVG, by their paths."""
    out, parts, rows = {}, [_HEAD], []
    for form in FORMS:
        values, off = solved(form)
        out[f"{FOLDER}/{form.name}.svg"] = svg(figure(form, values, off))
        parts.append(_section(form))
        rows.append(
            {
                "mechanism": plain(form.title),
                "source": plain(form.source),
                "speeds": str(len(form.speeds)),
                "largest difference": f"{np.nanmax(off):.1e}",
            }
        )
    parts.insert(1, table(rows))
    return {"closed-forms.md": "\n\n".join(parts) + "\n"} | out


_HEAD = """# Closed forms

Core takes any mechanism, so it can be held to every one that is known in closed form. Those here turn, and each shows
something that a solver which only knows blades could not: critical speeds, a steady state away from the guess, loops. The
numbers and figures are made when this page is; the tests have more (double pendulum, slider-crank, four-bar, portal frame).

Lines: the closed form. Points: core. Below: the relative difference of the eigenvalues."""


def _section(form: ClosedForm) -> str:
    picture = f"![{form.title}: frequencies against speed]({FOLDER}/{form.name}.svg)"
    return f"## {form.title}\n\n$$\n{form.formula}\n$$\n\n{plain(form.about)}\n\n*Source:* {plain(form.source)}.\n\n{picture}"


def solved(form: ClosedForm) -> tuple[Complex, Array]:
    """Core's eigenvalues and their relative differences (speeds, branches)."""
    found = [differences(form, omega) for omega in form.speeds.tolist()]
    return np.array([values for values, _ in found]), np.array([off for _, off in found])


def figure(form: ClosedForm, values: Complex, off: Array) -> Figure:
    """Above, frequencies (and growth rates, where there are any) against speed; below, the differences on a log axis."""
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
    beside(axes, ends, size=8)
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
    axes.annotate(f"held to {form.target:.0e}", (0, form.target), (4, -10), textcoords="offset points", size=8)
    axes.set_ylim(max(LEAST, np.nanmin(off)) / 3, 10 * form.target)
    axes.yaxis.set_major_locator(LogLocator(numticks=5))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("speed, rad/s")
    axes.set_ylabel("difference")
