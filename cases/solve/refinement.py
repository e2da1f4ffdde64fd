"""One solver's frequencies of one blade at many speeds, refined until they are converged.

The modes of every refinement are paired with the same reference modes, so that a sequence of frequencies belongs to one
mode.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.modes import Modes
from ...references.protocol.process import Failure
from ...references.protocol.worker import Answer, Run
from ..judge.pairing import Pair, pair
from ..judge.uncertainty import Estimate, from_bracket, from_refinement, widened

Array = NDArray[np.float64]
Ask = Callable[[Sequence[Run]], list[Answer]]

SURE = 2e-4
"""A code is refined until its relative uncertainty is at most this."""

LEAST, MOST = 4 / 3, 2.0
"""Ratio of a further refinement to the one before. Below 1.3, the observed order of convergence is uncertain (Celik et al.,
J. Fluids Eng. 130 (2008) 078001)."""

AIM = 0.5
"""Uncertainty at which a further refinement aims, as a fraction of the largest allowed."""


@dataclass(frozen=True)
class Refining:
    """Refinement of a solver: all ``levels`` first; then finer ones, up to ``cap``, until its uncertainty is ``sure``.

    Further ones are multiples of the first, as fine as the ``order`` of convergence requires: from ``least`` to ``MOST`` times
    the one before. ``bracket``: the solver gives an error bound, ``Modes.uncertainty``, so that no refinement is needed.
    """

    levels: tuple[int, ...]
    order: int
    cap: int
    sure: float = SURE
    bracket: bool = False
    least: float = LEAST


@dataclass(frozen=True)
class RefinedMode:
    """One mode, followed through the refinements.

    Attributes:
        estimate: None if no refinement had a partner for the mode.
        partner: at the finest refinement.
        history: (elements, frequency in rad/s) of every refinement that had a partner.
        bracketed: whether the uncertainty is the error bound of the code rather than from refinement.
    """

    estimate: Estimate | None
    partner: Pair
    history: tuple[tuple[int, float], ...]
    bracketed: bool = False


@dataclass(frozen=True)
class Refinements:
    """A solver's answer at one speed: its modes at every refinement, and why the finest is missing, if it is."""

    answers: tuple[Modes, ...]
    failure: Failure | None = None


@dataclass(frozen=True)
class Wanted:
    """Modes wanted at one speed: ``indices`` among the modes of ``reference``; ``weight`` as in ``pairing``."""

    reference: Modes
    indices: tuple[int, ...]
    weight: Array


def solve(
    ask: Ask,
    speeds: Sequence[float],
    refining: Refining,
    count: int,
    wanted: Callable[[float, Sequence[Modes]], Wanted],
) -> list[Refinements]:
    """Refinements at each speed. Coarse ones are solved first, so that a time limit affects only the fine ones.

    Args:
        ask: the solver.
        speeds: rad/s.
        refining: how it is refined.
        count: number of modes to request.
        wanted: modes that must converge at a speed, from the answers at that speed so far (at least one).
    """
    runs = [(omega, n, count) for n in refining.levels for omega in speeds]
    finest = dict.fromkeys(speeds, refining.levels[-1])
    solved: dict[float, list[Modes]] = {omega: [] for omega in speeds}
    failed: dict[float, Failure] = {}
    while runs:
        for (omega, _, _), answer in zip(runs, ask(runs), strict=True):
            wrong = omega in failed and failed[omega].kind == "nonsense"  # final, whatever other refinements give
            if isinstance(answer, Modes) and solved[omega] and answer.elements <= solved[omega][-1].elements:
                answer = Failure(
                    "nonsense", f"elements: {answer.elements} after {solved[omega][-1].elements}: not refined"
                )
            if isinstance(answer, Failure):
                failed[omega] = failed[omega] if wrong else answer
            else:
                solved[omega].append(answer)
                if not wrong:
                    failed.pop(omega, None)
        open_ = [omega for omega in speeds if omega not in failed]
        unsure = {omega: _unsure(solved[omega], wanted(omega, solved[omega]), refining) for omega in open_}
        finer = {omega: _finer(finest[omega], u, refining) for omega, u in unsure.items() if u > refining.sure}
        runs = sorted(
            ((omega, n, count) for omega, n in finer.items() if n >= refining.least * finest[omega]), key=lambda r: r[1]
        )
        finest |= finer
    return [Refinements(tuple(solved[omega]), failed.get(omega)) for omega in speeds]


def _unsure(answers: Sequence[Modes], wanted: Wanted, refining: Refining) -> float:
    """The largest uncertainty of a wanted mode that refinement may reduce; infinite if one is not known."""
    modes = follow(answers, wanted, refining.order, refining.bracket)
    known = [m.estimate.uncertainty for m in modes if m.estimate and not m.bracketed]
    return max((np.inf if u is None else u for u in known), default=0.0)


def _finer(finest: int, uncertainty: float, refining: Refining) -> int:
    """The number of elements after ``finest``, at most the cap."""
    ratio = (uncertainty / (AIM * refining.sure)) ** (1.0 / refining.order) if refining.order else MOST
    first = refining.levels[0]
    multiple = math.ceil(finest * min(max(ratio, refining.least), MOST) / first - 1e-9)
    return min(first * multiple, refining.cap)


def follow(answers: Sequence[Modes], wanted: Wanted, order: int, bracket: bool = False) -> list[RefinedMode]:
    """The estimate of each wanted mode from a solver's answers, coarse to fine; ``bracket`` as in ``Refining``."""
    pairs = [pair(wanted.reference, modes, wanted.indices, wanted.weight) for modes in answers]
    return [_follow(answers, [level[i] for level in pairs], order, bracket) for i in range(len(wanted.indices))]


def _follow(answers: Sequence[Modes], partners: Sequence[Pair], order: int, bracket: bool) -> RefinedMode:
    found = [(m, p.mode) for m, p in zip(answers, partners, strict=True) if p.mode is not None]
    last = partners[-1] if partners else Pair(None, 0.0, "no partner: the code returned no modes")
    history = tuple((m.elements, float(m.frequencies[k])) for m, k in found)
    if last.mode is None:
        return RefinedMode(None, last, history)
    own = float(answers[-1].uncertainty[last.mode]) if len(answers[-1].uncertainty) else None
    if bracket and own is not None:
        return RefinedMode(from_bracket(history[-1][1], own), last, history, bracketed=True)
    refined = from_refinement([n for n, _ in history], [f for _, f in history], order)
    return RefinedMode(widened(refined, own or 0.0), last, history)
