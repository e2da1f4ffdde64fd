"""Frequencies with uncertainties: meshes refined until an accuracy is met, or one mesh compared with others.

A rigid axial or torsional strain has a small compliance (``sections``). Refined frequencies are corrected for it to first
order, by means of coarser meshes with twice the compliance.
"""

import itertools
import warnings
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..blade import Blade
from ..effects import Effects
from ..element import sections
from ..element.discretize import Mass, discretize
from ..element.measures import Measure
from ..modes import Modes
from ..steady import blade_state as steady
from ..steady.blade_state import SteadyStateError
from . import accuracy, grading
from .eigen import UnstableError
from .lanczos import EigensolverError
from .mesh_solver import MeshSolver, Solved

Array = NDArray[np.float64]

MAX_ELEMENTS = 6400
"""Largest number of elements of a refined mesh, by default."""

_FEWEST = 8  # elements of the coarsest mesh
_COMPARED = 1e-6  # accuracy of the refined frequencies with which a given mesh is compared
_TRIES = 5  # halvings before instability is reported: an under-resolved cable appears unstable


class AccuracyWarning(UserWarning):
    """Frequencies are less accurate than requested."""


@dataclass
class Meshes:
    """The meshes of one blade, each made at its first use."""

    blade: Blade
    count: int
    mass: Mass
    stiffness: Measure
    load: Array | None
    effects: Effects
    gravity: Array
    made: dict[tuple[int, bool], MeshSolver] = field(default_factory=dict)
    nodes: list[Array] = field(default_factory=list)

    @property
    def order(self) -> int:
        """Order of convergence."""
        return 4 if (self.mass, self.stiffness) == ("consistent", "corotational") else 2

    @cached_property
    def softened(self) -> Blade | None:
        """The blade with twice the compliance of rigid strains; None if no strain is rigid."""
        return sections.softened(self.blade)

    def uniform(self, elements: int) -> MeshSolver:
        """Solver on elements of equal length."""
        return self._solver(elements, elements)

    def graded(self, level: int, fastest: float) -> MeshSolver:
        """Solver on the mesh graded for the speed ``fastest`` (rad/s), halved ``level`` times."""
        if not self.nodes:
            self.nodes.append(grading.coarse(self.blade, max(_FEWEST, self.count), fastest))
        while len(self.nodes) <= level:
            self.nodes.append(grading.halved(self.nodes[-1]))
        return self._solver(-level, self.nodes[level])

    def bias(self, key: int, solved: Solved) -> Array:
        """(m,) relative change of frequencies due to the compliance of rigid strains.

        Args:
            key: the number of equal elements, or minus the level of the graded mesh.
            solved: the modes of that mesh.
        """
        if self.softened is None:
            return np.zeros(len(solved.modes.frequencies))
        with_twice = self._solver(key, key if key > 0 else self.nodes[-key], softened=True)
        return with_twice.at(solved.modes.omega, solved.state.shape).modes.frequencies / solved.modes.frequencies - 1.0

    def _solver(self, key: int, elements: int | Array, *, softened: bool = False) -> MeshSolver:
        if (key, softened) not in self.made:
            blade = self.softened if softened and self.softened else self.blade
            body = discretize(blade, elements, self.mass, self.stiffness, self.load)
            self.made[key, softened] = MeshSolver(body, self.count, self.effects, self.gravity)
        return self.made[key, softened]


def without_bias(coarse: Array, fine: Array) -> tuple[Array, Array]:
    """Factor (m,) that removes the bias from a frequency, and its relative uncertainty (m,).

    Args:
        coarse, fine: (m,) ``Meshes.bias`` of two meshes, the second twice as fine. The bias is linear in the compliance,
            except for a quadratic term.
    """
    return 1.0 - fine, np.abs(fine - coarse) + 3.0 * fine**2


_FAILURES = (SteadyStateError, UnstableError, ArithmeticError)


def refined(meshes: Meshes, omega: float, fastest: float, requested: float) -> Modes:
    """Halve the elements of the graded mesh until all uncertainties are small enough."""
    solved: list[Solved] = []
    best: Modes | None = None
    for level in itertools.count():
        solver = meshes.graded(level, fastest)
        if level > 2 and solver.body.elements > MAX_ELEMENTS:
            break
        before = meshes.graded(level - 1, fastest) if solved else None
        near = steady.carried_over(before.body, solved[-1].state.shape, solver.body) if before else None
        try:
            solved.append(solver.at(omega, near))
        except _FAILURES as error:
            if best is not None:
                break
            if level >= (_TRIES if isinstance(error, UnstableError) else 2):  # coarser meshes may fail by coarseness
                raise
            solved = []
            continue
        last = solved[-1].modes
        if len(solved) < 3 or len({len(s.modes.frequencies) for s in solved[-3:]}) > 1:
            continue
        estimate = accuracy.estimate(np.array([s.modes.frequencies for s in solved[-3:]]), meshes.order)
        rounded = solver.rounding(solved[-1])
        factor, of_factor = without_bias(*(meshes.bias(k - level, solved[-1 - k]) for k in (2, 1)))
        values = factor * estimate.values
        order = np.argsort(values)
        uncertainty = (estimate.of_values + of_factor + rounded)[order]
        now = replace(
            last, frequencies=values[order], uncertainty=uncertainty, rounding=rounded, shapes=last.shapes[order]
        )
        if best is None or uncertainty.max() < best.uncertainty.max():
            best = now
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


def as_given(meshes: Meshes, omega: float, elements: int, fastest: float) -> Modes:
    """Modes of one mesh, with uncertainties from a half and a quarter of its elements if stations are nodes of all three.

    Otherwise the error depends on the positions of the stations and follows no order of convergence: the uncertainty is the
    difference from the refined frequencies.
    """
    solver = meshes.uniform(elements)
    solved = solver.at(omega)
    rounded, last = solver.rounding(solved), solved.modes
    uncertainty = None
    if elements // 4 >= max(_FEWEST, meshes.count) and _aligned(meshes.blade, elements // 4, elements // 2, elements):
        uncertainty = _coarser(meshes, last)
    if uncertainty is None:
        uncertainty = _from_default(meshes, last, fastest)
    return replace(last, uncertainty=uncertainty + rounded, rounding=rounded)


def _aligned(blade: Blade, *meshes: int) -> bool:
    if blade.kinks:
        return False
    at = blade.stations[1:-1, None] / blade.length * np.array(meshes)
    return bool((np.abs(at - np.round(at)) < 1e-6).all())


def _coarser(meshes: Meshes, last: Modes) -> Array | None:
    """(m,) uncertainties from a half and a quarter of the elements; None if these have no steady state."""
    n, m = last.elements, len(last.frequencies)
    try:
        coarse, half = (meshes.uniform(k).at(last.omega) for k in (n // 4, n // 2))
        bias = meshes.bias(n // 4, coarse)
    except _FAILURES:
        return None
    few, more = coarse.modes.frequencies[:m], half.modes.frequencies[:m]
    if len(few) < m or len(more) < m:
        return None
    return accuracy.estimate(np.array([few, more, last.frequencies]), meshes.order).of_finest + np.abs(bias[:m])


def _from_default(meshes: Meshes, last: Modes, fastest: float) -> Array:
    """(m,) uncertainties from the difference to refined frequencies; infinite if refinement fails."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # the sum below contains that uncertainty
            true = refined(meshes, last.omega, fastest, _COMPARED)
    except _FAILURES:
        return np.full(len(last.frequencies), np.inf)
    m = min(len(last.frequencies), len(true.frequencies))
    uncertainty = np.full(len(last.frequencies), np.inf)
    uncertainty[:m] = np.abs(last.frequencies[:m] / true.frequencies[:m] - 1.0) + true.uncertainty[:m]
    return uncertainty
