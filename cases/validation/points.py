"""A measured point and the simulated value."""

from dataclasses import dataclass

import numpy as np

from ..judge.measured import Validation

RPM = np.pi / 30.0
"""rad/s."""


@dataclass(frozen=True)
class Point:
    """A measured point and the simulated value, both in Hz."""

    line: str
    rpm: float
    validation: Validation
