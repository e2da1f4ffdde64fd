"""The frequencies of one mode through the refinements of a solver, and the estimate that follows from them."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...references.protocol.process import Failure
from .pairing import Pair, pair
from .spectrum import Spectrum
from .uncertainty import Estimate, from_bracket, from_refinement, widened


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
    """A solver's answer at one point: its modes at every refinement, and why the finest is missing, if it is."""

    answers: tuple[Spectrum, ...]
    failure: Failure | None = None


@dataclass(frozen=True)
class Compared:
    """The modes compared at one point: ``indices`` among the modes of ``spectrum``, which has a weight."""

    spectrum: Spectrum
    indices: tuple[int, ...]


def follow(answers: Sequence[Spectrum], compared: Compared, order: int, bracket: bool = False) -> list[RefinedMode]:
    """The estimate of each compared mode from a solver's answers, coarse to fine.

    Args:
        answers: of one solver at one point, by refinement.
        compared: the modes to be followed.
        order: theoretical order of convergence.
        bracket: whether the solver's ``uncertainty`` is an error bound, so that no refinement is needed.
    """
    pairs = [pair(compared.spectrum, spectrum, compared.indices) for spectrum in answers]
    return [_follow(answers, [level[i] for level in pairs], order, bracket) for i in range(len(compared.indices))]


def _follow(answers: Sequence[Spectrum], partners: Sequence[Pair], order: int, bracket: bool) -> RefinedMode:
    last = partners[-1] if partners else Pair(None, 0.0, "no partner: the code returned no modes")
    modes = [(m, p.mode) for m, p in zip(answers, partners, strict=True) if p.mode is not None]
    history = tuple((m.elements, float(m.frequencies[k])) for m, k in modes)
    if last.mode is None:
        return RefinedMode(None, last, history)
    own = float(answers[-1].uncertainty[last.mode]) if len(answers[-1].uncertainty) else None
    if bracket and own is not None:
        return RefinedMode(from_bracket(history[-1][1], own), last, history, bracketed=True)
    refined = from_refinement([n for n, _ in history], [f for _, f in history], order)
    return RefinedMode(widened(refined, own or 0.0), last, history)
