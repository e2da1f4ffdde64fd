"""Margins from n per revolution, resonances, and fits of Southwell's law.

A margin is ``ω / (n Ω) − 1``: the distance of the natural frequency from the excitation frequency, relative to the
latter. The guideline cited by Park et al. (2010) requires only that they be separated; the user chooses the margin.
Park et al. use 10 %.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..judge.pairing import Array
from .tracking import Tracks

Range = tuple[float, float]
"""Lowest and highest operating speed, rad/s."""


@dataclass(frozen=True)
class Southwell:
    """``ω² = ω₀² + φ Ω²`` (Southwell and Gough 1921) by least squares over the requested speeds.

    Attributes:
        rest: ω₀, rad/s.
        coefficient: φ.
        residual: largest deviation of the fitted frequency, relative.
        uncertainty: absolute uncertainty of the coefficient, due to those of the frequencies.
    """

    rest: float
    coefficient: float
    residual: float
    uncertainty: float


@dataclass(frozen=True)
class Resonance:
    """A resonance: a track meets n per revolution.

    Attributes:
        track: index of the track.
        per_rev: n.
        omega: rotor speed, rad/s.
        frequency: rad/s.
        uncertainty: relative uncertainty of both, due to the solved frequencies and the interpolation between them.
        apart: distance of the speed from the operating range, relative to the nearer end of the range; negative below,
            0 inside; None without an operating range.
    """

    track: int
    per_rev: int
    omega: float
    frequency: float
    uncertainty: float
    apart: float | None


@dataclass(frozen=True)
class Margin:
    """Margin of a track from n per revolution over the operating range, relative to n Ω, positive above it.

    Attributes:
        track: index of the track.
        per_rev: n.
        low, high: margins at the ends of the range.
        least: smallest margin within the range; 0 if they meet.
        omega: speed of the smallest margin, rad/s.
        uncertainty: uncertainty of the margin, due to that of the frequency.
        kept: whether the required margin is kept, with the uncertainty taken into account.
    """

    track: int
    per_rev: int
    low: float
    high: float
    least: float
    omega: float
    uncertainty: float
    kept: bool


@dataclass(frozen=True)
class Line:
    """One track as a function of speed: monotone cubics through its squares over Ω²; relative uncertainties."""

    squares: Array
    values: Array
    uncertainties: Array

    @property
    def first(self) -> float:
        """First speed, rad/s."""
        return float(np.sqrt(self.squares[0]))

    @property
    def last(self) -> float:
        """Last speed, rad/s."""
        return float(np.sqrt(self.squares[-1]))

    def at(self, omega: float) -> float:
        """Frequency, rad/s, at rotor speed ``omega``, rad/s."""
        return float(np.sqrt(PchipInterpolator(self.squares, self.values)(omega**2)))

    def uncertainty(self, omega: float) -> float:
        """Relative uncertainty of ``at``: the larger of the neighbours', and the deviation of the cubic from a line."""
        x = omega**2
        k = int(np.clip(np.searchsorted(self.squares, x) - 1, 0, len(self.squares) - 2))
        bent = abs(self.at(omega) ** 2 - float(np.interp(x, self.squares, self.values)))
        return float(self.uncertainties[k : k + 2].max()) + 0.5 * bent / self.at(omega) ** 2

    def meets(self, n: int) -> Array:
        """Rotor speeds, rad/s, at which the frequency is n per revolution."""
        found = PchipInterpolator(self.squares, self.values - n**2 * self.squares).roots(extrapolate=False)
        return np.sqrt(np.unique(found[np.isfinite(found) & (found > 0)]))


def line_of(tracks: Tracks, t: int) -> Line | None:
    """A track as a line; None if it exists at fewer than two speeds."""
    k = np.flatnonzero(tracks.place[:, t] >= 0)
    if len(k) < 2:
        return None
    return Line(tracks.omega[k] ** 2, tracks.frequencies[k, t] ** 2, tracks.uncertainty[k, t])


def southwell(tracks: Tracks, t: int) -> Southwell | None:
    """The fit of one track; None if it exists at fewer than three of the requested speeds."""
    k = np.flatnonzero(tracks.asked & (tracks.place[:, t] >= 0))
    if len(k) < 3:
        return None
    omega, frequency = tracks.omega[k], tracks.frequencies[k, t]
    inverse = np.linalg.pinv(np.stack([np.ones(len(k)), omega**2], axis=1))
    rest, slope = inverse @ frequency**2
    fitted = np.sqrt(np.maximum(rest + slope * omega**2, 0.0))
    residual = float(np.abs(fitted / frequency - 1.0).max())
    doubt = float(np.abs(inverse[1]) @ (2.0 * tracks.uncertainty[k, t] * frequency**2))
    return Southwell(float(np.sqrt(max(rest, 0.0))), float(slope), residual, doubt)


def resonances(lines: Sequence[Line | None], per_rev: Sequence[int], operating: Range | None) -> tuple[Resonance, ...]:
    """Resonances of each line with each n per revolution, by speed."""
    found = []
    for t, line in enumerate(lines):
        if line is None:
            continue
        for n in per_rev:
            for omega in line.meets(n).tolist():
                found.append(Resonance(t, n, omega, n * omega, _meeting(line, n, omega), _apart(omega, operating)))
    return tuple(sorted(found, key=lambda r: (r.omega, r.per_rev)))


def _meeting(line: Line, n: int, omega: float) -> float:
    """Relative uncertainty of the speed at which a line meets n per revolution, from the slope of f² − n² Ω²."""
    x = omega**2
    slope = float(PchipInterpolator(line.squares, line.values).derivative()(x))
    return line.uncertainty(omega) * n**2 / max(abs(n**2 - slope), 1e-300)


def _apart(omega: float, operating: Range | None) -> float | None:
    if operating is None:
        return None
    low, high = operating
    return omega / low - 1.0 if omega < low else max(omega / high - 1.0, 0.0) if high else float("inf")


def margins(
    lines: Sequence[Line | None], per_rev: Sequence[int], operating: Range | None, wanted: float
) -> tuple[Margin, ...]:
    """Margins of each line that spans the operating range, for each n; ``wanted`` is the required margin."""
    if operating is None:
        return ()
    low, high = operating
    out = []
    for t, line in enumerate(lines):
        if line is None or line.first > low * (1 + 1e-9) or line.last < high * (1 - 1e-9):
            continue  # a track that does not span the range has no margin over it
        for n in per_rev:
            at = np.unique([max(low, 1e-9 * high), *[o for o in np.sqrt(line.squares) if low < o < high], high])
            values = np.array([line.at(min(max(o, line.first), line.last)) / (n * o) - 1.0 for o in at])
            inside = [o for o in line.meets(n) if low <= o <= high]
            k = int(np.abs(values).argmin())
            least, where = (0.0, float(inside[0])) if inside else (float(values[k]), float(at[k]))
            sure = 0.0 if inside else (1.0 + least) * line.uncertainty(min(max(where, line.first), line.last))
            kept = bool(abs(least) - sure >= wanted)
            out.append(Margin(t, n, float(values[0]), float(values[-1]), least, where, sure, kept))
    return tuple(out)
