"""The results of a mechanism as tables and as JSON: modes, steady state, coordinates, redundant constraints."""

from typing import Any

import numpy as np
from rich import box
from rich.markup import escape
from rich.table import Table

from ....core.element.measures import LARGE_STRAIN
from ....core.multibody import Solution
from ...shared.certain import certain, relative

ROTATIONS = (".rx", ".ry", ".rz")


def modes(solution: Solution, title: str) -> Table:
    """The table of modes: frequency, damping ratio and dominant coordinate, without digits dominated by rounding error."""
    out = Table(box=box.SIMPLE_HEAD, title=escape(title), title_justify="left", title_style="bold")
    for head in ("mode", "rad/s", "Hz", "damping ratio", "± rounding"):
        out.add_column(head, justify="right")
    out.add_column("largest motion")
    for row in _rows(solution):
        uncertainty = np.inf if row["relative_uncertainty"] is None else row["relative_uncertainty"]
        numbers = (certain(row["frequency_rad_s"], uncertainty), certain(row["frequency_hz"], uncertainty))
        grows = row["damping_ratio"] < -max(1e-9, uncertainty)
        ratio = (_ratio(row["damping_ratio"], uncertainty), relative(uncertainty))
        out.add_row(str(row["mode"]), *numbers, *ratio, escape(row["led_by"]) + ("; grows" if grows else ""))
    return out


def _ratio(damping: float, uncertainty: float) -> str:
    """The damping ratio with at most six decimals, none of them uncertain."""
    if not uncertainty < 0.5:
        return "?"
    places = 6 if uncertainty <= 1e-6 else int(-np.ceil(np.log10(uncertainty)))
    return f"{round(damping, places) + 0.0:.{places}f}"


ROUNDING = 1e-14
"""Smaller values (m or rad) are rounding of zero and shown as 0; ``--json`` has them."""


def state(solution: Solution) -> Table:
    """The table of coordinates: steady value, and whether the coordinate is independent, dependent or prescribed."""
    out = Table(box=box.SIMPLE_HEAD, title="steady state", title_justify="left", title_style="bold")
    out.add_column("coordinate")
    out.add_column("value", justify="right")
    out.add_column("")
    out.add_column("in vibration")
    for name, value in solution.steady.items():
        text = f"{value:.7g}" if abs(value) > ROUNDING else "0"
        out.add_row(escape(name), text, "rad" if name.endswith(ROTATIONS) else "m", _roles(solution)[name])
    return out


def redundant(solution: Solution) -> str:
    """One line on the redundant constraints."""
    if not solution.redundant:
        return "redundant constraints: none"
    return f"redundant constraints: {len(solution.redundant)}: {', '.join(solution.redundant)}"


def notes(solution: Solution) -> list[str]:
    """Explanation of the uncertainties, and a remark on a large steady strain."""
    legend = "± rounding: relative for frequencies, absolute for damping ratios; "
    if not all(beam.beams.bushings.all() for beam in solution.linear.tree.mechanism.beams):
        out = [
            legend
            + "each beam is one element: the error of this discretisation is not included; divide the beams to see it"
        ]
    else:
        out = [legend + "nothing is discretised, so there is no other numerical error"]
    if solution.strain > LARGE_STRAIN:
        out.append(
            f"steady strain up to {solution.strain:.1%}: above {LARGE_STRAIN:.0%}, check that linear elastic sections describe "
            "the beams"
        )
    return out


def plain(name: str, solution: Solution) -> dict[str, Any]:
    """All results as numbers, strings and lists."""
    return {
        "name": name,
        "modes": _rows(solution),
        "steady": solution.steady,
        "independent": list(solution.independent),
        "redundant": list(solution.redundant),
        "steady_strain": solution.strain,
    }


def _rows(solution: Solution) -> list[dict[str, Any]]:
    return [
        {
            "mode": k,
            "frequency_rad_s": abs(value),
            "frequency_hz": abs(value) / (2 * np.pi),
            "damping_ratio": float(damping),
            "relative_uncertainty": float(uncertainty) if np.isfinite(uncertainty) else None,
            "led_by": led_by,
        }
        for k, (value, damping, uncertainty, led_by) in enumerate(
            zip(solution.values.tolist(), solution.damping, solution.uncertainty, solution.leading, strict=True), 1
        )
    ]


def _roles(solution: Solution) -> dict[str, str]:
    part, names = solution.linear.partition, solution.coordinates
    follows = {names[j] for j in part.dependent}
    return {
        name: "independent" if name in solution.independent else "follows" if name in follows else "prescribed"
        for name in names
    }
