"""Compare a blade with the second reading of its file, property by property, station by station.

An entry (i, j) of a section matrix is compared relative to √(dᵢ dⱼ), d the larger diagonal of both readings; twist in rad,
positions relative to the length.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION, Blade
from ...references.readers import Stations

Array = NDArray[np.float64]

TARGET = 1e-6
"""Largest difference between two readings: formats print six or more digits, conversions add rounding only."""

STIFFNESS = {
    "axial stiffness": ("N", AXIAL),
    "edgewise shear stiffness": ("N", SHEAR_Y),
    "flapwise shear stiffness": ("N", SHEAR_Z),
    "torsional stiffness": ("N m²", TORSION),
    "flapwise stiffness": ("N m²", BEND_Y),
    "edgewise stiffness": ("N m²", BEND_Z),
}
INERTIA = {
    "mass per length": ("kg/m", (0, 1, 2), (0, 1, 2)),
    "first moments of mass": ("kg", (0, 1, 2), (3, 4, 5)),
    "moments of inertia": ("kg m", (3, 4, 5), (3, 4, 5)),
}
MOUNTING = {"hub_radius": "m", "precone": "rad", "pitch": "rad"}


@dataclass(frozen=True)
class Property:
    """Largest difference of one property between two readings.

    Attributes:
        name: the property.
        difference: relative; ``inf`` if it is rigid, or zero, in one reading only.
        station: number of the station, from 1; 0 if the property belongs to the whole blade.
        position: arc length of the station, m.
        first: value in Southwell's reading.
        second: value in the second reading.
        unit: unit of both values.
    """

    name: str
    difference: float
    station: int
    position: float
    first: float
    second: float
    unit: str

    @property
    def agrees(self) -> bool:
        """Whether the difference is within the target."""
        return self.difference <= TARGET

    def where(self, second: str) -> str:
        """One line on the largest difference; ``second`` names the second reader."""
        at = f" at station {self.station} ({self.position:.6g} m)" if self.station else ""
        a, b = _distinct(self.first, self.second)
        return f"{self.name}{at}: reader {a} {self.unit}, {second} {b} {self.unit}"


def compare(blade: Blade, stations: Stations, user_stated: tuple[str, ...] = ()) -> tuple[Property, ...]:
    """The largest difference of each property that the second reader reads.

    Args:
        blade: as the first reader returns it; it may have more stations.
        stations: the second reading.
        user_stated: names of the mounting that the user states in place of the file.
    """
    if not len(stations.s) or not np.isfinite(stations.s).all():
        raise ValueError("the second reading has no stations")
    nearest = np.abs(blade.stations[:, None] - stations.s).argmin(axis=0)
    properties = [
        _worst("position of the stations", "m", blade.stations[nearest], stations.s, blade.length, stations.s),
        *_matrices(blade.stiffness[nearest], blade.mass[nearest], stations),
        _worst("twist", "rad", blade.twist[nearest], stations.twist, 1.0, stations.s),
        *(
            _worst(
                f"reference curve {axis}", "m", blade.curve[nearest, k], stations.curve[:, k], blade.length, stations.s
            )
            for k, axis in enumerate("xyz")
        ),
        *_mounting(blade, stations, user_stated),
    ]
    return tuple(p for p in properties if p is not None)


def _matrices(stiffness: Array, mass: Array, second_stations: Stations) -> Iterator[Property | None]:
    second, s = second_stations.stiffness, second_stations.s
    for name, (unit, i) in STIFFNESS.items():
        scale = np.maximum(np.abs(_finite(stiffness[:, i, i])), np.abs(_finite(second[:, i, i])))
        yield _worst(name, unit, stiffness[:, i, i], second[:, i, i], scale, s)
    pairs = [(i, j) for i in range(6) for j in range(i)]
    yield _entries("stiffness couplings", "N, N m, N m²", stiffness, second, pairs, s)
    for name, (unit, rows, columns) in INERTIA.items():
        yield _entries(name, unit, mass, second_stations.mass, [(i, j) for i in rows for j in columns], s)


def _entries(
    name: str, unit: str, first: Array, second: Array, pairs: list[tuple[int, int]], s: Array
) -> Property | None:
    d = np.sqrt(
        np.maximum(
            *(np.abs(_finite(np.nan_to_num(np.diagonal(m, axis1=1, axis2=2), posinf=np.inf))) for m in (first, second))
        )
    )
    worst = [_worst(name, unit, first[:, i, j], second[:, i, j], d[:, i] * d[:, j], s) for i, j in pairs]
    entries = [p for p in worst if p is not None]
    return max(entries, key=lambda p: p.difference) if entries else None


def _mounting(blade: Blade, stations: Stations, user_stated: tuple[str, ...]) -> Iterator[Property | None]:
    for name, unit in MOUNTING.items():
        if name in stations.mounting and name not in user_stated:
            first, second = getattr(blade, name), stations.mounting[name]
            yield _whole(name.replace("_", " "), unit, first, second, max(abs(first), abs(second)))
    if "tip_mass" in stations.mounting:
        first, second = float(blade.tip_mass[0, 0]), float(stations.mounting["tip_mass"])
        yield _whole("tip mass", "kg", first, second, max(abs(first), abs(second)))


def _whole(name: str, unit: str, first: float, second: float, scale: float) -> Property | None:
    largest = _worst(name, unit, np.array([first]), np.array([second]), scale, np.zeros(1))
    return None if largest is None else Property(name, largest.difference, 0, 0.0, largest.first, largest.second, unit)


def _worst(name: str, unit: str, first: Array, second: Array, scale: float | Array, s: Array) -> Property | None:
    """The station with the largest difference relative to ``scale``; None if the second reader reads no value."""
    is_read = ~np.isnan(second)
    if not is_read.any():
        return None
    gap = np.where((first == second) | ~is_read, 0.0, np.inf)
    are_finite = np.isfinite(first) & np.isfinite(second)
    gap[are_finite] = np.abs(first[are_finite] - second[are_finite])
    size = np.broadcast_to(np.asarray(scale, float), gap.shape)
    relative = np.divide(gap, size, out=np.where(gap > 0, np.inf, 0.0), where=(size > 0) & np.isfinite(gap))
    k = int(np.argmax(relative))
    return Property(name, float(relative[k]), k + 1, float(s[k]), float(first[k]), float(second[k]), unit)


def _finite(values: Array) -> Array:
    return np.where(np.isfinite(values), values, 0.0)


def _distinct(first: float, second: float) -> tuple[str, str]:
    """Both numbers with as few digits as show that they differ."""
    for digits in range(3, 17):
        a, b = f"{first:.{digits}g}", f"{second:.{digits}g}"
        if a != b:
            return a, b
    return f"{first:.17g}", f"{second:.17g}"
