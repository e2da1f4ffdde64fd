"""Conformance checks against core: declared effects are included and no others, and no property is dropped silently."""

from dataclasses import fields, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ...core import solve
from ...core.effects import Effects
from ...core.spectrum.eigen import UnstableError
from ...references.protocol.interface import BladeAdapter, CodeError
from . import blades as known
from .asking import NotForItError, keep, limit_of
from .blades import PROPERTIES, Property

Array = NDArray[np.float64]

DROPPED, VISIBLE = 0.25, 5e-3
"""Required agreement as a fraction of the change due to a dropped property; least relative change that is checked."""


@cache
def _stubby(effects: Effects) -> Array:
    return solve.mesh_modes(known.STUBBY, known.FAST, 30, 4, effects=effects).frequencies


@cache
def _with_and_without(name: str, effects: Effects) -> tuple[Array, Array]:
    """Core's frequencies of the blades with and without a property."""
    (one,) = (p for p in PROPERTIES if p.name == name)
    having, lacking = (solve.mesh_modes(b, one.omega, 30, 4, effects=effects) for b in (one.having, one.lacking))
    return having.frequencies, lacking.frequencies


def _far(found: Array, other: Array) -> float:
    return float(_differences(found, other).max())


def _differences(found: Array, other: Array) -> Array:
    return np.abs(np.log(found[: len(other)] / other[: len(found)]))


def _mode(found: Array, other: Array) -> int:
    """Number of the mode that differs most."""
    return int(_differences(found, other).argmax()) + 1


def effects(code: BladeAdapter) -> None:
    """Each effect in turn, at a speed where its omission shows; not every code can reach this speed."""
    try:
        found, _, bracket = limit_of(code, known.STUBBY, known.FAST, (-2, -1))
    except CodeError as error:
        raise NotForItError(str(error)) from error
    here = _stubby(code.effects)
    near = _far(found, here)
    for name in (f.name for f in fields(Effects)):
        kept = getattr(code.effects, name)
        try:
            change = _far(_stubby(replace(code.effects, **{name: not kept})), here)
        except UnstableError:  # for instance without geometric stiffness: the effect cannot be checked
            continue
        if bracket > DROPPED * change:
            raise NotForItError(f"its uncertainty, {bracket:.1%}, is too large to show {name}")
        keep(
            near <= DROPPED * change,
            f"effects.{name} = {kept}: {known.STUBBY.name} at {known.FAST:g} rad/s, mode {_mode(found, here)}: differs by "
            f"{near:.2%} from Southwell's own solver with these effects; {name} changes the frequencies by up to {change:.2%}",
        )


def keeps(one: Property, code: BladeAdapter) -> None:
    """A property is not silently dropped; checked with two coarse levels."""
    found, _, bracket = limit_of(code, one.having, one.omega)
    having, lacking = _with_and_without(one.name, code.effects)
    change = _far(having, lacking)
    if change < VISIBLE:
        raise NotForItError(f"no effect without {', '.join(code.effects.lacks())}")
    if bracket > DROPPED * change:
        raise NotForItError(f"its uncertainty, {bracket:.1%}, is too large to show {one.name}")
    near, far = _far(found, having), _far(found, lacking)
    keep(
        near <= DROPPED * change,
        f"{one.name}: at {one.omega:g} rad/s, mode {_mode(found, having)}: differs by {near:.2%} from the blade with it, "
        f"by {far:.2%} from the blade without it",
    )
