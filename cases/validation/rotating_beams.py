"""The rotating beams of Epps and Chandra (1996): thin rectangular strips, clamped off the rotor's axis, some with a swept tip.

Numbers: ``epps_chandra.toml``. A strip's torsional stiffness is that of a thin rectangle, ``G w t³/3 (1 − 0.63 t/w)``
(Saint-Venant; S. P. Timoshenko and J. N. Goodier, *Theory of Elasticity*), its shear factors are 5/6. The composite strip has
its two shear moduli; its torsion takes the one across the chord.
"""

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS
from ...references.protocol.process import Failure
from ..input.schema import Compare
from ..judge.measured import Validation
from ..solve.core_solver import converged
from .points import RPM, Point

INCH, POUND = 0.0254, 4.4482216152605
"""m and N."""

BEAMS = ("aluminium", "composite")

COUNT = 8
"""Modes that are solved for, which hold all that were measured."""


@cache
def data() -> dict[str, Any]:
    """The numbers of ``epps_chandra.toml``."""
    return tomllib.loads((files(str(__package__)) / "epps_chandra.toml").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Factors:
    """On the stiffness and the mass of all sections."""

    stiffness: float = 1.0
    mass: float = 1.0


def beam(name: str, sweep: float, factors: Factors) -> Blade:
    """A beam as a blade, its tip swept backwards by so many degrees in the plane of rotation."""
    d = data()[name]
    w, t = d["width"] * INCH, d["thickness"] * INCH
    pressure = POUND / INCH**2
    E, (G_chord, G_across) = d["E"] * pressure, (g * pressure for g in d["G"])
    area, flap, lag = w * t, w * t**3 / 12.0, t * w**3 / 12.0
    torsion = w * t**3 / 3.0 * (1.0 - 0.63 * t / w)
    K = np.diag([E * area, 5 / 6 * G_chord * area, 5 / 6 * G_across * area, G_across * torsion, E * flap, E * lag])
    density = d["density"] * POUND / INCH**4
    M = density * np.diag([area, area, area, flap + lag, flap, lag])
    straight, *tip = (length * INCH for length in d["lengths"])
    angle = np.radians(sweep)
    ends = [np.zeros(3), np.array([straight, 0.0, 0.0])]
    ends += [ends[-1] + length * np.array([np.cos(angle), -np.sin(angle), 0.0]) for length in tip]
    stations = np.cumsum([0.0, straight, *tip])
    return Blade(
        f"{name}, {sweep:g}°",
        stations,
        np.stack([factors.stiffness * K] * len(ends)),
        np.stack([factors.mass * M] * len(ends)),
        np.zeros(len(ends)),
        hub_radius=data()["hub_radius"] * INCH,
        curve=np.array(ends),
        kinks=tuple(stations[1:-1].tolist()) if sweep else (),
    )


def solved(blade: Blade, rpm: float) -> dict[str, tuple[float, float]]:
    """Frequencies (Hz) by name, and their relative numerical uncertainty.

    Raises:
        ValueError: if there is no steady state.
    """
    (reference,) = converged(blade, [rpm * RPM], Compare(modes=COUNT), ALL_EFFECTS)
    if isinstance(reference, Failure):
        raise ValueError(f"{blade.name}: {rpm:g} rpm: {reference.reason}")
    estimates = [s.estimate for s in reference.modes]
    values = [(e.value / (2.0 * np.pi), e.uncertainty or 0.0) if e else (np.inf, 0.0) for e in estimates]
    return dict(zip(reference.names, values, strict=True))


def points(name: str) -> Iterator[Point]:
    """Every measured point of one kind of beam beside core's frequency."""
    d, u = data()[name], data()["uncertainty"]
    varied = (Factors(), Factors(stiffness=1.0 + u["stiffness"]), Factors(mass=1.0 + u["mass"]))
    for column, sweep in enumerate(d["sweep"]):
        blades = [beam(name, sweep, factors) for factors in varied]
        for row, rpm in enumerate(d["rpm"]):
            base, *variations = (solved(blade, rpm) for blade in blades)
            for k, table in enumerate(d["frequencies"], 1):
                mode = f"flapwise {k}"
                S, uncertainty = base[mode]
                inputs = float(np.sqrt(sum((variation[mode][0] - S) ** 2 for variation in variations)))
                line = f"{mode}, {sweep:g}°" if len(d["sweep"]) > 1 else mode
                yield Point(line, rpm, Validation(S, table[row][column], uncertainty * S, inputs, d["measured"]))
