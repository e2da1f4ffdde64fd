"""Negative controls in words, in tables and as a figure: what each mistake gets wrong, and who catches it."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator

from ...cases.judge.results import Control, Run
from ...cases.judge.verdict import percent, unsigned
from ...cases.verify.controls import Outcome, Status, outcomes
from ...cases.verify.lumping import CASE, OMEGA
from ..shared.style import COLOURS, INK, MARKERS, WIDTH, beside, house, title
from ..shared.units import BY_KEY, RAD_S, Units

SIGN: dict[Status, str] = {"caught": "✔", "missed": "✘", "needs a case": "–", "needs a code": "○"}

FLOOR = 1e-5
"""Smaller changes, relative, are none."""


def said(outcome: Outcome) -> str:
    """What became of one mistake: ``✔ caught``, ``– needs case yoo-shin-chordwise/delta-0``."""
    sign = SIGN[outcome.status]
    match outcome.status:
        case "needs a case":
            return f"{sign} needs case {' or '.join(outcome.mistake.seen_in)}"
        case "needs a code":
            return f"{sign} needs a code that shares nothing with core, and answers"
        case status:
            return f"{sign} {status}"


def catchers(outcome: Outcome) -> list[str]:
    """Codes and tables that caught it anywhere in the run."""
    return list(dict.fromkeys(code for row in outcome.cases.values() for code in row.caught))


def largest(outcome: Outcome) -> Control | None:
    """The row with the largest change: of those caught, if any was."""
    rows = [r for r in outcome.cases.values() if r.change is not None]
    return max(rows, key=lambda r: (bool(r.caught), abs(r.change or 0.0)), default=None)


def headline(run: Run) -> str:
    """How many mistakes are caught, in a sentence; which are missed. Empty for a run without any."""
    found = outcomes(run.controls)
    caught = sum(o.status == "caught" for o in found)
    missed = ", ".join(o.mistake.name for o in found if o.status == "missed")
    if not found:
        return ""
    if missed:
        return f"**Negative controls: core made wrong on purpose is not noticed: {missed}.** This harness is blind."
    rest = f"; for the others see below ({len(found) - caught})" if caught < len(found) else ""
    return f"Negative controls: {caught} of {len(found)} deliberate mistakes in core are caught{rest}."


def overview(run: Run) -> list[dict[str, str]]:
    """A row a mistake: what is wrong, the largest change and where, and who caught it."""
    rows = []
    for outcome in outcomes(run.controls):
        worst = largest(outcome)
        rows.append(
            {
                "core made wrong": outcome.mistake.name,
                "how": outcome.mistake.what,
                "outcome": said(outcome),
                "largest change": _largest(run, worst),
                "caught by": ", ".join(catchers(outcome)),
            }
        )
    return rows


def _largest(run: Run, row: Control | None) -> str:
    if row is None:
        return "no steady state is left"
    change = row.change or 0.0
    return f"{percent(change)}: {_where(run, row)}" if abs(change) >= FLOOR else "none"


def by_case(run: Run) -> list[dict[str, str]]:
    """Mistake × blade: the largest change, at which speed, and how many of those that answered caught it."""
    found = outcomes(run.controls)
    blades = list(dict.fromkeys(r.case for r in run.controls))
    return [
        {"core made wrong": outcome.mistake.name} | {blade: _entry(run, outcome.cases.get(blade)) for blade in blades}
        for outcome in found
    ]


def _entry(run: Run, row: Control | None) -> str:
    if row is None:
        return ""
    if row.change is None:
        return "no steady state"
    if abs(row.change) < FLOOR:
        return "unchanged"
    asked = len(row.caught) + len(row.missed)
    told = f"caught by {len(row.caught)} of {asked}" if asked else "nobody to tell"
    return f"{percent(row.change)}<br>{row.mode}, {_units(run, row.case).at(row.omega)}<br>{told}"


def sentence(run: Run) -> str:
    """Why the paper's own case is not enough: Coriolis left out, at the speed of its table; empty without that row."""
    rows = [r for r in run.controls if r.control == "no Coriolis" and r.change is not None]
    paper = next((r for r in rows if (r.case, r.omega) == (CASE, OMEGA)), None)
    worst = max(rows, key=lambda r: abs(r.change or 0.0), default=None)
    if paper is None or worst is None or not paper.missed or paper.caught:
        return ""
    return (
        f"The paper's own case cannot see everything: at {OMEGA:g} rad/s, leaving out the Coriolis force changes no frequency "
        f"of {CASE} by more than {unsigned(paper.change or 0.0)}, and none of the {len(paper.missed)} independent answers "
        f"there notices. In this run it is worth {percent(worst.change or 0.0)} at most: {_where(run, worst)}."
    )


def _where(run: Run, row: Control) -> str:
    return f"{row.case}, {row.mode}, {_units(run, row.case).at(row.omega)}"


def _units(run: Run, case: str) -> Units:
    return next((BY_KEY[s.unit] for s in run.settings if s.case == case), RAD_S)


def mistakes(run: Run, case: str, units: Units) -> Figure | None:
    """What a program with each mistake gets wrong over the speeds of a case: the largest relative error of its modes.

    Hollow where no independent answer notices; a line ends where the mistake leaves no steady state. None if the case has
    fewer than two speeds.
    """
    rows = [r for r in run.controls if r.case == case]
    speeds = sorted({r.omega for r in rows})
    names = list(dict.fromkeys(r.control for r in rows))
    seen = {name: [r for r in rows if r.control == name and abs(r.change or 0.0) >= FLOOR] for name in names}
    if len(speeds) < 2 or not any(seen.values()):
        return None
    targets = sorted({c.target for c in run.cells if c.case == case and c.shares == "nothing"})
    with house():
        figure = Figure((WIDTH, 4.2))
        axes = figure.add_axes((0.1, 0.125, 0.64, 0.72))
        axes.set_yscale("log")
        top = max(abs(r.change or 0.0) for r in rows)
        axes.set_ylim(FLOOR, 10.0 ** np.ceil(np.log10(1.2 * top)))
        axes.set_xlim(0, 1.03 * speeds[-1] * units.speeds)
        for target in targets:
            axes.axhline(target, color=INK, lw=1.2, zorder=1)
            axes.annotate(f"target {unsigned(target)}", (0, target), (4, 3), textcoords="offset points", size=8)
        ends: list[tuple[float, str, str]] = []
        for k, name in enumerate(names):
            if mine := seen[name]:
                _line(axes, mine, units, k)
                last = mine[-1]
                short = "" if last.omega == speeds[-1] else f", to {units.at(last.omega)}"
                ends.append((abs(last.change or 0.0), f"{name}{short}", COLOURS[k % len(COLOURS)]))
        beside(axes, ends, size=8)
        axes.yaxis.set_major_locator(LogLocator(numticks=12))
        axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{100 * y:g} %"))
        axes.set_xlabel(units.speed_label)
        axes.set_ylabel("largest error of the modes compared")
        unseen = ", ".join(name for name in names if not seen[name])
        below = "core made wrong on purpose against core as it is; hollow: no independent answer notices" + (
            f"; no change: {unseen}" if unseen else ""
        )
        title(figure, f"{case}: what programs that leave these out get wrong", below)
    return figure


def _line(axes: Axes, rows: Sequence[Control], units: Units, k: int) -> None:
    """A line over the speeds; markers hollow where nobody notices."""
    colour, marker = COLOURS[k % len(COLOURS)], MARKERS[k % len(MARKERS)]
    speeds, sizes = [r.omega * units.speeds for r in rows], [abs(r.change or 0.0) for r in rows]
    axes.plot(speeds, sizes, color=colour, lw=1.2, zorder=3)
    for x, y, row in zip(speeds, sizes, rows, strict=True):
        axes.plot([x], [y], marker, ms=5, mfc=colour if row.caught else "white", mec=colour, zorder=4)
