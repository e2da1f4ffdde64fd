"""What a difference means: the table of verdicts, as pure functions of numbers.

============================ ===================================================================================
pass                         ``|d| + u ≤ target``
fail                         ``|d| − u > target``, or a code gave no answer to a question it accepts
inconclusive                 neither: refine
known difference             the cause is named, its size is computed, what remains is within the target, and
                             refinement leads to the reference
estimate                     a code that brackets its own answer, and a bracket too wide to tell: never evidence
measured                     no code but a measurement: ``E = S − D`` against u_val, see ``measured``; never evidence
not applicable               declared by the code, with the reason
not run                      not installed
============================ ===================================================================================

``d`` is the relative difference of two paired modes and ``u`` its numerical uncertainty. A code is compared with core
lacking the same effects, so that like is compared with like. Only ``pass`` counts as agreement.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from .results import Verdict

Judgement = tuple[Verdict, str]
"""The verdict, and its reason where it is not a plain pass."""


@dataclass(frozen=True)
class Effect:
    """What leaving one physical effect out does to one of core's frequencies: ``change`` is ``without/with − 1``.

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

    The remainder has passed ``judge`` already; the cause is what the code declares to lack. A cause without a size is none.

    Args:
        shift: what lacking them changes, all together, relative; None where core has no such mode with all effects.
        target: largest shift that still counts as agreement with all effects.
        effects: each of them alone.
    """
    if shift is None:
        names = ", ".join(f"no {e.name}" for e in effects)
        return (
            "inconclusive",
            f"{names}: size unknown, as core with all effects has no mode like it; without, core agrees",
        )
    if abs(shift) <= target:
        return "pass", ""
    changes = {
        e.name: "not comparable" if e.change is None else percent(e.change) for e in effects if not _small(e, shift)
    }
    causes = [f"no {name}: {change}" for name, change in changes.items()]
    together = [f"together {percent(shift)}"] if len(causes) != 1 else []
    return "known difference", f"{', '.join(causes + together)} (core with and without); without, core agrees"


def bracketed(difference: float, uncertainty: float | None, target: float) -> Judgement:
    """The verdict on a code that declares that it brackets its own answer.

    Refining does not narrow a bracket: what neither passes nor lies outside is an estimate, and no evidence.

    Args:
        difference: of the code's answer from the reference, relative to the reference.
        uncertainty: half the bracket's width, relative to the code's answer.
        target: relative.
    """
    verdict, reason = judge(difference, uncertainty, target)
    if verdict == "pass" or uncertainty is None:
        return verdict, reason
    away = -difference / (1.0 + difference)
    bracket = f"an estimate, by its own account within {unsigned(uncertainty)}: core, {percent(away)} from it, lies"
    return ("estimate", f"{bracket} inside") if abs(away) <= uncertainty else ("fail", f"{bracket} outside")


def discretised(
    difference: float,
    uncertainty: float | None,
    target: float,
    remainder: float,
    limit: float | None,
    what: str,
    size: float | None = None,
) -> Judgement:
    """The verdict on an answer of one given discretisation, whose error is known if it meets three conditions.

    Args:
        difference: of the answer from the converged reference, relative.
        uncertainty: of that difference.
        target: relative.
        remainder: difference of the answer from core's with the same discretisation; 0 if it is core's own answer.
        limit: difference from the reference of what core's refinements of that discretisation lead to; None if unknown.
        what: the discretisation's name.
        size: its error: core's answer with it against the reference; ``difference`` if omitted.
    """
    verdict, reason = judge(difference, uncertainty, target)
    if verdict == "pass" or limit is None:
        return verdict, reason
    if judge(remainder, uncertainty, target)[0] != "pass":
        return verdict, reason
    error = f"discretisation error of {what}: {percent(difference if size is None else size)}"
    if abs(limit) + (uncertainty or 0.0) <= target:
        rest = f", {percent(remainder)} remain" if remainder else ""
        return "known difference", f"{error}{rest}; refined, its limit is {percent(limit)} from the reference"
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
