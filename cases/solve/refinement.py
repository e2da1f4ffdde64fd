"""One solver's frequencies of one blade at many speeds, refined until they are converged.

The modes of every refinement are paired with the same reference modes, so that a sequence of frequencies belongs to one
mode.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...references.protocol.process import Failure
from ...references.protocol.worker import Run
from ..judge.convergence import Compared, Refinements, follow
from ..judge.spectrum import Answer, Spectrum

Ask = Callable[[Sequence[Run]], list[Answer]]

MAX_UNCERTAINTY = 2e-4
"""A code is refined until its relative uncertainty is at most this."""

LEAST, MOST = 4 / 3, 2.0
"""Ratio of a further refinement to the one before. Below 1.3, the observed order of convergence is uncertain (Celik et al.,
J. Fluids Eng. 130 (2008) 078001)."""

AIM = 0.5
"""Uncertainty at which a further refinement aims, as a fraction of the largest allowed."""


@dataclass(frozen=True)
class Refining:
    """Refinement of a solver: all ``levels`` first; then finer ones, up to ``cap``, until ``max_uncertainty`` is met.

    Further ones are multiples of the first, as fine as the ``order`` of convergence requires: from ``least`` to ``MOST`` times
    the one before. ``bracket``: the solver gives an error bound, ``Spectrum.uncertainty``, so that no refinement is needed.
    """

    levels: tuple[int, ...]
    order: int
    cap: int
    max_uncertainty: float = MAX_UNCERTAINTY
    bracket: bool = False
    least: float = LEAST


def solve(
    ask: Ask,
    speeds: Sequence[float],
    refining: Refining,
    count: int,
    compared: Callable[[float, Sequence[Spectrum]], Compared],
) -> list[Refinements]:
    """Refinements at each speed. Coarse ones are solved first, so that a time limit affects only the fine ones.

    Args:
        ask: the solver.
        speeds: rad/s.
        refining: how it is refined.
        count: number of modes to request.
        compared: modes that must converge at a speed, from the answers at that speed so far (at least one).
    """
    runs = [(omega, n, count) for n in refining.levels for omega in speeds]
    finest = dict.fromkeys(speeds, refining.levels[-1])
    solved: dict[float, list[Spectrum]] = {omega: [] for omega in speeds}
    failed: dict[float, Failure] = {}
    while runs:
        for (omega, _, _), answer in zip(runs, ask(runs), strict=True):
            is_nonsense = omega in failed and failed[omega].kind == "nonsense"  # final, whatever other refinements give
            if isinstance(answer, Spectrum) and solved[omega] and answer.elements <= solved[omega][-1].elements:
                answer = Failure(
                    "nonsense", f"elements: {answer.elements} after {solved[omega][-1].elements}: not refined"
                )
            if isinstance(answer, Failure):
                failed[omega] = failed[omega] if is_nonsense else answer
            else:
                solved[omega].append(answer)
                if not is_nonsense:
                    failed.pop(omega, None)
        open_ = [omega for omega in speeds if omega not in failed]
        unsure = {omega: _unsure(solved[omega], compared(omega, solved[omega]), refining) for omega in open_}
        finer = {
            omega: _finer(finest[omega], u, refining) for omega, u in unsure.items() if u > refining.max_uncertainty
        }
        runs = sorted(
            ((omega, n, count) for omega, n in finer.items() if n >= refining.least * finest[omega]), key=lambda r: r[1]
        )
        finest |= finer
    return [Refinements(tuple(solved[omega]), failed.get(omega)) for omega in speeds]


def _unsure(answers: Sequence[Spectrum], compared: Compared, refining: Refining) -> float:
    """The largest uncertainty of a compared mode that refinement may reduce; infinite if one is not known."""
    modes = follow(answers, compared, refining.order, refining.bracket)
    uncertainties = [m.estimate.uncertainty for m in modes if m.estimate and not m.bracketed]
    return max((np.inf if u is None else u for u in uncertainties), default=0.0)


def _finer(finest: int, uncertainty: float, refining: Refining) -> int:
    """The number of elements after ``finest``, at most the cap."""
    ratio = (uncertainty / (AIM * refining.max_uncertainty)) ** (1.0 / refining.order) if refining.order else MOST
    first = refining.levels[0]
    multiple = math.ceil(finest * min(max(ratio, refining.least), MOST) / first - 1e-9)
    return min(first * multiple, refining.cap)
