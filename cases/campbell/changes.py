"""The frequencies of one blade against those of another, mode by mode: each is paired with the one of its shape."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.blade import Blade
from ...core.modes import Modes
from ..judge.pairing import aligned, families, numbered, pair, weights
from .diagram import Wanted, solver


@dataclass(frozen=True)
class Changed:
    """One mode of a blade and its partner in the other.

    Attributes:
        omega: rotor speed, rad/s.
        name: family and number within it, ``flapwise 2``, in the first blade.
        frequency: of the first blade, rad/s.
        other: of the mode of the other blade that has the same shape, rad/s; NaN if none has.
        mac: of both shapes.
        note: why there is no partner, or what makes it ambiguous.
    """

    omega: float
    name: str
    frequency: float
    other: float
    mac: float
    note: str = ""

    @property
    def relative(self) -> float:
        """``frequency / other − 1``."""
        return self.frequency / self.other - 1.0


def changes(
    blade: Blade, against: Blade, speeds: Sequence[float], modes: int, elements: int | None
) -> tuple[Changed, ...]:
    """The lowest ``modes`` of ``blade`` at each of ``speeds`` (rad/s), paired with those of ``against``.

    Both have ``elements`` equal elements, or as many as the accuracy of ``Wanted`` takes. Shapes are compared by MAC with
    the mass of ``blade``.

    Raises:
        CaseError: if a speed has no stable steady state for one of them.
    """
    weight = weights(blade)
    asked = Wanted(tuple(speeds), modes=modes, elements=elements)
    first, second = (solver(b, asked) for b in (blade, against))
    return tuple(row for omega in speeds for row in _at(first(omega), second(omega), modes, weight))


def _at(found: Modes, other: Modes, modes: int, weight: np.ndarray) -> list[Changed]:
    found, other = aligned(found, weight), aligned(other, weight)
    wanted = range(min(modes, len(found.frequencies)))
    names = numbered(families(found, weight))
    out = []
    for k, partner in zip(wanted, pair(found, other, wanted, weight), strict=True):
        theirs = float(other.frequencies[partner.mode]) if partner.mode is not None else np.nan
        out.append(Changed(found.omega, names[k], float(found.frequencies[k]), theirs, partner.mac, partner.note))
    return out
