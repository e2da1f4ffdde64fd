"""``southwell validate``: writes the page that compares measured rotors with their models."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter
from matplotlib.figure import Figure

from ...cases.input import atomic
from ...cases.input.writing import writable
from ...cases.judge.measured import COVERAGE
from ...cases.validation import comparison, rotating_beams, sandia34
from ...cases.validation.comparison import Simulated
from ...cases.validation.points import Point
from ..shared.console import output
from ..shared.markdown import plain, table
from ..shared.style import COLOURS, MARKERS, MUTED, WIDTH, plot_style, svg
from . import beam_section
from .tables import by_line, every

PAGE, FIGURE = "validation.md", "validation.svg"


def command(*, out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("southwell-report")) -> int:
    """Compare models of measured rotors with their measurements.

    The comparison error E = S - D is compared with u_val (ASME V&V 20). The rotors are the Sandia 34 m vertical-axis test
    bed and the rotating beams of Epps and Chandra. The command writes validation.md and Campbell diagrams with the measured
    points, and takes several minutes. The status is 0 whatever the comparison shows.

    Parameters
    ----------
    out
        Output folder.
    """
    beams = {name: tuple(rotating_beams.points(name)) for name in rotating_beams.BEAMS}
    model = comparison.simulated()
    points = comparison.points(model)
    with writable(f"--out {out}"):
        out.mkdir(parents=True, exist_ok=True)
        for name, text in pages(model, points, beams).items():
            atomic.write(out / name, text)
    console = output()
    for rows in (summary(points), *(by_line(of_beam, {}) for of_beam in beams.values())):
        console.print(table(rows), markup=False, soft_wrap=True)
        console.print()
    console.print(f"{out / PAGE}", markup=False, soft_wrap=True)
    return 0


def pages(model: Simulated, points: Sequence[Point], beams: Mapping[str, Sequence[Point]]) -> dict[str, str]:
    """The page and its figures by file name; ``beams`` has the points of each kind of rotating beam."""
    parts = [_HEAD, _SANDIA, f"![Campbell diagram]({FIGURE})", table(summary(points)), _MODEL, every(points)]
    parts += beam_section.parts(beams)
    figures = {FIGURE: svg(figure(model, points)), beam_section.FIGURE: svg(beam_section.figure(beams))}
    return {PAGE: "\n\n".join(parts) + "\n", **figures}


def summary(points: Sequence[Point]) -> list[dict[str, str]]:
    """One row per measured line of the Sandia rotor."""
    return by_line(points, {line["name"]: plain(line["title"]) for line in comparison.data()["lines"]})


def figure(model: Simulated, points: Sequence[Point]) -> Figure:
    """Draw measured points and the model's frequencies against rotor speed."""
    with plot_style():
        fig = Figure(figsize=(WIDTH, 5.2), layout="constrained")
        axes = fig.add_subplot()
        rpm = np.linspace(0.0, comparison.SPEEDS[-1], 81)
        for k, line in enumerate(comparison.data()["lines"]):
            measured = [p for p in points if p.line == line["name"]]
            colour = COLOURS[k % len(COLOURS)]
            for name in line["of"]:
                f = [comparison.at_speed([at[name] for at in model.base], x)[0] for x in rpm]
                axes.plot(rpm, f, color=colour, linewidth=1.2)
            axes.errorbar(
                [p.rpm for p in measured],
                [p.validation.measured for p in measured],
                yerr=[COVERAGE * p.validation.data for p in measured],
                fmt=MARKERS[k % len(MARKERS)],
                color=colour,
                markersize=5,
                elinewidth=0.8,
                label=f"{line['name']}: {line['title']}",
            )
        axes.set(xlabel="rotor speed, rpm", ylabel="frequency, Hz", xlim=(-0.02 * rpm[-1], None), ylim=(0, None))
        axes.set_title("Sandia 34 m test bed: measured (points, ± 2 u_D) and simulated (lines)")
        axes.grid(color=MUTED, alpha=0.15)
        fig.legend(loc="outside lower center", ncols=3, fontsize=8)
    return fig


_HEAD = f"""# Measured rotors

A measurement does not confirm or contradict a solver; it shows how far the *model* is from the rotor. The comparison error
E = S − D contains the model error and three uncertainties: of the numerical solution (u_num), of the inputs (u_input), and of
the data (u_D). With u_val² = u_num² + u_input² + u_D², the model error is visible where |E| exceeds
{COVERAGE:g} u_val (ASME V&V 20-2009, sec. 1-5). All values are in Hz."""

_SANDIA = f"""## The Sandia 34 m vertical-axis test bed

The test bed has two curved blades and four struts on a tower. The model was written from the published section data before
the measured frequencies were looked at, and has not been adjusted since.

Source: {sandia34.data()["citation"]}; data {comparison.data()["provenance"]}."""

_ASSUMED = sandia34.data()["uncertainty"]

_MODEL = f"""### What the model assumes

- The guy wires are rigid: the tower top is free only in yaw. The frequencies of the tower modes are therefore too high.
- The uncertainty of the inputs is not published. The assumed standard uncertainties are
  {100 * _ASSUMED["stiffness"]:g} % of all stiffness and {100 * _ASSUMED["mass"]:g} % of all mass.
- The mass matrices of the source place the mass centre outside the profile, across the chord. Stiffness and mass are those of
  one material, so the model has the mass centre at the tension centre. The change to either reading of the printed number is
  part of u_input.
- u_num contains the change when every element is halved, extrapolated with order {comparison.ORDER}; the error of the
  interpolation between the speeds at which the model is solved ({", ".join(f"{rpm:g}" for rpm in comparison.SPEEDS)} rpm); and
  half the distance between two modes where a measured line may be either of them.
- u_D is {comparison.data()["uncertainty"]:g} Hz: half the smallest scatter of repeated measurements at one speed."""
