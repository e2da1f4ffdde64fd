"""The reference of a code: core with the effects that the code keeps, and the change due to the missing effects."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, replace

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...references.protocol.process import Failure
from ..input.schema import Compare
from ..judge.pairing import pair
from ..judge.reference import Converged, Reference
from ..judge.verdict import Effect
from .core_solver import converged

MAJORITY = 0.5
"""Least MAC of core's modes with and without an effect that also changes shapes: at most one mode can reach it."""

References = dict[Effects, list[Reference | Failure]]
"""Effects → references at each speed."""

Solve = Callable[[Effects, Iterable[float]], dict[float, Converged | Failure]]
"""Core with these effects, at these speeds at least: rad/s → modes."""


def relevant_effects(effects: Effects, blade: Blade, omega: float = 1.0) -> Effects:
    """The effects without irrelevant omissions: an effect that cannot change this blade at this speed is not missing.

    A blade without rotary inertia cannot lack it; at rest only rotary inertia can be missing.
    """
    inertia = effects.rotary_inertia or not blade.mass[:, 3:, 3:].any()
    return replace(effects if omega else ALL_EFFECTS, rotary_inertia=inertia)


def references(blade: Blade, speeds: Sequence[float], compare: Compare, effect_sets: Iterable[Effects]) -> References:
    """Core's references with all effects, and with each of the sets of effects ``effect_sets``.

    Where core with all effects has no stable steady state, or too few modes, there is no reference for any effects, and the
    failure gives the reason.
    """
    solved: dict[Effects, dict[float, Converged | Failure]] = {}

    def solve(effects: Effects, at: Iterable[float]) -> dict[float, Converged | Failure]:
        """Core with these effects, at least at the speeds ``at``."""
        by_speed = solved.setdefault(effects, {})
        if new := [omega for omega in at if omega not in by_speed]:
            by_speed |= zip(new, converged(blade, new, compare, effects), strict=True)
        return by_speed

    full = solve(ALL_EFFECTS, speeds)
    failures = {omega: _absent(omega, modes) for omega, modes in full.items() if isinstance(modes, Failure)}
    solvable = [omega for omega in speeds if omega not in failures]
    out: References = {}
    for effects in {*effect_sets, ALL_EFFECTS}:
        present = zip(solvable, _references(blade, solvable, compare.target, effects, solve), strict=True)
        by_speed = {**failures, **dict(present)}
        out[effects] = [by_speed[omega] for omega in speeds]
    return out


def _absent(omega: float, failure: Failure) -> Failure:
    """Why there is no reference at a speed."""
    if failure.kind == "no reference":
        return failure
    return Failure("no reference", f"speeds: {omega:g} rad/s: no steady state: {failure.reason}: give lower speeds")


def _references(
    blade: Blade, speeds: Sequence[float], target: float, kept_effects: Effects, solve: Solve
) -> list[Reference | Failure]:
    relevant_at = {omega: relevant_effects(kept_effects, blade, omega) for omega in speeds}
    reduced = {
        omega: solve(effects, [o for o in speeds if relevant_at[o] == effects])[omega]
        for omega, effects in relevant_at.items()
    }
    full = solve(ALL_EFFECTS, ())
    solved = {omega: answer for omega, answer in reduced.items() if not isinstance(answer, Failure)}
    partners = {omega: _partners(answer, full[omega]) for omega, answer in solved.items()}
    shifted = [omega for omega, answer in solved.items() if _shifted(answer, partners[omega][0], target)]
    changes: dict[float, list[list[Effect]]] = {omega: [[] for _ in answer.modes] for omega, answer in solved.items()}
    for name in (f.name for f in fields(kept_effects)):  # each effect alone
        speeds_without = [omega for omega in shifted if not getattr(relevant_at[omega], name)]
        partial_models = solve(replace(ALL_EFFECTS, **{name: False}), speeds_without)
        for omega in speeds_without:
            partial_frequencies, _ = _partners(solved[omega], partial_models[omega])
            for effects, f, full_frequency in zip(changes[omega], partial_frequencies, partners[omega][0], strict=True):
                effects.append(Effect(name.replace("_", " "), _change(f, full_frequency)))
    return [
        Reference(answer, *partners[omega], tuple(map(tuple, changes[omega])))
        if not isinstance(answer, Failure)
        else answer
        for omega, answer in reduced.items()
    ]


def _shifted(reduced: Converged, full_frequencies: Sequence[float | None], target: float) -> bool:
    """Whether a mode changes by more than the target due to what is left out."""
    values = [s.estimate.value if s.estimate else None for s in reduced.modes]
    shifts = [_change(value, f) for value, f in zip(values, full_frequencies, strict=True)]
    return any(change is None or abs(change) > target for change in shifts)


def _change(partial: float | None, full: float | None) -> float | None:
    return partial / full - 1.0 if partial and full else None


def _partners(reduced: Converged, full: Converged | Failure) -> tuple[tuple[float | None, ...], tuple[float, ...]]:
    """Frequencies in ``full`` of the modes of ``reduced``, and the MACs of the shapes."""
    if isinstance(full, Failure):
        return (None,) * len(reduced.modes), (0.0,) * len(reduced.modes)
    modes = dict(zip(full.indices, full.modes, strict=True))
    partners = pair(reduced.spectrum, full.spectrum, reduced.indices, min_mac=MAJORITY)
    estimates = [modes[p.mode].estimate if p.mode in modes else None for p in partners]
    return tuple(e.value if e else None for e in estimates), tuple(p.mac for p in partners)
