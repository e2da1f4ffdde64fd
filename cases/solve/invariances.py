"""The frequencies of a blade in other descriptions of it, as rows of a run; see ``reading.invariance``."""

import warnings
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version

import numpy as np

from ...core import solve
from ...core.blade import Blade
from ...core.blade_checks import BladeError
from ...core.modes import Array, Modes
from ...core.spectrum.refinement import AccuracyWarning
from ..input.errors import NO_STATE
from ..judge.results import PropertyCheck
from ..judge.verdict import percent, unsigned
from ..reading.invariance import INVARIANCES, Invariance, NotApplicableError
from .properties import CORE

ACCURACY = 1e-6
"""Requested accuracy of the frequencies."""

ROUNDING = 1e-9
"""Smallest uncertainty of a difference."""

MAX_UNCERTAINTY = 1e-3
"""Uncertainty above which a difference within it says nothing."""


@dataclass(frozen=True)
class Invariances:
    """The task that solves one blade in other descriptions.

    Attributes:
        case: name of the case.
        blade: the blade.
        omega: rotor speed, rad/s.
        count: number of modes.
    """

    case: str
    blade: Blade
    omega: float
    count: int

    @property
    def code(self) -> str:
        """Core's name."""
        return CORE

    def __call__(self) -> list[PropertyCheck]:
        """One row for each invariance."""
        as_given: list[Modes] = []
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # uncertainties are in the rows
            return [self._row(invariance, as_given) for invariance in INVARIANCES]

    def _row(self, invariance: Invariance, as_given: list[Modes]) -> PropertyCheck:
        row = PropertyCheck(
            *(self.case, CORE, version("southwell"), "invariance", invariance.name, ACCURACY, "not applicable"),
            unit="rad/s",
        )
        try:
            first, second, error = self._solved(invariance, as_given)
        except NotApplicableError as reason:
            return replace(row, reason=str(reason))
        except BladeError as refusal:
            return replace(row, reason=f"the other description is refused: {refusal}")
        except (*NO_STATE, ArithmeticError) as failure:
            return replace(row, verdict="not run", reason=f"not solved: {failure}")
        difference = second / first.frequencies - 1.0
        excess = np.abs(difference) - error
        worst = int(np.argmax(excess))
        filled = replace(
            row,
            value=float(second[worst]),
            reference=float(first.frequencies[worst]),
            difference=float(difference[worst]),
            target=float(error[worst]),
        )
        if excess[worst] > 0:
            change = (
                f"mode {worst + 1} changes by {percent(float(difference[worst]))} ± {unsigned(float(error[worst]))}"
            )
            return replace(
                filled, verdict="fail", reason=f"{invariance.name}: {change}: wrong: {invariance.convention}"
            )
        if error.max() > MAX_UNCERTAINTY:
            size = unsigned(float(error.max()))
            return replace(filled, verdict="inconclusive", reason=f"{invariance.name}: known to {size} only")
        return replace(filled, verdict="pass")

    def _solved(self, invariance: Invariance, as_given: list[Modes]) -> tuple[Modes, Array, Array]:
        """The modes, the frequencies of the other description, and the relative uncertainty of their difference, (m,).

        The modes of the blade as it is given are solved once and kept in ``as_given``.
        """
        omega = -self.omega if invariance.reversed_rotation else self.omega
        modes = partial(solve.modes, count=self.count, accuracy=ACCURACY, allow_large_strain=True)
        blade, described_otherwise = invariance.alter(self.blade, 1)
        if blade is self.blade and not as_given:
            as_given.append(modes(blade, self.omega))
        first = as_given[0] if blade is self.blade else modes(blade, self.omega)
        second = modes(described_otherwise, omega)
        error = first.uncertainty + second.uncertainty + ROUNDING
        if invariance.exact:
            return first, second.frequencies, error
        # linear interpolation between stations: the error falls with the square of their distance; at a kink the other
        # description needs different properties on either side of one station, and it falls with the distance
        fine = modes(invariance.alter(self.blade, 2)[1], omega)
        order = 1 if self.blade.kinks else 2
        step = (fine.frequencies - second.frequencies) / (2**order - 1)
        return first, fine.frequencies + step, error + fine.uncertainty + np.abs(step) / first.frequencies
