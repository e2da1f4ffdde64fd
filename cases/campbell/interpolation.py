"""How much the interpolation between a blade's stations can change its frequencies."""

from dataclasses import dataclass, replace

import numpy as np

from ...core import solve
from ...core.blade import Blade
from ...core.participation import families, numbered, participation
from ..input.errors import NO_STATE

FEWEST = 5
"""Fewest stations of which every second one can be left out."""

STEP = 1e-4
"""Distance of two stations, relative to the length, below which they describe a step, which is kept."""

ELEMENTS = 48
"""Elements of the mesh on which both blades are solved; its own error is common to both."""

ORDER = 2
"""Order of linear interpolation: with twice the distance of the stations its error is four times as large."""

SAFETY = 1.25
"""Factor on the estimate, as in the grid convergence index (Roache 1994)."""

TARGET = 1e-3
"""Error above which a warning is due: the 0.1 % of Park et al. (2010)."""


@dataclass(frozen=True)
class InterpolationError:
    """Estimated relative error of a frequency at rest due to linear interpolation between the given stations.

    Attributes:
        mode: name of the mode with the largest error.
        size: its error, relative.
        stations: number of stations.
    """

    mode: str
    size: float
    stations: int

    def __str__(self) -> str:
        return (
            f"interpolation between the {self.stations} stations can change {self.mode} by {100 * self.size:.2g} % (estimated "
            "by leaving out every second one): give more stations if the properties are known between them"
        )


def interpolation_error(blade: Blade, modes: int) -> InterpolationError | None:
    """Estimate the error from a solution with every second station left out; None if this cannot be estimated.

    The difference of both solutions is three times the error of the given stations, whose interpolation is of order 2.
    """
    try:
        fine, coarse = (
            solve.mesh_modes(b, 0.0, max(ELEMENTS, 4 * modes), modes) for b in (blade, without_every_second(blade))
        )
    except (*NO_STATE, ValueError):
        return None
    n = min(len(fine.frequencies), len(coarse.frequencies))
    error = SAFETY * np.abs(coarse.frequencies[:n] / fine.frequencies[:n] - 1.0) / (2**ORDER - 1)
    worst = int(error.argmax())
    names = list(numbered(families(participation(fine, blade))))
    return InterpolationError(names[worst], float(error[worst]), len(blade.stations))


def warnings(blade: Blade, modes: int) -> list[str]:
    """One line if the interpolation error of a frequency may exceed ``TARGET``."""
    error = interpolation_error(blade, modes)
    return [str(error)] if error and error.size > TARGET else []


def without_every_second(blade: Blade) -> Blade:
    """The blade with properties at every second inner station replaced by interpolation between the neighbours.

    The curve, kinks and steps are kept.
    """
    s = blade.stations
    is_step = np.diff(s) < STEP * s[-1]
    steps = np.append(is_step, False) | np.append(False, is_step)
    left_out = np.zeros(len(s), dtype=bool)
    if len(s) >= FEWEST:
        left_out[1:-1:2] = True
    left_out &= ~steps
    kept_stations = ~left_out

    def at(values: np.ndarray) -> np.ndarray:
        flat = values.reshape(len(s), -1)
        finite = np.where(np.isinf(flat), 0.0, flat)
        columns = [
            np.where(np.isinf(v).any(), v, np.interp(s, s[kept_stations], f[kept_stations]))
            for v, f in zip(flat.T, finite.T, strict=True)
        ]
        return np.stack(columns, axis=1).reshape(values.shape)

    return replace(blade, stiffness=at(blade.stiffness), mass=at(blade.mass), twist=at(blade.twist))
