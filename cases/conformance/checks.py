"""Conformance checks of a code for blades: each function returns, or raises an error that describes the fault."""

from collections.abc import Callable
from dataclasses import fields, replace
from functools import cache
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from ...core import solve
from ...core.blade import Blade
from ...core.effects import Effects
from ...core.eigen import UnstableError
from ...core.modes import STATIONS, Modes
from ...references.protocol.interface import Code, CodeError, Shares, digits
from . import blades as known
from .blades import BEAM, CANTILEVER, LENGTH, PLANK, PROPERTIES, Property

Array = NDArray[np.float64]
Ask = Callable[[Code], None]

NEAR = 1e-3
"""Required relative agreement after extrapolation from the two coarsest levels, or the code's error bound if wider."""

ROUNDING = 1e-6
"""Largest relative difference between two answers of one code to the same numbers."""

FEWEST = 5
"""Fewest digits of a code's answers with which ``NEAR`` can be checked."""

DROPPED, VISIBLE = 0.25, 5e-3
"""Required agreement as a fraction of the change due to a dropped property; least relative change that is checked."""


class BrokenError(AssertionError):
    """A code that fails a check; one line describes its behaviour."""


class NotForItError(Exception):
    """A check that the code declines or that does not apply to it, with the reason."""


def _keep(true: Any, message: str) -> None:
    if not bool(true):
        raise BrokenError(message)


def _close(found: Any, exact: Any, what: str, within: float) -> None:
    found, exact = np.atleast_1d(found), np.atleast_1d(exact)
    _keep(len(found) >= len(exact), f"{what}: {len(found)} modes, {len(exact)} expected")
    found = found[: len(exact)]
    off = np.abs(found / exact - 1.0).max()
    said = f"{what}: {np.round(found, 6).tolist()} rad/s, expected {np.round(exact, 6).tolist()}"
    _keep(off <= within, f"{said}: {off:.1e} apart, at most {within:.0e}")


def _rounding(code: Code) -> float:
    """Relative rounding of two answers: half a unit of the last digit each, for a first digit of 1."""
    return 10.0 ** (1 - digits(code))


def _same(code: Code) -> float:
    """The same for answers to the same numbers, which conditioning does not affect."""
    return min(_rounding(code), ROUNDING)


def _ask(code: Code, blade: Blade, omega: float, level: int, count: int = 4) -> Modes:
    if reason := code.unsupported(blade):
        raise NotForItError(reason)
    return code.solve(blade, omega, code.levels[level], count)


def _limit(code: Code, blade: Blade, omega: float, levels: tuple[int, int] = (0, 1)) -> tuple[Array, Modes, float]:
    """Frequencies (m,) extrapolated by the declared order from two levels, the finer modes, and their error bound."""
    coarse, fine = (_ask(code, blade, omega, level) for level in levels)
    m = min(len(coarse.frequencies), len(fine.frequencies))
    limit = fine.frequencies[:m]
    if code.order:
        gain = (fine.elements / coarse.elements) ** code.order - 1.0
        limit = limit + (limit - coarse.frequencies[:m]) / gain
    return limit, fine, float(max(fine.uncertainty[:m], default=0.0))


def _along(modes: Modes, axis: int) -> int:
    """The lowest mode whose tip moves most along ``axis`` of y, z."""
    tips = np.abs(modes.shapes[:, -1, 1:3])
    found = np.flatnonzero(tips[:, axis - 1] > tips[:, 2 - axis])
    _keep(found.size, f"no mode of {len(tips)} moves mostly along {'xyz'[axis]} at the tip: axes not converted?")
    return int(found[0])


def _is(code: Code, blade: Blade, omega: float, exact: float, axis: int | None = None) -> None:
    limit, fine, bracket = _limit(code, blade, omega)
    k = 0 if axis is None else _along(fine, axis)
    along = "" if axis is None else f" along {'xyz'[axis]}"
    _close(limit[k], exact, f"{blade.name} at {omega:g} rad/s, lowest{along}", max(bracket, NEAR))


def declares(code: Code) -> None:
    """The declarations of the adapter are valid."""
    _keep(
        code.name and not set(code.name) & set(" ,:/\n"),
        f"name: {code.name!r}: it is typed on a command line: no spaces, commas, colons or slashes",
    )
    _keep(code.title.strip(), "title: empty")
    _keep(code.shares in get_args(Shares), f"shares: {code.shares!r}: not one of {', '.join(get_args(Shares))}")
    _keep(isinstance(code.effects, Effects), f"effects: {code.effects!r}: not a core.effects.Effects")
    _keep(isinstance(code.order, int) and code.order >= 0, f"order: {code.order!r}: not a whole number (0: spectral)")
    declared = digits(code)
    _keep(
        isinstance(declared, int) and declared >= FEWEST,
        f"digits: {declared!r}: not a whole number of at least {FEWEST}",
    )
    steps = np.divide(code.levels[1:], code.levels[:-1])
    _keep(
        len(steps) >= 2 and (steps >= 1.4).all(),
        f"levels: {code.levels}: at least three are needed, each at least 1.4 times the previous one",
    )
    version = code.version()
    _keep(version is None or version.strip(), "version: empty: return None if the code is not installed")
    _keep(version is not None or code.hint.strip(), "hint: empty: say how to install the code")
    _keep(
        code.unsupported(BEAM) is None, f"unsupported: {code.unsupported(BEAM)}: every code must accept a uniform beam"
    )


def refuses(code: Code) -> None:
    """``unsupported`` and ``solve`` agree."""
    reasons = [(p, code.unsupported(p.having)) for p in PROPERTIES]
    for p, reason in reasons:
        if reason is None:
            continue
        _keep(reason.strip() and "\n" not in reason, f"{p.name}: unsupported: {reason!r}: not one line with the reason")
        try:
            code.solve(p.having, 0.0, code.levels[0], 1)
        except CodeError:
            continue
        raise BrokenError(f"{p.name}: unsupported returns {reason!r}, but solve answers: it must raise CodeError")
    if not any(reason for _, reason in reasons):
        raise NotForItError("the code accepts all these blades")


def at_rest(code: Code) -> None:
    """A uniform cantilever, two modes in each plane."""
    limit, _, bracket = _limit(code, BEAM, 0.0)
    _close(limit, np.repeat(CANTILEVER[:2], 2), "beam at rest, in pairs", max(bracket, NEAR))


def turning(code: Code) -> None:
    """Stiffened by tension, softened in the plane of rotation."""
    omega = known.WRIGHT_SPEED
    _is(code, BEAM, omega, known.WRIGHT, axis=2)
    _is(code, BEAM, omega, float(np.sqrt(known.WRIGHT**2 - omega**2)), axis=1)


def counts(code: Code) -> None:
    """The requested number of modes is returned."""
    few, many = (_ask(code, BEAM, known.SPEED, 0, count) for count in (3, 8))
    for modes, count in ((few, 3), (many, 8)):
        f = modes.frequencies
        _keep(3 <= len(f) <= count, f"{count} modes requested, {len(f)} returned")
        _keep((f > 0).all() and (np.diff(f) >= 0).all(), f"frequencies: {f.tolist()}: not positive and ascending")
        _keep(modes.omega == known.SPEED, f"Modes.omega: {modes.omega}, requested {known.SPEED}")
        _keep(modes.elements >= code.levels[0], f"Modes.elements: {modes.elements}, requested {code.levels[0]}")
    _close(many.frequencies, few.frequencies, "the first three of eight modes, and three modes", _same(code))


def repeats(code: Code) -> None:
    """No state remains from another call."""
    first = _ask(code, BEAM, known.SPEED, 0)
    _ask(code, replace(BEAM, hub_radius=1.0), 1.0, 1)
    again = _ask(code, BEAM, known.SPEED, 0)
    same = np.array_equal(first.frequencies, again.frequencies) and np.array_equal(first.shapes, again.shapes)
    _keep(
        same, f"the same call before and after another: {first.frequencies.tolist()}, then {again.frequencies.tolist()}"
    )


def shapes(code: Code) -> None:
    """The first shape, nearly that at rest."""
    shape = _ask(code, BEAM, known.SPEED, 1).shapes[0]
    _keep(np.abs(shape[0]).max() <= 1e-6 * np.abs(shape).max(), f"the root moves: {shape[0].tolist()}")
    moved = np.abs(shape[:, 1:3]).max(axis=1)
    wrong = np.abs(moved / moved[-1] - known.cantilever_shape()).max()
    _keep(
        wrong < 0.02,
        f"first shape: differs from the cantilever's by up to {wrong:.3f} of the tip's motion: wrong stations or scale?",
    )
    stray = np.abs(shape[:, [0, 3]]).max() / moved[-1]
    _keep(stray < 0.05, f"first shape: stretch or torsion is {stray:.3f} of the bending: wrong order of columns?")


def order(code: Code) -> None:
    """Observed order at the three coarsest levels."""
    if not code.order:
        raise NotForItError("spectral: no order")
    found = [_ask(code, BEAM, 0.0, level, 3) for level in (0, 1, 2)]
    f = np.array([modes.frequencies[2] for modes in found])
    n = [modes.elements for modes in found]
    first, second = np.abs(np.diff(f)) / f[-1]
    if second < 1e-9:
        return
    seen = np.log(first / second) / np.log(n[1] / n[0])
    _keep(
        seen > code.order - 0.3,
        f"observed order {seen:.2f}, declared {code.order}: {f.tolist()} rad/s with {n} elements",
    )


def units(code: Code) -> None:
    """Lengths in feet, masses in pounds, times in minutes: the same to the declared digits of the code."""
    length, mass, rate = 1 / 0.3048, 1 / 0.45359237, 60.0
    power = np.add.outer([0, 0, 0, 1, 1, 1], [0, 0, 0, 1, 1, 1])
    other = replace(
        BEAM,
        stations=BEAM.stations * length,
        curve=BEAM.curve * length,
        stiffness=BEAM.stiffness * mass * length ** (1.0 + power) * rate**2,
        mass=BEAM.mass * mass * length ** (power - 1.0),
    )
    here, there = _ask(code, BEAM, known.SPEED, 0), _ask(code, other, known.SPEED * rate, 0)
    _close(there.frequencies / rate, here.frequencies, "the same beam in ft, lb and min", _rounding(code))


def quarter_pitch(code: Code) -> None:
    """A pitch of 90° exchanges the planes."""
    pitched, plain = (_ask(code, b, known.SPEED, 0) for b in (replace(PLANK, pitch=np.pi / 2), known.SWAPPED))
    _close(pitched.frequencies, plain.frequencies, "a plank pitched by 90°, and one with exchanged planes", _same(code))
    for axis in (1, 2):
        same = _along(pitched, axis) == _along(plain, axis)
        _keep(same, f"a plank pitched by 90°: its modes along {'xyz'[axis]} are not those of one with exchanged planes")


def pitch_sense(code: Code) -> None:
    """Flapwise motion leans to −y."""
    found = _lean(_ask(code, replace(PLANK, pitch=0.3), 0.0, 1))
    _keep(
        abs(found + np.tan(0.3)) < 0.01, f"at rest, pitched by 0.3: y/z = {found:.4f}, expected −tan 0.3: wrong sense?"
    )


def twist_sense(code: Code) -> None:
    """The same by twist."""
    found = _lean(_ask(code, replace(PLANK, twist=np.array([0.3, 0.3])), 0.0, 1))
    _keep(
        abs(found + np.tan(0.3)) < 0.01, f"at rest, twisted by 0.3: y/z = {found:.4f}, expected −tan 0.3: wrong sense?"
    )


def _lean(modes: Modes) -> float:
    tip = modes.shapes[0, -1]
    return float((tip[1] / tip[2]).real)


def torsion(code: Code) -> None:
    """π/2 √(GJ / I) / L, a quarter of a sine; or no such mode at all."""
    blade, exact = known.shaft()
    limit, fine, _ = _limit(code, blade, 0.0)
    bend = np.abs(fine.shapes[:, :, :3]).max((1, 2)) / LENGTH
    turns = np.flatnonzero(np.abs(fine.shapes[:, :, 3]).max(1) > 10 * bend)
    if not turns.size:
        there = (np.abs(limit / exact - 1.0) < NEAR).any()
        _keep(
            not there,
            f"soft shaft: the mode at {exact:g} rad/s has no rotation about the axis: wrong order of columns?",
        )
        raise NotForItError("the code has no torsion")
    _close(limit[turns[0]], exact, "soft shaft at rest, lowest torsional mode", NEAR)
    shape = fine.shapes[turns[0], :, 3]
    wrong = np.abs(shape / shape[-1] - np.sin(np.pi / 2 * STATIONS)).max()
    _keep(wrong < 0.01, f"soft shaft: its rotation differs from a quarter sine by {wrong:.3f} of the tip's")


def tip_mass_weighs(code: Code) -> None:
    """At rest."""
    _is(code, known.WITH_TIP_MASS, 0.0, known.TIP_AT_REST)


def tip_mass_pulls(code: Code) -> None:
    """Rotating: its centrifugal force is the tip's tension."""
    _is(code, known.WITH_TIP_MASS, known.TIP_SPEED, known.TIP_TURNING, axis=2)


def coupled_planes(code: Code) -> None:
    """Bending stiffness with a product EI_yz."""
    _is(code, known.coupled_plank(), 0.0, float(CANTILEVER[0]))


def corner(code: Code) -> None:
    """Two straight pieces at right angles, at rest."""
    blade, exact = known.cornered()
    _is(code, blade, 0.0, exact, axis=1)


def hinged_root(code: Code) -> None:
    """With a flap hinge at the rotor's axis the first flapwise mode is a straight line at Ω, whatever the stiffness."""
    _is(code, known.HINGED, known.SPEED, known.SPEED, axis=2)


def shear(code: Code) -> None:
    """A short beam, soft in shear, at rest."""
    _is(code, known.short_beam(known.SHEAR), 0.0, known.timoshenko())


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
    return float(np.abs(np.log(found[: len(other)] / other[: len(found)])).max())


def effects(code: Code) -> None:
    """Each effect in turn, at a speed where its omission shows; not every code can reach this speed."""
    try:
        found, _, bracket = _limit(code, known.STUBBY, known.FAST, (-2, -1))
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
        _keep(
            near <= DROPPED * change,
            f"effects.{name} = {kept}: differs by {near:.2%} from core with these effects; {name} changes {change:.2%}",
        )


def keeps(one: Property, code: Code) -> None:
    """A property is not silently dropped; checked with two coarse levels."""
    found, _, bracket = _limit(code, one.having, one.omega)
    having, lacking = _with_and_without(one.name, code.effects)
    change = _far(having, lacking)
    if change < VISIBLE:
        raise NotForItError(f"no effect without {', '.join(code.effects.lacks())}")
    if bracket > DROPPED * change:
        raise NotForItError(f"its uncertainty, {bracket:.1%}, is too large to show {one.name}")
    near, far = _far(found, having), _far(found, lacking)
    _keep(
        near <= DROPPED * change,
        f"{one.name}: differs by {near:.2%} from the blade with it, by {far:.2%} from the blade without it",
    )
