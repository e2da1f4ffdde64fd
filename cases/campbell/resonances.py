"""Speeds at which modes meet n per revolution, each solved by Newton's method from the interpolated one."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.modes import Modes
from ..judge.pairing import Array, aligned, mac
from .lines import Line
from .tracking import MIN_MAC, Solver, Tracks

Range = tuple[float, float]
"""Lowest and highest operating speed, rad/s."""

_STEPS = 12  # of Newton's method at one crossing
_NEGLIGIBLE = 1e-10  # relative error after which it ends even if frequencies have no uncertainty
_CERTAIN = 30.0  # least difference of two distances, in uncertainties, for the slope between them
_STEEP = 0.2  # relative difference of the line's slope from the chord's above which it is not used
_SLOPE_DOUBT = 1e-3  # smallest relative error assumed for a slope


@dataclass(frozen=True)
class Resonance:
    """A resonance: a track meets n per revolution.

    Attributes:
        track: index of the track.
        per_rev: n.
        omega: rotor speed, rad/s.
        frequency: rad/s.
        uncertainty: relative uncertainty of both, due to that of the frequency at this speed and to the error of Newton's
            last step; where the track cannot be followed there, to the interpolation between solved speeds instead.
        distance: distance of the speed from the operating range, relative to the nearer end of the range; negative below,
            0 inside; None without an operating range.
        touches: whether the track comes so near to n per revolution that it may touch it, without crossing it.
    """

    track: int
    per_rev: int
    omega: float
    frequency: float
    uncertainty: float
    distance: float | None
    touches: bool = False


@dataclass(frozen=True)
class Unlisted:
    """Modes that pass n per revolution between two solved speeds and are not tracked from one to the other.

    Attributes:
        per_rev: n.
        omega: the two speeds, rad/s.
        number: how many more modes are below n per revolution after than before, not counting the tracks' crossings;
            negative if fewer.
    """

    per_rev: int
    omega: tuple[float, float]
    number: int


def resonances(
    solve: Solver,
    tracks: Tracks,
    lines: Sequence[Line | None],
    weight: Array,
    per_rev: Sequence[int],
    operating: Range | None,
) -> tuple[Resonance, ...]:
    """Resonances of each line with each n per revolution, by speed; ``solve`` is the source of the tracks."""
    crossings = []
    for t, line in enumerate(lines):
        for n in per_rev if line is not None else ():
            assert line is not None
            for start in line.crosses(n):
                omega, uncertainty = _solved(solve, tracks, t, line, weight, n, start)
                crossings.append(Resonance(t, n, omega, n * omega, uncertainty, _apart(omega, operating)))
            for omega, uncertainty in line.touches(n).items():
                crossings.append(Resonance(t, n, omega, n * omega, uncertainty, _apart(omega, operating), touches=True))
    return tuple(sorted(crossings, key=lambda r: (r.omega, r.per_rev)))


def near_crossings(lines: Sequence[Line | None], per_rev: Sequence[int]) -> list[float]:
    """Speeds, rad/s, at which to solve so that two crossings between solved speeds are not missed."""
    return [omega for line in lines if line is not None for n in per_rev for omega in line.near_crossings(n)]


def unlisted(tracks: Tracks, per_rev: Sequence[int]) -> tuple[Unlisted, ...]:
    """Changes of the number of tracked modes below n per revolution that are not crossings of tracks.

    No solver's mode is missing, so the number of modes below n Ω is exact at each solved speed.
    """
    out = []
    present = tracks.mode_index >= 0
    for n in per_rev:
        below = present & (np.nan_to_num(tracks.frequencies, nan=np.inf) < n * tracks.omega[:, None])
        both = present[1:] & present[:-1]
        missed = (below[1:] & ~both).sum(1) - (below[:-1] & ~both).sum(1)
        for k in np.flatnonzero(missed).tolist():
            out.append(Unlisted(n, (float(tracks.omega[k]), float(tracks.omega[k + 1])), int(missed[k])))
    return tuple(out)


def _solved(
    solve: Solver, tracks: Tracks, t: int, line: Line, weight: Array, n: int, start: float
) -> tuple[float, float]:
    """Speed (rad/s) and relative uncertainty of a crossing: Newton's method on ω² − n² Ω² over x = Ω².

    It stays between two solved speeds. Its slope is first the line's, then that to the nearest point where it is certain. The
    interpolated speed and its uncertainty are returned if the mode at a speed is not certainly that of the track.
    """
    tracked = np.flatnonzero(tracks.mode_index[:, t] >= 0)
    k = tracked[np.searchsorted(tracks.omega[tracked], start).clip(1, len(tracked) - 1) - 1 :][:2]
    distances = {
        float(o**2): float(f**2 - (n * o) ** 2) for o, f in zip(tracks.omega[k], tracks.frequencies[k, t], strict=True)
    }
    low, high = distances
    x, slope, chord = start**2, line.slope(start) - n**2, (distances[high] - distances[low]) / (high - low)
    interpolated = start, line.uncertainty(start) * n**2 / max(abs(slope), 1e-300)
    doubt = abs(slope / chord - 1.0) if chord else np.inf
    for step in range(_STEPS):
        modes = aligned(solve(float(np.sqrt(x))), weight)
        mode = _same(tracks, t, k, modes, weight)
        if mode is None:
            return interpolated
        square = float(modes.frequencies[mode]) ** 2
        noise = 2.0 * float(modes.uncertainty[mode]) * square if len(modes.uncertainty) else np.inf
        floor = noise if np.isfinite(noise) else 0.0
        distance = square - n**2 * x
        references = [y for y in distances if y != x and abs(distances[y] - distance) > _CERTAIN * floor]
        if references and (step or doubt > _STEEP):
            nearest = min(references, key=lambda y: abs(y - x))
            slope_now = (distance - distances[nearest]) / (x - nearest)
            doubt, slope = abs(slope_now / slope - 1.0) if slope else 1.0, slope_now
        distances[x] = distance
        low, high = (x, high) if distance * distances[low] > 0 else (low, x)
        move = -distance / slope if slope else np.inf
        step_error = abs(move) * (doubt + _SLOPE_DOUBT)  # error of the step, due to that of the slope
        if low <= x + move <= high and step_error <= max(0.1 * floor / abs(slope), _NEGLIGIBLE * x):
            return float(np.sqrt(x + move)), (noise / abs(slope) + step_error) / (2.0 * x)
        x = x + move if low < x + move < high else 0.5 * (low + high)
    return interpolated


def _same(tracks: Tracks, t: int, indices: NDArray[np.intp], solved: Modes, weight: Array) -> int | None:
    """The mode whose shape is that of the track at both neighbouring speeds; None if that is not certain."""
    modes = set()
    for k in indices:
        table = mac(tracks.shapes[k, [t]], solved.shapes, weight)[0]
        modes.add(int(table.argmax()) if table.max() >= MIN_MAC else -1)
    return modes.pop() if len(modes) == 1 and -1 not in modes else None


def _apart(omega: float, operating: Range | None) -> float | None:
    if operating is None:
        return None
    low, high = operating
    return omega / low - 1.0 if omega < low else max(omega / high - 1.0, 0.0) if high else float("inf")
