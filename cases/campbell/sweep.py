"""Core's own answer for a blade over speeds: frequencies with names."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from ...core import solve, velocity_transformation
from ...core.blade import Blade
from ..input.errors import NO_STATE, unsteady
from ..judge.pairing import aligned, families, weights
from ..verify.core_solver import Solver

Method = Literal["chain", "velocity-transformation"]

METHODS: Mapping[Method, Solver] = MappingProxyType(
    {"chain": solve.modes, "velocity-transformation": velocity_transformation.modes}
)
"""Core's two ways to a blade's modes: block-tridiagonal in the bodies' own twists, or Park et al. (2010) with B."""


@dataclass(frozen=True)
class Named:
    """One natural frequency: its place from the lowest, and its name, ``flapwise 2``, at that speed; rad/s."""

    omega: float
    mode: int
    name: str
    frequency: float


def sweep(blade: Blade, speeds: Sequence[float], elements: int, count: int, method: Method = "chain") -> list[Named]:
    """The ``count`` lowest modes (fewer if there are fewer) at each of ``speeds``, rad/s.

    Raises:
        CaseError: if a speed has no stable steady state.
    """
    weight = weights(blade)
    rows = []
    for omega in speeds:
        try:
            found = aligned(METHODS[method](blade, omega, elements, count), weight)
        except NO_STATE as error:
            raise unsteady(blade.name, omega, error) from error
        seen: Counter[str] = Counter()
        for mode, (family, frequency) in enumerate(zip(families(found, weight), found.frequencies, strict=True), 1):
            seen[family] += 1
            rows.append(Named(float(omega), mode, f"{family} {seen[family]}", float(frequency)))
    return rows
