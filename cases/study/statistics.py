"""What a study has found: counts of its rows, and the spread of each frequency over the samples."""

from collections.abc import Iterable
from dataclasses import dataclass

import pandas as pd

from .rows import INTERNAL, Row


@dataclass(frozen=True)
class Outcome:
    """Counts of a study.

    Attributes:
        frequencies: number of frequencies.
        missing: number of speeds of samples without a frequency.
        internal: how many of these are due to a defect of this package.
        reason: the reason of the first missing one, with its sample; empty if there is none.
    """

    frequencies: int = 0
    missing: int = 0
    internal: int = 0
    reason: str = ""


def outcome(rows: Iterable[Row]) -> Outcome:
    """Count the rows of a study, one by one."""
    frequencies = missing = internal = 0
    first = ""
    for row in rows:
        if row.reason is None:
            frequencies += 1
            continue
        missing += 1
        internal += row.reason.startswith(INTERNAL)
        first = first or f"{row.blade}, sample {row.sample}: {row.reason}"
    return Outcome(frequencies, missing, internal, first)


def spreads(rows: Iterable[Row]) -> pd.DataFrame:
    """Spread of the frequencies over the samples, in rad/s; all of them are in memory.

    Returns:
        One line for each blade, omega (rad/s) and mode number: the most frequent name of the mode, the number of samples,
        mean, standard deviation (nan for one sample), and the 5th and 95th percentile. The number is that of each
        sample's own order, so that it belongs to different motions if samples exchange the order of two modes.
    """
    columns = ["blade", "omega", "mode", "name", "frequency"]
    table = pd.DataFrame(
        ((r.blade, r.omega_rad_s, r.mode, r.name, r.frequency_rad_s) for r in rows if r.reason is None),
        columns=pd.Index(columns),
    )
    groups = table.groupby(columns[:3], as_index=False)
    return groups.agg(
        name=("name", lambda names: names.value_counts().index[0]),
        samples=("frequency", "size"),
        mean=("frequency", "mean"),
        deviation=("frequency", "std"),
        low=("frequency", lambda values: values.quantile(0.05)),
        high=("frequency", lambda values: values.quantile(0.95)),
    )
