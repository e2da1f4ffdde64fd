"""The Campbell diagram of a blade: its modes along rotor speed, named, and how far they keep from n per revolution.

A margin is ``ω / (n Ω) − 1``: the natural frequency's distance from the exciting one, in parts of the exciting one. The
guideline that Park et al. (2010) cite only asks for the two to be apart; how far apart is for the user to say. Park et al.
reckon with 10 %.
"""

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..core.blade import Blade
from ..core.chain import SteadyStateError
from ..core.eigen import UnstableError
from ..core.modes import Modes
from ..core.participation import MIXED, families, numbered, participation
from ..core.solve import NO_GRAVITY, sweep
from .encounters import Encounter, encounters
from .errors import CaseError
from .pairing import Array, weights
from .tracking import Solver, Tracks, track

SPARE = 4
"""Modes solved beyond those asked for, so that each finds its successor."""


@dataclass(frozen=True)
class Wanted:
    """What a diagram is asked to show.

    Attributes:
        speeds: rad/s, ascending, two at least.
        modes: how many, from the lowest.
        per_rev: multiples n of the rotor's speed that excite.
        operating: (lowest, highest) speed at which the rotor runs, rad/s; within ``speeds``.
        margin: the least distance wanted of a mode from n per revolution within the operating range, relative.
        elements: of the discretisation.
        gravity: (3,) m/s² in the hub's axes, see ``prestress``.
    """

    speeds: Sequence[float]
    modes: int = 6
    per_rev: tuple[int, ...] = (1, 2, 3, 4, 5, 6)
    operating: tuple[float, float] | None = None
    margin: float = 0.1
    elements: int = 50
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Southwell:
    """``ω² = ω₀² + φ Ω²`` (Southwell and Gough 1921) by least squares over the speeds asked for.

    Attributes:
        rest: ω₀, rad/s.
        coefficient: φ.
        residual: largest deviation of the fitted frequency, relative.
    """

    rest: float
    coefficient: float
    residual: float


@dataclass(frozen=True)
class Resonance:
    """A track meets n per revolution.

    Attributes:
        track: its place.
        per_rev: n.
        omega: rad/s, of the rotor.
        frequency: rad/s.
        apart: the speed's distance from the operating range, in parts of the range's nearer end; negative below, 0 inside;
            None without an operating range.
    """

    track: int
    per_rev: int
    omega: float
    frequency: float
    apart: float | None


@dataclass(frozen=True)
class Margin:
    """How far a track keeps from n per revolution over the operating range; each relative to n Ω, positive above it.

    Attributes:
        track: its place.
        per_rev: n.
        low, high: at the range's ends.
        least: the smallest within; 0 if they meet.
        omega: where that is, rad/s.
        kept: whether it is as large as wanted.
    """

    track: int
    per_rev: int
    low: float
    high: float
    least: float
    omega: float
    kept: bool


@dataclass(frozen=True)
class Campbell:
    """A diagram.

    Attributes:
        blade: what was solved.
        wanted: what was asked for.
        tracks: the modes along speed.
        shares: (n, t, 4) of kinetic energy in flap, edge, torsion, axial motion; NaN where there is no mode.
        names: of each track: of its first speed, ``flap 2``.
        last: names at the last speed of each, which differ where a mode has changed its motion.
        local: (n, t) names at each speed; empty where there is no mode.
        southwell: of each track; None where it has fewer than three speeds.
        encounters: crossings and veerings.
        resonances: all within the speeds, by speed.
        margins: every track with every n; empty without an operating range.
    """

    blade: Blade
    wanted: Wanted
    tracks: Tracks
    shares: Array
    names: tuple[str, ...]
    last: tuple[str, ...]
    local: tuple[tuple[str, ...], ...]
    southwell: tuple[Southwell | None, ...]
    encounters: tuple[Encounter, ...]
    resonances: tuple[Resonance, ...]
    margins: tuple[Margin, ...]

    def label(self, t: int) -> str:
        """A track's name, and what it becomes: ``flap 2 → edge 1``."""
        return self.names[t] if self.names[t] == self.last[t] else f"{self.names[t]} → {self.last[t]}"

    def family(self, t: int) -> str:
        """The motion that carries a track over most of its speeds."""
        there = self.shares[self.tracks.asked & (self.tracks.place[:, t] >= 0), t]
        return families(np.mean(there, axis=0, keepdims=True))[0] if len(there) else MIXED

    def closest(self, t: int) -> Margin | None:
        """The track's smallest margin."""
        mine = [m for m in self.margins if m.track == t]
        return min(mine, key=lambda m: abs(m.least)) if mine else None


def solver(blade: Blade, wanted: Wanted, told: Callable[[float], None] = lambda omega: None) -> Solver:
    """Core at one speed after another; ``told`` hears of each speed when it is done.

    Raises (the solver):
        CaseError: if a speed has no stable steady state.
    """
    gravity = np.array(wanted.gravity) if any(wanted.gravity) else NO_GRAVITY
    waiting: deque[float] = deque()
    stream = sweep(blade, iter(waiting.popleft, None), wanted.elements, wanted.modes + SPARE, gravity=gravity)

    def solve(omega: float) -> Modes:
        waiting.append(omega)
        try:
            found = next(stream)
        except (SteadyStateError, UnstableError) as error:
            raise CaseError(f"{blade.name}: speed: {omega:g} rad/s: {error}: give lower speeds") from error
        told(omega)
        return found

    return solve


def campbell(blade: Blade, wanted: Wanted, solve: Solver | None = None) -> Campbell:
    """The diagram; ``solve`` gives the modes instead of core.

    Raises:
        CaseError: fewer than two speeds, an operating range outside them, or a speed without a stable steady state.
    """
    _check(wanted)
    weight = weights(blade)
    tracks = track(solve or solver(blade, wanted), wanted.speeds, weight, wanted.modes)
    shares = np.full((*tracks.place.shape, 4), np.nan)
    local: list[tuple[str, ...]] = []
    for k, found in enumerate(tracks.solved):
        there = np.flatnonzero(tracks.place[k] >= 0)
        whole = participation(found, blade)
        shares[k, there] = whole[tracks.place[k, there]]
        named = numbered(families(whole))
        local.append(tuple(named[p] if p >= 0 else "" for p in tracks.place[k]))
    held = [np.flatnonzero(tracks.place[:, t] >= 0) for t in range(tracks.count)]
    lines = [_line(tracks, t) for t in range(tracks.count)]
    return Campbell(
        blade=blade,
        wanted=wanted,
        tracks=tracks,
        shares=shares,
        names=_distinct([local[k[0]][t] for t, k in enumerate(held)]),
        last=_distinct([local[k[-1]][t] for t, k in enumerate(held)]),
        local=tuple(local),
        southwell=tuple(_southwell(tracks, t) for t in range(tracks.count)),
        encounters=encounters(tracks, shares, weight),
        resonances=_resonances(lines, wanted),
        margins=_margins(lines, wanted),
    )


def rises(diagram: Campbell, omega: float) -> Array:
    """Each track's rise of frequency (t,) from the first speed to ``omega`` (rad/s), relative; NaN where it has none there."""
    out = np.full(diagram.tracks.count, np.nan)
    for t in range(diagram.tracks.count):
        line = _line(diagram.tracks, t)
        if line is not None and line.first == diagram.tracks.omega[0] and omega <= line.last:
            out[t] = line.at(omega) / line.at(line.first) - 1.0
    return out


def _check(wanted: Wanted) -> None:
    speeds = wanted.speeds
    if len(speeds) < 2:
        raise CaseError(f"speeds: {len(speeds)} given: a diagram needs two at least; give a range first:last:step")
    if wanted.operating:
        low, high = wanted.operating
        if not (speeds[0] <= low * (1 + 1e-9) and low <= high <= speeds[-1] * (1 + 1e-9)):
            raise CaseError(
                f"operating range: {low:g} to {high:g} rad/s is not within the speeds, {speeds[0]:g} to {speeds[-1]:g} rad/s: "
                "widen the speeds, or correct the range"
            )


def _distinct(names: Sequence[str]) -> tuple[str, ...]:
    """Tracks that begin at different speeds can be called alike: the later ones are told apart by a prime."""
    out: list[str] = []
    for name in names:
        while name in out:
            name += "′"
        out.append(name)
    return tuple(out)


@dataclass(frozen=True)
class _Line:
    """One track as a function of speed: monotone cubics through its squares over Ω²."""

    squares: Array
    values: Array

    @property
    def first(self) -> float:
        return float(np.sqrt(self.squares[0]))

    @property
    def last(self) -> float:
        return float(np.sqrt(self.squares[-1]))

    def at(self, omega: float) -> float:
        """Frequency, rad/s."""
        return float(np.sqrt(PchipInterpolator(self.squares, self.values)(omega**2)))

    def meets(self, n: int) -> Array:
        """Rotor speeds at which the frequency is n per revolution."""
        found = PchipInterpolator(self.squares, self.values - n**2 * self.squares).roots(extrapolate=False)
        return np.sqrt(np.unique(found[np.isfinite(found) & (found > 0)]))


def _line(tracks: Tracks, t: int) -> _Line | None:
    k = np.flatnonzero(tracks.place[:, t] >= 0)
    return _Line(tracks.omega[k] ** 2, tracks.frequencies[k, t] ** 2) if len(k) > 1 else None


def _southwell(tracks: Tracks, t: int) -> Southwell | None:
    k = np.flatnonzero(tracks.asked & (tracks.place[:, t] >= 0))
    if len(k) < 3:
        return None
    omega, frequency = tracks.omega[k], tracks.frequencies[k, t]
    (rest, slope), *_ = np.linalg.lstsq(np.stack([np.ones(len(k)), omega**2], axis=1), frequency**2, rcond=None)
    fitted = np.sqrt(np.maximum(rest + slope * omega**2, 0.0))
    residual = float(np.abs(fitted / frequency - 1.0).max())
    return Southwell(float(np.sqrt(max(rest, 0.0))), float(slope), residual)


def _resonances(lines: Sequence[_Line | None], wanted: Wanted) -> tuple[Resonance, ...]:
    found = []
    for t, line in enumerate(lines):
        for n in wanted.per_rev if line else ():
            for omega in line.meets(n) if line else ():
                found.append(Resonance(t, n, float(omega), n * float(omega), _apart(float(omega), wanted.operating)))
    return tuple(sorted(found, key=lambda r: (r.omega, r.per_rev)))


def _apart(omega: float, operating: tuple[float, float] | None) -> float | None:
    if operating is None:
        return None
    low, high = operating
    return omega / low - 1.0 if omega < low else max(omega / high - 1.0, 0.0) if high else float("inf")


def _margins(lines: Sequence[_Line | None], wanted: Wanted) -> tuple[Margin, ...]:
    if wanted.operating is None:
        return ()
    low, high = wanted.operating
    out = []
    for t, line in enumerate(lines):
        if line is None or line.first > low * (1 + 1e-9) or line.last < high * (1 - 1e-9):
            continue  # a track that does not last over the range has no margin over it
        for n in wanted.per_rev:
            at = np.unique([max(low, 1e-9 * high), *[o for o in np.sqrt(line.squares) if low < o < high], high])
            values = np.array([line.at(min(max(o, line.first), line.last)) / (n * o) - 1.0 for o in at])
            inside = [o for o in line.meets(n) if low <= o <= high]
            k = int(np.abs(values).argmin())
            least, where = (0.0, float(inside[0])) if inside else (float(values[k]), float(at[k]))
            kept = bool(abs(least) >= wanted.margin)
            out.append(Margin(t, n, float(values[0]), float(values[-1]), least, where, kept))
    return tuple(out)
