"""A tracked mode as a function of rotor speed, and where it meets n per revolution.

With K = K₀ + Ω² K₂ and C = Ω C₁ (exact for a straight blade), the speeds at which modes meet n per revolution are the
eigenvalues of one Hermitian problem, ``(n² M − K₂ − i n C₁) x = Ω⁻² K₀ x`` with K₀ positive definite. By Sylvester's law of
inertia the number of modes below n Ω then never decreases with speed: each mode meets each n at most once, from above, so the
signs at the solved speeds show every crossing. Only by its steady deformation can a blade's mode meet n twice between two
solved speeds, or touch it; ``Line.near_crossings`` looks for that.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..judge.pairing import Array
from .tracking import Tracks

NEAR = 1e-3
"""Relative distance from a solved speed within which no other is added to look for two crossings."""


@dataclass(frozen=True)
class _Minimum:
    """A smallest distance |ω² − n² Ω²| by the parabola through three solved speeds on one side of n per revolution.

    Attributes:
        square: Ω² there.
        smallest: the distance there, negative beyond n per revolution.
        curvature: half its second derivative over Ω².
        solved: smallest distance at the three speeds.
        within: the uncertainty of that distance.
        is_near: whether one of the three speeds is within ``NEAR``.
    """

    square: float
    smallest: float
    curvature: float
    solved: float
    within: float
    is_near: bool


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

    def slope(self, omega: float) -> float:
        """Derivative of ω² with respect to Ω² at rotor speed ``omega``, rad/s."""
        return float(PchipInterpolator(self.squares, self.values).derivative()(omega**2))

    def uncertainty(self, omega: float) -> float:
        """Relative uncertainty of ``at``: the larger of the neighbours', and the deviation of the cubic from a line."""
        x = omega**2
        k = int(np.clip(np.searchsorted(self.squares, x) - 1, 0, len(self.squares) - 2))
        curvature = abs(self.at(omega) ** 2 - float(np.interp(x, self.squares, self.values)))
        return float(self.uncertainties[k : k + 2].max()) + 0.5 * curvature / self.at(omega) ** 2

    def crosses(self, n: int) -> list[float]:
        """Rotor speeds, rad/s, at which the frequency crosses n per revolution, except where it may only touch it."""
        roots = PchipInterpolator(self.squares, self.values - n**2 * self.squares).roots(extrapolate=False)
        speeds = np.sqrt(np.unique(roots[np.isfinite(roots) & (roots > 0)])).tolist()
        touching = self.touches(n).items()
        return [omega for omega in speeds if not any(abs(omega / at - 1.0) <= width for at, width in touching)]

    def touches(self, n: int) -> dict[float, float]:
        """Speeds, rad/s, at which the frequency comes so near to n per revolution that it may touch it, and does not cross it.

        With the relative uncertainty of each: half the width over which the two cannot be distinguished.
        """
        widths: dict[float, float] = {}
        for m in self._minima(n):
            if m.is_near and m.smallest <= m.within:
                at, width = float(np.sqrt(m.square)), float(np.sqrt((m.within + abs(m.smallest)) / m.curvature))
                if not any(abs(at / touched - 1.0) <= wide for touched, wide in widths.items()):
                    widths[at] = width / (2.0 * m.square)
        return widths

    def near_crossings(self, n: int) -> list[float]:
        """Speeds, rad/s, at which to solve: the frequency may reach n per revolution there, but not at the solved speeds."""
        return [float(np.sqrt(m.square)) for m in self._minima(n) if not m.is_near and m.smallest <= 0.5 * m.solved]

    def _minima(self, n: int) -> Iterator[_Minimum]:
        distance = self.values - n**2 * self.squares
        within = np.nan_to_num(2.0 * self.uncertainties * self.values, posinf=0.0)
        side = np.where(np.abs(distance) > within, np.sign(distance), 0.0)
        for k in range(1, len(distance) - 1):
            three = slice(k - 1, k + 2)
            if abs(side[three].sum()) < np.abs(side[three]).sum() or not side[three].any():
                continue  # on both sides
            x, d = self.squares[three], np.sign(side[three].sum()) * distance[three]
            (h0, h1), (s0, s1) = np.diff(x), np.diff(d) / np.diff(x)
            curvature = (s1 - s0) / (h0 + h1)
            slope = s0 + curvature * h0
            at = x[1] - 0.5 * slope / curvature if curvature > 0 else np.inf
            if x[0] <= at <= x[2] and at > 0:
                is_near = bool((np.abs(x - at) <= 2.0 * NEAR * at).any())
                smallest = d[1] - 0.25 * slope**2 / curvature
                yield _Minimum(
                    float(at), float(smallest), float(curvature), float(d.min()), float(within[three].max()), is_near
                )


def line_of(tracks: Tracks, t: int) -> Line | None:
    """A track as a line; None if it exists at fewer than two speeds."""
    k = np.flatnonzero(tracks.mode_index[:, t] >= 0)
    if len(k) < 2:
        return None
    return Line(tracks.omega[k] ** 2, tracks.frequencies[k, t] ** 2, tracks.uncertainty[k, t])
