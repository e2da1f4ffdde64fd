"""Rows of a code that reads the deck itself; what its beam leaves out and core has is added to the uncertainty."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.solve import sweep
from ...references.protocol.interface import Deck
from ...references.protocol.process import Limits
from ...references.protocol.worker import Run as CodeRun
from ...references.protocol.worker import answers
from ..judge.cells import Head, Rows, join, joined
from ..judge.refined import refined
from ..judge.results import Cell
from ..judge.spectrum import Answer, of_blades
from ..judge.verdict import AGREES, judge, unsigned
from .refinement import Refining
from .works import References, refinements

ACCURACY = 1e-6
"""Relative accuracy of core's frequencies with and without precone."""


def deck_code(
    head: Head,
    name: str,
    deck: Deck,
    blade: Blade,
    effects: Effects,
    refining: Refining,
    limits: Limits,
    core: References,
) -> Rows:
    """Rows of a code that solves the deck, refined until it can be judged.

    Args:
        head: fields common to the cells.
        name: import path of the code.
        deck: the files.
        blade: as Southwell reads it: for the check whether the code supports it, and for the effect of its precone.
        effects: that the code includes.
        refining: its levels and order.
        limits: of each solution.
        core: the references at each speed.
    """

    def ask(runs: Sequence[CodeRun]) -> list[Answer]:
        return of_blades(answers(name, blade, runs, limits, head.version, deck))

    speeds, count = [omega for omega, _ in core], max(r.core.count for _, r in core)
    sizes = _precone(blade, speeds, count, effects) if blade.precone else np.zeros((len(speeds), count))
    rows: list[Rows] = []
    for (omega, r, s), size in zip(refinements(ask, refining, core), sizes, strict=True):
        cells, levels = refined(head, omega, r, s, refining.order)
        rows.append(([_widened(cell, size, k) for cell, k in zip(cells, r.core.indices, strict=False)], levels))
    return joined(rows)


def _precone(blade: Blade, speeds: Sequence[float], count: int, effects: Effects) -> NDArray[np.float64]:
    """(speeds, count) relative changes of core's frequencies without precone, in ascending order of the frequencies."""
    unconed = replace(blade, precone=0.0)
    solutions = [
        [modes.frequencies for modes in sweep(body, speeds, count=count, accuracy=ACCURACY, effects=effects)]
        for body in (blade, unconed)
    ]
    return np.array([np.abs(flat / coned - 1.0) for coned, flat in zip(*solutions, strict=True)])


def _widened(cell: Cell, sizes: NDArray[np.float64], mode: int) -> Cell:
    """The cell with the effect of precone on a mode of core, by its number, in the uncertainty."""
    size = float(sizes[mode]) if mode < len(sizes) else float("inf")
    if size <= ACCURACY or cell.difference is None or cell.uncertainty is None:
        return cell
    uncertainty = cell.uncertainty + size
    why = f"without precone, which changes the frequency of Southwell's own solver by {unsigned(size)}"
    if cell.verdict not in (*AGREES, "fail"):
        return replace(cell, uncertainty=uncertainty, reason=join(cell.reason, why))
    verdict, reason = judge(cell.difference, uncertainty, cell.target)
    return replace(cell, uncertainty=uncertainty, verdict=verdict, reason=join(reason, why))
