"""One measured point beside the simulation."""

from dataclasses import dataclass

import numpy as np

from ..judge.measured import Validation

RPM = np.pi / 30.0
"""rad/s."""


@dataclass(frozen=True)
class Point:
    """One measured point beside what the model gives there, both in Hz."""

    line: str
    rpm: float
    validation: Validation
