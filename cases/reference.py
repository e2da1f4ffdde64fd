"""What a code is compared with: core with the effects that the code keeps, and what the missing ones would change."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace

from ..core.blade import Blade
from ..core.model import FULL, Model
from ..references.worker import Failure
from .errors import CaseError
from .own import Converged, converged
from .pairing import pair
from .schema import Compare
from .verdict import Effect


@dataclass(frozen=True)
class Reference:
    """Core's modes at one speed with the effects of one model.

    Attributes:
        core: converged modes.
        full: the same modes' frequencies with all effects, rad/s; None where no mode with all effects resembles them.
        likeness: MAC of each mode with the one with all effects.
        effects: for each mode, what leaving out each effect that the model lacks does to it.
    """

    core: Converged
    full: tuple[float | None, ...]
    likeness: tuple[float, ...]
    effects: tuple[tuple[Effect, ...], ...]


MAJORITY = 0.5
"""Least MAC of core's modes with and without an effect that changes shapes too: at most one mode can be so alike."""

References = dict[Model, list[Reference | Failure]]
"""By model, at each speed."""


def felt(model: Model, blade: Blade) -> Model:
    """The model as this blade feels it: rotary inertia is not lacking where the blade has none."""
    return replace(model, rotary_inertia=model.rotary_inertia or not blade.mass[:, 3:, 3:].any())


def references(blade: Blade, speeds: Sequence[float], compare: Compare, models: Iterable[Model]) -> References:
    """Core's references with all effects, and with those of each of ``models``.

    Raises:
        CaseError: if with all effects there is no stable steady state at one of the speeds, or too few modes.
    """
    models = set(models) | {FULL}
    lacking = {f.name for model in models for f in fields(model) if not getattr(model, f.name)}
    without = {effect: replace(FULL, **{effect: False}) for effect in lacking}
    solved = {model: converged(blade, speeds, compare, model) for model in {*models, *without.values()}}
    for omega, full in zip(speeds, solved[FULL], strict=True):
        if isinstance(full, Failure):
            raise CaseError(f"{blade.name}: speeds: {omega:g} rad/s: no steady state: {full.reason}: give lower speeds")
    return {
        model: [
            mine
            if isinstance(mine, Failure)
            else _reference(
                mine,
                solved[FULL][k],
                {name: solved[m][k] for name, m in without.items() if not getattr(model, name)},
            )
            for k, mine in enumerate(solved[model])
        ]
        for model in models
    }


def _reference(mine: Converged, full: Converged | Failure, without: dict[str, Converged | Failure]) -> Reference:
    whole, likeness = _partners(mine, full)
    changes = {name: _partners(mine, other)[0] for name, other in without.items()}
    effects = tuple(
        tuple(Effect(name.replace("_", " "), _change(f[i], reference)) for name, f in changes.items())
        for i, reference in enumerate(whole)
    )
    return Reference(mine, whole, likeness, effects)


def _change(without: float | None, whole: float | None) -> float | None:
    return without / whole - 1.0 if without and whole else None


def _partners(mine: Converged, other: Converged | Failure) -> tuple[tuple[float | None, ...], tuple[float, ...]]:
    """Frequencies in ``other`` of the modes of ``mine``, and how alike the shapes are."""
    if isinstance(other, Failure):
        return (None,) * len(mine.settled), (0.0,) * len(mine.settled)
    theirs = dict(zip(other.wanted.indices, other.settled, strict=True))
    wanted = mine.wanted
    found = pair(wanted.reference, other.wanted.reference, wanted.indices, wanted.weight, least=MAJORITY)
    estimates = [theirs[p.mode].estimate if p.mode in theirs else None for p in found]
    return tuple(e.value if e else None for e in estimates), tuple(p.mac for p in found)
