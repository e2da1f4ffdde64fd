"""Tracking of modes over rotor speed by shape; the step is halved where the shapes are ambiguous.

Neighbouring speeds are linked by the assignment with the largest sum of mass-weighted MACs. A step is accepted if every
mode of interest has at least MAC ``MIN_MAC`` with its predecessor and no two of them swap places; otherwise it is halved,
down to a given smallest step. A link that is still ambiguous is recorded as a ``Doubt``. Two modes that swap places
between neighbouring speeds cross, or veer too closely to be resolved: their shapes bound the gap. With stiffness
coupling κ between two modes of squared frequencies δ apart (Pierre 1988; Leissa 1974), each shape contains κ/δ of the
other, so that the rotation of the shapes over the step, ``asin √MAC`` of one mode with the other, is at most
κ (1/|δ| before + 1/|δ| after), and the gap is 2κ.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ...core.modes import Modes
from ..judge.pairing import Array, aligned, mac

Solver = Callable[[float], Modes]
"""Modes at a rotor speed, rad/s; the same number at every speed."""

MIN_MAC = 0.95
"""Least MAC for a certain link between two speeds (the angle between the shapes is 13°)."""

LOST = 0.5
"""Least MAC for a successor."""

CLOSED = 1e-6
"""Gap, relative to the frequency, that is too narrow to resolve."""

SMALLEST = 2.0**-8
"""The smallest step, as a fraction of the requested steps."""


@dataclass(frozen=True)
class Doubt:
    """A mode whose successor is ambiguous even with the smallest step.

    Attributes:
        omega: (before, after) rad/s.
        track: index of the track.
        frequency: frequency before the step, rad/s.
        mac: MAC with the chosen successor; 0 if there is none and the track ends or begins here.
        rival: largest MAC with any other mode.
    """

    omega: tuple[float, float]
    track: int
    frequency: float
    mac: float
    rival: float


@dataclass(frozen=True)
class Tracks:
    """Modes tracked over speed.

    Attributes:
        omega: (n,) solved rotor speeds, rad/s, ascending: the requested and the inserted ones.
        requested: (n,) whether the speed was requested.
        frequencies: (n, t) rad/s; NaN before the beginning and after the end of a track.
        uncertainty: (n, t) relative; likewise, and infinite if unknown.
        mode_index: (n, t) number of the mode from the lowest, 0 upwards; −1 where there is none.
        mac: (n, t) MAC with the previous speed; NaN where there is none.
        shapes: (n, t, 21, 4) complex; NaN where there is none.
        solved: all modes at each speed, including those without a track.
        bound: (n, t, t) upper bound on the gap between two tracks that have swapped places since the previous speed,
            rad/s; else NaN.
        doubts: ambiguous links.
        smallest: the smallest step, rad/s.
    """

    omega: Array
    requested: NDArray[np.bool_]
    frequencies: Array
    uncertainty: Array
    mode_index: NDArray[np.intp]
    mac: Array
    shapes: NDArray[np.complex128]
    solved: tuple[Modes, ...]
    bound: Array
    doubts: tuple[Doubt, ...]
    smallest: float

    @property
    def count(self) -> int:
        """Number of tracks."""
        return self.frequencies.shape[1]

    @property
    def certain(self) -> bool:
        """Whether every link is certain and no two modes swap places."""
        return not self.doubts and not np.isfinite(self.bound).any()


@dataclass(frozen=True)
class _Link:
    """Modes ``rows`` of one speed become ``columns`` of the next; ``table`` holds MACs, ``bounds`` gaps of swapped pairs."""

    table: Array
    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    bounds: dict[tuple[int, int], float]


def track(
    solve: Solver,
    speeds: Sequence[float] | Array,
    weight: Array,
    count: int,
    added_speeds: Sequence[float] = (),
    smallest_step: float = SMALLEST,
) -> Tracks:
    """Track the ``count`` lowest modes over ``speeds`` (rad/s, ascending) and ``added_speeds`` between them.

    A mode that is among the ``count`` lowest at any speed is tracked over all speeds, as far as ``solve`` returns it;
    ``solve`` should therefore return a few more modes. ``smallest_step`` is a fraction of the largest step of ``speeds``; with
    1 no step is halved.

    Raises:
        ValueError: if ``speeds`` are not ascending.
    """
    if not len(speeds) or (np.diff(speeds) <= 0).any():
        raise ValueError(f"speeds: {list(speeds)}: not ascending: sort them and remove duplicates")
    smallest = smallest_step * float(np.diff(speeds).max(initial=0.0))
    points, links = [_solved(solve, speeds[0], weight)], []
    for omega in sorted({float(v) for v in (*speeds, *added_speeds)})[1:]:
        for link, modes in _between(solve, points[-1], _solved(solve, omega, weight), weight, count, smallest):
            links.append(link)
            points.append(modes)
    return _strung(points, links, speeds, count, smallest)


def _solved(solve: Solver, omega: float, weight: Array) -> Modes:
    return aligned(solve(float(omega)), weight)


def _between(
    solve: Solver, a: Modes, b: Modes, weight: Array, count: int, smallest: float
) -> list[tuple[_Link, Modes]]:
    """Links and modes from ``a`` (excluded) to ``b`` (included), with as many steps as required."""
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
    """Upper bound, rad/s, on the gap between two modes that swap places over a step."""
    (i, j), (p, q) = before, after
    angle = np.arcsin(np.sqrt(min(max(table[i, q], table[j, p]), 1.0)))
    gaps = [abs(x[m] ** 2 - x[n] ** 2) for x, (m, n) in ((a.frequencies, before), (b.frequencies, after))]
    if min(gaps) == 0.0:
        return 0.0
    coupling = angle / (1.0 / gaps[0] + 1.0 / gaps[1])
    return float(coupling / a.frequencies[i])  # a gap of 2κ in ω²


def _sure(link: _Link, a: Modes, count: int) -> bool:
    """Whether the links of the ``count`` lowest modes need no smaller step."""
    for i, p in zip(link.rows, link.columns, strict=True):
        if (i < count or p < count) and link.table[i, p] < MIN_MAC:
            return False
    return all(i >= count or gap <= CLOSED * a.frequencies[i] for (i, _), gap in link.bounds.items())


def _strung(
    points: Sequence[Modes], links: Sequence[_Link], speeds: Sequence[float] | Array, count: int, smallest: float
) -> Tracks:
    """Tracks from links, without those that are never among the ``count`` lowest."""
    owner = [list(range(len(points[0].frequencies)))]  # the track of each mode at each speed
    tracks = len(owner[0])
    doubts: list[Doubt] = []
    for k, link in enumerate(links):
        line_at = [-1] * len(points[k + 1].frequencies)
        after = dict(zip(link.rows.tolist(), link.columns.tolist(), strict=True))
        for i in range(len(owner[k])):
            p = after.get(i)
            value = float(link.table[i, p]) if p is not None else 0.0
            is_linked = p is not None and value >= LOST
            if is_linked and p is not None:
                line_at[p] = owner[k][i]
            if value < MIN_MAC and (i < count or (p is not None and p < count)):
                rival = float(np.delete(link.table[i], p if p is not None else []).max(initial=0.0))
                step = (points[k].omega, points[k + 1].omega)
                frequency = float(points[k].frequencies[i])
                doubts.append(Doubt(step, owner[k][i], frequency, value if is_linked else 0.0, rival))
        for p, name in enumerate(line_at):
            if name < 0:
                line_at[p], tracks = tracks, tracks + 1
        owner.append(line_at)
    names_of_lines = sorted({name for names in owner for name in names[:count]}, key=lambda t: _first(owner, t))
    return _tables(points, links, owner, names_of_lines, doubts, speeds, smallest)


def _first(owner: Sequence[Sequence[int]], name: int) -> tuple[int, int]:
    return next((k, names.index(name)) for k, names in enumerate(owner) if name in names)


def _tables(
    points: Sequence[Modes],
    links: Sequence[_Link],
    owner: Sequence[Sequence[int]],
    names: Sequence[int],
    doubts: Sequence[Doubt],
    speeds: Sequence[float] | Array,
    smallest: float,
) -> Tracks:
    n, t = len(points), len(names)
    column = {name: i for i, name in enumerate(names)}
    frequencies, uncertainties, similar = (np.full((n, t), np.nan) for _ in range(3))
    mode_index = np.full((n, t), -1)
    shapes = np.full((n, t, *points[0].shapes.shape[1:]), np.nan, complex)
    bound = np.full((n, t, t), np.nan)
    for k, modes in enumerate(points):
        uncertainty = modes.uncertainty if len(modes.uncertainty) else np.full(len(modes.frequencies), np.inf)
        for p, name in enumerate(owner[k]):
            if name in column:
                i = column[name]
                uncertainties[k, i] = uncertainty[p]
                frequencies[k, i], mode_index[k, i], shapes[k, i] = modes.frequencies[p], p, modes.shapes[p]
                if k and name in owner[k - 1]:
                    similar[k, i] = links[k - 1].table[owner[k - 1].index(name), p]
        for (i, j), gap in links[k - 1].bounds.items() if k else ():
            pair = [column.get(owner[k - 1][m]) for m in (i, j)]
            if pair[0] is not None and pair[1] is not None:
                bound[k, pair[0], pair[1]] = bound[k, pair[1], pair[0]] = gap
    omega = np.array([modes.omega for modes in points])
    unclear = tuple(Doubt(d.omega, column[d.track], d.frequency, d.mac, d.rival) for d in doubts if d.track in column)
    requested = np.isin(omega, speeds)
    return Tracks(
        omega,
        requested,
        frequencies,
        uncertainties,
        mode_index,
        similar,
        shapes,
        tuple(points),
        bound,
        unclear,
        smallest,
    )
