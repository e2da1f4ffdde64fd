"""Named frequencies of a blade over rotor speed, computed by core."""

import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ...core import solve, velocity_transformation
from ...core.blade import Blade
from ...core.modes import Modes
from ...core.participation import families, numbered, participation
from ...core.spectrum.refinement import AccuracyWarning
from ..input.errors import NO_STATE, rad_s, unsteady
from ..judge.pairing import aligned, weights

Method = Literal["chain", "velocity-transformation"]
"""Core's two ways to a blade's modes: block-tridiagonal in the bodies' own twists, or Park et al. (2010) with B."""

ELEMENTS = 50
"""Default number of elements of the velocity transformation, whose matrices are dense."""


@dataclass(frozen=True)
class Named:
    """One natural frequency, with its number and its name at that speed, ``flapwise 2``.

    Attributes:
        omega: rotor speed, rad/s.
        mode: 1 for the lowest.
        name: family and number within the family.
        frequency: rad/s.
        uncertainty: relative; infinite if unknown.
        strain: largest steady strain at that speed.
    """

    omega: float
    mode: int
    name: str
    frequency: float
    uncertainty: float
    strain: float


def sweep(
    blade: Blade,
    speeds: Sequence[float],
    elements: int | None,
    count: int,
    accuracy: float = 1e-6,
    allow_large_strain: bool = False,
    method: Method = "chain",
    at: Callable[[float], str] = rad_s,
) -> Iterator[list[Named]]:
    """Yield the ``count`` lowest modes (or all, if fewer) at each of ``speeds``, rad/s; see ``core.solve.modes``.

    ``at`` names a speed in an error, in the unit in which it was given.

    Raises:
        CaseError: if a speed has no stable steady state, or one of large strain.
    """
    weight = weights(blade)
    if method == "velocity-transformation":
        found = _by_velocity_transformation(blade, speeds, elements or ELEMENTS, count, allow_large_strain)
    else:
        found = solve.sweep(blade, speeds, elements, count, accuracy=accuracy, allow_large_strain=allow_large_strain)
    for omega in speeds:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", AccuracyWarning)  # uncertainties are in the rows
                one = aligned(next(found), weight)
        except NO_STATE as error:
            raise unsteady(blade.name, omega, error, at) from error
        known = zip(numbered(families(participation(one, blade))), one.frequencies, one.uncertainty, strict=True)
        yield [
            Named(float(omega), mode, name, float(frequency), float(sure), one.strain)
            for mode, (name, frequency, sure) in enumerate(known, 1)
        ]


def _by_velocity_transformation(
    blade: Blade, speeds: Sequence[float], elements: int, count: int, allow_large_strain: bool
) -> Iterator[Modes]:
    """The uncertainty is that of the chain solver on the same mesh, and the difference between both methods."""
    chain = solve.sweep(blade, speeds, elements, count, allow_large_strain=allow_large_strain)
    ours = velocity_transformation.sweep(blade, speeds, elements, count)
    for same, found in zip(chain, ours, strict=True):
        apart = np.abs(found.frequencies / same.frequencies - 1.0)
        yield replace(found, uncertainty=same.uncertainty + apart, strain=same.strain)
