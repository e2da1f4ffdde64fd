"""Modes tracked over operating points by their shapes: a Campbell diagram from linearisations."""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from .findings import LIMIT, Finding
from .judged import JudgedSet, TrackedMode
from .modes import Mode
from .orders import order_lines

MIN_OVERLAP = 0.3
"""Overlap |l r| of left and right eigenvectors of two operating points below which a mode is not continued."""


def track(sets: Sequence[JudgedSet]) -> tuple[TrackedMode, ...]:
    """Track modes from set to set; sets with other states begin new modes."""
    rows: list[list[Mode | None]] = []
    last: list[int] = []
    for k, judged_set in enumerate(sets):
        current: list[int | None] = [None] * len(judged_set.modes)
        comparable = k > 0 and {s.key for s in sets[k - 1].azimuth_set.states} == {
            s.key for s in judged_set.azimuth_set.states
        }
        if comparable and last and judged_set.modes:
            index = [judged_set.azimuth_set.index[s.key] for s in sets[k - 1].azimuth_set.states]
            adjoints = np.array([_mode(rows[row]).adjoint for row in last])
            shapes = np.array([mode.shape[index] for mode in judged_set.modes]).T
            overlap = np.abs(adjoints @ shapes)
            before = np.array([_mode(rows[row]).frequency for row in last])[:, None]
            now = np.array([mode.frequency for mode in judged_set.modes])[None, :]
            cost = -np.minimum(overlap, 1) + 0.5 * np.abs(np.log(now / before))
            for i, j in zip(*linear_sum_assignment(cost), strict=True):
                if overlap[i, j] > MIN_OVERLAP:
                    current[j] = last[i]
        last = []
        for mode, row in zip(judged_set.modes, current, strict=True):
            if row is None:
                rows.append([None] * k)
                row = len(rows) - 1
            rows[row].append(mode)
            last.append(row)
        for row in rows:
            row += [None] * (k + 1 - len(row))
    return tuple(TrackedMode(_label(row), tuple(row)) for row in sorted(rows, key=_first))


def _mode(row: Sequence[Mode | None]) -> Mode:
    return next(mode for mode in reversed(row) if mode is not None)


def _first(row: Sequence[Mode | None]) -> float:
    return next(mode.frequency for mode in row if mode is not None)


def _label(row: Sequence[Mode | None]) -> str:
    names = [mode.name for mode in row if mode is not None]
    return names[0] if names[-1] == names[0] else f"{names[0]} → {names[-1]}"


def lines(sets: Sequence[JudgedSet], tracked: Sequence[TrackedMode]) -> tuple[Finding, ...]:
    """Multiples of the rotor speed among the tracked modes."""
    speeds = np.array([judged_set.azimuth_set.omega for judged_set in sets]) / (2 * np.pi)
    frequencies = np.array([[np.nan if m is None else m.frequency for m in mode.at] for mode in tracked])
    return order_lines([mode.name for mode in tracked], speeds, frequencies)


def drift(sets: Sequence[JudgedSet]) -> tuple[Finding, ...]:
    """Versions that differ between operating points."""
    versions = sorted({file.version for judged_set in sets for file in judged_set.azimuth_set.files})
    within = any(len({file.version for file in judged_set.azimuth_set.files}) > 1 for judged_set in sets)
    if len(sets) < 2 or len(versions) < 2 or within:
        return ()
    return (
        Finding(
            "version drift",
            LIMIT,
            f"operating points were written by {len(versions)} versions ({', '.join(versions[:3])})",
            "linearise all operating points with one version",
            float(len(versions)),
        ),
    )
