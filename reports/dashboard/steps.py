"""Detects steps in a series of runs: lasting changes of a number, as opposed to noise."""

from collections.abc import Sequence

import numpy as np

from ...cases.regression.gate import MOVED

BEFORE, AFTER = 4, 3
"""Number of runs required before and after a step of a run time."""

SPREADS, LEAST = 5.0, 0.2
"""A step exceeds this many standard deviations (estimated from medians), and this fraction of the earlier level."""

TICK = 1e-3
"""Smallest change of a run time that counts, seconds."""

SIGMA = 1.4826
"""Ratio of standard deviation to median absolute deviation of a normal distribution (Hampel 1974)."""


def frequency_steps(values: Sequence[float | None]) -> list[int]:
    """Positions at which a frequency differs from its previous value; frequencies have no noise."""
    out, last = [], None
    for k, value in enumerate(values):
        if value is None:
            continue
        if last is not None and abs(value - last) > MOVED * abs(last):
            out.append(k)
        last = value
    return out


def timing_steps(seconds: Sequence[float | None]) -> list[tuple[int, float]]:
    """The levels of a run time: the position where each begins, and its median; several if there are steps.

    At a step, ``AFTER`` consecutive runs lie on the same side of the earlier level, beyond its scatter, which is
    estimated from at least ``BEFORE`` runs. One or two slow runs are not a step.
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
