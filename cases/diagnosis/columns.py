"""The diagnosis of a column of a run: why a code's, or another program's, frequencies fail."""

from collections.abc import Sequence

import numpy as np

from ...core.blade import Blade
from ..input.readers import BladeFile
from ..judge.results import Cell, Diagnosed
from .diagnose import cause_lines, diagnose, mode_lines

LEAST, MOST = 1e-5, 1e-3
"""Limits of the uncertainty that is taken from the cells, relative, if a difference exceeds its own."""


def is_due(cells: Sequence[Cell], added: bool) -> bool:
    """Whether a column has a diagnosis: it has a frequency that fails, or is the file of another program."""
    answered = _frequencies(cells)
    return bool(answered) and (added or any(cell.verdict == "fail" for cell in answered))


def _frequencies(cells: Sequence[Cell]) -> list[Cell]:
    """The cells of a code with a frequency that depends on nothing but the rotor speed."""
    candidates = (cell for cell in cells if cell.role == "code" and cell.quantity == "frequency" and not cell.where)
    return [cell for cell in candidates if cell.mode and cell.value]


def diagnosed(blade: Blade, cells: Sequence[Cell], deck: BladeFile | None = None) -> Diagnosed:
    """The diagnosis of one column of one blade, from its cells; the modes were paired by shape, or by the file's names.

    ``deck`` is the blade's file, if it has one.
    """
    answered = _frequencies(cells)
    speeds = sorted({cell.omega for cell in answered})
    names = sorted({cell.name for cell in answered})
    frequencies = np.full((len(speeds), len(names)), np.nan)
    for cell in answered:
        frequencies[speeds.index(cell.omega), names.index(cell.name)] = cell.value
    uncertainties = [cell.uncertainty for cell in answered if cell.uncertainty is not None]
    uncertainty = float(np.clip(np.median(uncertainties), LEAST, MOST)) if uncertainties else LEAST
    if all(abs(cell.difference or 0.0) <= (cell.uncertainty or 0.0) for cell in answered):
        uncertainty = max([uncertainty, *uncertainties])  # coarsely printed numbers need no cause either
    diagnosis = diagnose(blade, speeds, frequencies, names, by_shape=True, uncertainty=uncertainty, deck=deck)
    return Diagnosed(
        case=cells[0].case,
        code=cells[0].code,
        known=diagnosis.cause is not None or bool(diagnosis.arithmetic),
        sentence=diagnosis.sentence,
        causes=cause_lines(diagnosis),
        modes=mode_lines(diagnosis),
    )
