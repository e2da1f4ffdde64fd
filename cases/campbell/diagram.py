"""The Campbell diagram of a blade: its modes along rotor speed, named, and how far they keep from n per revolution."""

import warnings
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...core.blade import Blade
from ...core.chain.refinement import AccuracyWarning
from ...core.modes import Modes
from ...core.participation import families, numbered, participation
from ...core.solve import NO_GRAVITY, sweep
from ..input.errors import NO_STATE, CaseError, rad_s, unsteady
from ..judge.pairing import Array, weights
from .encounters import Encounter, encounters
from .margins import Margin, Range, Resonance, Southwell, line_of, margins, resonances, southwell
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
        elements: of equal length along the blade; by default as many at each speed as ``accuracy`` takes.
        accuracy: largest relative uncertainty of a frequency, without ``elements``.
        allow_large_strain: accept steady strains above ``core.solve.LARGEST_STRAIN``.
        gravity: (3,) m/s² in the hub's axes, see ``prestress``.
        load: for each of the blade's stations a steady force per length, N/m, likewise; none by default.
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

    def label_at(self, t: int, omega: float) -> str:
        """What a track is called at the speed solved that is nearest to ``omega``."""
        there = np.flatnonzero(self.tracks.place[:, t] >= 0)
        return self.local[there[np.abs(self.tracks.omega[there] - omega).argmin()]][t]

    def label_over(self, t: int, low: float, high: float) -> str:
        """What it is called from one speed to another: ``flap 2``, or ``flap 2 → edge 1``."""
        return " → ".join(dict.fromkeys((self.label_at(t, low), self.label_at(t, high))))


def solver(
    blade: Blade,
    wanted: Wanted,
    on_speed: Callable[[float], None] = lambda omega: None,
    at: Callable[[float], str] = rad_s,
) -> Solver:
    """Core at one speed after another; ``on_speed`` is called with each speed when it is done, ``at`` names one in an error.

    Raises (the solver):
        CaseError: if a speed has no stable steady state, or one of large strain.
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
    lines = [line_of(tracks, t) for t in range(tracks.count)]
    return Campbell(
        blade=blade,
        wanted=wanted,
        tracks=tracks,
        shares=shares,
        names=_distinct([local[k[0]][t] for t, k in enumerate(held)]),
        last=_distinct([local[k[-1]][t] for t, k in enumerate(held)]),
        local=tuple(local),
        southwell=tuple(southwell(tracks, t) for t in range(tracks.count)),
        encounters=encounters(tracks, shares, weight),
        resonances=resonances(lines, wanted.per_rev, wanted.operating),
        margins=margins(lines, wanted.per_rev, wanted.operating, wanted.margin),
    )


def rises(diagram: Campbell, omega: float) -> Array:
    """Each track's rise of frequency (t,) from the first speed to ``omega`` (rad/s), relative; NaN where it has none there."""
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
    """Tracks that begin at different speeds can be called alike: the later ones are told apart by a prime."""
    out: list[str] = []
    for name in names:
        while name in out:
            name += "′"
        out.append(name)
    return tuple(out)
