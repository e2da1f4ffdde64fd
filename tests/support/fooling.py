"""Codes that do wrong in ways that once were not judged as failures."""

import os
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from southwell.core.blade import Blade
from southwell.core.effects import Effects
from southwell.core.modes import Modes
from southwell.core.solve import mesh_modes
from southwell.references.protocol.interface import BladeAdapter, Independence
from southwell.references.theories.exact_beam import CODE as EXACT


@dataclass(frozen=True)
class Fooling(BladeAdapter):
    """The exact beam, with something done to its answer."""

    name: str
    alter: Callable[[Modes], Modes] = lambda modes: modes
    levels: tuple[int, ...] = EXACT.levels
    bracket: bool = False
    order: int = EXACT.order
    title: str = "Exact beam, altered"
    effects: Effects = EXACT.effects
    hint: str = ""

    def version(self) -> str | None:
        return "1.0"

    def unsupported(self, blade: Blade) -> str | None:
        return EXACT.unsupported(blade)

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        return self.alter(EXACT.solve(blade, omega, elements, count))


def _without_flap(modes: Modes) -> Modes:
    shapes = modes.shapes.copy()
    shapes[:, :, 2] = 0.0
    return replace(modes, shapes=shapes)


def _wide(modes: Modes) -> Modes:
    return replace(modes, frequencies=1.6 * modes.frequencies, uncertainty=np.full(len(modes.frequencies), 0.9))


def _extra(modes: Modes) -> Modes:
    """A spurious mode, unlike all others, between the second and the third."""
    saw = np.zeros_like(modes.shapes[:1])
    saw[0, 1:, 1:3] = (-1.0) ** np.arange(1, saw.shape[1])[:, None]
    frequencies = np.insert(modes.frequencies, 2, modes.frequencies[1:3].mean())[: len(modes.frequencies)]
    shapes = np.concatenate([modes.shapes[:2], saw, modes.shapes[2:]])[: len(modes.frequencies)]
    return replace(modes, frequencies=frequencies, shapes=shapes)


def _first_order(modes: Modes, error: float = 2e-3) -> Modes:
    """With an error that is inversely proportional to the number of elements."""
    return replace(modes, frequencies=modes.frequencies * (1.0 + error / modes.elements))


def _scattered(modes: Modes, error: float = 2e-6) -> Modes:
    """With an error whose sign changes from mesh to mesh, which refinement does not reduce."""
    return replace(modes, frequencies=modes.frequencies * (1.0 + error * (-1.0) ** (modes.elements // 16)))


@dataclass(frozen=True)
class Deaf(Fooling):
    """Says that it refines, and solves the same mesh."""

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        return replace(super().modes(blade, omega, 10, count), elements=elements)


@dataclass(frozen=True)
class Fragile(Fooling):
    """Crashes with more than the third of its meshes."""

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        if elements > self.levels[2]:
            os.abort()
        return super().modes(blade, omega, elements, count)


INVENTED = Independence("Beamer 3", "Rossi (2001)", "Rossi (2001), eq. 7")


@dataclass(frozen=True)
class Copy(Fooling):
    """Core's own solver, with an origin of its own."""

    independence: Independence | None = INVENTED

    def unsupported(self, blade: Blade) -> str | None:
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        return mesh_modes(blade, omega, elements, count)


FAR = Fooling("far", lambda m: replace(m, frequencies=1.4 * m.frequencies), levels=(8, 16, 32), order=4)
DEAF = Deaf("deaf", lambda m: replace(m, frequencies=1.0009 * m.frequencies), levels=(8, 16, 32), order=4)
CRUDE = Fooling("crude", _first_order, levels=(8, 16, 32), order=4)
SCATTERS = Fooling("scatters", _scattered, levels=(8, 16, 32), order=4)
FRAGILE = Fragile("fragile", lambda m: _first_order(m, 0.5), levels=(8, 16, 32), order=1)
COPY = Copy("copy", levels=(8, 16, 32), order=4)
LOST = Fooling("lost", _without_flap)
EXTRA = Fooling("extra", _extra)
DAMPED = Fooling("damped", lambda m: replace(m, damping=np.where(np.arange(len(m.frequencies)) == 2, 0.03, 0.0)))
WIDE = Fooling("wide", _wide)
WIDE_ONCE = Fooling("wide-once", _wide, levels=(10,))
BRACKET = Fooling("bracket", _wide, bracket=True)
ZERO = Fooling("zero", lambda m: replace(m, frequencies=np.append(0.0, m.frequencies[1:])))


def _ghosts(modes: Modes) -> Modes:
    """Beside every mode another of nearly the same shape, 30 % above it."""
    frequencies = np.concatenate([modes.frequencies, 1.3 * modes.frequencies])
    blurred = modes.shapes + 0.05 * modes.shapes[::-1]
    order = np.argsort(frequencies, kind="stable")[: len(modes.frequencies)]
    return replace(modes, frequencies=frequencies[order], shapes=np.concatenate([modes.shapes, blurred])[order])


def _wandering(modes: Modes) -> Modes:
    """Another frequency at every refinement, and the same number of elements told of each."""
    return replace(modes, frequencies=modes.frequencies * (1 + 0.01 / modes.elements), elements=10)


def _backwards(modes: Modes) -> Modes:
    """Refinements numbered from the finest to the coarsest."""
    return replace(modes, frequencies=modes.frequencies * (1 + 0.01 / modes.elements), elements=1000 - modes.elements)


GHOSTS = Fooling("ghosts", _ghosts)
WANDERING = Fooling("wandering", _wandering, order=2)
BACKWARDS = Fooling("backwards", _backwards, order=2)
NAMED_CORE = Fooling("southwell")
