"""Alterations, each a function from what a function does right to what a wrong one does: of any function, and of core."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...core.blade import BEND_Y, BEND_Z, TORSION, Blade
from ...core.effects import Effects
from ...core.element.mesh import Mesh
from ...core.steady.blade_state import Steady
from ...references.protocol.process import Failure
from ..diagnosis import scaled_terms
from ..solve import core_solver

Balance = Callable[..., Steady]


def returned(alter: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """The value that a function returns is altered."""
    return lambda original: lambda *args, **kwargs: alter(original(*args, **kwargs))


def answered(alter: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """The answers of a code are altered; failures stay as they are."""
    return returned(lambda answers: [answer if isinstance(answer, Failure) else alter(answer) for answer in answers])


def received(alter: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """A function receives another blade or turbine, its first argument."""
    return lambda original: lambda subject, *args, **kwargs: original(alter(subject), *args, **kwargs)


def with_effects(**omitted: bool) -> Callable[[Balance], Balance]:
    """Core omits effects without declaring it."""

    def make(original: Balance) -> Balance:
        def faulty(body: Mesh, omega: float, gravity: Any, effects: Effects, guess: Any = None) -> Steady:
            return original(body, omega, gravity, replace(effects, **omitted), guess)

        return faulty

    return make


def softening(factor: float, **omitted: bool) -> Callable[[Balance], Balance]:
    """Spin softening is multiplied by ``factor``; effects in ``omitted`` are also omitted."""

    def make(original: Balance) -> Balance:
        def faulty(body: Mesh, omega: float, gravity: Any, effects: Effects, guess: Any = None) -> Steady:
            state = original(body, omega, gravity, replace(effects, **omitted), guess)
            return replace(state, pencil=scaled_terms.softened(body, state, omega, factor))

        return faulty

    return make


def pencil(alter: Callable[[Any], Any]) -> Callable[[Balance], Balance]:
    """The linearised matrices are altered."""
    return returned(lambda state: replace(state, pencil=alter(state.pencil)))


def chained(alter: Callable[[Mesh, Blade], Mesh]) -> Callable[[Any], Any]:
    """The chain is altered after discretisation."""

    def make(original: Any) -> Any:
        def faulty(blade: Blade, *args: Any, **kwargs: Any) -> Mesh:
            return alter(original(blade, *args, **kwargs), blade)

        return faulty

    return make


def alter_property(alter: Callable[[Any, Blade, Any], Any]) -> Callable[[Any], Any]:
    """A property along the blade is altered: ``alter(values, blade, s)``."""

    def make(original: Any) -> Any:
        def faulty(blade: Blade, s: Any) -> Any:
            return alter(original(blade, s), blade, s)

        return faulty

    return make


def at_speed(alter: Callable[[float], float]) -> Callable[[Any], Any]:
    """Core uses different rotor speeds."""

    def make(original: Any) -> Any:
        def faulty(blade: Blade, omegas: Sequence[float], *args: Any, **kwargs: Any) -> Any:
            return original(blade, list(map(alter, omegas)), *args, **kwargs)

        return faulty

    return make


def whole_end(chain: Mesh, blade: Blade) -> Mesh:
    """The last element's whole mass at the tip, instead of its half."""
    lumps = chain.lumps.copy()
    lumps[-1] += lumps[-1] - blade.tip_mass
    return replace(chain, lumps=lumps)


def scaled_tip(factor: float) -> Callable[[Mesh, Blade], Mesh]:
    """The tip body's inertia times ``factor``."""

    def alter(chain: Mesh, blade: Blade) -> Mesh:
        lumps = chain.lumps.copy()
        lumps[-1] += (factor - 1.0) * blade.tip_mass
        return replace(chain, lumps=lumps)

    return alter


def mirrored_tip(chain: Mesh, blade: Blade) -> Mesh:
    """The tip body's inertia reflected in the x–z plane."""
    lumps, flip = chain.lumps.copy(), np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    lumps[-1] += flip @ blade.tip_mass @ flip - blade.tip_mass
    return replace(chain, lumps=lumps)


def scaled_beyond(mass: Any, blade: Blade, s: Any, factor: float, fraction: float) -> Any:
    """Mass per length (k, 6, 6) times ``factor`` where ``s`` exceeds the ``fraction`` of the length."""
    return mass * np.where(np.asarray(s) > fraction * blade.length, factor, 1.0)[:, None, None]


def swapped_axes(stiffness: Any, *_: Any) -> Any:
    """Section stiffness (k, 6, 6) with y and z exchanged."""
    order = [0, 2, 1, 3, 5, 4]
    return stiffness[:, order][:, :, order]


def swapped_coupling(stiffness: Any, *_: Any) -> Any:
    """Section stiffness (k, 6, 6) with torsion coupled to the other bending."""
    out = stiffness.copy()
    out[:, TORSION, [BEND_Y, BEND_Z]] = stiffness[:, TORSION, [BEND_Z, BEND_Y]]
    out[:, [BEND_Y, BEND_Z], TORSION] = stiffness[:, [BEND_Z, BEND_Y], TORSION]
    return out


def scaled_coupling(factor: float) -> Callable[[Any, Blade, Any], Any]:
    """The coupling of torsion and flapwise bending times ``factor``."""

    def alter(stiffness: Any, *_: Any) -> Any:
        out = stiffness.copy()
        out[:, TORSION, BEND_Y] *= factor
        out[:, BEND_Y, TORSION] *= factor
        return out

    return alter


def scaled_strain(strain: int, factor: float) -> Callable[[Any, Blade, Any], Any]:
    """The stiffness of one strain times ``factor``."""

    def alter(stiffness: Any, *_: Any) -> Any:
        out = stiffness.copy()
        out[:, strain, strain] *= factor
        return out

    return alter


def core_modes(alter: Callable[[Blade], Blade]) -> tuple[Any, str, Callable[[Any], Any]]:
    """Where core's columns get their modes, with another blade."""
    return core_solver, "mesh_sweep", received(alter)
