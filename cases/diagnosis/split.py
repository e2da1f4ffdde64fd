"""The difference of each mode divided into an offset at rest and a slope with speed: ω² = ω₀² + φ Ω² (Southwell 1921).

From four speeds on, a term in Ω⁴ is fitted too, so that ω₀ and φ are those at low speed also where the curve bends.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

DOMINANT = 0.8
"""Part of a difference's sum of squares above which it is called an offset, or a slope."""

SMALL = 0.3
"""A relative offset up to this fraction of the largest difference is not mentioned beside a dominant slope."""

FALLS = 0.02
"""A frequency falls or stays if φ is below this fraction of the solver's."""


@dataclass(frozen=True)
class ModeSplit:
    """One mode of a program and of the solver.

    Attributes:
        mode: name.
        at_rest, rest_reference: ω₀, rad/s; nan if the numbers do not determine it.
        slope, slope_reference: φ; nan without two speeds.
    """

    mode: str
    at_rest: float
    rest_reference: float
    slope: float
    slope_reference: float

    @property
    def offset(self) -> float:
        """Relative difference at rest."""
        return self.at_rest / self.rest_reference - 1.0


def split(names: Sequence[Sequence[str]], speeds: Array, frequencies: Array, reference: Array) -> tuple[ModeSplit, ...]:
    """Fit the frequencies (S, M) of a program and of the solver at the same speeds (S,), rad/s.

    ``names`` (S × M) are those of the solver's modes, so that a mode is followed where frequencies cross.
    """
    tracks: dict[str, list[tuple[float, float, float]]] = {}
    for row, omega in enumerate(speeds.tolist()):
        for column, name in enumerate(names[row]):
            expected, observed = float(reference[row, column]), float(frequencies[row, column])
            if name and np.isfinite([expected, observed]).all():
                tracks.setdefault(name, []).append((omega, observed, expected))
    return tuple(_fit(name, np.array(points)) for name, points in tracks.items())


def _fit(name: str, points: Array) -> ModeSplit:
    omega, observed, expected = points.T
    if len(np.unique(omega)) == 1:
        at_rest = not omega[0]
        return ModeSplit(name, *((observed[0], expected[0]) if at_rest else (nan, nan)), nan, nan)
    values = []
    for frequency in (observed, expected):
        weight = 1.0 / frequency**2
        powers = (0, 2, 4) if len(np.unique(omega)) > 3 else (0, 2)
        terms = np.stack([weight * omega**power for power in powers], axis=1)
        (square, slope, *_), *_ = np.linalg.lstsq(terms, weight * frequency**2, rcond=None)
        values.append((float(np.sqrt(square)) if square > 0 else nan, float(slope)))
    return ModeSplit(name, values[0][0], values[1][0], values[0][1], values[1][1])


def indication(modes: Sequence[ModeSplit], fastest: float, uncertainty: float) -> str:
    """What offset and slope say about the cause, in words; empty if nothing.

    Args:
        modes: the modes.
        fastest: highest speed, rad/s.
        uncertainty: relative; smaller differences are not mentioned.
    """
    sloped = [mode for mode in modes if np.isfinite([mode.slope, mode.at_rest, mode.rest_reference]).all()]
    rising = [mode for mode in sloped if mode.slope_reference * fastest**2 > 0.02 * mode.rest_reference**2]
    if rising and all(mode.slope < -FALLS * mode.slope_reference for mode in rising):
        return "frequencies fall with speed where the solver's rise: geometric stiffness is missing or reversed"
    if rising and all(abs(mode.slope) <= FALLS * mode.slope_reference for mode in rising):
        return "frequencies do not move with speed: geometric stiffness or the rotation is missing"
    if not sloped:
        return ""
    at_rest = np.array([mode.at_rest**2 - mode.rest_reference**2 for mode in sloped])
    turning = np.array([(mode.slope - mode.slope_reference) * fastest**2 for mode in sloped])
    expected_squares = np.array(
        [mode.rest_reference**2 + max(mode.slope_reference, 0.0) * fastest**2 for mode in sloped]
    )
    squares = [float(((part / expected_squares) ** 2).sum()) for part in (at_rest, turning)]
    if max(np.abs(at_rest / expected_squares).max(), np.abs(turning / expected_squares).max()) <= 2.0 * uncertainty:
        return ""
    offsets = [mode.offset for mode in sloped]
    whole_change = 0.5 * float(np.abs((at_rest + turning) / expected_squares).max())
    if squares[0] >= DOMINANT * sum(squares):
        return "the difference is an offset at rest: stiffness or mass"
    if squares[1] >= DOMINANT * sum(squares) and max(map(abs, offsets)) <= SMALL * whole_change:
        return "the difference grows from rest with speed: hub radius, centrifugal terms, gravity or precone"
    span = f"{100.0 * min(offsets):+.2f} to {100.0 * max(offsets):+.2f} %".replace("-", "−")
    return f"the difference has an offset at rest ({span}: stiffness or mass) and a slope with speed"
