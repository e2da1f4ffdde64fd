"""Differences by arithmetic alone: a constant unit, squared frequencies, or the frequencies of other modes in the right place.

They are sought before any hypothesis about the blade. A conversion is accepted only if it removes nearly all of a large
difference.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from .spectra import Label

Array = NDArray[np.float64]

CONSTANTS = {
    "2π: rad/s given as Hz": 2.0 * np.pi,
    "1/2π: Hz given as rad/s": 0.5 / np.pi,
    "60: per minute given as per second": 60.0,
    "1/60: per second given as per minute": 1.0 / 60.0,
    "60/2π: rpm given as rad/s": 30.0 / np.pi,
    "2π/60: rad/s given as rpm": np.pi / 30.0,
    "2": 2.0,
    "1/2": 0.5,
    "√2": np.sqrt(2.0),
    "1/√2": np.sqrt(0.5),
}
"""Names and values of constant ratios of a program's frequencies to the solver's."""

LARGE = 0.1
"""Smallest difference (root mean square of logarithms) that arithmetic may explain."""

REMAINS = 0.2
"""Largest part of it that may remain (root mean squares)."""

CLOSE = 0.06
"""Largest root mean square that may remain (logarithms)."""


@dataclass(frozen=True)
class Arithmetic:
    """A conversion: its name, and the (S, M) frequencies of the program (rad/s) and of the solver that correspond with it."""

    name: str
    frequencies: Array
    reference: Array


def arithmetic(
    frequencies: Array, reference: Array, labels: Sequence[Label], all_frequencies: Sequence[Array]
) -> Arithmetic:
    """The best conversion; its name is empty if none removes nearly all of the difference.

    Args:
        frequencies: (S, M) frequencies of a program, nan where unknown.
        reference: (S, M) the solver's, under the same labels.
        labels: (M,) of the modes.
        all_frequencies: S arrays of all frequencies of the solver, ascending.
    """
    plain = Arithmetic("", frequencies, reference)
    start = _size(plain)
    if not start >= LARGE:
        return plain
    candidates = [
        Arithmetic(", ".join(filter(None, (unit, order))), converted, reordered)
        for unit, converted in _units(frequencies)
        for order, reordered in _orders(converted, reference, labels, all_frequencies)
    ]
    best = min(candidates[1:], key=lambda candidate: _size(candidate) * (1.5 if "," in candidate.name else 1.0))
    return best if _size(best) <= min(REMAINS * start, CLOSE) else plain


def difference(frequencies: Array, reference: Array) -> Array:
    """(S, M) logarithms of the ratios; nan where one is unknown."""
    with np.errstate(all="ignore"):
        return np.log(frequencies / reference)


def _size(candidate: Arithmetic) -> float:
    """Root mean square of the difference; infinite if fewer numbers can be compared."""
    values = difference(candidate.frequencies, candidate.reference)[np.isfinite(candidate.frequencies)]
    return float(np.sqrt(np.mean(values**2))) if len(values) and np.isfinite(values).all() else np.inf


def _units(frequencies: Array) -> list[tuple[str, Array]]:
    """The numbers as they are, divided by constants, and as squares."""
    out = [("", frequencies)]
    out += [(f"constant ratio {name}", frequencies / value) for name, value in CONSTANTS.items()]
    out.append(("squared frequencies, (rad/s)²", np.sqrt(frequencies)))
    out.append(("squared frequencies, Hz²", 2.0 * np.pi * np.sqrt(frequencies)))
    return out


def _orders(
    frequencies: Array, reference: Array, labels: Sequence[Label], all_frequencies: Sequence[Array]
) -> list[tuple[str, Array]]:
    """The reference in other orders of the modes, of which the program may have another one, twice as many or a part."""
    out = [("", reference)]
    with np.errstate(all="ignore"):
        distance = np.abs(np.log(frequencies[:, :, None] / reference[:, None, :]))
        cost = np.nansum(distance, axis=0) / (~np.isnan(distance)).sum(axis=0)
    if np.isfinite(cost).all() and len(labels) > 1:
        _, order = linear_sum_assignment(cost)
        exchanged = [k for k, partner in enumerate(order.tolist()) if k != partner]
        if exchanged:
            name = "modes in another order: " + ", ".join(f"{labels[k]} is {labels[order[k]]}" for k in exchanged)
            out.append((name, reference[:, order]))
    if all(isinstance(label, int) for label in labels):
        numbers = np.array(labels, dtype=int) - 1
        rules: dict[str, Callable[[NDArray[np.int64]], NDArray[np.int64]]] = {
            "every mode twice (conjugate pairs)": lambda k: k // 2,
            "half of the modes: the 1st, 3rd, …": lambda k: 2 * k,
            "half of the modes: the 2nd, 4th, …": lambda k: 2 * k + 1,
            "the first mode is missing": lambda k: k + 1,
            "one more mode below the first": lambda k: k - 1,
        }
        out += [(name, _taken(all_frequencies, rule(numbers))) for name, rule in rules.items()]
    return out


def _taken(all_frequencies: Sequence[Array], places: NDArray[np.int64]) -> Array:
    """(S, M) frequencies with these indices among all; nan beyond the last."""
    out = np.full((len(all_frequencies), len(places)), np.nan)
    for row, values in zip(out, all_frequencies, strict=True):
        inside = (places >= 0) & (places < len(values))
        row[inside] = values[places[inside]]
    return out
