"""Verdicts on differences, as pure functions of numbers.

============================ ===================================================================================
pass                         ``|d| + u ≤ target``, and the target is at most ``WIDEST``
coarse                       ``|d| + u ≤ target`` of a wider target: shown, never evidence
fail                         ``|d| − u > target``, or a code gave no answer to a case that it accepts
inconclusive                 neither pass nor fail: refine
known difference             the cause is named, its size is computed, the remainder is within the target, and
                             refinement leads to the reference
estimate                     the code's own error bound is too wide for a verdict; never evidence
measured                     a measurement, not a code: ``E = S − D`` against u_val, see ``measured``; never evidence
not applicable               declared by the code, with the reason
not run                      not installed
============================ ===================================================================================

``d`` is the relative difference of two paired modes and ``u`` its numerical uncertainty. A code that lacks effects is
compared with core without the same effects. Only ``pass`` counts as agreement.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from .results import Verdict

WIDEST = 5e-3
"""Widest target, relative, at which agreement is evidence; five times the paper's."""

AGREES: tuple[Verdict, ...] = ("pass", "coarse")
"""Verdicts of a difference within its target."""

Judgement = tuple[Verdict, str]
"""The verdict, and the reason for any verdict other than a plain pass."""


@dataclass(frozen=True)
class Effect:
    """Change of one of core's frequencies without one physical effect: ``change`` is ``without/with − 1``.

    None if core has no corresponding mode with or without the effect.
    """

    name: str
    change: float | None


def judge(difference: float, uncertainty: float | None, target: float) -> Judgement:
    """The verdict on a relative difference; ``uncertainty`` is None if unknown."""
    if uncertainty is None:
        return "inconclusive", "unknown uncertainty"
    if abs(difference) + uncertainty <= target:
        return within(target)
    size = f"{percent(difference)} ± {unsigned(uncertainty)}"
    if abs(difference) - uncertainty > target:
        return "fail", f"{size} exceeds {unsigned(target)}"
    return "inconclusive", f"{size}: too uncertain for a target of {unsigned(target)}"


def within(target: float) -> Judgement:
    """The verdict on a difference within its target: agreement, or too coarse to be evidence."""
    if target <= WIDEST:
        return "pass", ""
    return "coarse", f"agreement within {unsigned(target)} is no evidence; {unsigned(WIDEST)} would be"


def known_difference(shift: float | None, target: float, effects: Sequence[Effect]) -> Judgement:
    """The verdict on a code that agrees with core when both lack the same effects.

    The remainder has already passed ``judge``; the cause is the effects that the code declares missing. A cause of
    unknown size does not explain a difference.

    Args:
        shift: relative change due to all missing effects together; None if core has no such mode with all effects.
        target: largest shift that still counts as agreement with all effects.
        effects: change due to each missing effect alone.
    """
    if shift is None:
        names = ", ".join(f"no {e.name}" for e in effects)
        return (
            "inconclusive",
            f"{names}: size unknown, because Southwell's own solver with all effects has no similar mode; without them it "
            "agrees",
        )
    if abs(shift) <= target:
        return within(target)
    changes = {
        e.name: "not comparable" if e.change is None else percent(e.change) for e in effects if not _small(e, shift)
    }
    causes = [f"no {name}: {change}" for name, change in changes.items()]
    total = [f"together {percent(shift)}"] if len(causes) != 1 else []
    return (
        "known difference",
        f"{', '.join(causes + total)} (change of the answer of Southwell's own solver, which agrees without them)",
    )


def bracketed(difference: float, uncertainty: float | None, target: float) -> Judgement:
    """The verdict on a code that gives an error bound for its answer.

    Refinement does not reduce the bound: an answer that neither passes nor lies outside it is only an estimate.

    Args:
        difference: of the code's answer from the reference, relative to the reference.
        uncertainty: half width of the bound, relative to the code's answer.
        target: relative.
    """
    verdict, reason = judge(difference, uncertainty, target)
    if verdict in AGREES or uncertainty is None:
        return verdict, reason
    deviation = -difference / (1.0 + difference)
    bound = f"estimate with a stated bound of {unsigned(uncertainty)}; Southwell's own solver differs by {percent(deviation)},"
    return (
        ("estimate", f"{bound} within the bound")
        if abs(deviation) <= uncertainty
        else ("fail", f"{bound} beyond the bound")
    )


def discretised(
    difference: float,
    uncertainty: float | None,
    target: float,
    remainder: float,
    limit: float | None,
    name: str,
    size: float | None = None,
) -> Judgement:
    """The verdict on an answer from a given discretisation.

    The difference is known if core with the same discretisation agrees and its refinements lead to the reference.

    Args:
        difference: of the answer from the converged reference, relative.
        uncertainty: of that difference.
        target: relative.
        remainder: difference of the answer from core's with the same discretisation; 0 if it is core's answer.
        limit: difference between the limit of core's refinements of that discretisation and the reference; None if
            unknown.
        name: of the discretisation.
        size: its error: core's answer with it against the reference; ``difference`` if omitted.
    """
    verdict, reason = judge(difference, uncertainty, target)
    if verdict in AGREES or limit is None:
        return verdict, reason
    if judge(remainder, uncertainty, target)[0] not in AGREES:
        return verdict, reason
    error = f"discretisation error of {name}: {percent(difference if size is None else size)}"
    if abs(limit) + (uncertainty or 0.0) <= target:
        remainder_text = f", remainder {percent(remainder)}" if remainder else ""
        return (
            "known difference",
            f"{error}{remainder_text}; its limit under refinement is {percent(limit)} from the reference",
        )
    return "fail", f"{error}, and its refinements do not converge to the reference ({percent(limit)})"


def _small(effect: Effect, shift: float) -> bool:
    return effect.change is not None and abs(effect.change) < 0.01 * abs(shift)


def percent(value: float) -> str:
    """Format a relative number in percent with its sign: ``−1.23 %``, ``+0.044 %``."""
    return f"{'−' if value < 0 else '+'}{unsigned(value)}"


def unsigned(value: float) -> str:
    """Format the size of a relative number in percent, with at least two digits: ``12.35 %``, ``0.044 %``."""
    size = 100 * abs(value)
    return f"{size:.2f} %" if size >= 1 else f"{size:#.2g} %"
