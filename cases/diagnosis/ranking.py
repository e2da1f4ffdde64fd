"""Which hypotheses explain a difference, by how much, and whether that beats chance.

A difference is the vector D of the natural logarithms of the ratios of a program's frequencies to the solver's; a hypothesis
predicts δ, and r = D − δ remains. Among vectors of D's length in n dimensions with random direction, the part within r of a
fixed δ is a spherical cap (S. Li, *Asian J. Math. Stat.* 4, 2011, 66), ½ I_ρ((n − 1)/2, ½) with ρ = |r|²/|D|² and I the
regularised incomplete beta function, times at most 2√ρ for the length; with one fitted factor, I_ρ((n − 1)/2, ½). Times the
number of hypotheses of the kind it bounds the probability that one of them explains as much by chance. Speeds are not
independent: a mode's differences have two degrees of freedom at most (Southwell's ω² = ω₀² + φΩ²), and one if they are
nearly the same at all speeds.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.special import betainc

from .spectra import Change, Problem, effect

Array = NDArray[np.float64]

CHANCE = 5e-3
"""Largest probability that a named cause explains as much by chance."""

UNEXPLAINED, UNFITTED = 0.35, 0.2
"""Largest remainder of a named cause, as a fraction of the difference (root mean squares); the second with a fitted factor."""

VISIBLE = 2.0
"""A hypothesis has an effect if the largest change is at least this multiple of the uncertainty."""

EQUAL = 1e-7
"""Changes of frequencies within this are those of the same cause in other words."""

LIKELIHOOD = 3.0
"""Two causes are not told apart if their log likelihoods differ by less than this."""

STEADY = 0.3
"""A mode's difference is the same at all speeds if it varies by less than this fraction of its largest value."""

TRIED_PAIRS, FITTED_PAIRS, FITTED = 8, 3, 4
"""Largest numbers of pairs, pairs with a factor, and factors that are solved, after a linear estimate of all."""

PROMISING = 0.5
"""Largest chance, by the linear estimate, of what is solved, apart from the best factor."""

SHOWN = 5
"""Largest number of causes returned."""

NOISE = 1.5
"""A cause that leaves at most this multiple of the uncertainty (root mean square) needs no factor and no second cause."""

FIT_STEP, FITS, MAX_FACTOR = 1.02, 3, 100.0
"""Factor for the derivative, number of iterations, and largest fitted factor."""


@dataclass(frozen=True)
class Cause:
    """One explanation of a difference.

    Attributes:
        changes: hypotheses, with their factors.
        explained: part of the difference's sum of squares that it explains, at most 1.
        remains: largest relative difference that remains.
        rms: root mean square of what remains.
        chance: bound of the probability that a hypothesis of this kind explains as much by chance.
        prediction: (S, M) its effect on the frequencies (logarithms).
    """

    changes: tuple[Change, ...]
    explained: float
    remains: float
    rms: float
    chance: float
    prediction: Array

    @property
    def named(self) -> bool:
        """Whether it explains enough, and more than chance."""
        limit = UNEXPLAINED if _is_fixed(self) else UNFITTED
        return self.chance <= CHANCE and self.explained >= 1.0 - limit**2


@dataclass(frozen=True)
class Ranking:
    """Causes, the most probable first; those that are not told apart from it; the hypotheses without effect on this blade."""

    causes: tuple[Cause, ...]
    ties: tuple[Cause, ...]
    without_effect: tuple[str, ...]


def freedom(difference: Array) -> int:
    """Degrees of freedom of differences (S, M), nan where unknown: two for a mode whose difference moves with speed, or one."""
    out = 0
    for column in difference.T:
        values = column[np.isfinite(column)]
        if len(values):
            out += 2 if np.ptp(values) > STEADY * np.abs(values).max() else 1
    return out


def chance(share: float, dimensions: int, kinds: int, fitted: int = 0) -> float:
    """Bound of the probability that one of ``kinds`` hypotheses leaves at most the ``share`` ρ of a random difference."""
    if dimensions <= fitted:
        return 1.0
    share = min(max(share, 0.0), 1.0)
    if fitted:
        probability = float(betainc((dimensions - fitted) / 2, fitted / 2, share))
    else:
        cap = 0.5 * float(betainc((dimensions - 1) / 2, 0.5, share)) if dimensions > 1 else 0.5
        probability = cap * min(1.0, 2.0 * np.sqrt(share))
    return min(1.0, kinds * probability)


def rank(problem: Problem, difference: Array, uncertainty: float) -> Ranking:
    """Rank single hypotheses, those with a fitted factor, and, if more remains than the uncertainty, pairs.

    Args:
        problem: the blade, speeds and modes.
        difference: (S, M) logarithms of the ratios of the program's frequencies to the solver's; nan where unknown.
        uncertainty: relative; differences up to this need no cause.
    """
    search = _Search(problem, difference, uncertainty)
    single, invisible = search.fixed()
    causes = [search.cause(((name, 1.0),), len(single)) for name in single]
    if not search.is_enough(causes):
        factors = (name for name, hypothesis in problem.hypotheses.items() if hypothesis.fitted)
        slopes = {name: effect(problem, ((name, FIT_STEP),)) / np.log(FIT_STEP) for name in factors}
        slopes = {name: slope for name, slope in slopes.items() if search.is_visible(0.1 * slope)}
        causes += search.fitted(slopes)
        if not search.is_enough(causes):
            causes += search.pairs(single, slopes)
    best = _ordered(causes)
    ties = tuple(cause for cause in best[1:] if cause.named and search.is_tied(cause, best[0])) if best else ()
    return Ranking(tuple(best[:SHOWN]), ties, tuple(invisible))


def _ordered(causes: Sequence[Cause]) -> list[Cause]:
    return sorted(causes, key=lambda cause: (cause.chance, cause.rms))


@dataclass(frozen=True)
class _Search:
    problem: Problem
    difference: Array
    uncertainty: float

    def is_visible(self, prediction: Array) -> bool:
        values = prediction[np.isfinite(self.difference)]
        return bool(np.isfinite(values).all() and np.abs(values).max(initial=0.0) >= VISIBLE * self.uncertainty)

    def fixed(self) -> tuple[dict[str, Array], list[str]]:
        """Effects of the hypotheses without a factor that change a frequency, and the names of those that change none."""
        visible: dict[str, Array] = {}
        invisible: list[str] = []
        finite = np.isfinite(self.difference)
        for name, hypothesis in self.problem.hypotheses.items():
            if hypothesis.fitted:
                continue
            prediction = effect(self.problem, ((name, 1.0),))
            if not np.isfinite(prediction[finite]).all():
                continue
            if not self.is_visible(prediction):
                invisible.append(name)
            elif not any(np.abs((prediction - explanation)[finite]).max() <= EQUAL for explanation in visible.values()):
                visible[name] = prediction
        return visible, invisible

    def cause(self, changes: tuple[Change, ...], kinds: int, fitted: int = 0) -> Cause:
        """What one hypothesis, or several together, explain."""
        prediction = effect(self.problem, changes)
        finite = np.isfinite(self.difference)
        remainder = (self.difference - prediction)[finite]
        size = float((self.difference[finite] ** 2).sum())
        if not np.isfinite(remainder).all() or not size:
            return Cause(changes, 0.0, np.inf, np.inf, 1.0, prediction)
        floor = finite.sum() * self.uncertainty**2
        share = float(max((remainder**2).sum(), floor)) / size
        return Cause(
            changes=changes,
            explained=1.0 - float((remainder**2).sum()) / size,
            remains=float(np.abs(remainder).max()),
            rms=float(np.sqrt((remainder**2).mean())),
            chance=chance(share, freedom(self.difference), kinds, fitted),
            prediction=prediction,
        )

    def is_enough(self, causes: Sequence[Cause]) -> bool:
        """Whether the best cause leaves no more than the uncertainty."""
        best = min((cause.rms for cause in causes if cause.named), default=np.inf)
        return best <= NOISE * self.uncertainty

    def fitted(self, slopes: dict[str, Array]) -> list[Cause]:
        """Causes with a factor: those that explain most to first order, with the factor refined."""
        finite = np.isfinite(self.difference)
        D = self.difference[finite]
        squares = {name: remaining_square(D, slope[finite]) for name, slope in slopes.items()}
        best = sorted(squares, key=lambda name: squares[name])[:FITTED]
        promising = best[:1] + [name for name in best[1:] if self._is_promising(squares[name], len(slopes), 1)]
        return [self._refined((), name, slopes[name], len(slopes)) for name in promising]

    def _is_promising(self, square: float, kinds: int, fitted: int = 0) -> bool:
        size = float((self.difference[np.isfinite(self.difference)] ** 2).sum())
        return chance(square / size, freedom(self.difference), kinds, fitted) <= PROMISING

    def _refined(self, changes: tuple[Change, ...], name: str, slope: Array, kinds: int) -> Cause:
        """The factor by Gauss–Newton steps, with the secant from the last factor as slope."""
        finite = np.isfinite(self.difference)
        a, best = 0.0, Cause(changes, 0.0, np.inf, np.inf, 1.0, slope)
        begin = effect(self.problem, changes) if changes else np.zeros_like(slope)
        prediction = begin
        for _ in range(FITS):
            remainder = (self.difference - prediction)[finite]
            a += float(remainder @ slope[finite] / (slope[finite] @ slope[finite]))
            if not 1e-6 < abs(a) <= np.log(MAX_FACTOR):
                break
            cause = self.cause((*changes, (name, float(np.exp(a)))), kinds, fitted=1)
            if not cause.rms < best.rms:
                break
            best, prediction = cause, cause.prediction
            slope = (prediction - begin) / a
        return best

    def pairs(self, single: dict[str, Array], slopes: dict[str, Array]) -> list[Cause]:
        """Pairs that explain most if their effects are added, solved together."""
        finite = np.isfinite(self.difference)
        D = self.difference[finite]
        squares = {
            (a, b): float(((D - single[a][finite] - single[b][finite]) ** 2).sum()) for a, b in combinations(single, 2)
        }
        best = sorted(squares, key=lambda names: squares[names])[:TRIED_PAIRS]
        out = [
            self.cause(((a, 1.0), (b, 1.0)), len(squares))
            for a, b in best
            if self._is_promising(squares[a, b], len(squares))
        ]
        mixed = {
            (name, factor): remaining_square(D - prediction[finite], slope[finite])
            for name, prediction in single.items()
            for factor, slope in slopes.items()
        }
        for name, factor in sorted(mixed, key=lambda names: mixed[names])[:FITTED_PAIRS]:
            if self._is_promising(mixed[name, factor], len(mixed), 1):
                out.append(self._refined(((name, 1.0),), factor, slopes[factor], len(mixed)))
        return out

    def is_tied(self, cause: Cause, best: Cause) -> bool:
        """Whether the numbers do not tell a cause from the best: log likelihoods, with the best one's remainder as noise."""
        finite = np.isfinite(self.difference)
        variance = max(self.uncertainty, best.rms) ** 2
        squares = [finite.sum() * cause.rms**2 for cause in (cause, best)]
        same_kind = len(cause.changes) <= len(best.changes) and (_is_fixed(cause) or not _is_fixed(best))
        return same_kind and (squares[0] - squares[1]) / (2.0 * variance) < LIKELIHOOD


def _is_fixed(cause: Cause) -> bool:
    """Whether no factor was fitted."""
    return all(factor == 1.0 for _, factor in cause.changes)


def remaining_square(difference: Array, slope: Array) -> float:
    """Sum of squares that remains of ``difference`` after the best multiple of ``slope``."""
    return float(difference @ difference - (difference @ slope) ** 2 / (slope @ slope))
