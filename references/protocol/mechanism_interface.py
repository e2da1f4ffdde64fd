"""The base class of adapters that solve mechanisms. A code may solve blades (``interface.BladeAdapter``) as well."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .interface import Adapter, CodeError

if TYPE_CHECKING:
    from ...core.mechanism.description import Mechanism

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class MechanismModes:
    """A mechanism's modes about its steady state.

    Attributes:
        coordinates: names of the code's k coordinates; those of cut joints may be missing.
        steady: (k,) their steady values, m or rad.
        values: (m,) eigenvalues λ, 1/s, sorted by modulus: one of each conjugate pair, and the real ones.
        shapes: (m, k) motion of the coordinates in each mode, any scale.
        seconds: wall time; nan: not measured, as of an answer from the store.
    """

    coordinates: tuple[str, ...]
    steady: NDArray[np.float64]
    values: Complex
    shapes: Complex
    seconds: float = 0.0

    def __post_init__(self) -> None:
        m, k = len(self.values), len(self.coordinates)
        if self.shapes.shape != (m, k) or self.steady.shape != (k,):
            raise ValueError(f"shapes: {self.shapes.shape}, steady: {self.steady.shape}, expected {(m, k)} and {(k,)}")
        if not (np.isfinite(self.values).all() and np.isfinite(self.shapes).all() and np.isfinite(self.steady).all()):
            raise ValueError("eigenvalues, shapes or steady state are not finite")


class MechanismAdapter(Adapter):
    """A source of a mechanism's modes; the rules of ``interface`` apply."""

    @abstractmethod
    def unsupported_mechanism(self, mechanism: "Mechanism") -> str | None:
        """The reason, in one line, why this code cannot solve this mechanism; None if it can."""

    @abstractmethod
    def mechanism_modes(self, mechanism: "Mechanism", guess: Mapping[str, float]) -> MechanismModes:
        """All modes of a supported mechanism about the steady state near ``guess``.

        Raises:
            CodeError: no steady state, or no convergence.
        """

    def solve_mechanism(self, mechanism: "Mechanism", guess: Mapping[str, float]) -> MechanismModes:
        """The modes, or a refusal; arguments as for ``mechanism_modes``.

        Raises:
            CodeError: unsupported mechanism, no steady state, or no convergence.
        """
        if reason := self.unsupported_mechanism(mechanism):
            raise CodeError(reason)
        return self.mechanism_modes(mechanism, guess)
