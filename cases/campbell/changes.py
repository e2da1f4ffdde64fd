"""Comparison of the frequencies of two blades, with modes paired by shape."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.blade import Blade
from ...core.modes import Modes
from ...core.participation import families, numbered, participation
from ..judge.pairing import aligned, pair, weights
from ..judge.spectrum import of_blade
from .diagram import CampbellRequest, solver


@dataclass(frozen=True)
class ModeDifference:
    """One mode of a blade and its partner in the other.

    Attributes:
        omega: rotor speed, rad/s.
        name: family and number within the family in the first blade, ``flapwise 2``.
        frequency: frequency of the first blade, rad/s.
        partner: frequency of the mode of the other blade with the same shape, rad/s; NaN if there is none.
        uncertainty: of ``relative``, numerical: the sum of both frequencies' relative uncertainties.
        mac: MAC of the two shapes.
        note: why there is no partner, or why it is ambiguous.
    """

    omega: float
    name: str
    frequency: float
    partner: float
    uncertainty: float
    mac: float
    note: str = ""

    @property
    def relative(self) -> float:
        """``frequency / partner − 1``."""
        return self.frequency / self.partner - 1.0


def changes(
    blade: Blade, against: Blade, speeds: Sequence[float], modes: int, elements: int | None
) -> tuple[ModeDifference, ...]:
    """Pair the lowest ``modes`` of ``blade`` at each of ``speeds`` (rad/s) with those of ``against``.

    Both have ``elements`` equal elements, or as many as the accuracy of ``CampbellRequest`` requires. Shapes are compared by
    MAC with the mass of ``blade``.

    Raises:
        CaseError: if one of the blades has no stable steady state at a speed.
    """
    weight = weights(blade)
    request = CampbellRequest(tuple(speeds), modes=modes, elements=elements)
    first, second = (solver(b, request) for b in (blade, against))
    return tuple(row for omega in speeds for row in _at(blade, first(omega), second(omega), modes, weight))


def _at(blade: Blade, first: Modes, second: Modes, modes: int, weight: np.ndarray) -> list[ModeDifference]:
    first, second = aligned(first, weight), aligned(second, weight)
    indices = range(min(modes, len(first.frequencies)))
    names = numbered(families(participation(first, blade)))
    out = []
    partners = pair(of_blade(first, weight), of_blade(second), indices)
    for k, partner in zip(indices, partners, strict=True):
        partner_frequency, uncertainty = np.nan, np.nan
        if partner.mode is not None:
            partner_frequency, uncertainty = (
                float(second.frequencies[partner.mode]),
                _uncertainty(first, k) + _uncertainty(second, partner.mode),
            )
        out.append(
            ModeDifference(
                first.omega,
                names[k],
                float(first.frequencies[k]),
                partner_frequency,
                uncertainty,
                partner.mac,
                partner.note,
            )
        )
    return out


def _uncertainty(modes: Modes, k: int) -> float:
    return float(modes.uncertainty[k]) if len(modes.uncertainty) else np.nan
