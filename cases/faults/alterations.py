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


def sent(alter: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """A code is sent another blade, turbine or list of mechanisms, its second argument."""
    return lambda original: lambda name, subject, *how: original(name, alter(subject), *how)


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


def at_speed(alter: Callable[[float], float]) -> Callable[[Any], Any]:
    """Core uses different rotor speeds."""

    def make(original: Any) -> Any:
        def faulty(blade: Blade, omegas: Sequence[float], *args: Any, **kwargs: Any) -> Any:
            return original(blade, list(map(alter, omegas)), *args, **kwargs)

        return faulty

    return make


def whole_end(original: Any) -> Any:
    """The last element's whole mass at the tip, instead of its half."""

    def faulty(blade: Blade, *args: Any, **kwargs: Any) -> Mesh:
        chain = original(blade, *args, **kwargs)
        lumps = chain.lumps.copy()
        lumps[-1] += lumps[-1] - blade.tip_mass
        return replace(chain, lumps=lumps)

    return faulty


def light_tip(original: Any) -> Any:
    """The last tenth of a blade has no mass per length (k, 6, 6)."""

    def faulty(blade: Blade, s: Any) -> Any:
        return original(blade, s) * np.where(np.asarray(s) > 0.9 * blade.length, 0.0, 1.0)[:, None, None]

    return faulty


def swapped_coupling(blade: Blade) -> Blade:
    """Torsion is coupled to the other bending."""
    out = blade.stiffness.copy()
    out[:, TORSION, [BEND_Y, BEND_Z]] = blade.stiffness[:, TORSION, [BEND_Z, BEND_Y]]
    out[:, [BEND_Y, BEND_Z], TORSION] = blade.stiffness[:, [BEND_Z, BEND_Y], TORSION]
    return replace(blade, stiffness=out)


def core_modes(alter: Callable[[Blade], Blade]) -> tuple[Any, str, Callable[[Any], Any]]:
    """Where core's columns get their modes, with another blade."""
    return core_solver, "mesh_sweep", received(alter)
