"""Natural frequencies of a blade at each rotor speed, by core; ``tracked.tracked`` follows modes from speed to speed."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ...core.blade import Blade
from ...core.participation import families, numbered, participation
from ..judge.pairing import aligned, weights
from .diagram import CampbellRequest, solver


@dataclass(frozen=True)
class NamedMode:
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
) -> Iterator[list[NamedMode]]:
    """Yield the ``count`` lowest modes (or all, if fewer) at each of ``speeds``, rad/s; see ``core.solve.modes``.

    Raises:
        CaseError: if a speed has no stable steady state, or one of large strain.
    """
    how = CampbellRequest(speeds, count, elements=elements, accuracy=accuracy, allow_large_strain=allow_large_strain)
    weight, solve = weights(blade), solver(blade, how, spare=0)
    for omega in speeds:
        modes = aligned(solve(omega), weight)
        rows = zip(numbered(families(participation(modes, blade))), modes.frequencies, modes.uncertainty, strict=True)
        yield [
            NamedMode(float(omega), mode, name, float(frequency), float(uncertainty), modes.strain)
            for mode, (name, frequency, uncertainty) in enumerate(rows, 1)
        ]
