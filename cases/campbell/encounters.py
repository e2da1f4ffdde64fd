"""Crossings and veerings of modes over speed.

Tracks that swap places cross. Tracks that come close without swapping veer if they exchange their shapes; near the
closest point the squares of the frequencies behave like those of two coupled oscillators, and the square of their
difference is a parabola over Ω² (Leissa 1974; Perkins and Mote 1986, J. Sound Vib. 106).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..judge.pairing import Array, mac
from .tracking import Tracks

Index = NDArray[np.intp]

EXCHANGED = 0.1
"""Least exchange of shape for a veering; with less, two close modes are practically uncoupled."""

PAST = 3.0
"""Distance, in smallest gaps, at which two modes have passed each other: 71° of the 90° rotation of the shapes."""


@dataclass(frozen=True)
class Encounter:
    """Two tracks that cross or veer.

    Attributes:
        kind: ``crossing`` or ``veering``.
        tracks: indices of the two tracks, the one that is lower before the encounter first.
        omega: speed of the crossing or of the smallest distance, rad/s.
        frequency: mean frequency at that speed, rad/s.
        gap: rad/s: smallest distance of a veering; upper bound on a possible gap of a crossing.
        uncertainty: relative uncertainty of the neighbouring solved frequencies; for that of the gap see
            ``gap_uncertainty``.
        exchanged: fraction of the shapes exchanged from ``window[0]`` to ``window[1]``, 0 to 1.
        window: speeds between which the modes pass each other, rad/s.
        complete: whether they have passed each other within the solved speeds.
        before, after: (2, 4) fractions of kinetic energy of the two (``core.participation``) at the window's ends.
    """

    kind: Literal["crossing", "veering"]
    tracks: tuple[int, int]
    omega: float
    frequency: float
    gap: float
    uncertainty: float
    exchanged: float
    window: tuple[float, float]
    complete: bool
    before: Array
    after: Array

    @property
    def gap_uncertainty(self) -> float:
        """Uncertainty of the gap, rad/s."""
        return 2.0 * self.uncertainty * self.frequency


def encounters(tracks: Tracks, fractions: Array, weight: Array) -> tuple[Encounter, ...]:
    """All encounters, by speed; ``fractions`` (n, t, 4) are the energy fractions of the tracks at each speed."""
    build = partial(_encounter, tracks, fractions, weight)
    pairs = []
    for i in range(tracks.count):
        for j in range(i + 1, tracks.count):
            both = np.flatnonzero((tracks.mode_index[:, i] >= 0) & (tracks.mode_index[:, j] >= 0))
            for run in np.split(both, np.flatnonzero(np.diff(both) > 1) + 1):
                pairs += _of_pair(build, tracks, i, j, run)
    return tuple(sorted(pairs, key=lambda e: (e.omega, e.frequency)))


def _of_pair(build: Callable[..., Encounter], tracks: Tracks, i: int, j: int, k: Index) -> list[Encounter]:
    if len(k) < 2:
        return []
    x = tracks.omega[k] ** 2
    squares = tracks.frequencies[k][:, [i, j]] ** 2
    d = squares[:, 1] - squares[:, 0]
    is_above = tracks.mode_index[k, j] > tracks.mode_index[k, i]
    swaps = np.flatnonzero(is_above[1:] != is_above[:-1])
    within_pair = []
    for a in swaps:
        at = x[a] - d[a] * (x[a + 1] - x[a]) / (d[a + 1] - d[a]) if d[a + 1] != d[a] else x[a]
        where = float(np.sqrt(np.clip(at, x[a], x[a + 1])))
        square = float(np.interp(at, x, squares.mean(1)))
        gap = float(tracks.bound[k[a + 1], i, j])
        pair = (i, j) if is_above[a] else (j, i)
        within_pair.append(build("crossing", pair, where, square, gap, (k[a], k[a + 1]), True))
    size = np.abs(d)
    ends = [0, *(swaps + 1).tolist(), len(k)]  # between crossings
    for between in (slice(*limits) for limits in pairwise(ends)):
        within_pair += _veerings(build, (i, j), k[between], x[between], size[between], squares[between])
    return within_pair


def _veerings(
    build: Callable[..., Encounter], pair: tuple[int, int], k: Index, x: Array, size: Array, squares: Array
) -> list[Encounter]:
    """Interior minima of the distance with exchange of shapes; ``size`` is the distance of the squared frequencies."""
    veerings = []
    inside = np.flatnonzero((size[1:-1] <= size[:-2]) & (size[1:-1] < size[2:])) + 1
    for m in inside.tolist():
        at, smallest = _closest(x[m - 1 : m + 2], size[m - 1 : m + 2])
        a, before = _passed(size, m, -1, smallest)
        b, after = _passed(size, m, 1, smallest)
        square = float(np.interp(at, x, squares.mean(1)))
        gap = float(smallest / (2.0 * np.sqrt(square)))
        order = pair if squares[m, 0] < squares[m, 1] else (pair[1], pair[0])
        window = (int(k[a]), int(k[b]))
        e = build("veering", order, float(np.sqrt(at)), square, gap, window, before and after)
        if e.exchanged >= EXCHANGED:
            veerings.append(e)
    return veerings


def _closest(x: Array, size: Array) -> tuple[float, float]:
    """Position and value of the minimum of ``size``, by the parabola through its squares at three points."""
    middle, scale = x[1], x[2] - x[0]
    c2, c1, c0 = np.polyfit((x - middle) / scale, size**2, 2)
    at = float(np.clip(middle - 0.5 * c1 / c2 * scale, x[0], x[2])) if c2 > 0 else float(middle)
    square = c0 - 0.25 * c1**2 / c2 if c2 > 0 else size[1] ** 2
    return at, float(np.sqrt(square)) if square > 0 else float(size[1])


def _passed(size: Array, m: int, step: int, smallest: float) -> tuple[int, bool]:
    """First index from ``m`` on at which the two have passed each other, else the farthest before the next approach."""
    k = m
    while 0 <= k + step < len(size) and size[k] < PAST * smallest and size[k + step] >= size[k]:
        k += step
    return k, bool(size[k] >= PAST * smallest)


def _encounter(
    tracks: Tracks,
    fractions: Array,
    weight: Array,
    kind: Literal["crossing", "veering"],
    pair: tuple[int, int],
    omega: float,
    square: float,
    gap: float,
    window: tuple[int, int],
    complete: bool,
) -> Encounter:
    a, b = window
    two = list(pair)
    table = mac(tracks.shapes[a, two], tracks.shapes[b, two], weight)
    swapped = table[0, 1] + table[1, 0]
    return Encounter(
        kind=kind,
        tracks=pair,
        omega=omega,
        frequency=float(np.sqrt(square)),
        gap=gap,
        uncertainty=float(tracks.uncertainty[a : b + 1, two].max()),
        exchanged=float(swapped / max(table.sum(), 1e-300)),
        window=(float(tracks.omega[a]), float(tracks.omega[b])),
        complete=complete,
        before=fractions[a, two],
        after=fractions[b, two],
    )
