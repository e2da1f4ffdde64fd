"""Compare mass, inertia and tip flexibility of a code's own model with a quadrature of the stations that does not use core.

A code whose model is too heavy or too soft is named before its frequencies are compared, with the property that is wrong.
Lumped masses converge with the square of the element size: a second number of elements removes that part.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade, clamped
from ...core.element.discretize import discretize, divide
from ...core.element.sections import integrate
from ...core.space import spatial as sp
from ...core.space.inertia import transformed
from ...references.protocol.fingerprint import UPPER, Fingerprint, of_matrix, tip_flexibility
from ...references.readers.quadrature import Mounted, bend, linear, weigh
from ...references.readers.stations import Stations

Array = NDArray[np.float64]

TARGET = 1e-3
"""Largest difference of mass and inertia."""

EXACT = 1e-5
"""Difference below which no second number of elements is needed."""

NAMES = (
    ("mass", "kg"),
    ("first moment of mass along x", "kg m"),
    ("first moment of mass along y", "kg m"),
    ("first moment of mass along z", "kg m"),
    ("inertia about the rotor's axis", "kg m²"),
)

MOTIONS = ("along x", "along y", "along z", "about x", "about y", "about z")
"""Displacements and rotations of the tip, and the forces and moments there."""


def _bend(i: int, j: int) -> tuple[str, str]:
    """Name and unit of an entry of the tip's flexibility."""
    unit = ("m/N", "rad/N", "rad/(N m)")[(i > 2) + (j > 2)]
    if i == j:
        return f"tip flexibility {MOTIONS[i]}", unit
    return f"tip flexibility {MOTIONS[i]} by {'moment' if j > 2 else 'force'} {MOTIONS[j]}", unit


BENDS = tuple(_bend(int(i), int(j)) for i, j in zip(*UPPER, strict=True))
COUPLINGS = tuple(len(NAMES) + k for k, (i, j) in enumerate(zip(*UPPER, strict=True)) if i != j)
"""Where the couplings of the tip's motions are among all properties."""

SLOWEST = (1.0, 0.5)
"""Lowest orders of convergence of inertia and of flexibility: ∫ ds/EI converges slowly at a thin tip."""


@dataclass(frozen=True)
class Weight:
    """One property of a code's model against the stations.

    Attributes:
        name: the property.
        difference: relative, without the part that a finer mesh removes; of a first moment, relative to mass times tip
            radius; of a coupling of the tip's motions, to the root of the product of both flexibilities.
        finest: relative difference of the finest mesh.
        change: of the relative difference between both meshes.
        model: value in the code's model.
        stations: value by quadrature of the stations.
        unit: unit of both values.
        ratio: of the numbers of elements of both meshes.
        order: the lowest order of convergence that is assumed, see ``SLOWEST``.
    """

    name: str
    difference: float
    finest: float
    change: float
    model: float
    stations: float
    unit: str
    ratio: float = 2.0
    order: float = SLOWEST[0]

    @property
    def verdict(self) -> Literal["pass", "fail", "inconclusive"]:
        """Inconclusive if convergence of the lowest order would remove what the model differs by."""
        if min(abs(self.difference), abs(self.finest)) <= TARGET:
            return "pass"
        remaining = abs(self.change) / (self.ratio**self.order - 1.0)
        return "fail" if abs(self.finest) - remaining > TARGET else "inconclusive"

    @property
    def line(self) -> str:
        """One line on the difference."""
        resolution = f", of which refinement changed {_percent(self.change)}: too few elements to judge"
        resolution = resolution if self.verdict == "inconclusive" else ""
        return (
            f"{self.name}: {self.model:.6g} {self.unit} in the code's model, {self.stations:.6g} {self.unit} by quadrature of "
            f"the stations: {_percent(self.finest)}{resolution}"
        )


def _percent(value: float) -> str:
    return f"{100 * value:+.2g} %".replace("-", "−")


def stations_of(blade: Blade) -> Stations:
    """The stations of a blade as its description states them, where no second reader has read its file."""
    return Stations("its description", blade.stations, blade.stiffness, blade.mass, blade.twist, blade.curve)


def resolved(blade: Blade, stations: Stations) -> Stations:
    """The sections of a second reading at the stations of the blade, with the curve and the twist of the blade.

    A reader adds stations where curve or twist need them; linear interpolation between those of the file would bend otherwise.
    """
    if len(stations.s) == len(blade.stations):
        return stations
    infinite = np.isinf(stations.stiffness).any(axis=0)
    stiffness = linear(stations.s, np.where(infinite, 0.0, stations.stiffness), blade.stations)
    mass = linear(stations.s, stations.mass, blade.stations)
    soft = np.where(infinite, np.inf, stiffness)
    return Stations(stations.reader, blade.stations, soft, mass, blade.twist, blade.curve)


def enough(blade: Blade, stations: Stations, models: Sequence[Fingerprint], rotary: bool) -> bool:
    """Whether no finer model is needed: a first one is exact, or two show no difference."""
    checks = weights(blade, stations, models, rotary)
    if len(models) == 1:
        return all(abs(w.difference) <= EXACT for w in checks)
    return all(w.verdict == "pass" for w in checks)


def weights(blade: Blade, stations: Stations, models: Sequence[Fingerprint], rotary: bool = True) -> tuple[Weight, ...]:
    """The properties of a code's model against those of the stations; of the tip's couplings, the one that differs most.

    Args:
        blade: for its mounting, tip mass and kinks.
        stations: as a second reader, or the description of the blade, has them.
        models: with one or two numbers of elements, coarse to fine.
        rotary: whether the code has the moments of inertia of the sections.
    """
    rows = [_differences(blade, stations, model, rotary) for model in models]
    of_model, expected, last = rows[-1]
    change, extrapolated, ratio = np.zeros(len(last)), np.zeros(len(last)), 2.0
    if len(models) == 2 and models[1].elements > models[0].elements:
        change, ratio = last - rows[0][2], models[1].elements / models[0].elements
        extrapolated = change / (ratio**2 - 1.0)
    difference = last + extrapolated
    couplings = [k for k in COUPLINGS if k < len(last)]
    indices = {*range(len(last))} - {*couplings} | {*sorted(couplings, key=lambda k: -abs(difference[k]))[:1]}
    return tuple(
        Weight(
            name,
            difference=float(difference[k]),
            finest=float(last[k]),
            change=float(change[k]),
            model=float(of_model[k]),
            stations=float(expected[k]),
            unit=unit,
            ratio=ratio,
            order=SLOWEST[k >= len(NAMES)],
        )
        for k, (name, unit) in enumerate((NAMES + BENDS)[: len(last)])
        if k in indices
    )


def _differences(blade: Blade, stations: Stations, model: Fingerprint, rotary: bool) -> tuple[Array, Array, Array]:
    """Values (5 or 26,) of the model and of the stations, and their relative differences."""
    mounted = Mounted(stations, blade.hub_radius, blade.precone, blade.pitch, blade.kinks)
    mass, first, inertia = weigh(mounted, blade.tip_mass, model.start, rotary)
    of_model = np.array([model.mass, *model.first_moments, model.rotor_inertia])
    expected = np.array([mass, *first, inertia])
    moment = mass * (blade.hub_radius + blade.length)
    scale = np.array([mass, moment, moment, moment, inertia])
    if model.flexibility is not None and not np.isnan(stations.stiffness).any():
        flexibility = bend(mounted)
        size = np.sqrt(np.diagonal(flexibility))
        sizes = np.outer(size, size)[UPPER]
        of_model, expected = np.append(of_model, model.flexibility), np.append(expected, flexibility[UPPER])
        scale = np.append(scale, np.where(sizes > 0, sizes, 1.0))  # rigid strains: both are zero
    return of_model, expected, (of_model - expected) / scale


MESHES = (16, 64, 256)
"""Numbers of elements of core's own models: thin tips, whose flexibility is that of the last metres, need many."""


def of_core(blade: Blade, elements: int = MESHES[0]) -> Fingerprint:
    """The fingerprint of the model that core assembles with a number of elements."""
    mesh = discretize(blade, elements)
    points = mesh.beams.points
    at = mesh.nodes[mesh.parent[points.element]] @ sp.exp(points.zeta0)
    bodies = transformed(points.mass, at).sum(axis=0) + transformed(mesh.lumps, mesh.nodes).sum(axis=0)
    weighed = of_matrix(bodies, elements)
    if not clamped(blade):
        return weighed
    statics = integrate(blade, divide(blade, elements))
    to_hub = sp.adjoint(statics.nodes[:-1])
    at_tip = np.eye(6)
    at_tip[:3, 3:] = -sp.skew(statics.nodes[-1, :3, 3])
    lever = at_tip @ to_hub
    flexibility = (lever @ statics.flexibility @ np.swapaxes(lever, 1, 2)).sum(axis=0)
    return replace(weighed, flexibility=tip_flexibility(flexibility))
