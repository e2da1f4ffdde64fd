"""Margins from n per revolution, and fits of Southwell's law.

A margin is ``ω / (n Ω) − 1``, the distance of the natural frequency from the excitation frequency relative to the
latter, or ``ω − n Ω`` in rad/s, as the required margin is given. The guideline cited by Park et al. (2010) requires only
that they be separated; the user chooses the margin. Park et al. use 10 %.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .lines import Line
from .required import RequiredMargin
from .resonances import Range, Resonance
from .tracking import Tracks


@dataclass(frozen=True)
class Southwell:
    """``ω² = ω₀² + φ Ω²`` (Southwell and Gough 1921) by least squares over the requested speeds.

    Attributes:
        at_rest: ω₀, rad/s.
        coefficient: φ.
        residual: largest deviation of the fitted frequency, relative.
        uncertainty: absolute uncertainty of the coefficient, due to those of the frequencies.
    """

    at_rest: float
    coefficient: float
    residual: float
    uncertainty: float


@dataclass(frozen=True)
class Margin:
    """Margin of a track from n per revolution over the operating range, positive above it.

    Margins and their uncertainty are relative to n Ω or in rad/s, as the required margin.

    Attributes:
        track: index of the track.
        per_rev: n.
        low, high: margins at the ends of the range.
        smallest: smallest margin within the range; 0 if they meet.
        omega: speed of the smallest margin, rad/s.
        uncertainty: uncertainty of the margin, due to that of the frequency.
        kept: whether the required margin is kept, with the uncertainty taken into account.
    """

    track: int
    per_rev: int
    low: float
    high: float
    smallest: float
    omega: float
    uncertainty: float
    kept: bool


def southwell(tracks: Tracks, t: int) -> Southwell | None:
    """The fit of one track; None if it exists at fewer than three of the requested speeds."""
    k = np.flatnonzero(tracks.requested & (tracks.mode_index[:, t] >= 0))
    if len(k) < 3:
        return None
    omega, frequency = tracks.omega[k], tracks.frequencies[k, t]
    inverse = np.linalg.pinv(np.stack([np.ones(len(k)), omega**2], axis=1))
    rest_square, slope = inverse @ frequency**2
    fitted = np.sqrt(np.maximum(rest_square + slope * omega**2, 0.0))
    residual = float(np.abs(fitted / frequency - 1.0).max())
    doubt = float(np.abs(inverse[1]) @ (2.0 * tracks.uncertainty[k, t] * frequency**2))
    return Southwell(float(np.sqrt(max(rest_square, 0.0))), float(slope), residual, doubt)


def margins(
    lines: Sequence[Line | None],
    crossings: Sequence[Resonance],
    per_rev: Sequence[int],
    operating: Range | None,
    required: RequiredMargin,
) -> tuple[Margin, ...]:
    """Margins (``required``: at least) for each n of each line that spans the range; ``crossings``: resonances."""
    if operating is None:
        return ()
    low, high = operating
    out = []
    for t, line in enumerate(lines):
        if line is None or line.first > low * (1 + 1e-9) or line.last < high * (1 - 1e-9):
            continue  # a track that does not span the range has no margin over it
        for n in per_rev:
            at = np.unique([max(low, 1e-9 * high), *[o for o in np.sqrt(line.squares) if low < o < high], high])
            unit = 1.0 if required.unit else n * at
            values = (np.array([line.at(min(max(o, line.first), line.last)) for o in at]) - n * at) / unit
            inside = [r.omega for r in crossings if (r.track, r.per_rev) == (t, n) and low <= r.omega <= high]
            k = int(np.abs(values).argmin())
            smallest, where = (0.0, float(inside[0])) if inside else (float(values[k]), float(at[k]))
            frequency = smallest + (n * where if required.unit else 1.0)
            uncertainty = 0.0 if inside else frequency * line.uncertainty(min(max(where, line.first), line.last))
            is_kept = bool(abs(smallest) - uncertainty >= required.value)
            out.append(Margin(t, n, float(values[0]), float(values[-1]), smallest, where, uncertainty, is_kept))
    return tuple(out)
