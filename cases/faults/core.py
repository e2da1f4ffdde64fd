"""Faults in core, where Python passes geometry, sections, chains and pencils to the compiled loops."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ...core import solve
from ...core.blade import BEND_Y, BEND_Z, TORSION, Blade
from ...core.chain import solution
from ...core.chain.steady import Steady
from ...core.effects import Effects
from ...core.element import discretize, sections
from ...core.element.discretize import Chain
from ..verify import core_faults, core_solver
from .seeding import Fault, Trial

Balance = Callable[..., Steady]

INERTIA = np.pad(np.full((3, 3), 25.0), (3, 0)) + np.pad(np.ones((3, 3)), (0, 3))
"""Sections with the moments of inertia of sections five times as thick."""

PARK = Trial("park-cantilever", (10.0,), ("exact-beam",))
THICK = Trial("park-cantilever", (10.0,), ("exact-beam",), lambda b: replace(b, mass=b.mass * INERTIA))
FAST = Trial("yoo-shin-chordwise/delta-0", (10.0,), ("exact-beam",))
AXIAL = Trial("yoo-shin-chordwise/delta-0", (50.0,), ("exact-beam",))
TWISTED = Trial("pretwisted-beam", (8.0,), ("assumed-modes",))
TAPERED = Trial("tapered-beam", (8.0,), ("exact-beam",))
TIP = Trial("tip-mass", (12.0,), ("exact-beam",))
PITCHED = Trial("pretwisted-beam", (8.0,), ("scikit-fem",), lambda b: replace(b, pitch=0.5))
TORSIONAL = Trial("articulated/flap", (10.0,), ("scikit-fem",), modes=1, motions=("torsion",))
HINGED = Trial("articulated/sprung", (10.0,), ("scikit-fem",))

BESIDE = np.zeros((6, 6))
BESIDE[:3, :3] = 0.2 * np.eye(3)
BESIDE[0, 5] = BESIDE[5, 0] = -0.2 * 0.1
BESIDE[2, 3] = BESIDE[3, 2] = 0.2 * 0.1
BESIDE[3, 3] = BESIDE[5, 5] = 0.2 * 0.1**2

CONED = Trial("pretwisted-beam", (4.0,), ("exudyn-tree",), lambda b: replace(b, precone=0.1, tip_mass=BESIDE), modes=2)
"""With a point mass at the tip: a fifth of the beam's mass, offset from the axis by a tenth of its length. Without
precone or without offset, reversing the sign of the other gives a mirror image with the same frequencies."""


COUPLED = replace(CONED, change=lambda b: _coupled(replace(b, precone=0.1, tip_mass=BESIDE)))
"""The same blade, so that the sign of the coupling also matters."""


def modelled(**lacks: bool) -> Callable[[Balance], Balance]:
    """Core omits effects without declaring it."""

    def make(right: Balance) -> Balance:
        def wrong(body: Chain, omega: float, gravity: Any, model: Effects, guess: Any = None) -> Steady:
            return right(body, omega, gravity, replace(model, **lacks), guess)

        return wrong

    return make


def softening(factor: float, **lacks: bool) -> Callable[[Balance], Balance]:
    """Spin softening is multiplied by ``factor``; effects in ``lacks`` are also omitted."""

    def make(right: Balance) -> Balance:
        def wrong(body: Chain, omega: float, gravity: Any, model: Effects, guess: Any = None) -> Steady:
            state = right(body, omega, gravity, replace(model, **lacks), guess)
            return replace(state, pencil=core_faults.softened(body, state, omega, factor))

        return wrong

    return make


def pencil(alter: Callable[[Any], Any]) -> Callable[[Balance], Balance]:
    """The linearised matrices are altered."""

    def make(right: Balance) -> Balance:
        def wrong(*args: Any, **kwargs: Any) -> Steady:
            state = right(*args, **kwargs)
            return replace(state, pencil=alter(state.pencil))

        return wrong

    return make


def chained(alter: Callable[[Chain, Blade], Chain]) -> Callable[[Any], Any]:
    """The chain is altered after discretisation."""

    def make(right: Any) -> Any:
        def wrong(blade: Blade, *args: Any, **kwargs: Any) -> Chain:
            return alter(right(blade, *args, **kwargs), blade)

        return wrong

    return make


def bladed(alter: Callable[[Blade], Blade]) -> Callable[[Any], Any]:
    """A function receives a different blade."""

    def make(right: Any) -> Any:
        def wrong(blade: Blade, *args: Any, **kwargs: Any) -> Any:
            return right(alter(blade), *args, **kwargs)

        return wrong

    return make


def valued(alter: Callable[[Any, Blade, Any], Any]) -> Callable[[Any], Any]:
    """A property along the blade is altered: ``alter(values, blade, s)``."""

    def make(right: Any) -> Any:
        def wrong(blade: Blade, s: Any) -> Any:
            return alter(right(blade, s), blade, s)

        return wrong

    return make


def at_speed(alter: Callable[[float], float]) -> Callable[[Any], Any]:
    """Core uses a different rotor speed."""

    def make(right: Any) -> Any:
        def wrong(blade: Blade, omega: float, *args: Any, **kwargs: Any) -> Any:
            return right(blade, alter(omega), *args, **kwargs)

        return wrong

    return make


def _whole_end(chain: Chain, blade: Blade) -> Chain:
    lumps = chain.lumps.copy()
    lumps[-1] += lumps[-1] - blade.tip_mass
    return replace(chain, lumps=lumps)


def _tip(factor: float) -> Callable[[Chain, Blade], Chain]:
    def alter(chain: Chain, blade: Blade) -> Chain:
        lumps = chain.lumps.copy()
        lumps[-1] += (factor - 1.0) * blade.tip_mass
        return replace(chain, lumps=lumps)

    return alter


def _mirrored_tip(chain: Chain, blade: Blade) -> Chain:
    lumps, flip = chain.lumps.copy(), np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    lumps[-1] += flip @ blade.tip_mass @ flip - blade.tip_mass
    return replace(chain, lumps=lumps)


def _scaled(mass: Any, blade: Blade, s: Any, factor: float, beyond: float) -> Any:
    return mass * np.where(np.asarray(s) > beyond * blade.length, factor, 1.0)[:, None, None]


def _swapped(stiffness: Any, *_: Any) -> Any:
    order = [0, 2, 1, 3, 5, 4]
    return stiffness[:, order][:, :, order]


def _coupling(stiffness: Any, *_: Any) -> Any:
    out = stiffness.copy()
    out[:, TORSION, [BEND_Y, BEND_Z]] = stiffness[:, TORSION, [BEND_Z, BEND_Y]]
    out[:, [BEND_Y, BEND_Z], TORSION] = stiffness[:, [BEND_Z, BEND_Y], TORSION]
    return out


def _uncoupled(factor: float) -> Callable[[Any, Blade, Any], Any]:
    def alter(stiffness: Any, *_: Any) -> Any:
        out = stiffness.copy()
        out[:, TORSION, BEND_Y] *= factor
        out[:, BEND_Y, TORSION] *= factor
        return out

    return alter


def _coupled(blade: Blade) -> Blade:
    """Torsion is coupled with flapwise bending by half the value that would make the section singular."""
    stiffness = blade.stiffness.copy()
    size = 0.5 * np.sqrt(stiffness[:, TORSION, TORSION] * stiffness[:, BEND_Y, BEND_Y])
    stiffness[:, TORSION, BEND_Y] = stiffness[:, BEND_Y, TORSION] = size
    return replace(blade, stiffness=stiffness)


def _times(strain: int, factor: float) -> Callable[[Any, Blade, Any], Any]:
    def alter(stiffness: Any, *_: Any) -> Any:
        out = stiffness.copy()
        out[:, strain, strain] *= factor
        return out

    return alter


def _negative(matrix: Any) -> Any:
    return replace(matrix, diagonal=-matrix.diagonal, upper=-matrix.upper, lower=-matrix.lower)


def _own_modes(alter: Callable[[Blade], Blade]) -> tuple[Any, str, Callable[[Any], Any]]:
    return core_solver, "mesh_modes", bladed(alter)


def _shifted(blade: Blade) -> Blade:
    return core_faults.shifted(blade)


def _core(name: str, what: str, size: str, seam: Any, trial: Trial, fast: bool = False) -> Fault:
    return Fault(name, "core", what, size, (seam,), trial, fast=fast)


BALANCE = "balance"

FAULTS = (
    _core(
        "no geometric stiffness",
        "the centrifugal tension does not stiffen",
        "first chordwise −71 %",
        (solution, BALANCE, modelled(geometric=False)),
        PARK,
        True,
    ),
    _core(
        "softening's sign",
        "spin softening is added instead of taken away",
        "first chordwise +57 %",
        (solution, BALANCE, softening(-1.0)),
        PARK,
        True,
    ),
    _core(
        "frozen frame",
        "linearised in a frame that stands still: chordwise is read as flapwise",
        "first chordwise +31 %",
        (solution, BALANCE, softening(0.0, coriolis=False)),
        PARK,
        True,
    ),
    _core(
        "axis shifted",
        "reference axis shifted by a quarter of the radius of gyration, without the coupling terms",
        "chordwise +2 to +3 %",
        _own_modes(_shifted),
        PARK,
        True,
    ),
    _core(
        "no Coriolis",
        "no Coriolis force",
        "first chordwise 1.7 % at γ = 10",
        (solution, BALANCE, modelled(coriolis=False)),
        FAST,
        True,
    ),
    _core(
        "whole end mass",
        "of lumped masses the tip's is a whole element's instead of half",
        "first modes −2 % of 50 elements",
        (solve, "discretize", chained(_whole_end)),
        PARK,
        True,
    ),
    _core(
        "no hub radius",
        "the root lies on the rotor's axis",
        "first modes −3 %",
        (sections, "root", bladed(lambda b: replace(b, hub_radius=0.0))),
        PARK,
        True,
    ),
    _core(
        "Coriolis' sign",
        "the gyroscopic terms turn the other way: frequencies stay, the lag between stretch and bending is reversed",
        "no frequency; MAC of mixed modes below 0.8",
        (solution, BALANCE, pencil(lambda p: replace(p, C=_negative(p.C)))),
        AXIAL,
    ),
    _core(
        "half the Coriolis force",
        "a factor of 2 lost in the Coriolis terms",
        "first chordwise 1.2 % at γ = 10",
        (
            solution,
            BALANCE,
            pencil(
                lambda p: replace(
                    p, C=replace(p.C, diagonal=p.C.diagonal / 2, upper=p.C.upper / 2, lower=p.C.lower / 2)
                )
            ),
        ),
        FAST,
    ),
    _core(
        "no prestretch",
        "the steady state is that of the undeformed blade",
        "first chordwise 10 % at γ = 50",
        (solution, BALANCE, modelled(prestretch=False)),
        AXIAL,
    ),
    _core(
        "half the softening",
        "spin softening of half the size",
        "first chordwise +17 %",
        (solution, BALANCE, softening(0.5)),
        PARK,
    ),
    _core(
        "no rotary inertia",
        "sections have no moments of inertia",
        "second flapwise +1.3 %",
        _own_modes(lambda b: replace(b, mass=b.mass * np.pad(np.ones((3, 3)), (0, 3)))),
        THICK,
    ),
    _core(
        "twist's sense",
        "twist turns the sections the other way",
        "shapes mirrored; MAC below 0.8",
        (sections, "twist_at", lambda right: lambda blade, s: -right(blade, s)),
        TWISTED,
    ),
    _core(
        "no twist",
        "twist is dropped",
        "second mode by percents",
        (sections, "twist_at", lambda right: lambda blade, s: 0.0 * right(blade, s)),
        TWISTED,
    ),
    _core(
        "precone's sense",
        "precone leans the blade the other way",
        "lowest modes ±0.5 %",
        (sections, "root", bladed(lambda b: replace(b, precone=-b.precone))),
        CONED,
    ),
    _core(
        "no precone",
        "precone is dropped",
        "lowest modes ±0.5 %",
        (sections, "root", bladed(lambda b: replace(b, precone=0.0))),
        CONED,
    ),
    _core(
        "pitch's sense",
        "pitch turns the blade the other way",
        "lowest modes ±0.5 %",
        (sections, "root", bladed(lambda b: replace(b, pitch=-b.pitch))),
        PITCHED,
    ),
    _core(
        "no pitch",
        "pitch is dropped",
        "lowest modes by percents",
        (sections, "root", bladed(lambda b: replace(b, pitch=0.0))),
        PITCHED,
    ),
    _core(
        "last element's mass",
        "the last tenth of the blade weighs nothing",
        "first modes +23 %",
        (discretize, "mass_at", valued(lambda m, b, s: _scaled(m, b, s, 0.0, 0.9))),
        PARK,
    ),
    _core(
        "mass per length",
        "mass one half of a percent too large",
        "all modes at rest −0.25 %",
        (discretize, "mass_at", valued(lambda m, b, s: 1.005 * m)),
        Trial("park-cantilever", (0.0,), ("exact-beam",)),
    ),
    _core(
        "no taper",
        "the root's stiffness all along the blade",
        "first modes +10 %",
        (sections, "stiffness_at", lambda right: lambda blade, s: right(blade, 0.0 * np.asarray(s))),
        TAPERED,
    ),
    _core("tip mass in grams", "a unit error: a thousand times the tip mass", "first modes by −80 %",
          (solve, "discretize", chained(_tip(1000.0))), TIP),
    _core("no tip mass", "the tip mass is dropped", "first modes by tens of percents",
          (solve, "discretize", chained(_tip(0.0))), TIP),
    _core("offset's sign", "the tip's mass centre lies behind the axis instead of ahead of it", "lowest modes ±0.5 %",
          (solve, "discretize", chained(_mirrored_tip)), CONED),
    _core("axes swapped", "the stiffness across is that along, and the other way round", "factor 2",
          (sections, "stiffness_at", valued(_swapped)), Trial("pretwisted-beam", (0.0,), ("assumed-modes",))),
    _core("bending stiffness", "EI_z half a percent too large", "chordwise at rest +0.25 %",
          (sections, "stiffness_at", valued(_times(BEND_Z, 1.005))), Trial("park-cantilever", (0.0,), ("exact-beam",))),
    _core("torsional stiffness", "GJ one percent too large", "first torsion +0.5 %",
          (sections, "stiffness_at", valued(_times(TORSION, 1.01))), TORSIONAL),
    _core("speed in revolutions", "rad/s taken for revolutions per second", "flapwise by factors",
          (core_solver, "mesh_modes", at_speed(lambda omega: 2 * np.pi * omega)), PARK),
    _core("transposed coupling", "torsion couples with the other bending: a pair of indices exchanged", "shapes; percents",
          (sections, "stiffness_at", valued(_coupling)), COUPLED),
    _core("coupling's sign", "bending and torsion couple with the other sign", "lowest modes by percents",
          (sections, "stiffness_at", valued(_uncoupled(-1.0))), COUPLED),
    _core("no coupling", "the sections' off-diagonal stiffness is dropped", "percents",
          (sections, "stiffness_at", valued(_uncoupled(0.0))), COUPLED),
    _core("one Gauss point", "the flexibility of an element is integrated with one point: it cannot be inverted", "no answer",
          (sections, "GAUSS", lambda _: 1), PARK),
    _core("root spring", "the spring in the root's hinge is dropped", "first modes by tens of percents",
          _own_modes(lambda b: replace(b, root=np.where(np.isinf(b.root), b.root, 0.0))), HINGED),
)  # fmt: skip
