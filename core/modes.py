"""Natural frequencies and mode shapes in the form that every code returns."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STATIONS: Array = np.linspace(0.0, 1.0, 21)
"""Fractions of the blade's length at which every code samples its mode shapes."""


@dataclass(frozen=True)
class Modes:
    """Natural frequencies and mode shapes of a blade at one rotor speed.

    Attributes:
        omega: rotor speed, rad/s.
        frequencies: (m,) natural frequencies, rad/s, ascending.
        shapes: (m, 21, 4) complex: displacement along the blade axes x, y, z (m) and rotation about x (rad) of the
            reference curve at ``STATIONS``, at any scale; the real part of shape × exp(iωt) is the motion, so that the
            phase contains the gyroscopic lag.
        elements: refinement: number of elements, or of terms in a series.
        damping: (m,) damping ratios, zero for undamped models.
        uncertainty: (m,) relative uncertainty, if the code estimates it; empty: determined by refinement.
        rounding: (m,) relative error due to rounding alone, if the code estimates it; empty: not estimated.
        strain: largest steady strain of the reference curve (axial and shear); nan: not computed.
        seconds: wall time of the solution; nan: not measured, as of an answer from the store.
    """

    omega: float
    frequencies: Array
    shapes: NDArray[np.complex128]
    elements: int
    damping: Array = field(default_factory=lambda: np.zeros(0))
    uncertainty: Array = field(default_factory=lambda: np.zeros(0))
    rounding: Array = field(default_factory=lambda: np.zeros(0))
    strain: float = float("nan")
    seconds: float = 0.0

    def __post_init__(self) -> None:
        if self.shapes.shape != (len(self.frequencies), len(STATIONS), 4):
            raise ValueError(f"shapes: {self.shapes.shape}, expected {(len(self.frequencies), len(STATIONS), 4)}")
        if not (np.isfinite(self.frequencies).all() and np.isfinite(self.shapes).all()):
            raise ValueError("frequencies or shapes are not finite")
        if not len(self.damping):
            object.__setattr__(self, "damping", np.zeros(len(self.frequencies)))
