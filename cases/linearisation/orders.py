"""Multiples of the rotor speed that a table lists as modes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .findings import DEFECT, Finding

Array = NDArray[np.float64]

TOLERANCE = 2e-3
"""Largest relative deviation of a frequency from a multiple of the rotor speed at every operating point."""

MIN_RANGE = 1.1
"""Ratio of the largest and smallest rotor speed over which proportionality is visible."""


@dataclass(frozen=True)
class TrackedFrequency:
    """Frequencies of one row of a Campbell table.

    Attributes:
        name: of the row.
        speeds: rotor speeds, Hz.
        frequencies: Hz; NaN where the row has none.
        uncertainty: relative to the frequencies.
    """

    name: str
    speeds: Array
    frequencies: Array
    uncertainty: Array


def order_lines(lines: Sequence[TrackedFrequency], where: str) -> tuple[Finding, ...]:
    """Rows whose frequencies are one multiple of the rotor speed at three or more operating points."""
    out = []
    for line in lines:
        valid = np.isfinite(line.frequencies) & (line.speeds > 0)
        if np.count_nonzero(valid) < 3 or np.ptp(np.log(line.speeds[valid])) < np.log(MIN_RANGE):
            continue
        ratio = line.frequencies[valid] / line.speeds[valid]
        order = int(np.round(np.median(ratio)))
        if order >= 1 and np.abs(ratio / order - 1).max() < TOLERANCE:
            out.append(
                Finding(
                    "order line",
                    DEFECT,
                    where,
                    f"{line.name} is {order} times the rotor speed at {np.count_nonzero(valid)} operating points",
                    f"it is the {order}P excitation and no mode: remove it",
                    float(order),
                )
            )
    return tuple(out)
