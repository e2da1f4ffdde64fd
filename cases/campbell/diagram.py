"""The Campbell diagram of a blade: named modes over rotor speed, and their margins from n per revolution."""

import warnings
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from ...core.blade import Blade
from ...core.modes import Modes
from ...core.participation import families, numbered, participation
from ...core.solve import NO_GRAVITY, sweep
from ...core.spectrum.refinement import AccuracyWarning
from ..input.errors import NO_STATE, CaseError, rad_s, unsteady
from ..judge.pairing import Array, weights
from .encounters import Encounter, encounters
from .lines import line_of
from .margins import Margin, Southwell, margins, southwell
from .resonances import Range, Resonance, Unlisted, dips, resonances, unlisted
from .tracking import Solver, Tracks, track

SPARE = 4
"""Number of modes solved above those requested, so that each finds its successor."""


_ROUNDS = 8  # of inserting speeds between which a mode may meet n per revolution twice


@dataclass(frozen=True)
class Wanted:
    """Settings of a diagram.

    Attributes:
        speeds: rad/s, ascending, at least two.
        modes: number of modes, from the lowest.
        per_rev: excitation harmonics n, multiples of the rotor speed.
        operating: (lowest, highest) operating speed, rad/s; within ``speeds``.
        margin: required relative distance of a mode from n per revolution within the operating range.
        elements: number of elements of equal length; by default as many at each speed as ``accuracy`` requires.
        accuracy: largest relative uncertainty of a frequency, if ``elements`` is not given.
        allow_large_strain: accept steady strains above ``core.element.measures.LARGEST_STRAIN``.
        gravity: (3,) m/s² in the hub's axes, see ``prestress``.
        load: steady force per length at each of the blade's stations, N/m, in the same axes; none by default.
    """

    speeds: Sequence[float]
    modes: int = 6
    per_rev: tuple[int, ...] = (1, 2, 3, 4, 5, 6)
    operating: Range | None = None
    margin: float = 0.1
    elements: int | None = None
    accuracy: float = 1e-6
    allow_large_strain: bool = False
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    load: tuple[tuple[float, float, float], ...] = ()


@dataclass(frozen=True)
class Campbell:
    """A diagram.

    Attributes:
        blade: the blade.
        wanted: the settings.
        tracks: the modes over speed.
        energy_fractions: (n, t, 4) fractions of kinetic energy in the order of ``FAMILIES``; NaN where there is no mode.
        names: name of each track at its first speed, ``flapwise 2``.
        last: name of each track at its last speed, which differs if the dominant motion has changed.
        local: (n, t) names at each speed; empty where there is no mode.
        southwell: fit of each track; None with fewer than three speeds.
        encounters: crossings and veerings.
        resonances: all resonances within the speeds, by speed.
        unlisted: steps of speed over which more modes pass n per revolution than ``resonances`` has.
        margins: margin of every track from every n; empty without an operating range.
    """

    blade: Blade
    wanted: Wanted
    tracks: Tracks
    energy_fractions: Array
    names: tuple[str, ...]
    last: tuple[str, ...]
    local: tuple[tuple[str, ...], ...]
    southwell: tuple[Southwell | None, ...]
    encounters: tuple[Encounter, ...]
    resonances: tuple[Resonance, ...]
    unlisted: tuple[Unlisted, ...]
    margins: tuple[Margin, ...]

    def label(self, t: int) -> str:
        """Name of a track at its first and, if different, last speed: ``flapwise 2 → edgewise 1``."""
        return self.names[t] if self.names[t] == self.last[t] else f"{self.names[t]} → {self.last[t]}"

    def label_at(self, t: int, omega: float) -> str:
        """Name of a track at the solved speed nearest to ``omega`` (rad/s)."""
        there = np.flatnonzero(self.tracks.place[:, t] >= 0)
        return self.local[there[np.abs(self.tracks.omega[there] - omega).argmin()]][t]

    def label_over(self, t: int, low: float, high: float) -> str:
        """Name of a track between two speeds (rad/s): ``flapwise 2``, or ``flapwise 2 → edgewise 1``."""
        return " → ".join(dict.fromkeys((self.label_at(t, low), self.label_at(t, high))))


def solver(
    blade: Blade,
    wanted: Wanted,
    on_speed: Callable[[float], None] = lambda omega: None,
    at: Callable[[float], str] = rad_s,
) -> Solver:
    """Core as a function of speed; ``on_speed`` is called with each solved speed, ``at`` formats a speed in an error.

    Raises (the solver):
        CaseError: if there is no stable steady state at a speed, or its strain is large.
    """
    gravity = np.array(wanted.gravity) if any(wanted.gravity) else NO_GRAVITY
    load = np.array(wanted.load) if wanted.load else None
    waiting: deque[float] = deque()
    speeds = iter(waiting.popleft, None)
    stream = sweep(
        blade,
        speeds,
        wanted.elements,
        wanted.modes + SPARE,
        accuracy=wanted.accuracy,
        gravity=gravity,
        load=load,
        allow_large_strain=wanted.allow_large_strain,
    )

    def solve(omega: float) -> Modes:
        waiting.append(omega)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)  # uncertainties are in the answer
                found = next(stream)
        except NO_STATE as error:
            raise unsteady(blade.name, omega, error, at) from error
        on_speed(omega)
        return found

    return solve


def campbell(blade: Blade, wanted: Wanted, solve: Solver | None = None) -> Campbell:
    """Compute the diagram; ``solve`` replaces core as the source of the modes.

    Raises:
        CaseError: if there are fewer than two speeds, the operating range lies outside them, or a speed has no stable
            steady state.
    """
    _check(wanted)
    weight = weights(blade)
    solve = cache(solve or solver(blade, wanted))
    tracks = _tracks(solve, wanted, weight)
    energy_fractions = np.full((*tracks.place.shape, 4), np.nan)
    local: list[tuple[str, ...]] = []
    for k, found in enumerate(tracks.solved):
        there = np.flatnonzero(tracks.place[k] >= 0)
        whole = participation(found, blade)
        energy_fractions[k, there] = whole[tracks.place[k, there]]
        named = numbered(families(whole))
        local.append(tuple(named[p] if p >= 0 else "" for p in tracks.place[k]))
    exists = [np.flatnonzero(tracks.place[:, t] >= 0) for t in range(tracks.count)]
    lines = [line_of(tracks, t) for t in range(tracks.count)]
    met = resonances(solve, tracks, lines, weight, wanted.per_rev, wanted.operating)
    return Campbell(
        blade=blade,
        wanted=wanted,
        tracks=tracks,
        energy_fractions=energy_fractions,
        names=_distinct([local[k[0]][t] for t, k in enumerate(exists)]),
        last=_distinct([local[k[-1]][t] for t, k in enumerate(exists)]),
        local=tuple(local),
        southwell=tuple(southwell(tracks, t) for t in range(tracks.count)),
        encounters=encounters(tracks, energy_fractions, weight),
        resonances=met,
        unlisted=unlisted(tracks, wanted.per_rev),
        margins=margins(lines, met, wanted.per_rev, wanted.operating, wanted.margin),
    )


def _tracks(solve: Solver, wanted: Wanted, weight: Array) -> Tracks:
    """The tracks, with speeds inserted where a mode may meet n per revolution twice between two solved speeds."""
    tracks = track(solve, wanted.speeds, weight, wanted.modes)
    for _ in range(_ROUNDS):
        more = dips([line_of(tracks, t) for t in range(tracks.count)], wanted.per_rev)
        if not more:
            break
        tracks = track(solve, wanted.speeds, weight, wanted.modes, (*tracks.omega.tolist(), *more))
    return tracks


def rises(diagram: Campbell, omega: float) -> Array:
    """Relative rise (t,) of each track's frequency from the first speed to ``omega`` (rad/s); NaN where it is missing."""
    out = np.full(diagram.tracks.count, np.nan)
    for t in range(diagram.tracks.count):
        line = line_of(diagram.tracks, t)
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
    """Make names unique: tracks that begin at different speeds can have the same name; later ones get a prime."""
    out: list[str] = []
    for name in names:
        while name in out:
            name += "′"
        out.append(name)
    return tuple(out)
