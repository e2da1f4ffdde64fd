"""The figure of the paper's lumped mass: the error by cause, and how each cause converges."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator, NullLocator

from ...cases.verify.lumping import CASE, OMEGA
from ..shared.style import FAINT, INK, WIDTH, beside, house, title
from .lumped import BOTH, EXACT, FRAME, LOOKS, MASS, PAPER, Taken


def lumping(found: Taken) -> Figure:
    """Draw the error at the paper's 50 elements by cause (left), and how each cause converges (right)."""
    with house():
        figure = Figure((WIDTH, 4.0))
        left = figure.add_axes((0.115, 0.125, 0.4, 0.64))
        right = figure.add_axes((0.6, 0.125, 0.205, 0.64))
        _parts(left, found)
        _falling(right, found)
        fractions = ", ".join(f"{100 * s:.0f} %" for s in found.fractions)
        about = f"{CASE}, {OMEGA:g} rad/s, edgewise modes 1 to {len(found.fractions)}; from core with its switches"
        title(figure, f"How much of the error is the lumped mass? {fractions}", about)
    return figure


def _parts(axes: Axes, found: Taken) -> None:
    modes = range(len(found.fractions))
    parts = {name: 100 * found.at(name) for name in (MASS, FRAME)}
    base = np.zeros(len(found.fractions))
    for name, part in parts.items():
        label, colour, _ = LOOKS[name]
        axes.barh(modes, part, 0.4, left=base, color=colour)
        for k in modes:
            axes.annotate(_signed(part[k]), (base[k] + part[k] / 2, k + 0.33), ha="center", va="center", size=7.5)
        end = (base[-1] + part[-1] / 2, len(found.fractions) - 0.33)
        axes.annotate(label, end, ha="center", va="center", size=7.5, color=colour, weight="bold")
        base = base + part
    for k, both in enumerate(100 * found.at(BOTH)):
        axes.plot([both], [k], "|", ms=24, mew=2.2, color=INK)
        axes.annotate(f"{_signed(both)} %", (both, k - 0.36), ha="center", va="center", size=8, weight="bold")
    axes.set_yticks(modes, [f"edgewise {k + 1}" for k in modes])
    axes.tick_params(axis="y", length=0)
    axes.set_ylim(len(modes) - 0.1, -0.6)
    axes.set_xlim(122 * found.at(BOTH).min(), 0)
    axes.xaxis.set_major_locator(MultipleLocator(0.05))
    axes.set_xlabel("error, %")
    axes.set_title(f"{PAPER} elements: bars, each alone; tick, both", size=9)


def _signed(percent: float) -> str:
    return f"{percent:+.3f}".replace("-", "−")


def _falling(axes: Axes, found: Taken) -> None:
    axes.axvline(PAPER, color=FAINT, lw=1.0, zorder=1)
    axes.set_xscale("log")
    axes.set_yscale("log")
    ends = []
    for name, (label, colour, marker) in LOOKS.items():
        shown = slice(None, -2 if name == EXACT else None)  # EXACT is compared with its finest refinement
        n, error = found.elements[shown], np.abs(found.errors[name][shown, -1])
        axes.plot(n, error, color=colour, marker=marker, ms=4, mfc="white", lw=1.1)
        order = -np.polyfit(np.log(n), np.log(error), 1)[0]
        ends.append((float(error[-1]), f"{label}: order {order:.1f}", colour))
    beside(axes, ends, size=8)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(found.elements, [str(n) for n in found.elements])
    axes.set_xlabel("elements")
    axes.set_ylabel("|error|, relative")
    axes.set_title(f"edgewise {len(found.fractions)}, refined", size=9)
