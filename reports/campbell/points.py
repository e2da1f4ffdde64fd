"""User results on a Campbell diagram: frequencies of a test rig or of another program."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ...cases.campbell.diagram import Campbell
from ...cases.judge.measured import COVERAGE
from ...cases.plan.user_results import UserFrequency, UserResults
from ..shared.style import INK, MARKERS
from ..shared.units import Units


def draw(axes: Axes, user_results: Sequence[UserResults], blade: str, units: Units) -> None:
    """Draw the points of each file; measured points have bars of two standard uncertainties."""
    for k, results in enumerate(user_results):
        points = _of(results, blade)
        bars = [COVERAGE * (r.value.uncertainty or 0.0) * r.value.value * units.frequencies for r in points]
        axes.errorbar(
            [r.omega * units.speeds for r in points],
            [r.value.value * units.frequencies for r in points],
            yerr=bars if results.measured else None,
            fmt=_marker(k),
            ms=4.5,
            mfc=INK if results.measured else "white",
            color=INK,
            elinewidth=0.9,
            capsize=2.0,
            zorder=6,
        )


def legend(user_results: Sequence[UserResults], blade: str) -> list[Line2D]:
    """A legend entry for each file with points of this blade."""
    return [
        Line2D(
            [],
            [],
            ls="",
            marker=_marker(k),
            ms=4.5,
            color=INK,
            mfc=INK if results.measured else "white",
            label=f"{results.name}, measured, ± 2 u_D" if results.measured else results.name,
        )
        for k, results in enumerate(user_results)
        if _of(results, blade)
    ]


def outside(user_results: Sequence[UserResults], diagram: Campbell, top: float) -> str:
    """How many points lie outside the diagram's speeds or above ``top`` (rad/s), as text; empty if none do."""
    low, high = diagram.request.speeds[0], diagram.request.speeds[-1]
    all_results = [r for results in user_results for r in _of(results, diagram.blade.name)]
    n = sum(r.omega < low - r.slack or r.omega > high + r.slack or r.value.value > top for r in all_results)
    return f"{n} of {len(all_results)} added points outside" if n else ""


def _of(results: UserResults, blade: str) -> list[UserFrequency]:
    return [row for row in results.rows if row.blade in ("", blade)]


def _marker(k: int) -> str:
    return MARKERS[(k + 1) % len(MARKERS)]
