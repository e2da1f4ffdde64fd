"""Which independent codes confirm each line of a Campbell diagram, from a matrix run of the same blade."""

from dataclasses import dataclass

import numpy as np

from ..judge.results import Cell, Run
from .diagram import Campbell

MAX_DISTANCE = 1e-3
"""Largest relative difference between the frequencies of a line and of the run for the same mode."""


@dataclass(frozen=True)
class Confirmed:
    """One line of the diagram at one speed.

    Attributes:
        track: index of the track in the diagram.
        omega: rotor speed, rad/s.
        frequency: frequency in the diagram, rad/s.
        uncertainty: relative uncertainty due to discretisation and rounding; infinite if unknown.
        codes: names of the codes that share nothing with core and agree with it within the target.
        difference: largest relative difference among these codes; NaN if there are none.
        dissenting: codes that share nothing with core and do not agree, each with its verdict.
    """

    track: int
    omega: float
    frequency: float
    uncertainty: float
    codes: tuple[str, ...]
    difference: float
    dissenting: tuple[str, ...]


def speeds(diagram: Campbell) -> tuple[float, ...]:
    """Speeds (rad/s) at which lines are confirmed: the ends of the operating range, or the first and the last speed."""
    requested = diagram.request.speeds
    return tuple(sorted(set(diagram.request.operating or (requested[0], requested[-1]))))


def confirmations(diagram: Campbell, run: Run) -> tuple[Confirmed, ...]:
    """Every line at the speeds of ``run``, a matrix run of the diagram's blade, except where a line does not exist."""
    tracks = diagram.tracks
    out = []
    for omega in sorted({c.omega for c in run.cells if c.mode}):
        k = int(np.abs(tracks.omega - omega).argmin())
        for t in np.flatnonzero(tracks.mode_index[k] >= 0):
            mode = int(tracks.mode_index[k, t])
            solved, frequency = tracks.solved[k], float(tracks.frequencies[k, t])
            uncertainty = float(solved.uncertainty[mode]) if len(solved.uncertainty) else np.inf
            cells = [c for c in run.cells if c.omega == omega and c.shares == "nothing" and _is(c, frequency, run)]
            agree = [c for c in cells if c.verdict == "pass"]
            dissent = [c for c in cells if c.verdict not in ("pass", "coarse", "estimate", "measured")]
            dissenting_codes = tuple(f"{c.code} ({c.verdict})" for c in dissent)
            largest = max((abs(c.difference) for c in agree if c.difference is not None), default=np.nan)
            codes = tuple(dict.fromkeys(c.code for c in agree))
            out.append(Confirmed(int(t), omega, frequency, uncertainty, codes, largest, dissenting_codes))
    return tuple(out)


def _is(cell: Cell, frequency: float, run: Run) -> bool:
    """Whether a cell is for the mode of this frequency: the nearest mode of the run, within ``MAX_DISTANCE``."""
    if not (cell.mode and cell.full and cell.role == "code"):
        return False
    frequencies = {c.full for c in run.cells if c.omega == cell.omega and c.full}
    nearest = min(frequencies, key=lambda f: abs(f - frequency))
    return cell.full == nearest and abs(nearest / frequency - 1.0) < MAX_DISTANCE
