"""Change of a blade's frequencies due to one thing that is altered in core."""

from dataclasses import dataclass

from ...core.blade import Blade
from ...core.modes import Modes
from ...core.participation import families, numbered, participation
from ..input.schema import Compare
from ..judge.pairing import aligned, pair, weights
from ..judge.spectrum import of_blade
from .core_solver import qualifying


@dataclass(frozen=True)
class ModeChange:
    """Name and frequencies (rad/s) of one mode with and without the alteration; ``wrong`` is None if no mode corresponds."""

    name: str
    right: float
    wrong: float | None

    @property
    def change(self) -> float | None:
        """Relative difference of ``wrong`` from ``right``."""
        return None if self.wrong is None else self.wrong / self.right - 1.0


def changed(right: Modes, wrong: Modes, blade: Blade, compare: Compare) -> tuple[ModeChange, ...]:
    """The modes of ``right`` that a case compares, with names, and the most similar modes of ``wrong``."""
    weight = weights(blade)
    right, wrong = aligned(right, weight), aligned(wrong, weight)
    energies = participation(right, blade)
    indices, names = qualifying(energies, compare), numbered(families(energies))
    partners = [p.mode for p in pair(of_blade(right, weight), of_blade(wrong), indices)]
    return tuple(
        ModeChange(names[k], float(right.frequencies[k]), None if p is None else float(wrong.frequencies[p]))
        for k, p in zip(indices, partners, strict=True)
    )
