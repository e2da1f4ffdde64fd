"""Steps in a series of runs: where a number moved and stayed, as against points that are only noisy."""

from collections.abc import Sequence

import numpy as np

MOVED = 1e-9
"""Relative: what frequencies may differ by from run to run."""

BEFORE, AFTER = 4, 2
"""Runs on either side that a step of a timing needs."""

SPREADS, LEAST = 5.0, 0.2
"""A timing's step is more than this many standard deviations (estimated from medians), and this part of what was before."""

SIGMA = 1.4826
"""Standard deviation over median absolute deviation, of a normal distribution (Hampel 1974)."""


def frequency_steps(values: Sequence[float | None]) -> list[int]:
    """Where a frequency differs from the last one before it: it has no noise, so every move is one."""
    out, last = [], None
    for k, value in enumerate(values):
        if value is None:
            continue
        if last is not None and abs(value - last) > MOVED * abs(last):
            out.append(k)
        last = value
    return out


def timing_steps(seconds: Sequence[float | None]) -> list[int]:
    """Where a timing's level changes: the median of the runs from there on against the median and spread of those before.

    A single slow run is no step: at least ``AFTER`` runs must follow it at the new level, and ``BEFORE`` stand before.
    """
    at = [k for k, value in enumerate(seconds) if value is not None]
    values = np.array([seconds[k] for k in at], float)
    out, begin, k = [], 0, BEFORE
    while k <= len(values) - AFTER:
        before, after = values[begin:k], values[k : k + max(AFTER, 3)]
        level = float(np.median(before))
        spread = SIGMA * float(np.median(np.abs(before - level)))
        beyond = np.abs(after - level) > max(SPREADS * spread, LEAST * level)
        same_side = np.ptp(np.sign(after - level)) == 0
        if beyond.all() and same_side:
            out.append(at[k])
            begin, k = k, k + BEFORE
        else:
            k += 1
    return out
