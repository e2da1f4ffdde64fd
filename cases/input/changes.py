"""Changes of a blade's properties by name, for "what if": ``EI_flap=*1.1``, ``tip_mass=*2``, ``pitch=2.5``.

A stiffness is scaled about the section's centre, independent of the reference axis: with the section stiffness K
(6, 6), its inverse S and the unit vector e of a strain, ``K + (f − 1)/S(e, e) e eᵀ`` multiplies the stiffness 1/S(e, e)
by f and keeps the other centres; the axial stiffness is scaled with its column, ``K + (f − 1) k kᵀ/K(x, x)``, which
keeps the tension centre.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import isfinite, radians

import numpy as np
from numpy.typing import NDArray

from ...core.blade import AXIAL, BEND_Y, BEND_Z, TORSION, Blade
from .errors import CaseError, located, nearest

Array = NDArray[np.float64]

FORM = re.compile(r"\s*(\w+)\s*=\s*(\*?)\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*")


@dataclass(frozen=True)
class PropertyChange:
    """A change of one property.

    Attributes:
        name: name of the property; one of ``PROPERTIES``.
        value: factor, or new value in the unit of ``PROPERTIES``.
        factor: whether ``value`` multiplies the property.
    """

    name: str
    value: float
    factor: bool

    def __str__(self) -> str:
        return f"{self.name} × {self.value:g}" if self.factor else f"{self.name} = {self.value:g} {UNITS[self.name]}"


def parse(text: str) -> PropertyChange:
    """Parse a change: ``NAME=*FACTOR``, or ``NAME=VALUE`` for a scalar property.

    Raises:
        CaseError: if the form is invalid, the property unknown, or the factor not positive.
    """
    match = FORM.fullmatch(text)
    if not match:
        raise CaseError(f"--set {text}: not NAME=*FACTOR or NAME=VALUE: write it as in EI_flap=*1.1 or pitch=2.5")
    name, factor, value = match[1], bool(match[2]), float(match[3])
    if name not in PROPERTIES:
        raise CaseError(f"--set {text}: {name!r} is not a property of a blade: {nearest(name, PROPERTIES)}")
    if not factor and name not in UNITS:
        raise CaseError(f"--set {text}: {name} varies along the blade: give a factor, as in {name}=*1.1")
    if not isfinite(value) or (factor and value <= 0):
        raise CaseError(f"--set {text}: {value:g}: a factor is positive and finite, as in {name}=*1.1")
    return PropertyChange(name, value, factor)


def apply(blade: Blade, changes: Sequence[PropertyChange]) -> Blade:
    """Apply all changes to a blade, in order.

    Raises:
        CaseError: if a factor is not positive, a stiffness is rigid, a property is zero, or a value is invalid for a blade.
    """
    for change in changes:
        if change.factor and not change.value > 0:
            raise CaseError(f"--set {change}: a factor is positive")
        with located(f"--set {change}: "):
            blade = PROPERTIES[change.name](blade, change)
    return blade


def _stiffness(strain: int) -> Callable[[Blade, PropertyChange], Blade]:
    def changed(blade: Blade, change: PropertyChange) -> Blade:
        stiffness = blade.stiffness.copy()
        for section in stiffness:  # (6, 6); rigid strains have no compliance
            if np.isinf(section[strain, strain]):
                raise CaseError(f"--set {change}: {change.name} is rigid in this blade: a factor changes nothing")
            soft = np.flatnonzero(np.isfinite(section.diagonal()))
            position = int(np.flatnonzero(soft == strain)[0])
            part = section[np.ix_(soft, soft)]
            if strain == AXIAL:
                column = part[:, position]
                part = part + (change.value - 1.0) * np.outer(column, column) / part[position, position]
                part[position] = part[:, position] = change.value * column
            else:
                rest = np.arange(len(part)) != position
                coupled = part[position, rest] @ np.linalg.solve(part[np.ix_(rest, rest)], part[rest, position])
                part[position, position] = coupled + change.value * (part[position, position] - coupled)
            section[np.ix_(soft, soft)] = part
        return replace(blade, stiffness=stiffness)

    return changed


def _scaled(field: str) -> Callable[[Blade, PropertyChange], Blade]:
    def changed(blade: Blade, change: PropertyChange) -> Blade:
        before = getattr(blade, field)
        if not np.any(before):
            raise CaseError(f"--set {change}: {change.name} is zero in this blade: a factor changes nothing")
        return replace(blade, **{field: change.value * before})

    return changed


def _number(field: str, unit: float = 1.0) -> Callable[[Blade, PropertyChange], Blade]:
    def changed(blade: Blade, change: PropertyChange) -> Blade:
        return _scaled(field)(blade, change) if change.factor else replace(blade, **{field: unit * change.value})

    return changed


PROPERTIES: dict[str, Callable[[Blade, PropertyChange], Blade]] = {
    "EI_flap": _stiffness(BEND_Y),
    "EI_edge": _stiffness(BEND_Z),
    "GJ": _stiffness(TORSION),
    "EA": _stiffness(AXIAL),
    "mass": _scaled("mass"),
    "tip_mass": _scaled("tip_mass"),
    "twist": _scaled("twist"),
    "hub_radius": _number("hub_radius"),
    "precone": _number("precone", radians(1.0)),
    "pitch": _number("pitch", radians(1.0)),
}
"""Properties that can be changed. Masses change with their moments of inertia; axes are those of the sections."""

UNITS = {"hub_radius": "m", "precone": "degrees", "pitch": "degrees"}
"""Scalar properties and their units."""
