"""Conformance checks against core: declared effects are included and no others, and no property is dropped silently."""

from dataclasses import fields, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ...core import solve
from ...core.effects import Effects
from ...core.spectrum.eigen import UnstableError
from ...references.protocol.interface import BladeAdapter, CodeError
from . import blades
from .asking import NotForItError, limit_of, require
from .blades import PROPERTIES, Property

Array = NDArray[np.float64]

DROPPED, VISIBLE = 0.25, 5e-3
"""Required agreement as a fraction of the change due to a dropped property; least relative change that is checked."""


@cache
def _stubby(effects: Effects) -> Array:
    return solve.mesh_modes(blades.STUBBY, blades.FAST, 30, 4, effects=effects).frequencies


@cache
def _with_and_without(name: str, effects: Effects) -> tuple[Array, Array]:
    """Core's frequencies of the blades with and without a property."""
    (prop,) = (p for p in PROPERTIES if p.name == name)
    having, lacking = (solve.mesh_modes(b, prop.omega, 30, 4, effects=effects) for b in (prop.having, prop.lacking))
    return having.frequencies, lacking.frequencies


def _far(values: Array, other: Array) -> float:
    return float(_differences(values, other).max())


def _differences(values: Array, other: Array) -> Array:
    return np.abs(np.log(values[: len(other)] / other[: len(values)]))


def _mode(values: Array, other: Array) -> int:
    """Number of the mode that differs most."""
    return int(_differences(values, other).argmax()) + 1


def effects(code: BladeAdapter) -> None:
    """Each effect in turn, at a speed where its omission shows; not every code can reach this speed."""
    try:
        frequencies, _, bracket = limit_of(code, blades.STUBBY, blades.FAST, (-2, -1))
    except CodeError as error:
        raise NotForItError(str(error)) from error
    stubby = _stubby(code.effects)
    near = _far(frequencies, stubby)
    for name in (f.name for f in fields(Effects)):
        kept = getattr(code.effects, name)
        try:
            change = _far(_stubby(replace(code.effects, **{name: not kept})), stubby)
        except UnstableError:  # for instance without geometric stiffness: the effect cannot be checked
            continue
        if bracket > DROPPED * change:
            raise NotForItError(f"its uncertainty, {bracket:.1%}, is too large to show {name}")
        require(
            near <= DROPPED * change,
            f"effects.{name} = {kept}: {blades.STUBBY.name} at {blades.FAST:g} rad/s, mode {_mode(frequencies, stubby)}: "
            f"differs by {near:.2%} from Southwell's own solver with these effects; {name} changes the frequencies by up to "
            f"{change:.2%}",
        )


def keeps(prop: Property, code: BladeAdapter) -> None:
    """A property is not silently dropped; checked with two coarse levels."""
    frequencies, _, bracket = limit_of(code, prop.having, prop.omega)
    having, lacking = _with_and_without(prop.name, code.effects)
    change = _far(having, lacking)
    if change < VISIBLE:
        raise NotForItError(f"no effect without {', '.join(code.effects.lacks())}")
    if bracket > DROPPED * change:
        raise NotForItError(f"its uncertainty, {bracket:.1%}, is too large to show {prop.name}")
    near, far = _far(frequencies, having), _far(frequencies, lacking)
    require(
        near <= DROPPED * change,
        f"{prop.name}: at {prop.omega:g} rad/s, mode {_mode(frequencies, having)}: differs by {near:.2%} from the blade "
        f"with it, by {far:.2%} from the blade without it",
    )
