"""Core's answer as the reference of a code: converged modes, and the change due to the effects that the code lacks."""

from dataclasses import dataclass

from .convergence import Compared, RefinedMode
from .verdict import Effect

MARGIN = 4
"""Number of modes solved above the highest one compared, so that each can find its partner."""


@dataclass(frozen=True)
class Converged(Compared):
    """Core's modes at one point, with the estimates and dominant motions of the compared ones, in their order."""

    modes: tuple[RefinedMode, ...]
    motions: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the compared modes, such as ``flapwise 2``."""
        return tuple(self.spectrum.labels[k] for k in self.indices)

    @property
    def count(self) -> int:
        """Number of modes to request from another solver."""
        return max(self.indices) + 1 + MARGIN


@dataclass(frozen=True)
class Reference:
    """Core's modes at one point with given effects.

    Attributes:
        core: converged modes.
        full: frequencies of the same modes with all effects, rad/s; None if no mode with all effects corresponds.
        likeness: MAC of each mode with its counterpart with all effects.
        effects: for each mode, its change due to each effect that is left out; empty if the change due to all of
            them together is within the target.
        quantities: the quantities of each mode that are compared.
    """

    core: Converged
    full: tuple[float | None, ...]
    likeness: tuple[float, ...]
    effects: tuple[tuple[Effect, ...], ...]
    quantities: tuple[str, ...] = ("frequency",)
