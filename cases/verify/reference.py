"""The reference of a code: core with the effects that the code keeps, and the change due to the missing effects."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS, Effects
from ...references.protocol.process import Failure
from ..input.errors import CaseError
from ..input.schema import Compare
from ..judge.pairing import pair
from ..judge.verdict import Effect
from .core_solver import Converged, converged


@dataclass(frozen=True)
class Reference:
    """Core's modes at one speed with given effects.

    Attributes:
        core: converged modes.
        full: frequencies of the same modes with all effects, rad/s; None if no mode with all effects corresponds.
        likeness: MAC of each mode with its counterpart with all effects.
        effects: for each mode, its change due to each effect that is left out; empty if the change due to all of
            them together is within the target.
    """

    core: Converged
    full: tuple[float | None, ...]
    likeness: tuple[float, ...]
    effects: tuple[tuple[Effect, ...], ...]


MAJORITY = 0.5
"""Least MAC of core's modes with and without an effect that also changes shapes: at most one mode can reach it."""

References = dict[Effects, list[Reference | Failure]]
"""Effects → references at each speed."""


def felt(effects: Effects, blade: Blade, omega: float = 1.0) -> Effects:
    """The effects without irrelevant omissions: an effect that cannot change this blade at this speed is not missing.

    A blade without rotary inertia cannot lack it; at rest only rotary inertia can be missing.
    """
    inertia = effects.rotary_inertia or not blade.mass[:, 3:, 3:].any()
    return replace(effects if omega else ALL_EFFECTS, rotary_inertia=inertia)


def references(blade: Blade, speeds: Sequence[float], compare: Compare, kept: Iterable[Effects]) -> References:
    """Core's references with all effects, and with each of the effects ``kept``.

    Raises:
        CaseError: if core with all effects has no stable steady state at one of the speeds, or too few modes.
    """
    kept = set(kept) | {ALL_EFFECTS}
    by_speed = [_at(blade, omega, compare, kept) for omega in speeds]
    return {effects: [solved[effects] for solved in by_speed] for effects in kept}


def _at(blade: Blade, omega: float, compare: Compare, kept: Iterable[Effects]) -> dict[Effects, Reference | Failure]:
    @cache
    def solve(effects: Effects) -> Converged | Failure:
        return converged(blade, omega, compare, effects)

    full = solve(ALL_EFFECTS)
    if isinstance(full, Failure):
        raise CaseError(f"{blade.name}: speeds: {omega:g} rad/s: no steady state: {full.reason}: give lower speeds")
    out: dict[Effects, Reference | Failure] = {}
    for effects in kept:
        keeps = felt(effects, blade, omega)
        mine = solve(keeps)
        out[effects] = mine if isinstance(mine, Failure) else _reference(mine, full, compare.target, keeps, solve)
    return out


def _reference(
    mine: Converged, full: Converged, target: float, kept: Effects, solve: Callable[[Effects], Converged | Failure]
) -> Reference:
    whole, likeness = _partners(mine, full)
    values = [s.estimate.value if s.estimate else None for s in mine.modes]
    shifts = [_change(value, f) for value, f in zip(values, whole, strict=True)]
    effects: list[list[Effect]] = [[] for _ in values]
    if any(shift is None or abs(shift) > target for shift in shifts):  # solve for each effect alone
        for name in (f.name for f in fields(kept) if not getattr(kept, f.name)):
            without, _ = _partners(mine, solve(replace(ALL_EFFECTS, **{name: False})))
            for found, f, reference in zip(effects, without, whole, strict=True):
                found.append(Effect(name.replace("_", " "), _change(f, reference)))
    return Reference(mine, whole, likeness, tuple(map(tuple, effects)))


def _change(without: float | None, whole: float | None) -> float | None:
    return without / whole - 1.0 if without and whole else None


def _partners(mine: Converged, other: Converged | Failure) -> tuple[tuple[float | None, ...], tuple[float, ...]]:
    """Frequencies in ``other`` of the modes of ``mine``, and the MACs of the shapes."""
    if isinstance(other, Failure):
        return (None,) * len(mine.modes), (0.0,) * len(mine.modes)
    theirs = dict(zip(other.wanted.indices, other.modes, strict=True))
    wanted = mine.wanted
    found = pair(wanted.reference, other.wanted.reference, wanted.indices, wanted.weight, least=MAJORITY)
    estimates = [theirs[p.mode].estimate if p.mode in theirs else None for p in found]
    return tuple(e.value if e else None for e in estimates), tuple(p.mac for p in found)
