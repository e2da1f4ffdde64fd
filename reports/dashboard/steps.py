"""Steps in a series of runs: where a number moved and stayed, as against points that are only noisy."""

from collections.abc import Sequence

import numpy as np

from ...cases.regression.gate import MOVED

BEFORE, AFTER = 4, 3
"""Runs on either side that a step of a timing needs."""

SPREADS, LEAST = 5.0, 0.2
"""A timing's step is more than this many standard deviations (estimated from medians), and this part of what was before."""

TICK = 1e-3
"""Seconds: a shorter change of a time is none."""

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


def timing_steps(seconds: Sequence[float | None]) -> list[tuple[int, float]]:
    """The levels a timing had: where each begins, and its median; more than one if there was a step.

    A step is where ``AFTER`` runs on end lie beyond the scatter of the level before, on one side of it, and ``BEFORE`` runs
    tell what that level was: a single slow run is none, nor are two.
    """
    at = [k for k, value in enumerate(seconds) if value is not None]
    values = np.array([seconds[k] for k in at], float)
    begins, k = [0], BEFORE
    while k <= len(values) - AFTER:
        before, after = values[begins[-1] : k], values[k : k + AFTER]
        level = float(np.median(before))
        spread = SIGMA * float(np.median(np.abs(before - level)))
        away = (after - level) / max(SPREADS * spread, LEAST * level, TICK)
        if (away > 1).all() or (away < -1).all():
            begins.append(k)
            k += BEFORE
        else:
            k += 1
    ends = [*begins[1:], len(values)]
    return [(at[a], float(np.median(values[a:b]))) for a, b in zip(begins, ends, strict=True)] if at else []
