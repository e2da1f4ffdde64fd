"""One mode followed along rotor speed, by shape; the step is halved wherever the shapes leave a doubt.

Neighbouring speeds are linked by the assignment with the largest sum of mass-weighted MACs. A step is taken as it is if every
mode of interest is at least ``SURE`` its predecessor and no two of them swap places; else it is halved, down to a stated
smallest step. What is not clear there is kept as a ``Doubt``. Two modes that swap places between neighbouring speeds cross, or
veer so closely that it cannot be seen: their shapes bound how closely. With stiffness coupling κ between two modes of squared
frequencies δ apart (Pierre 1988; Leissa 1974), each shape holds κ/δ of the other, so that the turn of the shapes over the step,
``asin √MAC`` of one mode with the other, is at most κ (1/|δ| before + 1/|δ| after), and the gap is 2κ.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ...core.modes import Modes
from ..judge.pairing import Array, aligned, mac

Solver = Callable[[float], Modes]
"""Modes at a rotor speed, rad/s; always as many."""

SURE = 0.95
"""A MAC from which a mode is without doubt the one before (the angle between the shapes is 13°)."""

LOST = 0.5
"""A MAC below which a mode is nobody's successor."""

CLOSED = 1e-6
"""A gap, relative to the frequency, too narrow to look for."""

SMALLEST = 2.0**-8
"""The smallest step, of the steps asked for."""


@dataclass(frozen=True)
class Doubt:
    """A step at which a mode's successor is not clear even with the smallest step.

    Attributes:
        omega: (before, after) rad/s.
        track: the mode's place among the tracks.
        frequency: rad/s, before.
        mac: with the successor that was taken; 0 if none was, and the track ends or begins here.
        rival: the largest MAC with any other.
    """

    omega: tuple[float, float]
    track: int
    frequency: float
    mac: float
    rival: float


@dataclass(frozen=True)
class Tracks:
    """Modes followed along speed.

    Attributes:
        omega: (n,) rotor speeds solved, rad/s, ascending: those asked for, and those between.
        asked: (n,) which were asked for.
        frequencies: (n, t) rad/s; NaN where a track has not begun, or has ended.
        uncertainty: (n, t) relative; likewise, and infinite where it is not known.
        place: (n, t) from the lowest mode, 0 upwards; −1 where there is none.
        mac: (n, t) with the speed before; NaN where there is none.
        shapes: (n, t, 21, 4) complex; NaN where there is none.
        solved: all modes at each speed, also those that no track is about.
        bound: (n, t, t) where two tracks have swapped places since the speed before, a gap between them is no wider than
            this, rad/s; else NaN.
        doubts: what could not be settled.
        smallest: the smallest step, rad/s.
    """

    omega: Array
    asked: NDArray[np.bool_]
    frequencies: Array
    uncertainty: Array
    place: NDArray[np.intp]
    mac: Array
    shapes: NDArray[np.complex128]
    solved: tuple[Modes, ...]
    bound: Array
    doubts: tuple[Doubt, ...]
    smallest: float

    @property
    def count(self) -> int:
        """How many tracks."""
        return self.frequencies.shape[1]


@dataclass(frozen=True)
class _Link:
    """Modes ``rows`` of one speed become ``columns`` of the next; ``table`` holds MACs, ``bounds`` gaps of swapped pairs."""

    table: Array
    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    bounds: dict[tuple[int, int], float]


def track(solve: Solver, speeds: Sequence[float] | Array, weight: Array, count: int) -> Tracks:
    """Follow the ``count`` lowest modes along ``speeds`` (rad/s, ascending).

    A mode that is among the ``count`` lowest at any speed is followed over all of them, as far as ``solve`` gives it: let that
    give a few more.

    Raises:
        ValueError: if ``speeds`` are not ascending.
    """
    if not len(speeds) or (np.diff(speeds) <= 0).any():
        raise ValueError(f"speeds: {list(speeds)}: not ascending: sort them and drop duplicates")
    smallest = SMALLEST * float(np.diff(speeds).max(initial=0.0))
    points, links = [_solved(solve, speeds[0], weight)], []
    for omega in speeds[1:]:
        for link, modes in _between(solve, points[-1], _solved(solve, omega, weight), weight, count, smallest):
            links.append(link)
            points.append(modes)
    return _strung(points, links, speeds, count, smallest)


def _solved(solve: Solver, omega: float, weight: Array) -> Modes:
    return aligned(solve(float(omega)), weight)


def _between(
    solve: Solver, a: Modes, b: Modes, weight: Array, count: int, smallest: float
) -> list[tuple[_Link, Modes]]:
    """Links and modes from ``a`` (without) to ``b`` (with), as many as it takes."""
    link = _link(a, b, weight)
    if b.omega - a.omega <= smallest * (1 + 1e-9) or _sure(link, a, count):
        return [(link, b)]
    middle = _solved(solve, 0.5 * (a.omega + b.omega), weight)
    first = _between(solve, a, middle, weight, count, smallest)
    return first + _between(solve, middle, b, weight, count, smallest)


def _link(a: Modes, b: Modes, weight: Array) -> _Link:
    table = mac(a.shapes, b.shapes, weight)
    rows, columns = linear_sum_assignment(-table)
    after = dict(zip(rows.tolist(), columns.tolist(), strict=True))
    bounds = {}
    for i in after:
        for j in after:
            if i < j and after[i] > after[j]:
                bounds[i, j] = _bound(a, b, (i, j), (after[i], after[j]), table)
    return _Link(table, rows, columns, bounds)


def _bound(a: Modes, b: Modes, before: tuple[int, int], after: tuple[int, int], table: Array) -> float:
    """The widest gap, rad/s, that two modes which swap places over a step can have had between."""
    (i, j), (p, q) = before, after
    turn = np.arcsin(np.sqrt(min(max(table[i, q], table[j, p]), 1.0)))
    apart = [abs(x[m] ** 2 - x[n] ** 2) for x, (m, n) in ((a.frequencies, before), (b.frequencies, after))]
    if min(apart) == 0.0:
        return 0.0
    coupling = turn / (1.0 / apart[0] + 1.0 / apart[1])
    return float(coupling / a.frequencies[i])  # a gap of 2κ in ω²


def _sure(link: _Link, a: Modes, count: int) -> bool:
    """Whether nothing would be learnt from a smaller step about the ``count`` lowest modes."""
    for i, p in zip(link.rows, link.columns, strict=True):
        if (i < count or p < count) and link.table[i, p] < SURE:
            return False
    return all(i >= count or gap <= CLOSED * a.frequencies[i] for (i, _), gap in link.bounds.items())


def _strung(
    points: Sequence[Modes], links: Sequence[_Link], speeds: Sequence[float] | Array, count: int, smallest: float
) -> Tracks:
    """Tracks from links; those that are never among the ``count`` lowest are left out."""
    owner = [list(range(len(points[0].frequencies)))]  # the track of each mode at each speed
    tracks = len(owner[0])
    doubts: list[Doubt] = []
    for k, link in enumerate(links):
        here = [-1] * len(points[k + 1].frequencies)
        after = dict(zip(link.rows.tolist(), link.columns.tolist(), strict=True))
        for i in range(len(owner[k])):
            p = after.get(i)
            value = float(link.table[i, p]) if p is not None else 0.0
            taken = p is not None and value >= LOST
            if taken and p is not None:
                here[p] = owner[k][i]
            if value < SURE and (i < count or (p is not None and p < count)):
                rival = float(np.delete(link.table[i], p if p is not None else []).max(initial=0.0))
                step = (points[k].omega, points[k + 1].omega)
                frequency = float(points[k].frequencies[i])
                doubts.append(Doubt(step, owner[k][i], frequency, value if taken else 0.0, rival))
        for p, name in enumerate(here):
            if name < 0:
                here[p], tracks = tracks, tracks + 1
        owner.append(here)
    kept = sorted({name for names in owner for name in names[:count]}, key=lambda t: _first(owner, t))
    return _tables(points, links, owner, kept, doubts, speeds, smallest)


def _first(owner: Sequence[Sequence[int]], name: int) -> tuple[int, int]:
    return next((k, names.index(name)) for k, names in enumerate(owner) if name in names)


def _tables(
    points: Sequence[Modes],
    links: Sequence[_Link],
    owner: Sequence[Sequence[int]],
    kept: Sequence[int],
    doubts: Sequence[Doubt],
    speeds: Sequence[float] | Array,
    smallest: float,
) -> Tracks:
    n, t = len(points), len(kept)
    column = {name: i for i, name in enumerate(kept)}
    frequencies, sure, similar = (np.full((n, t), np.nan) for _ in range(3))
    place = np.full((n, t), -1)
    shapes = np.full((n, t, *points[0].shapes.shape[1:]), np.nan, complex)
    bound = np.full((n, t, t), np.nan)
    for k, modes in enumerate(points):
        known = modes.uncertainty if len(modes.uncertainty) else np.full(len(modes.frequencies), np.inf)
        for p, name in enumerate(owner[k]):
            if name in column:
                i = column[name]
                sure[k, i] = known[p]
                frequencies[k, i], place[k, i], shapes[k, i] = modes.frequencies[p], p, modes.shapes[p]
                if k and name in owner[k - 1]:
                    similar[k, i] = links[k - 1].table[owner[k - 1].index(name), p]
        for (i, j), gap in links[k - 1].bounds.items() if k else ():
            pair = [column.get(owner[k - 1][m]) for m in (i, j)]
            if pair[0] is not None and pair[1] is not None:
                bound[k, pair[0], pair[1]] = bound[k, pair[1], pair[0]] = gap
    omega = np.array([modes.omega for modes in points])
    unclear = tuple(Doubt(d.omega, column[d.track], d.frequency, d.mac, d.rival) for d in doubts if d.track in column)
    asked = np.isin(omega, speeds)
    return Tracks(omega, asked, frequencies, sure, place, similar, shapes, tuple(points), bound, unclear, smallest)
