"""The results of a mechanism as tables and as JSON: modes, steady state, coordinates, redundant constraints."""

from typing import Any

import numpy as np
from rich import box
from rich.table import Table

from ...core.multibody.solution import Solution

ROTATIONS = (".rx", ".ry", ".rz")


def modes(found: Solution, title: str) -> Table:
    """A row for each mode: frequency, damping ratio, the coordinate that leads."""
    out = Table(box=box.SIMPLE_HEAD, title=title, title_justify="left", title_style="bold")
    for head in ("mode", "rad/s", "Hz", "damping ratio"):
        out.add_column(head, justify="right")
    out.add_column("led by")
    for row in _rows(found):
        numbers = (f"{row['frequency_rad_s']:.7g}", f"{row['frequency_hz']:.7g}", f"{row['damping_ratio']:.6f}")
        out.add_row(str(row["mode"]), *numbers, row["led_by"] + ("; grows" if row["damping_ratio"] < -1e-9 else ""))
    return out


ROUNDING = 1e-14
"""Less than this, in m or rad, is what rounding leaves of zero; ``--json`` has it."""


def state(found: Solution) -> Table:
    """A row for each coordinate: its value in the steady state, and whether it is free to choose, follows, or is prescribed."""
    out = Table(box=box.SIMPLE_HEAD, title="steady state", title_justify="left", title_style="bold")
    out.add_column("coordinate")
    out.add_column("value", justify="right")
    out.add_column("")
    out.add_column("in vibration")
    for name, value in found.steady.items():
        shown = f"{value:.7g}" if abs(value) > ROUNDING else "0"
        out.add_row(name, shown, "rad" if name.endswith(ROTATIONS) else "m", _roles(found)[name])
    return out


def redundant(found: Solution) -> str:
    """One line on the redundant constraints."""
    if not found.redundant:
        return "redundant constraints: none"
    return f"redundant constraints: {len(found.redundant)}: {', '.join(found.redundant)}"


def plain(name: str, found: Solution) -> dict[str, Any]:
    """All of it as plain numbers, strings and lists."""
    return {
        "name": name,
        "modes": _rows(found),
        "steady": found.steady,
        "independent": list(found.independent),
        "redundant": list(found.redundant),
    }


def _rows(found: Solution) -> list[dict[str, Any]]:
    return [
        {
            "mode": k,
            "frequency_rad_s": abs(value),
            "frequency_hz": abs(value) / (2 * np.pi),
            "damping_ratio": float(damping),
            "led_by": led_by,
        }
        for k, (value, damping, led_by) in enumerate(
            zip(found.values.tolist(), found.damping, found.leading, strict=True), 1
        )
    ]


def _roles(found: Solution) -> dict[str, str]:
    part, names = found.linear.partition, found.coordinates
    follows = {names[j] for j in part.dependent}
    return {
        name: "independent" if name in found.independent else "follows" if name in follows else "prescribed"
        for name in names
    }
