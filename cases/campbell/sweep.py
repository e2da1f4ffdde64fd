"""Core's own answer for a blade over speeds: frequencies with names."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from ...core.blade import Blade
from ...core.solve import modes
from ..input.errors import NO_STATE, unsteady
from ..judge.pairing import aligned, families, weights


@dataclass(frozen=True)
class Named:
    """One natural frequency: its place from the lowest, and its name, ``flapwise 2``, at that speed; rad/s."""

    omega: float
    mode: int
    name: str
    frequency: float


def sweep(blade: Blade, speeds: Sequence[float], elements: int, count: int) -> list[Named]:
    """The ``count`` lowest modes (fewer if there are fewer) at each of ``speeds``, rad/s.

    Raises:
        CaseError: if a speed has no stable steady state.
    """
    weight = weights(blade)
    rows = []
    for omega in speeds:
        try:
            found = aligned(modes(blade, omega, elements, count), weight)
        except NO_STATE as error:
            raise unsteady(blade.name, omega, error) from error
        seen: Counter[str] = Counter()
        for mode, (family, frequency) in enumerate(zip(families(found, weight), found.frequencies, strict=True), 1):
            seen[family] += 1
            rows.append(Named(float(omega), mode, f"{family} {seen[family]}", float(frequency)))
    return rows
