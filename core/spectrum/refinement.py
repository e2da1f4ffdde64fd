"""Frequencies with uncertainties: meshes refined until an accuracy is met, or one mesh compared with others.

A rigid axial or torsional strain has a small compliance (``sections``). Refined frequencies are corrected for it to first
order, by means of coarser meshes with twice the compliance.
"""

import itertools
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..blade import Blade
from ..element import sections
from ..element.discretize import Mass, discretize
from ..element.measures import Measure
from ..element.mesh import Mesh
from ..modes import Modes
from ..steady import blade_state
from ..steady.blade_state import SteadyStateError
from ..tree.pencil import Shape
from . import accuracy, grading
from .eigen import UnstableError
from .lanczos import EigensolverError
from .mesh_solver import Options, Solved, Start, rounding, solve

Array = NDArray[np.float64]

MAX_ELEMENTS = 6400
"""Largest number of elements of a refined mesh, by default."""

_FEWEST = 8  # elements of the coarsest mesh
_COMPARED = 1e-6  # accuracy of the refined frequencies with which a given mesh is compared
_TRIES = 6  # halvings before instability is reported: an under-resolved cable appears unstable


class AccuracyWarning(UserWarning):
    """Frequencies are less accurate than requested."""


class Key(NamedTuple):
    """A mesh: the number of equal elements, or the times that the graded mesh is halved; whether rigid strains are softened."""

    elements: int | None = None
    halvings: int = 0
    softened: bool = False


Starts = Mapping[Key, Start]
"""The start of each mesh's next solution."""


@dataclass(frozen=True)
class Meshes:
    """The meshes of one blade, each made at its first use; ``grading_speed``: the speed for which meshes are graded, rad/s."""

    blade: Blade
    options: Options
    mass: Mass = "consistent"
    stiffness: Measure = "corotational"
    load: Array | None = None
    grading_speed: float = 0.0

    @property
    def order(self) -> int:
        """Order of convergence."""
        return 4 if (self.mass, self.stiffness) == ("consistent", "corotational") else 2

    @cached_property
    def softened(self) -> Blade | None:
        """The blade with twice the compliance of rigid strains; None if no strain is rigid."""
        return sections.softened(self.blade)

    def mesh(self, key: Key) -> Mesh:
        """The mesh with this key."""
        if key not in self._meshes:
            blade = self.softened if key.softened and self.softened else self.blade
            nodes = self._nodes(key.halvings) if key.elements is None else key.elements
            self._meshes[key] = discretize(blade, nodes, self.mass, self.stiffness, self.load)
        return self._meshes[key]

    def _nodes(self, halvings: int) -> Array:
        """Nodes of the graded mesh, halved ``halvings`` times."""
        if not halvings:
            return grading.coarse(self.blade, max(_FEWEST, self.options.count), self.grading_speed)
        return grading.halved(self._nodes(halvings - 1))

    @cached_property
    def _meshes(self) -> dict[Key, Mesh]:
        return {}


@dataclass(frozen=True)
class AtSpeed:
    """The meshes at one speed (rad/s); the starts are replaced as meshes are solved."""

    meshes: Meshes
    omega: float
    starts: dict[Key, Start]

    def solved(self, key: Key, initial_shape: Shape | None = None) -> Solved:
        """The modes of a mesh; see ``mesh_solver.solve``."""
        solved = solve(self.meshes.mesh(key), self.omega, self.meshes.options, self.starts.get(key), initial_shape)
        self.starts[key] = solved.start
        return solved

    def rounding(self, key: Key, solved: Solved) -> Array:
        """(m,) relative error of the frequencies of a mesh due to rounding."""
        return rounding(self.meshes.mesh(key), solved, self.meshes.options)

    def bias(self, key: Key, solved: Solved) -> Array:
        """(m,) relative change of a mesh's frequencies due to the compliance of rigid strains."""
        if self.meshes.softened is None:
            return np.zeros(len(solved.frequencies))
        twice = self.solved(key._replace(softened=True), solved.state.shape)
        return twice.frequencies / solved.frequencies - 1.0


def without_bias(coarse: Array, fine: Array) -> tuple[Array, Array]:
    """Factor (m,) that removes the bias from a frequency, and its relative uncertainty (m,).

    Args:
        coarse, fine: (m,) ``AtSpeed.bias`` of two meshes, the second twice as fine. The bias is linear in the compliance,
            except for a quadratic term.
    """
    return 1.0 - fine, np.abs(fine - coarse) + 3.0 * fine**2


_FAILURES = (SteadyStateError, UnstableError, ArithmeticError)


def refined(meshes: Meshes, omega: float, requested: float, starts: Starts) -> tuple[Modes, Starts]:
    """The modes, and starts for the next speed: the graded mesh is halved until all uncertainties are small enough."""
    at = AtSpeed(meshes, omega, dict(starts))
    modes = _refined(at, requested)
    return modes, at.starts


def _refined(at: AtSpeed, requested: float) -> Modes:
    meshes, omega = at.meshes, at.omega
    solved: list[Solved] = []
    best: Modes | None = None
    for halvings in itertools.count():
        mesh = meshes.mesh(Key(halvings=halvings))
        if halvings > 2 and mesh.elements > MAX_ELEMENTS:
            break
        initial_shape = (
            blade_state.carried_over(meshes.mesh(Key(halvings=halvings - 1)), solved[-1].state.shape, mesh)
            if solved
            else None
        )
        try:
            solved.append(at.solved(Key(halvings=halvings), initial_shape))
        except _FAILURES as error:
            if best is not None:
                break
            if halvings >= (_TRIES if isinstance(error, UnstableError) else 2):  # coarser meshes may fail by coarseness
                raise
            solved = []
            continue
        last = solved[-1].modes
        if len(solved) < 3 or len({len(s.frequencies) for s in solved[-3:]}) > 1:
            continue
        estimate = accuracy.estimate(np.array([s.frequencies for s in solved[-3:]]), meshes.order)
        rounded = at.rounding(Key(halvings=halvings), solved[-1])
        factor, of_factor = without_bias(*(at.bias(Key(halvings=halvings - k), solved[-1 - k]) for k in (2, 1)))
        values = factor * estimate.values
        order = np.argsort(values)
        uncertainty = (estimate.of_values + of_factor + rounded)[order]
        current = replace(
            last, frequencies=values[order], uncertainty=uncertainty, rounding=rounded, shapes=last.shapes[order]
        )
        if best is None or uncertainty.max() < best.uncertainty.max():
            best = current
        if (
            uncertainty <= requested
        ).all() or rounded.max() > 0.5 * uncertainty.max():  # accurate enough, or limited by rounding
            break
    if best is None:
        raise EigensolverError(
            f"omega: {omega:.6g} rad/s: fewer modes on fine meshes than on coarse ones: request fewer modes"
        )
    if best.uncertainty.max() > requested:
        warnings.warn(
            f"omega: {omega:.6g} rad/s: relative uncertainty {best.uncertainty.max():.1e} with {best.elements} elements "
            f"exceeds the requested accuracy {requested:.1e}",
            AccuracyWarning,
            stacklevel=3,
        )
    return best


def as_given(meshes: Meshes, omega: float, elements: int, starts: Starts) -> tuple[Modes, Starts]:
    """Modes of one mesh, and starts for the next speed.

    Uncertainties follow from a half and a quarter of its elements if stations are nodes of all three. Otherwise the error
    depends on the positions of the stations and follows no order of convergence: the uncertainty is the difference from the
    refined frequencies.
    """
    at = AtSpeed(meshes, omega, dict(starts))
    solved = at.solved(Key(elements))
    rounded, last = at.rounding(Key(elements), solved), solved.modes
    uncertainty = None
    fewest = max(_FEWEST, meshes.options.count)
    if elements // 4 >= fewest and _aligned(meshes.blade, elements // 4, elements // 2, elements):
        uncertainty = _coarser(at, last)
    if uncertainty is None:
        uncertainty = _from_default(at, last)
    return replace(last, uncertainty=uncertainty + rounded, rounding=rounded), at.starts


def _aligned(blade: Blade, *meshes: int) -> bool:
    if blade.kinks:
        return False
    at = blade.stations[1:-1, None] / blade.length * np.array(meshes)
    return bool((np.abs(at - np.round(at)) < 1e-6).all())


def _coarser(at: AtSpeed, last: Modes) -> Array | None:
    """(m,) uncertainties from a half and a quarter of the elements; None if these have no steady state."""
    n, m = last.elements, len(last.frequencies)
    try:
        coarse, medium = (at.solved(Key(k)) for k in (n // 4, n // 2))
        bias = at.bias(Key(n // 4), coarse)
    except _FAILURES:
        return None
    coarse_frequencies, medium_frequencies = coarse.frequencies[:m], medium.frequencies[:m]
    if len(coarse_frequencies) < m or len(medium_frequencies) < m:
        return None
    levels = np.array([coarse_frequencies, medium_frequencies, last.frequencies])
    return accuracy.estimate(levels, at.meshes.order).of_finest + np.abs(bias[:m])


def _from_default(at: AtSpeed, last: Modes) -> Array:
    """(m,) uncertainties from the difference to refined frequencies; infinite if refinement fails."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # the sum below contains that uncertainty
            true = _refined(at, _COMPARED)
    except _FAILURES:
        return np.full(len(last.frequencies), np.inf)
    m = min(len(last.frequencies), len(true.frequencies))
    uncertainty = np.full(len(last.frequencies), np.inf)
    uncertainty[:m] = np.abs(last.frequencies[:m] / true.frequencies[:m] - 1.0) + true.uncertainty[:m]
    return uncertainty
