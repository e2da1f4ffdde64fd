"""The Campbell diagram of a blade: named modes over rotor speed, and their margins from n per revolution."""

import warnings
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ...core.blade import Blade
from ...core.modes import Modes
from ...core.solve import NO_GRAVITY, sweep
from ...core.spectrum.refinement import AccuracyWarning
from ..input.errors import NO_STATE, CaseError, rad_s, unsteady
from ..judge.pairing import Array, weights
from .encounters import Encounter, encounters
from .labels import Labels, labels
from .lines import line_of
from .margins import Margin, Southwell, margins, southwell
from .required import TEN_PERCENT, RequiredMargin
from .resonances import Range, Resonance, Unlisted, near_crossings, resonances, unlisted
from .tracking import Solver, Tracks, track

SPARE = 4
"""Number of modes solved above those requested, so that each finds its successor."""


ROUNDING = 1e-9
"""Distance of two speeds, relative to the highest, that is due to the conversion of units."""

_ROUNDS = 8  # of inserting speeds between which a mode may meet n per revolution twice


@dataclass(frozen=True)
class CampbellRequest:
    """Settings of a diagram.

    Attributes:
        speeds: rad/s, ascending, at least two.
        modes: number of modes, from the lowest.
        per_rev: excitation harmonics n, multiples of the rotor speed.
        operating: (lowest, highest) operating speed, rad/s; within ``speeds``.
        margin: required distance of a mode from n per revolution within the operating range.
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
    margin: RequiredMargin = TEN_PERCENT
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
        request: the settings.
        tracks: the modes over speed.
        energy_fractions: (n, t, 4) fractions of kinetic energy in the order of ``FAMILIES``; NaN where there is no mode.
        labels: labels of the tracks.
        southwell: fit of each track; None with fewer than three speeds.
        encounters: crossings and veerings.
        resonances: all resonances within the speeds, by speed.
        unlisted: steps of speed over which more modes pass n per revolution than ``resonances`` has.
        margins: margin of every track from every n; empty without an operating range.
    """

    blade: Blade
    request: CampbellRequest
    tracks: Tracks
    energy_fractions: Array
    labels: Labels
    southwell: tuple[Southwell | None, ...]
    encounters: tuple[Encounter, ...]
    resonances: tuple[Resonance, ...]
    unlisted: tuple[Unlisted, ...]
    margins: tuple[Margin, ...]


def solver(
    blade: Blade,
    request: CampbellRequest,
    on_speed: Callable[[float], None] = lambda omega: None,
    at: Callable[[float], str] = rad_s,
    spare: int = SPARE,
) -> Solver:
    """Core as a function of speed, which returns ``spare`` modes above those requested.

    ``on_speed`` is called with each solved speed, ``at`` formats a speed in an error.

    Raises (the solver):
        CaseError: if there is no stable steady state at a speed, or its strain is large.
    """
    gravity = np.array(request.gravity) if any(request.gravity) else NO_GRAVITY
    load = np.array(request.load) if request.load else None
    waiting: deque[float] = deque()
    speeds = iter(waiting.popleft, None)
    stream = sweep(
        blade,
        speeds,
        request.elements,
        request.modes + spare,
        accuracy=request.accuracy,
        gravity=gravity,
        load=load,
        allow_large_strain=request.allow_large_strain,
    )

    def solve(omega: float) -> Modes:
        waiting.append(omega)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)  # uncertainties are in the answer
                modes = next(stream)
        except NO_STATE as error:
            raise unsteady(blade.name, omega, error, at) from error
        on_speed(omega)
        return modes

    return solve


def campbell(blade: Blade, request: CampbellRequest, solve: Solver | None = None) -> Campbell:
    """Compute the diagram; ``solve`` replaces core as the source of the modes.

    Raises:
        CaseError: if there are fewer than two speeds, the operating range lies outside them, or a speed has no stable
            steady state.
    """
    _check(request)
    request = _on_speeds(request)
    weight = weights(blade)
    solve = cache(solve or solver(blade, request))
    tracks = _tracks(solve, request, weight)
    mode_labels, energy_fractions = labels(tracks, blade)
    lines = [line_of(tracks, t) for t in range(tracks.count)]
    crossings = resonances(solve, tracks, lines, weight, request.per_rev, request.operating)
    return Campbell(
        blade=blade,
        request=request,
        tracks=tracks,
        energy_fractions=energy_fractions,
        labels=mode_labels,
        southwell=tuple(southwell(tracks, t) for t in range(tracks.count)),
        encounters=encounters(tracks, energy_fractions, weight),
        resonances=crossings,
        unlisted=unlisted(tracks, request.per_rev),
        margins=margins(lines, crossings, request.per_rev, request.operating, request.margin),
    )


def _tracks(solve: Solver, request: CampbellRequest, weight: Array) -> Tracks:
    """The tracks, also at the ends of the operating range.

    Speeds are inserted where a mode may meet n per revolution twice between two solved speeds.
    """
    tracks = track(solve, request.speeds, weight, request.modes, request.operating or ())
    for _ in range(_ROUNDS):
        added_speeds = near_crossings([line_of(tracks, t) for t in range(tracks.count)], request.per_rev)
        if not added_speeds:
            break
        tracks = track(solve, request.speeds, weight, request.modes, (*tracks.omega.tolist(), *added_speeds))
    return tracks


def _on_speeds(request: CampbellRequest) -> CampbellRequest:
    """The request with the ends of the operating range on the speeds that they equal to rounding."""
    if not request.operating:
        return request
    requested = np.array(request.speeds)
    nearest = [float(requested[np.abs(requested - end).argmin()]) for end in request.operating]
    low, high = (
        speed if abs(speed - end) <= ROUNDING * requested[-1] else end
        for speed, end in zip(nearest, request.operating, strict=True)
    )
    return replace(request, operating=(low, high))


def _check(request: CampbellRequest) -> None:
    speeds = request.speeds
    if len(speeds) < 2:
        raise CaseError(f"speeds: {len(speeds)} given: a diagram needs at least two; give a range first:last:step")
    if request.operating:
        low, high = request.operating
        if not (speeds[0] <= low + ROUNDING * speeds[-1] and low <= high <= speeds[-1] * (1 + ROUNDING)):
            raise CaseError(
                f"operating range: {low:g} to {high:g} rad/s is not within the speeds, {speeds[0]:g} to {speeds[-1]:g} rad/s: "
                "widen the speeds, or correct the range"
            )
