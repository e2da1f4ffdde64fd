"""The effect of the paper's lumped mass and body-fixed beam stiffness on its frequencies, separately and together."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator, NullLocator

from ...cases.judge.results import Run
from ...cases.verify.lumping import CASE, MASSES, OMEGA, STIFFNESSES, variant
from ..shared.style import COLOURS, FAINT, INK, WIDTH, beside, house, title

PAPER = 50
"""Number of elements of the paper's cantilever."""

EXACT, FRAME, MASS, BOTH = (variant(mass, stiffness) for mass in MASSES for stiffness in STIFFNESSES)
"""The four discretisations: neither change, the body-fixed stiffness, the lumped mass, both as in the paper."""

LOOKS = {
    BOTH: ("both (paper)", INK, "o"),
    MASS: ("lumped mass", COLOURS[0], "s"),
    FRAME: ("parent's frame", COLOURS[1], "^"),
    EXACT: ("neither", COLOURS[2], "D"),
}


@dataclass(frozen=True)
class Taken:
    """Relative errors of the four discretisations.

    Attributes:
        elements: (n,) numbers of elements.
        errors: by name, (n, modes) relative errors.
    """

    elements: np.ndarray
    errors: dict[str, np.ndarray]

    def at(self, name: str) -> np.ndarray:
        """The (modes,) errors at the paper's number of elements."""
        return self.errors[name][self.elements.tolist().index(PAPER)]

    @property
    def fractions(self) -> np.ndarray:
        """(modes,) fraction of the whole error due to the lumped mass, at the paper's number of elements."""
        return self.at(MASS) / self.at(BOTH)


def taken(run: Run) -> Taken | None:
    """The errors relative to the finest refinement of ``EXACT``; None if the run has no such rows."""
    rows = {name: [v for v in run.levels if v.case == CASE and v.code == name] for name in LOOKS}
    if not all(rows.values()):
        return None
    elements = sorted({v.elements for v in rows[EXACT]})
    modes = sorted({v.mode for v in rows[EXACT]})
    table = {name: {(v.elements, v.mode): v.frequency for v in found} for name, found in rows.items()}
    grid = {name: np.array([[f[n, m] for m in modes] for n in elements]) for name, f in table.items()}
    exact = grid[EXACT][-1]
    return Taken(np.array(elements), {name: f / exact - 1.0 for name, f in grid.items()})


def sentence(found: Taken) -> str:
    """One sentence: how much of the paper's error is due to lumping."""
    percent = ", ".join(f"{100 * s:.0f} %" for s in found.fractions)
    return (
        f"With {PAPER} elements, lumping the mass causes {percent} of the error of edgewise modes 1 to {len(found.fractions)}; "
        "the rest is due to a beam stiffness that is linear in the parent body's frame."
    )


def lumping(run: Run) -> Figure | None:
    """Draw the error at the paper's 50 elements by cause (left), and how each cause converges (right)."""
    found = taken(run)
    if found is None:
        return None
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
