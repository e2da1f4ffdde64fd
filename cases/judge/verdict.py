"""What a difference means, given how sure it is and how large it may be.

``pass`` if |d| + u ≤ target; ``fail`` if |d| − u > target; else ``inconclusive``. A code is held to core with the code's
own effects, so that like is compared with like. What its missing effects change is then a *known difference*, its cause
named and its size taken from core, with and without.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from .results import Verdict

Judgement = tuple[Verdict, str]
"""The verdict, and its reason where it is not a plain pass."""


@dataclass(frozen=True)
class Effect:
    """What leaving one physical effect out does to a frequency of core's: ``change`` is ``without/with − 1``.

    None where core has no such mode with, or without.
    """

    name: str
    change: float | None


def judge(difference: float, uncertainty: float | None, target: float) -> Judgement:
    """The verdict on a relative difference; ``uncertainty`` None means that it is not known."""
    if uncertainty is None:
        return "inconclusive", "uncertainty not known"
    if abs(difference) + uncertainty <= target:
        return "pass", ""
    size = f"{percent(difference)} ± {unsigned(uncertainty)}"
    if abs(difference) - uncertainty > target:
        return "fail", f"{size} is more than {unsigned(target)}"
    return "inconclusive", f"{size} may or may not be within {unsigned(target)}"


def known(shift: float | None, target: float, effects: Sequence[Effect]) -> Judgement:
    """The verdict on a code that agrees with core when both lack the same effects.

    Args:
        shift: what lacking them changes, all together, relative; None where the mode does not exist with all effects.
        target: largest shift that still counts as agreement with all effects.
        effects: each of them alone.
    """
    if shift is None:
        names = ", ".join(f"no {e.name}" for e in effects)
        return "known difference", f"{names}: core with all effects has no mode like it; without, core agrees"
    if abs(shift) <= target:
        return "pass", ""
    changes = {
        e.name: "not comparable" if e.change is None else percent(e.change) for e in effects if not _small(e, shift)
    }
    causes = [f"no {name}: {change}" for name, change in changes.items()]
    together = [f"together {percent(shift)}"] if len(causes) != 1 else []
    return "known difference", f"{', '.join(causes + together)} (core with and without); without, core agrees"


def bracketed(difference: float, uncertainty: float | None, otherwise: Judgement) -> Judgement:
    """The verdict on a code that brackets its own estimate: wide, but true, is a known difference.

    Args:
        difference: of the estimate from the reference, relative to the reference.
        uncertainty: half the bracket's width, relative to the estimate.
        otherwise: the verdict that the two would have without a bracket.
    """
    if otherwise[0] == "pass" or uncertainty is None:
        return otherwise
    away = -difference / (1.0 + difference)
    bracket = f"an estimate, by its own account within {unsigned(uncertainty)}: core, {percent(away)} from it, lies"
    return ("known difference", f"{bracket} inside") if abs(away) <= uncertainty else ("fail", f"{bracket} outside")


def discretised(
    difference: float, uncertainty: float | None, target: float, limit: float | None, what: str
) -> Judgement:
    """The verdict on one given discretisation: its error is known if refining it leads to the reference.

    Args:
        difference: of that discretisation, relative.
        uncertainty: of the reference, relative.
        target: relative.
        limit: difference of its refinements' limit, relative; None if not known.
        what: the discretisation's name.
    """
    verdict, reason = judge(difference, uncertainty, target)
    error = f"discretisation error of {what}: {percent(difference)}"
    if verdict == "pass" or limit is None:
        return verdict, reason
    if abs(limit) + (uncertainty or 0.0) <= target:
        return "known difference", f"{error}; refined, its limit is {percent(limit)} from the reference"
    return "fail", f"{error}, and its refinements do not lead to the reference ({percent(limit)})"


def _small(effect: Effect, shift: float) -> bool:
    return effect.change is not None and abs(effect.change) < 0.01 * abs(shift)


def percent(value: float) -> str:
    """A relative number in percent with its sign: ``−1.23 %``, ``+0.044 %``."""
    return f"{'−' if value < 0 else '+'}{unsigned(value)}"


def unsigned(value: float) -> str:
    """The size of a relative number in percent, to two digits at least: ``12.35 %``, ``0.044 %``."""
    size = 100 * abs(value)
    return f"{size:.2f} %" if size >= 1 else f"{size:#.2g} %"
