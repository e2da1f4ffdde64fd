"""Multiples of the rotor speed that a table lists as modes."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .findings import DEFECT, Finding

Array = NDArray[np.float64]

TOLERANCE = 2e-3
"""Largest relative deviation of a frequency from a multiple of the rotor speed at every operating point."""

MIN_RANGE = 1.1
"""Ratio of the largest and smallest rotor speed over which proportionality is visible."""


def order_lines(names: Sequence[str], speeds: Array, frequencies: Array) -> tuple[Finding, ...]:
    """Rows of a Campbell table whose frequencies are one multiple of the rotor speed at three or more operating points.

    Args:
        names: of the rows.
        speeds: (k,) rotor speeds, Hz.
        frequencies: (m, k) Hz; NaN where a row has none.
    """
    out = []
    for name, frequency in zip(names, frequencies, strict=True):
        valid = np.isfinite(frequency) & (speeds > 0)
        if np.count_nonzero(valid) < 3 or np.ptp(np.log(speeds[valid])) < np.log(MIN_RANGE):
            continue
        ratio = frequency[valid] / speeds[valid]
        order = int(np.round(np.median(ratio)))
        if order >= 1 and np.abs(ratio / order - 1).max() < TOLERANCE:
            out.append(
                Finding(
                    "order line",
                    DEFECT,
                    f"{name} is {order} times the rotor speed at {np.count_nonzero(valid)} operating points",
                    f"it is the {order}P excitation and no mode: remove it",
                    float(order),
                )
            )
    return tuple(out)
