"""The page of a measured rotor beside its model, and the command that writes it, ``southwell validate``."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter
from matplotlib.figure import Figure

from ...cases.input import atomic
from ...cases.input.errors import CaseError
from ...cases.judge.measured import COVERAGE, statement
from ...cases.validation import comparison, sandia34
from ...cases.validation.comparison import Point, Simulated
from ..shared.console import output
from ..shared.markdown import plain, table
from ..shared.style import COLOURS, MARKERS, MUTED, WIDTH, house, svg

PAGE, FIGURE = "validation.md", "validation.svg"


def command(*, out: Annotated[Path, Parameter(name=["--out", "-o"])] = Path("southwell-report")) -> int:
    """Compare the model of a measured rotor with its measurements.

    The comparison error E = S - D is set against u_val (ASME V&V 20). The rotor is the Sandia 34 m vertical-axis test
    bed. Writes validation.md and a Campbell diagram with the measured points. Takes several minutes. The status is 0
    whatever the comparison shows: a measurement is not a code.

    Parameters
    ----------
    out
        Output folder.
    """
    model = comparison.simulated()
    points = comparison.points(model)
    try:
        out.mkdir(parents=True, exist_ok=True)
        for name, text in pages(model, points).items():
            atomic.write(out / name, text)
    except OSError as error:
        raise CaseError(f"--out {out}: cannot be written ({error.strerror}): give another folder") from error
    console = output()
    console.print(table(summary(points)), markup=False, soft_wrap=True)
    console.print(f"{out / PAGE}", markup=False, soft_wrap=True)
    return 0


def pages(model: Simulated, points: Sequence[Point]) -> dict[str, str]:
    """The page and its figure, by file name."""
    every = [{"line": p.line, "rpm": f"{p.rpm:.1f}", **numbers(p), "": statement(p.validation)} for p in points]
    text = "\n\n".join(
        [_HEAD, f"![Campbell diagram]({FIGURE})", table(summary(points)), _MODEL, "## Every point", table(every)]
    )
    return {PAGE: text + "\n", FIGURE: svg(figure(model, points))}


def numbers(p: Point) -> dict[str, str]:
    """A point's S, D, E and uncertainties, Hz."""
    v = p.validation
    return {
        "S": f"{v.simulated:.3f}",
        "D": f"{v.measured:.3f}",
        "E": f"{v.error:+.3f}".replace("-", "−"),
        "u_num": f"{v.numerical:.3f}",
        "u_input": f"{v.inputs:.3f}",
        "u_D": f"{v.data:.3f}",
        "u_val": f"{v.uncertainty:.3f}",
    }


def summary(points: Sequence[Point]) -> list[dict[str, str]]:
    """One row per measured line."""
    rows = []
    for line in comparison.data()["lines"]:
        mine = [p for p in points if p.line == line["name"]]
        off = [100.0 * p.validation.error / p.validation.measured for p in mine]
        seen = sum(p.validation.visible > 0.0 for p in mine)
        rows.append(
            {
                "line": line["name"],
                "mode": plain(line["title"]),
                "points": str(len(mine)),
                "E, % of D": f"{min(off):+.1f} to {max(off):+.1f}".replace("-", "−"),
                "model error visible": f"{seen} of {len(mine)}",
            }
        )
    return rows


def figure(model: Simulated, points: Sequence[Point]) -> Figure:
    """Measured points and the model's frequencies over the rotor's speed."""
    with house():
        fig = Figure(figsize=(WIDTH, 5.2), layout="constrained")
        axes = fig.add_subplot()
        rpm = np.linspace(0.0, comparison.SPEEDS[-1], 81)
        for k, line in enumerate(comparison.data()["lines"]):
            mine = [p for p in points if p.line == line["name"]]
            colour = COLOURS[k % len(COLOURS)]
            for name in line["of"]:
                f = [comparison.at_speed([at[name] for at in model.base], x) for x in rpm]
                axes.plot(rpm, f, color=colour, linewidth=1.2)
            axes.errorbar(
                [p.rpm for p in mine],
                [p.validation.measured for p in mine],
                yerr=[COVERAGE * p.validation.data for p in mine],
                fmt=MARKERS[k % len(MARKERS)],
                color=colour,
                markersize=5,
                elinewidth=0.8,
                label=f"{line['name']}: {line['title']}",
            )
        axes.set(xlabel="rotor speed, rpm", ylabel="frequency, Hz", xlim=(0, None), ylim=(0, None))
        axes.set_title("Sandia 34 m test bed: measured (points, ± 2 u_D) and simulated (lines)")
        axes.grid(color=MUTED, alpha=0.15)
        fig.legend(loc="outside lower center", ncols=3, fontsize=8)
    return fig


_HEAD = f"""# A measured rotor

The Sandia 34 m vertical-axis test bed: two curved blades and four struts on a tower. Its model was written from the
published section data before the measured frequencies were looked at, and has not been adjusted since.

A measurement is not a code. It does not confirm or contradict core; it shows how far the *model* is from the rotor. The
comparison error E = S − D holds the model's error and three uncertainties: of the numerical solution (u_num), of the inputs
(u_input), and of the data (u_D). With u_val² = u_num² + u_input² + u_D², the model's error is visible where |E| exceeds
{COVERAGE:g} u_val (ASME V&V 20-2009, sec. 1-5). All values are in Hz.

Source: {sandia34.data()["citation"]}; data {comparison.data()["provenance"]}."""

_ASSUMED = sandia34.data()["uncertainty"]

_MODEL = f"""## What the model assumes

- The guys are rigid: the tower's top is free only in yaw. The tower's modes are therefore too high.
- The inputs' uncertainty is not published. Assumed, as one standard uncertainty:
  {100 * _ASSUMED["stiffness"]:g} % of all stiffness, {100 * _ASSUMED["mass"]:g} % of all mass.
- The source's mass matrices put the mass centre across the chord, where the profile is not thick enough for it. Stiffness and
  mass are those of one material, so the model has the mass centre at the tension centre. The change to either reading
  of the printed number enters u_input.
- u_num is the change from halving every element, and half the distance of two modes where a measured line may be either.
- u_D is {comparison.data()["uncertainty"]:g} Hz: half the least scatter of repeated measurements at one speed."""
