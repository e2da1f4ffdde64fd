"""Conformance checks of a code for blades: each function returns, or raises an error that describes the fault."""

from dataclasses import replace

import numpy as np

from ...core.blade import AXIAL
from ...core.modes import STATIONS, Modes
from ...references.protocol.interface import BladeAdapter, CodeError
from . import blades
from .asking import (
    TOLERANCE,
    BrokenError,
    NotForItError,
    agrees,
    along,
    ask,
    limit_of,
    named,
    require,
    require_close,
    rounding,
    same,
)
from .blades import BEAM, CANTILEVER, LENGTH, PLANK, PROPERTIES

FEWEST = 5
"""Fewest digits of a code's answers with which ``TOLERANCE`` can be checked."""


def declares(code: BladeAdapter) -> None:
    """The declarations of the adapter are valid."""
    named(code)
    require(isinstance(code.order, int) and code.order >= 0, f"order: {code.order!r}: not a whole number (0: spectral)")
    require(
        isinstance(code.digits, int) and code.digits >= FEWEST,
        f"digits: {code.digits!r}: not a whole number of at least {FEWEST}",
    )
    steps = np.divide(code.levels[1:], code.levels[:-1])
    require(
        len(steps) >= 2 and (steps >= 1.4).all(),
        f"levels: {code.levels}: at least three are needed, each at least 1.4 times the previous one",
    )
    require(
        code.unsupported(BEAM) is None, f"unsupported: {code.unsupported(BEAM)}: every code must accept a uniform beam"
    )


def refuses(code: BladeAdapter) -> None:
    """``unsupported`` and ``solve`` agree."""
    reasons = [(p, code.unsupported(p.blade)) for p in PROPERTIES]
    for p, reason in reasons:
        if reason is None:
            continue
        require(
            reason.strip() and "\n" not in reason, f"{p.name}: unsupported: {reason!r}: not one line with the reason"
        )
        try:
            code.solve(p.blade, 0.0, code.levels[0], 1)
        except CodeError:
            continue
        raise BrokenError(f"{p.name}: unsupported returns {reason!r}, but solve answers: it must raise CodeError")
    if not any(reason for _, reason in reasons):
        raise NotForItError("the code accepts all these blades")


def at_rest(code: BladeAdapter) -> None:
    """A uniform cantilever, two modes in each plane."""
    limit, _, bracket = limit_of(code, BEAM, 0.0)
    require_close(limit, np.repeat(CANTILEVER[:2], 2), "beam at 0 rad/s, in pairs", max(bracket, TOLERANCE))


def turning(code: BladeAdapter) -> None:
    """Stiffened by tension, softened in the plane of rotation."""
    omega = blades.WRIGHT_SPEED
    agrees(code, BEAM, omega, blades.WRIGHT, axis=2)
    agrees(code, BEAM, omega, float(np.sqrt(blades.WRIGHT**2 - omega**2)), axis=1)


def counts(code: BladeAdapter) -> None:
    """The requested number of modes is returned."""
    three_modes, eight_modes = (ask(code, BEAM, blades.SPEED, 0, count) for count in (3, 8))
    for modes, count in ((three_modes, 3), (eight_modes, 8)):
        f = modes.frequencies
        require(3 <= len(f) <= count, f"beam at {blades.SPEED:g} rad/s: {count} modes requested, {len(f)} returned")
        invalid = np.flatnonzero(~(f > 0) | (np.diff(f, prepend=0.0) < 0))
        require(
            not invalid.size,
            f"beam at {blades.SPEED:g} rad/s, mode {int(invalid[0]) + 1 if invalid.size else 0}: frequencies {f.tolist()}: not "
            "positive and ascending",
        )
        require(modes.omega == blades.SPEED, f"Modes.omega: {modes.omega}, requested {blades.SPEED}")
        require(modes.elements >= code.levels[0], f"Modes.elements: {modes.elements}, requested {code.levels[0]}")
    require_close(
        eight_modes.frequencies,
        three_modes.frequencies,
        f"beam at {blades.SPEED:g} rad/s, 3 and 8 requested",
        same(code),
    )


def repeats(code: BladeAdapter) -> None:
    """No state remains from another call."""
    first = ask(code, BEAM, blades.SPEED, 0)
    ask(code, replace(BEAM, hub_radius=1.0), 1.0, 1)
    second = ask(code, BEAM, blades.SPEED, 0)
    is_equal = np.array_equal(first.frequencies, second.frequencies) and np.array_equal(first.shapes, second.shapes)
    require(
        is_equal,
        f"beam at {blades.SPEED:g} rad/s: the same call before and after another (hub radius 1 m, 1 rad/s): "
        f"{first.frequencies.tolist()}, then {second.frequencies.tolist()}",
    )


def shapes(code: BladeAdapter) -> None:
    """The first shape, nearly that at rest."""
    shape = ask(code, BEAM, blades.SPEED, 1).shapes[0]
    at = f"beam at {blades.SPEED:g} rad/s, mode 1"
    require(np.abs(shape[0]).max() <= 1e-6 * np.abs(shape).max(), f"{at}: the root moves: {shape[0].tolist()}")
    deflection = np.abs(shape[:, 1:3]).max(axis=1)
    deviation = np.abs(deflection / deflection[-1] - blades.cantilever_shape()).max()
    require(
        deviation < 0.02,
        f"{at}: the shape differs from the cantilever's by up to {deviation:.3f} of the tip's motion: check stations and scale",
    )
    stray = np.abs(shape[:, [0, 3]]).max() / deflection[-1]
    require(stray < 0.05, f"{at}: stretch or torsion is {stray:.3f} of the bending: check the order of the columns")


def order(code: BladeAdapter) -> None:
    """Observed order at the three coarsest levels."""
    if not code.order:
        raise NotForItError("spectral: no order")
    frequencies = [ask(code, BEAM, 0.0, level, 3) for level in (0, 1, 2)]
    f = np.array([modes.frequencies[2] for modes in frequencies])
    n = [modes.elements for modes in frequencies]
    first, second = np.abs(np.diff(f)) / f[-1]
    if second < 1e-9:
        return
    observed = np.log(first / second) / np.log(n[1] / n[0])
    require(
        observed > code.order - 0.3,
        f"beam at 0 rad/s, mode 3: observed order {observed:.2f}, declared {code.order}: {f.tolist()} rad/s with {n} elements",
    )


def units(code: BladeAdapter) -> None:
    """Lengths in feet, masses in pounds, times in minutes: the same to the declared digits of the code."""
    length, mass, rate = 1 / 0.3048, 1 / 0.45359237, 60.0
    power = np.add.outer([0, 0, 0, 1, 1, 1], [0, 0, 0, 1, 1, 1])
    scaled = replace(
        BEAM,
        stations=BEAM.stations * length,
        curve=BEAM.curve * length,
        stiffness=BEAM.stiffness * mass * length ** (1.0 + power) * rate**2,
        mass=BEAM.mass * mass * length ** (power - 1.0),
    )
    in_si, in_other_units = ask(code, BEAM, blades.SPEED, 0), ask(code, scaled, blades.SPEED * rate, 0)
    require_close(
        in_other_units.frequencies / rate,
        in_si.frequencies,
        f"beam at {blades.SPEED:g} rad/s, in ft, lb and min",
        rounding(code),
    )


def quarter_pitch(code: BladeAdapter) -> None:
    """A pitch of 90° exchanges the planes."""
    pitched, plain = (ask(code, b, blades.SPEED, 0) for b in (replace(PLANK, pitch=np.pi / 2), blades.SWAPPED))
    at = f"plank pitched by 90° at {blades.SPEED:g} rad/s"
    require_close(pitched.frequencies, plain.frequencies, f"{at}, against exchanged planes", same(code))
    for axis in (1, 2):
        same_axis = along(pitched, axis) == along(plain, axis)
        require(same_axis, f"{at}: the lowest mode along {'xyz'[axis]} is not that of a plank with exchanged planes")


def pitch_sense(code: BladeAdapter) -> None:
    """Flapwise motion leans to −y."""
    lean = _lean(ask(code, replace(PLANK, pitch=0.3), 0.0, 1))
    _leans(lean, "pitched")


def twist_sense(code: BladeAdapter) -> None:
    """The same by twist."""
    lean = _lean(ask(code, replace(PLANK, twist=np.array([0.3, 0.3])), 0.0, 1))
    _leans(lean, "twisted")


def precone_sense(code: BladeAdapter) -> None:
    """Flapwise motion of a blade coned towards +z leans to −x: shapes are along the rotor's axes."""
    _leans(_lean(ask(code, replace(PLANK, precone=0.3), 0.0, 1), axis=0), "coned", "x")


def _leans(ratio: float, how: str, axis: str = "y") -> None:
    at = f"plank {how} by 0.3 rad at 0 rad/s, mode 1"
    require(
        abs(ratio + np.tan(0.3)) < 0.01, f"{at}: {axis}/z = {ratio:.4f}, expected −tan 0.3: check the sense of rotation"
    )


def _lean(modes: Modes, axis: int = 1) -> float:
    tip = modes.shapes[0, -1]
    return float((tip[axis] / tip[2]).real)


def coriolis_sense(code: BladeAdapter) -> None:
    """The Coriolis force stretches a blade that moves along +y: ``EA u″ + m (ω² + Ω²) u = −2 i m Ω ω v`` for exp(iωt)."""
    blade, omega = blades.STUBBY, blades.FAST
    if not code.effects.coriolis:
        raise NotForItError("the code has no Coriolis terms")
    try:
        modes = ask(code, blade, omega, 1)
    except CodeError as error:  # not every code can reach this speed
        raise NotForItError(str(error)) from error
    lag = along(modes, 1)
    u, v = modes.shapes[lag, -1, 0], modes.shapes[lag, :, 1]
    s, EA, w = STATIONS * LENGTH, blade.stiffness[0, AXIAL, AXIAL], modes.frequencies[lag]
    k = np.sqrt(blades.MASS * (w**2 + omega**2) / EA)
    green = np.sin(k * s) / (k * np.cos(k * LENGTH))  # of a rod with a fixed root and a free end, at its end
    exact = 2j * blades.MASS * omega * w / EA * np.trapezoid(green * v, s)
    require(
        abs(u - exact) < 0.05 * abs(exact),
        f"{blade.name} at {omega:g} rad/s, mode {lag + 1}: stretch over edgewise motion at the tip {u / v[-1]:.4f}, expected "
        f"{exact / v[-1]:.4f}: wrong sign of the Coriolis terms, or exp(−iωt)?",
    )


def torsion(code: BladeAdapter) -> None:
    """π/2 √(GJ / I) / L, a quarter of a sine; or no such mode at all."""
    blade, exact = blades.shaft()
    limit, fine, _ = limit_of(code, blade, 0.0)
    bend = np.abs(fine.shapes[:, :, :3]).max((1, 2)) / LENGTH
    turns = np.flatnonzero(np.abs(fine.shapes[:, :, 3]).max(1) > 10 * bend)
    if not turns.size:
        is_torsion = (np.abs(limit / exact - 1.0) < TOLERANCE).any()
        require(
            not is_torsion,
            f"soft shaft at 0 rad/s: the mode at {exact:g} rad/s has no rotation about the axis: check the order of the "
            "columns",
        )
        raise NotForItError("the code has no torsion")
    first = int(turns[0]) + 1
    require_close(limit[turns[0]], exact, "soft shaft at 0 rad/s, lowest torsional mode", TOLERANCE, first)
    shape = fine.shapes[turns[0], :, 3]
    deviation = np.abs(shape / shape[-1] - np.sin(np.pi / 2 * STATIONS)).max()
    at = f"soft shaft at 0 rad/s, mode {first}"
    require(deviation < 0.01, f"{at}: the rotation differs from a quarter sine by {deviation:.3f} of the tip's")


def tip_mass_weighs(code: BladeAdapter) -> None:
    """At rest."""
    agrees(code, blades.WITH_TIP_MASS, 0.0, blades.TIP_AT_REST)


def tip_mass_pulls(code: BladeAdapter) -> None:
    """Rotating: its centrifugal force is the tip's tension."""
    agrees(code, blades.WITH_TIP_MASS, blades.TIP_SPEED, blades.TIP_TURNING, axis=2)


def tip_mass_axes(code: BladeAdapter) -> None:
    """A tip mass beside the axis is given in the tip section's axes: with the whole blade twisted, it turns as with pitch."""
    blade = replace(PLANK, tip_mass=blades.BESIDE)
    twisted, pitched = (
        ask(code, b, blades.SPEED, 0) for b in (replace(blade, twist=np.array([0.5, 0.5])), replace(blade, pitch=0.5))
    )
    at = f"plank with an offset tip mass at {blades.SPEED:g} rad/s, twisted by 0.5 rad, against pitched"
    require_close(twisted.frequencies, pitched.frequencies, at, same(code))


def coupled_planes(code: BladeAdapter) -> None:
    """Bending stiffness with a product EI_yz."""
    agrees(code, blades.coupled_plank(), 0.0, float(CANTILEVER[0]))


def corner(code: BladeAdapter) -> None:
    """Two straight pieces at right angles, at rest."""
    blade, exact = blades.cornered()
    agrees(code, blade, 0.0, exact, axis=1)


def hinged_root(code: BladeAdapter) -> None:
    """With a flap hinge at the rotor's axis the first flapwise mode is a straight line at Ω, whatever the stiffness."""
    agrees(code, blades.HINGED, blades.SPEED, blades.SPEED, axis=2)


def shear(code: BladeAdapter) -> None:
    """A short beam, soft in shear and softer along z than along y, at rest."""
    blade = blades.short_beam(blades.SHEAR, along_y=blades.SHEAR_Y)
    agrees(code, blade, 0.0, blades.timoshenko(), axis=2)
    agrees(code, blade, 0.0, blades.timoshenko(blades.SHEAR_Y), axis=1)
