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
    with_property, without_property = (
        solve.mesh_modes(b, prop.omega, 30, 4, effects=effects) for b in (prop.blade, prop.without)
    )
    return with_property.frequencies, without_property.frequencies


def _far(values: Array, reference: Array) -> float:
    return float(_differences(values, reference).max())


def _differences(values: Array, reference: Array) -> Array:
    return np.abs(np.log(values[: len(reference)] / reference[: len(values)]))


def _mode(values: Array, reference: Array) -> int:
    """Number of the mode that differs most."""
    return int(_differences(values, reference).argmax()) + 1


def effects(code: BladeAdapter) -> None:
    """Each effect in turn, at a speed where its omission shows; not every code can reach this speed."""
    try:
        frequencies, _, bracket = limit_of(code, blades.STUBBY, blades.FAST, (-2, -1))
    except CodeError as error:
        raise NotForItError(str(error)) from error
    stubby = _stubby(code.effects)
    difference = _far(frequencies, stubby)
    for name in (f.name for f in fields(Effects)):
        is_kept = getattr(code.effects, name)
        try:
            change = _far(_stubby(replace(code.effects, **{name: not is_kept})), stubby)
        except UnstableError:  # for instance without geometric stiffness: the effect cannot be checked
            continue
        if bracket > DROPPED * change:
            raise NotForItError(f"its uncertainty, {bracket:.1%}, is too large to show {name}")
        require(
            difference <= DROPPED * change,
            f"effects.{name} = {is_kept}: {blades.STUBBY.name} at {blades.FAST:g} rad/s, mode {_mode(frequencies, stubby)}: "
            f"differs by {difference:.2%} from Southwell's own solver with these effects; {name} changes the frequencies by "
            f"up to {change:.2%}",
        )


def keeps(prop: Property, code: BladeAdapter) -> None:
    """A property is not silently dropped; checked with two coarse levels."""
    frequencies, _, bracket = limit_of(code, prop.blade, prop.omega)
    with_property, without_property = _with_and_without(prop.name, code.effects)
    change = _far(with_property, without_property)
    if change < VISIBLE:
        raise NotForItError(f"no effect without {', '.join(code.effects.lacks())}")
    if bracket > DROPPED * change:
        raise NotForItError(f"its uncertainty, {bracket:.1%}, is too large to show {prop.name}")
    difference, difference_without = _far(frequencies, with_property), _far(frequencies, without_property)
    require(
        difference <= DROPPED * change,
        f"{prop.name}: at {prop.omega:g} rad/s, mode {_mode(frequencies, with_property)}: differs by {difference:.2%} from "
        f"the blade with it, by {difference_without:.2%} from the blade without it",
    )
