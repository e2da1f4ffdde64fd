"""The rotating beams of Epps and Chandra compared with their models: a part of the page of measured rotors."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from ...cases.judge.measured import COVERAGE
from ...cases.validation import rotating_beams
from ...cases.validation.points import Point
from ..shared.markdown import plain, table
from ..shared.style import COLOURS, MARKERS, MUTED, WIDTH, plot_style
from .tables import by_line, every

FIGURE = "validation-beams.svg"


def parts(beams: Mapping[str, Sequence[Point]]) -> list[str]:
    """Paragraphs of the page; ``beams`` has the points of each kind of beam."""
    out = [_HEAD, f"![Campbell diagrams]({FIGURE})"]
    for name, points in beams.items():
        of_beam = rotating_beams.data()[name]
        heading = of_beam["title"][0].upper() + of_beam["title"][1:]
        out += [
            f"### {plain(heading)}",
            f"Source: {plain(of_beam['provenance'])}.",
            table(by_line(points, {})),
            every(points),
        ]
    return out


def figure(beams: Mapping[str, Sequence[Point]]) -> Figure:
    """Draw one panel per beam: measured points, and core's frequencies joined by straight lines in Ω² and ω²."""
    panels = [
        (f"{name}, {sweep:g}°" if len(d["sweep"]) > 1 else name, [p for p in points if _of_sweep(p, sweep)])
        for name, points in beams.items()
        for d in [rotating_beams.data()[name]]
        for sweep in d["sweep"]
    ]
    with plot_style():
        fig = Figure(figsize=(WIDTH, 6.0), layout="constrained")
        for k, (heading, points) in enumerate(panels, 1):
            rpm_max = max(p.rpm for p in points)
            axes = fig.add_subplot(-(-len(panels) // 3), 3, k)
            for j, line in enumerate(dict.fromkeys(p.line for p in points)):
                measured = [p for p in points if p.line == line]
                rpm, f = np.array([p.rpm for p in measured]), np.array([p.validation.simulated for p in measured])
                fine = np.linspace(rpm[0], rpm[-1], 81)
                colour = COLOURS[j % len(COLOURS)]
                axes.plot(fine, np.sqrt(np.interp(fine**2, rpm**2, f**2)), color=colour, linewidth=1.2)
                bars = [COVERAGE * p.validation.data for p in measured]
                D = [p.validation.measured for p in measured]
                axes.errorbar(rpm, D, yerr=bars, fmt=MARKERS[j], color=colour, markersize=4, elinewidth=0.8)
            axes.set(
                xlabel="rotor speed, rpm",
                ylabel="frequency, Hz",
                xlim=(-0.03 * rpm_max, None),
                ylim=(0, None),
                title=heading,
            )
            axes.grid(color=MUTED, alpha=0.15)
        fig.suptitle("Epps and Chandra's beams, flapwise: measured (points, ± 2 u_D) and simulated (lines)")
    return fig


def _of_sweep(point: Point, sweep: float) -> bool:
    """Whether a point belongs to the beam with this sweep; beams without sweep have no angle."""
    return "°" not in point.line or point.line.endswith(f" {sweep:g}°")


_ASSUMED = rotating_beams.data()["uncertainty"]

_HEAD = f"""## The rotating beams of Epps and Chandra

The beams are thin strips, clamped at a distance from the rotor axis. The aluminium strips have a swept tip. The measurements
were known before the models were written, but the models have no free parameters: they are the beams as printed, and none was
adjusted. The paper itself was not available; the secondary source is named with each beam.

Source: {rotating_beams.data()["citation"]}.

- The assumed standard uncertainties of the inputs are {100 * _ASSUMED["stiffness"]:g} % of all stiffness (1 % of the
  thickness) and {100 * _ASSUMED["mass"]:g} % of all mass. The clamp, the hub radius and the speed are treated as exact.
- u_num is the uncertainty of Southwell's own solver after refinement.
- u_D is {rotating_beams.data()["aluminium"]["measured"]:g} Hz for the aluminium beams: the scatter of their first
  frequency, which hardly depends on the sweep. For the composite beam, whose frequencies were read off a figure,
  {rotating_beams.data()["composite"]["measured"]:g} Hz is assumed."""
