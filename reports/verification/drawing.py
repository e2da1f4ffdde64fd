"""The figures of a report as SVG. They are stored, and this module is imported only for figures that are not."""

from collections.abc import Callable, Sequence

from matplotlib.figure import Figure

from ...cases.judge.results import Run
from ..shared.style import svg
from ..shared.units import Units
from .convergence import convergence
from .figures import campbell, differences

Draw = Callable[[Run, str, Units, Sequence[str]], Figure | None]

FIGURES: dict[str, Draw] = {
    "campbell": campbell,
    "differences": differences,
    "convergence": convergence,
}
"""Figures of each blade, by the last part of the file name."""


def of_case(run: Run, case: str, units: Units, among: Sequence[str]) -> dict[str, str]:
    """The figures of one case, by kind."""
    figures = {kind: draw(run, case, units, among) for kind, draw in FIGURES.items()}
    return {kind: svg(figure) for kind, figure in figures.items() if figure}
