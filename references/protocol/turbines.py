"""The interface of a code for whole turbines, and what its answer consists of.

A code is given the turbine's tower, blade, bodies and angles; it divides tower and blades itself, linearises the machine at
several azimuths, and removes the azimuth by a multi-blade transformation of its own. Modes are seen from the ground.
"""

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core.modes import STATIONS
from .fingerprint import Fingerprint
from .interface import Adapter, CodeError

if TYPE_CHECKING:
    from ...core.turbine.turbine import Turbine

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class TurbineModes:
    """The lowest modes of a turbine.

    Attributes:
        values: (m,) eigenvalues λ, 1/s, by modulus: one of each conjugate pair.
        shapes: (m, s, 4) complex, at any scale: displacement along x, y, z and rotation about x at azimuth 0, at the 21
            stations of the tower in the ground's axes and of each blade in the hub's axes turned to it; see
            ``core.turbine.stations``.
        elements: refinement: number of elements of a blade.
    """

    values: Complex
    shapes: Complex
    elements: int

    def __post_init__(self) -> None:
        m = len(self.values)
        if self.shapes.ndim != 3 or self.shapes.shape[::2] != (m, 4) or self.shapes.shape[1] % len(STATIONS):
            raise ValueError(
                f"shapes: {self.shapes.shape}, expected {m} modes, {len(STATIONS)} stations a part, 4 columns"
            )
        if not (np.isfinite(self.values).all() and np.isfinite(self.shapes).all()):
            raise ValueError("eigenvalues or shapes are not finite")


class TurbineAdapter(Adapter):
    """Base class of adapters that compute a turbine's modes.

    Attributes:
        levels: refinements, coarse to fine: elements of each blade; at least 1.4 times the one before.
        order: theoretical order of convergence of its frequencies.
        finest: the finest refinement at which it is run.
    """

    levels: tuple[int, ...]
    order: int
    finest: int

    @abstractmethod
    def unsupported_turbine(self, turbine: "Turbine") -> str | None:
        """The reason, in one line, why this code cannot solve this turbine; None if it can."""

    @abstractmethod
    def turbine_modes(self, turbine: "Turbine", omega: float, elements: int, count: int) -> TurbineModes:
        """The ``count`` lowest modes of a supported turbine at ``omega`` (rad/s), without the free rotation of the rotor.

        Raises:
            CodeError: no steady state, or equations that change with the azimuth.
        """

    def turbine_fingerprint(self, turbine: "Turbine", elements: int) -> Fingerprint | None:
        """Mass and inertia of the turbine that this code assembles, see ``fingerprint.of_turbine``; None: not reported."""
        return None

    def solve_turbine(self, turbine: "Turbine", omega: float, elements: int, count: int) -> TurbineModes:
        """Check that the turbine is supported, and compute its modes; arguments as for ``turbine_modes``.

        Raises:
            CodeError: unsupported turbine, no steady state, or no convergence.
        """
        if reason := self.unsupported_turbine(turbine):
            raise CodeError(f"{turbine.name}: {reason}")
        return self.turbine_modes(turbine, omega, elements, count)
