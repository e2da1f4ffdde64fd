"""Tables of measured points, shared by all measured rotors."""

from collections.abc import Mapping, Sequence

from ...cases.judge.measured import statement
from ...cases.validation.points import Point
from ..shared.markdown import table


def every(points: Sequence[Point]) -> str:
    """The table of all points of a rotor, in a collapsible section."""
    rows = [{"line": p.line, "rpm": f"{p.rpm:.1f}", **numbers(p), "": statement(p.validation)} for p in points]
    return f"<details><summary>Every point</summary>\n\n{table(rows)}\n\n</details>"


def numbers(p: Point) -> dict[str, str]:
    """A point's S, D, E and uncertainties, in Hz."""
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


def by_line(points: Sequence[Point], titles: Mapping[str, str]) -> list[dict[str, str]]:
    """One row per measured line, with its title if it has one."""
    rows = []
    for line in dict.fromkeys(p.line for p in points):
        measured = [p for p in points if p.line == line]
        off = [100.0 * p.validation.error / p.validation.measured for p in measured]
        visible_count = sum(p.validation.visible > 0.0 for p in measured)
        rows.append(
            {
                "line": line,
                **({"mode": titles[line]} if titles else {}),
                "points": str(len(measured)),
                "E, % of D": f"{min(off):+.1f} to {max(off):+.1f}".replace("-", "−"),
                "model error visible": f"{visible_count} of {len(measured)}",
            }
        )
    return rows
