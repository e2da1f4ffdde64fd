"""HAWCStab2's results: a Campbell table (``.cmb``), and the amplitudes of its modes (``.amp``), by which they are named.

A row of either file is an operating point and begins with its wind speed. A ``.cmb`` file has one comment line, which ends
with the number of modes; its rows list all frequencies in Hz, then all damping ratios in percent, then optionally all real
parts. The rows of an ``.amp`` file list for each mode the amplitudes and the phases of the motions below, in this order.
"""

import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..input import files
from ..input.errors import CaseError
from ..input.readers.text import number
from .mode_tables import ModeTable

Array = NDArray[np.float64]

MOTIONS = (
    "tower side-side {}",
    "tower fore-aft {}",
    "tower torsion {}",
    "shaft side-side {}",
    "shaft vertical {}",
    "drivetrain {}",
    "edgewise {} collective",
    "edgewise {} backward",
    "edgewise {} forward",
    "flapwise {} collective",
    "flapwise {} backward",
    "flapwise {} forward",
    "torsion {} collective",
    "torsion {} backward",
    "torsion {} forward",
)
"""Motions of a mode in an ``.amp`` file: displacements of tower top and shaft end in m, rotations in rad, deflections of the
blade tips in multi-blade coordinates. ``{}`` is the number of the mode among those of the same motion."""


def read(path: Path, amplitudes: Path | None = None) -> ModeTable:
    """Read a ``.cmb`` file; its modes are named by the ``.amp`` file of the same analysis.

    The motion with the largest amplitude names a mode. Metres and radians are compared as HAWCStab2 prints them.

    Args:
        path: ``.cmb`` file.
        amplitudes: ``.amp`` file; without it, modes have their numbers as names.

    Raises:
        CaseError: one line with the file and the line, the value, the likely cause and the remedy.
    """
    first = files.text(path, older=True).partition("\n")[0]
    last = re.search(r"(\d+)\s*$", first)
    table = _numbers(path)
    if not len(table) or not last:
        raise CaseError(
            f"{path}: not a .cmb file of HAWCStab2: its first line ends with the number of modes, rows of numbers follow"
        )
    n = int(last[1])
    if n < 1 or (table.shape[1] - 1) not in (n, 2 * n, 3 * n):
        raise CaseError(
            f"{path}: line 2: {table.shape[1]} numbers for {n} modes: expected an operating point, and for each mode its "
            "frequency, its damping and optionally the real part of its eigenvalue"
        )
    values = table[:, 1:].T
    damping = values[n : 2 * n] / 100 if len(values) > n else np.full((n, len(table)), np.nan)
    modes = ModeTable(path.name, table[:, 0], "m/s", tuple(f"mode {k + 1}" for k in range(n)), values[:n], damping)
    return _named(modes, amplitudes) if amplitudes else modes


def _named(table: ModeTable, path: Path) -> ModeTable:
    """The table with names and shares from the mean squared amplitudes over the operating points."""
    rows = _numbers(path)
    n, motions = len(table.names), len(MOTIONS)
    if not len(rows) or rows.shape[1] != 1 + 2 * motions * n:
        length = rows.shape[1] if len(rows) else 0
        raise CaseError(
            f"{path}: {length} numbers in a row, expected {1 + 2 * motions * n}: a wind speed, and for each of the {n} modes "
            f"of {table.name} {motions} amplitudes with their phases: give the .amp file of the same analysis"
        )
    if not np.array_equal(rows[:, 0], table.points):
        raise CaseError(
            f"{path}: its wind speeds differ from those of {table.name}: give the .amp file of the same analysis"
        )
    squares = np.mean(rows[:, 1::2].reshape(len(rows), n, motions) ** 2, axis=0)  # (mode, motion)
    total = squares.sum(axis=1)
    if not (total > 0).all():
        raise CaseError(f"{path}: mode {int(np.argmin(total)) + 1} has no amplitude: write the file again")
    largest = squares.argmax(axis=1)
    shares = squares.max(axis=1) / total
    return replace(table, names=_numbered(largest), shares=tuple(float(share) for share in shares))


def _numbered(largest: Sequence[int] | NDArray[np.intp]) -> tuple[str, ...]:
    """Names of modes by their largest motions; modes of the same motion are counted."""
    order: Counter[str] = Counter()
    names: list[str] = []
    for k in largest:
        order[MOTIONS[k]] += 1
        names.append(MOTIONS[k].format(order[MOTIONS[k]]))
    return tuple(names)


def _numbers(path: Path) -> Array:
    """Rows of finite numbers of equal length (row, column), without comment lines and the first line."""
    rows: list[list[float]] = []
    for k, line in enumerate(files.text(path, older=True).splitlines()[1:], 2):
        if not line.strip() or line.lstrip().startswith(("#", "%")):
            continue
        values = [number(token) for token in line.split()]
        finite = [value for value in values if value is not None and math.isfinite(value) and abs(value) <= 1e100]
        if len(finite) != len(values):
            raise CaseError(f"{path}: line {k}: not a row of finite numbers: correct it")
        if rows and len(rows[0]) != len(finite):
            raise CaseError(f"{path}: line {k}: {len(finite)} numbers instead of {len(rows[0])}: give the whole file")
        rows.append(finite)
    return np.array(rows)
