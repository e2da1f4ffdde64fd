"""Diagnosis: why the frequencies of another program differ from the solver's.

First arithmetic, then the division into an offset at rest and a slope with speed, then the hypotheses, solved one by one and,
if one does not suffice, in pairs. A cause is named only if it explains more than chance; otherwise no cause is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.blade import Blade
from ..input import readers
from ..input.readers import BladeFile, Mount
from . import decks, spectra
from .arithmetic import arithmetic, difference
from .hypotheses import ALL
from .ranking import Cause, rank
from .spectra import Change, Label, Problem
from .split import ModeSplit, indication, split

Array = NDArray[np.float64]

UNCERTAINTY = 1e-4
"""Relative differences of frequencies up to this need no cause, unless the caller knows better."""

SHOWN, LIKELY = 3, 0.1
"""Number of causes that a result lists, and their largest probability by chance."""

MAX_SPEEDS = 4
"""Number of speeds that are solved: the lowest, the highest and some between."""


@dataclass(frozen=True)
class Diagnosis:
    """Why a program's frequencies differ.

    Attributes:
        largest: largest relative difference, after the arithmetic; nan without a number to compare.
        uncertainty: relative; differences up to this need no cause.
        arithmetic: the conversion that makes the numbers comparable; empty if none is needed.
        modes: offset at rest and slope with speed of each mode.
        indication: what offset and slope say, in words; empty if nothing.
        causes: the most probable causes first; whether one is known is in ``cause``.
        ties: causes that the numbers do not tell apart from the first.
        without_effect: hypotheses that change no frequency of this blade.
    """

    largest: float
    uncertainty: float
    arithmetic: str
    modes: tuple[ModeSplit, ...]
    indication: str
    causes: tuple[Cause, ...]
    ties: tuple[Cause, ...]
    without_effect: tuple[str, ...]

    @property
    def agrees(self) -> bool:
        """Whether nothing remains to be explained."""
        return self.largest <= 3.0 * self.uncertainty

    @property
    def cause(self) -> Cause | None:
        """The known cause; None if there is none, or nothing to explain."""
        return self.causes[0] if self.causes and self.causes[0].named else None

    @property
    def sentence(self) -> str:
        """The diagnosis in one line."""
        if not np.isfinite(self.largest):
            return "no diagnosis: no frequency can be compared"
        first = f"{self.arithmetic}; then " if self.arithmetic else ""
        if self.agrees:
            end = f"all frequencies agree within {percent(self.largest)}"
            return f"{first}{end}" if first else end
        if self.cause:
            alternatives = "".join(f"; or {described(cause.changes)}" for cause in self.ties)
            changes = f"{described(self.cause.changes)} ({self._remainder(self.cause)})"
            return f"{first}agrees with Southwell's own solver {changes}{alternatives}"
        hint = f"; {self.indication}" if self.indication else ""
        return f"{first}no known cause of {percent(self.largest)}{hint}"

    def __str__(self) -> str:
        """The sentence, then the most probable causes and the modes, one line each."""
        return "\n".join([self.sentence, *cause_lines(self), *mode_lines(self)])

    def _remainder(self, cause: Cause) -> str:
        of = f" of {percent(self.largest)}" if cause.remains > 0.1 * self.largest else ""
        return f"{percent(cause.remains)}{of} remains"


def diagnose(
    blade: Blade,
    speeds: ArrayLike,
    frequencies: ArrayLike,
    modes: Sequence[Label] | None = None,
    *,
    by_shape: bool = False,
    uncertainty: float = UNCERTAINTY,
    deck: str | Path | BladeFile | None = None,
) -> Diagnosis:
    """Explain the differences of a program's frequencies from the solver's.

    Args:
        blade: the blade that was meant.
        speeds: (S,) rotor speeds, rad/s.
        frequencies: (S, M) frequencies of the program, rad/s; nan where unknown.
        modes: (M,) numbers among all modes of the blade, from 1, or names as ``flapwise 1``; by default 1 … M.
        by_shape: whether labels are of the solver's modes, to which the program's were paired by shape.
        uncertainty: relative uncertainty of the program's numbers; smaller differences are not explained.
        deck: file that the blade was read from, if it was: how HAWC2 and ElastoDyn describe a blade of it is then among the
            hypotheses.

    Raises:
        ValueError: arrays of other shapes, or nothing to compare.
        CaseError: the deck cannot be read.
    """
    omega, values = np.asarray(speeds, float), np.atleast_2d(np.asarray(frequencies, float))
    labels = tuple(modes) if modes is not None else tuple(range(1, values.shape[-1] + 1))
    if values.shape != (len(omega), len(labels)):
        raise ValueError(f"frequencies: shape {values.shape}, expected {(len(omega), len(labels))}: speeds × modes")
    if not np.isfinite(values).any():
        raise ValueError("frequencies: none is finite")
    rows = _rows(omega, values)
    kinds = ALL if deck is None else (*decks.hypotheses(_file(deck), blade), *ALL)
    problem = Problem(blade, tuple(omega[rows].tolist()), labels, by_shape, {kind.name: kind for kind in kinds})
    return explain(problem, values[rows], uncertainty)


def _file(deck: str | Path | BladeFile) -> BladeFile:
    if isinstance(deck, BladeFile):
        return deck
    reading = readers.reading(Path(deck))
    return BladeFile(Path(deck), reading.blade, reading.source, Mount())


def explain(problem: Problem, frequencies: Array, uncertainty: float = UNCERTAINTY) -> Diagnosis:
    """As ``diagnose``, for frequencies (S, M) at all speeds of a problem, whose solutions are kept for other numbers."""
    reference = spectra.reference(problem)
    frequencies = np.where(np.isfinite(reference) & (frequencies > 0), frequencies, np.nan)
    if not np.isfinite(frequencies).any():
        return Diagnosis(np.nan, uncertainty, "", (), "", (), (), ())
    all_frequencies = [
        spectrum.frequencies if spectrum else np.zeros(0) for spectrum in spectra.solved(problem, (), spectra.FINE)
    ]
    converted = arithmetic(frequencies, reference, problem.labels, all_frequencies)
    D = difference(converted.frequencies, converted.reference)
    largest = float(np.nanmax(np.abs(np.expm1(D))))
    mode_names = _names(problem, converted.reference)
    parts = split(mode_names, np.array(problem.speeds), converted.frequencies, converted.reference)
    hint = indication(parts, max(map(abs, problem.speeds)), uncertainty)
    if largest <= 3.0 * uncertainty or (converted.name and not _same_modes(converted.reference, reference)):
        return Diagnosis(largest, uncertainty, converted.name, parts, hint, (), (), ())
    ranking = rank(problem, D, uncertainty)
    return Diagnosis(
        largest,
        uncertainty,
        converted.name,
        parts,
        hint,
        ranking.causes,
        ranking.ties,
        ranking.without_effect,
    )


def _rows(omega: Array, frequencies: Array) -> list[int]:
    """Rows to solve: those with most numbers, evenly distributed over the speeds."""
    rows = np.flatnonzero(np.isfinite(frequencies).any(1))
    rows = rows[np.argsort(omega[rows], kind="stable")]
    if len(rows) > MAX_SPEEDS:
        targets = np.linspace(omega[rows[0]], omega[rows[-1]], MAX_SPEEDS)
        rows = rows[sorted({int(np.abs(omega[rows] - speed).argmin()) for speed in targets})]
    return rows.tolist()


def _names(problem: Problem, reference: Array) -> list[list[str]]:
    """(S × M) names of the solver's modes with these frequencies."""
    out = []
    for row, (spectrum, names_at_speed) in enumerate(
        zip(spectra.solved(problem, (), spectra.FINE), spectra.names(problem), strict=True)
    ):
        line = []
        for value in reference[row]:
            line.append(
                names_at_speed[int(np.abs(spectrum.frequencies - value).argmin())]
                if spectrum and np.isfinite(value)
                else ""
            )
        out.append(line)
    return out


def _same_modes(a: Array, b: Array) -> bool:
    return bool(np.array_equal(a, b, equal_nan=True))


def described(changes: Sequence[Change]) -> str:
    """Hypotheses in words: ``without hub radius``, ``with 0.986 × the mass``, joined by *and*."""
    return " and ".join(_described(name, factor) for name, factor in changes)


def _described(name: str, factor: float) -> str:
    if factor == 1.0:
        return name
    also = " (or the inverse factor on all stiffness)" if name == "mass" else ""
    return f"with {factor:.4g} × the {name}{also}"


def percent(value: float) -> str:
    """A relative difference with two significant digits, in percent."""
    return f"{np.format_float_positional(100.0 * value, precision=2, fractional=False, trim='-')} %"


def cause_lines(diagnosis: Diagnosis) -> tuple[str, ...]:
    """The most probable causes, one line each: what they explain, what remains, and the probability by chance."""
    return tuple(_cause(cause) for cause in diagnosis.causes[:SHOWN] if cause.chance <= LIKELY)


def _cause(cause: Cause) -> str:
    explained = f"{100.0 * max(cause.explained, 0.0):.4g} %"
    chance = f"; by chance {cause.chance:.1g}" if cause.chance > 1e-6 else ""
    return f"{described(cause.changes)}: explains {explained}, leaves {percent(cause.remains)}{chance}"


def mode_lines(diagnosis: Diagnosis) -> tuple[str, ...]:
    """One line for each mode: the difference at rest, and both slopes."""
    return tuple(f"{mode.mode}: {_split(mode)}" for mode in diagnosis.modes if np.isfinite(mode.offset))


def _split(mode: ModeSplit) -> str:
    at_rest = f"at rest {100.0 * mode.offset:+.3f} %"
    slope = f", φ {mode.slope:.4g} instead of {mode.slope_reference:.4g}" if np.isfinite(mode.slope) else ""
    return f"{at_rest}{slope}".replace("-", "−")
