"""A blade's natural frequencies and mode shapes: the public door of the in-house solver."""

import itertools
import time
import warnings
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from .blade import Blade, without_rotary_inertia
from .chain import accuracy, mesh, pencil, steady
from .chain.lanczos import EigensolverError, lanczos
from .chain.mode_shapes import mode_shapes
from .chain.pencil import Shape
from .chain.steady import LargeStrainError, Steady, SteadyStateError
from .effects import ALL_EFFECTS, Effects
from .eigen import UnstableError
from .element.discretize import Chain, Mass, discretize
from .element.measures import Measure
from .modes import Modes

Array = NDArray[np.float64]

NO_GRAVITY = np.zeros(3)


MAX_ELEMENTS = 6400
"""Elements that a mesh is refined to, by default."""

LARGE_STRAIN, LARGEST_STRAIN = 0.02, 0.2
"""Steady strains that are to be reported, and that are refused: sections are linear elastic."""

_FEWEST = 8  # elements of the coarsest mesh
_COMPARED = 1e-6  # uncertainty of what a given mesh is compared with
_TRIES = 5  # halvings until what is not stable is taken to be so: an under-resolved cable is not


class AccuracyWarning(UserWarning):
    """Frequencies are less accurate than asked for."""


def modes(
    blade: Blade,
    omega: float,
    elements: int | None = None,
    count: int = 10,
    *,
    accuracy: float = 1e-6,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array = NO_GRAVITY,
    load: Array | None = None,
    allow_large_strain: bool = False,
) -> Modes:
    """The lowest modes of a blade turning steadily at ``omega``, with their relative uncertainties.

    Args:
        blade: the blade.
        omega: rotor speed, rad/s.
        elements: how many beam elements, of equal length; by default, as many as ``accuracy`` takes, graded towards the root,
            and the frequencies are extrapolated (Richardson).
        count: how many modes (fewer if the discretisation has fewer).
        accuracy: largest relative uncertainty of a frequency, where ``elements`` is not given; ``AccuracyWarning`` where
            ``MAX_ELEMENTS`` elements, or rounding, do not allow it.
        mass: ``consistent`` (fourth order) or ``half_end`` (lumped, Park et al. 2010; second order).
        stiffness: ``corotational``, or ``body_fixed``: linear in the parent body's frame (Park et al. 2010).
        effects: physical effects kept.
        gravity: (3,) m/s², in the hub's axes at the azimuth of interest.
        load: (n, 3) steady force per length at the blade's stations, N/m, in the hub's axes, turning with them.
        allow_large_strain: accept steady strains above ``LARGEST_STRAIN``.

    Raises:
        ValueError: elements or count below 1, omega not finite, accuracy not positive, a load of another form.
        SteadyStateError: no steady state at this speed.
        LargeStrainError: a steady state with strains that linear elastic sections do not describe.
        UnstableError: the steady state is not stable.
        EigensolverError, MissedModesError: the eigensolver failed.
    """
    one = sweep(
        blade,
        [omega],
        elements,
        count,
        accuracy=accuracy,
        mass=mass,
        stiffness=stiffness,
        effects=effects,
        gravity=gravity,
        load=load,
        allow_large_strain=allow_large_strain,
    )
    return next(one)


def sweep(
    blade: Blade,
    omegas: Iterable[float],
    elements: int | None = None,
    count: int = 10,
    *,
    accuracy: float = 1e-6,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array = NO_GRAVITY,
    load: Array | None = None,
    allow_large_strain: bool = False,
) -> Iterator[Modes]:
    """The modes at one speed after another; arguments and errors as for ``modes``.

    Every mesh is made once, and each steady state is sought from where those before lead to.
    """
    if not accuracy > 0:
        raise ValueError(f"accuracy: {accuracy}: give a positive relative number, as in 1e-6")
    body = blade if effects.rotary_inertia else without_rotary_inertia(blade)
    meshes, fastest = _Meshes(body, count, mass, stiffness, load, effects, gravity), 0.0
    for omega in _checked(omegas, count):
        begun = time.perf_counter()
        if abs(omega) > fastest:  # the graded mesh is made for a range of speeds, up to a power of two
            fastest = 2.0 ** np.ceil(np.log2(abs(omega)))
            meshes = _Meshes(body, count, mass, stiffness, load, effects, gravity)
        found = (
            _refined(meshes, omega, fastest, accuracy)
            if elements is None
            else _as_given(meshes, omega, elements, fastest)
        )
        if found.strain > LARGEST_STRAIN and not allow_large_strain:
            raise LargeStrainError(
                f"omega: {omega:.6g} rad/s: steady strain {found.strain:.0%}: linear elastic sections do not describe it: the "
                "speed is too high or the blade too soft; check units, or allow large strains"
            )
        yield replace(found, seconds=time.perf_counter() - begun)


def mesh_modes(
    blade: Blade,
    omega: float,
    elements: int,
    count: int = 10,
    *,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array = NO_GRAVITY,
    load: Array | None = None,
) -> Modes:
    """The modes of one mesh, for studies of refinement: without uncertainties, at any strain; otherwise as ``modes``."""
    return next(mesh_sweep(blade, [omega], elements, count, mass, stiffness, effects, gravity, load))


def mesh_sweep(
    blade: Blade,
    omegas: Iterable[float],
    elements: int,
    count: int = 10,
    mass: Mass = "consistent",
    stiffness: Measure = "corotational",
    effects: Effects = ALL_EFFECTS,
    gravity: Array = NO_GRAVITY,
    load: Array | None = None,
) -> Iterator[Modes]:
    """The modes of one mesh at one speed after another; see ``mesh_modes``."""
    speeds = _checked(omegas, count)
    body = discretize(
        blade if effects.rotary_inertia else without_rotary_inertia(blade), elements, mass, stiffness, load
    )
    one = _Mesh(body, count, effects, gravity)
    return (one.at(omega).modes for omega in speeds)


def _checked(omegas: Iterable[float], count: int) -> Iterator[float]:
    """The speeds, each checked when its turn comes: the caller may choose it by the answers before."""
    if count < 1:
        raise ValueError(f"count: {count}: ask for at least one mode")
    for omega in omegas:
        if not np.isfinite(omega):
            raise ValueError(f"omega: {omega}: give a finite rotor speed in rad/s")
        yield float(omega)


def chain_modes(
    body: Chain, omega: float, count: int = 10, *, effects: Effects = ALL_EFFECTS, gravity: Array = NO_GRAVITY
) -> Modes:
    """The lowest modes of a chain, of which rounding is all that is known; arguments and errors as for ``modes``."""
    one = _Mesh(body, count, effects, gravity)
    solved = one.at(next(_checked([omega], count)))
    return replace(solved.modes, rounding=one.rounding(solved))


@dataclass(frozen=True)
class _Solved:
    """One mesh's modes at one speed, and what they are modes of."""

    modes: Modes
    state: Steady
    vectors: NDArray[np.complex128]


@dataclass
class _Mesh:
    """A chain, and its shapes at the speeds before."""

    body: Chain
    count: int
    effects: Effects
    gravity: Array
    known: list[tuple[float, Shape]] = field(default_factory=list)

    def at(self, omega: float, near: Shape | None = None) -> _Solved:
        """Solve at one speed, from the speeds before or else from a shape near by."""
        begun, body = time.perf_counter(), self.body
        guess = steady.extrapolate(self.known, omega)
        state = balance(body, omega, self.gravity, self.effects, near if guess is None else guess)
        try:
            found = lanczos(state.pencil, self.count)
        except (UnstableError, EigensolverError) as error:
            if pencil.loose(state.pencil):
                raise UnstableError(
                    f"omega: {omega:.6g} rad/s: nothing holds a free hinge (at rest, or lead–lag without offset): add a spring"
                ) from error
            raise type(error)(f"omega: {omega:.6g} rad/s: {error}") from error
        self.known = [*self.known[-steady.ORDER :], (omega, state.shape)]
        shapes, strain = mode_shapes(body, state.shape, found.vectors), steady.largest_strain(body, state.shape)
        seconds = time.perf_counter() - begun
        modes = Modes(omega, found.frequencies, shapes, body.elements, strain=strain, seconds=seconds)
        return _Solved(modes, state, found.vectors)

    def rounding(self, solved: _Solved) -> Array:
        """(m,) relative error of the frequencies by rounding."""
        if not (self.effects.geometric and self.effects.prestretch):  # about the undeformed shape, which is not rounded
            return np.full(len(solved.modes.frequencies), accuracy.FLOOR)
        state, omega = solved.state, solved.modes.omega
        return accuracy.rounding(self.body, state, omega, self.gravity, self.effects, solved.vectors)


@dataclass
class _Meshes:
    """The meshes of one blade."""

    blade: Blade
    count: int
    mass: Mass
    stiffness: Measure
    load: Array | None
    effects: Effects
    gravity: Array
    made: dict[int, _Mesh] = field(default_factory=dict)
    nodes: list[Array] = field(default_factory=list)

    @property
    def order(self) -> int:
        """Of convergence."""
        return 4 if (self.mass, self.stiffness) == ("consistent", "corotational") else 2

    def of(self, elements: int) -> _Mesh:
        """Elements of equal length."""
        if elements not in self.made:
            self.made[elements] = self._mesh(elements)
        return self.made[elements]

    def level(self, level: int, fastest: float) -> _Mesh:
        """The graded mesh, halved ``level`` times."""
        if not self.nodes:
            self.nodes.append(mesh.coarse(self.blade, max(_FEWEST, self.count), fastest))
        while len(self.nodes) <= level:
            self.nodes.append(mesh.halved(self.nodes[-1]))
        if -level not in self.made:
            self.made[-level] = self._mesh(self.nodes[level])
        return self.made[-level]

    def _mesh(self, elements: int | Array) -> _Mesh:
        body = discretize(self.blade, elements, self.mass, self.stiffness, self.load)
        return _Mesh(body, self.count, self.effects, self.gravity)


_FAILURES = (SteadyStateError, UnstableError, ArithmeticError)


def _refined(meshes: _Meshes, omega: float, fastest: float, wanted: float) -> Modes:
    """Halve the elements of the graded mesh until all uncertainties are small enough."""
    solved: list[_Solved] = []
    best: Modes | None = None
    for level in itertools.count():
        one = meshes.level(level, fastest)
        if level > 2 and one.body.elements > MAX_ELEMENTS:
            break
        before = meshes.level(level - 1, fastest) if solved else None
        near = steady.carried_over(before.body, solved[-1].state.shape, one.body) if before else None
        try:
            solved.append(one.at(omega, near))
        except _FAILURES as error:
            if best is not None:
                break
            if level >= (_TRIES if isinstance(error, UnstableError) else 2):  # coarser ones may be too coarse to hold
                raise
            solved = []
            continue
        last = solved[-1].modes
        if len(solved) < 3 or len({len(s.modes.frequencies) for s in solved[-3:]}) > 1:
            continue
        found = accuracy.estimate(np.array([s.modes.frequencies for s in solved[-3:]]), meshes.order)
        noise = one.rounding(solved[-1])
        order = np.argsort(found.values)
        sure = (found.of_values + noise)[order]
        now = replace(
            last, frequencies=found.values[order], uncertainty=sure, rounding=noise, shapes=last.shapes[order]
        )
        if best is None or sure.max() < best.uncertainty.max():
            best = now
        if (sure <= wanted).all() or noise.max() > 0.5 * sure.max():  # as good as wanted, or as it gets
            break
    if best is None:
        raise EigensolverError(
            f"omega: {omega:.6g} rad/s: fewer modes on fine meshes than on coarse ones: ask for fewer modes"
        )
    if best.uncertainty.max() > wanted:
        warnings.warn(
            f"omega: {omega:.6g} rad/s: relative uncertainty {best.uncertainty.max():.1e} with {best.elements} elements, more "
            f"than the accuracy {wanted:.1e} asked for",
            AccuracyWarning,
            stacklevel=3,
        )
    return best


def _as_given(meshes: _Meshes, omega: float, elements: int, fastest: float) -> Modes:
    """One mesh, with uncertainties from a half and a quarter of its elements where stations are nodes of all three.

    Else the error varies with where the stations are, which no sequence shows: the difference from the default's answer counts.
    """
    one = meshes.of(elements)
    solved = one.at(omega)
    noise, last = one.rounding(solved), solved.modes
    sure = None
    if elements // 4 >= max(_FEWEST, meshes.count) and _aligned(meshes.blade, elements // 4, elements // 2, elements):
        sure = _coarser(meshes, last)
    if sure is None:
        sure = _from_default(meshes, last, fastest)
    return replace(last, uncertainty=sure + noise, rounding=noise)


def _aligned(blade: Blade, *meshes: int) -> bool:
    if blade.kinks:
        return False
    at = blade.stations[1:-1, None] / blade.length * np.array(meshes)
    return bool((np.abs(at - np.round(at)) < 1e-6).all())


def _coarser(meshes: _Meshes, last: Modes) -> Array | None:
    """(m,) uncertainties from a half and a quarter of the elements; None if these have no steady state."""
    n, m = last.elements, len(last.frequencies)
    try:
        coarse, half = (meshes.of(k).at(last.omega).modes.frequencies for k in (n // 4, n // 2))
    except _FAILURES:
        return None
    if len(coarse) < m or len(half) < m:
        return None
    return accuracy.estimate(np.array([coarse, half, last.frequencies]), meshes.order).of_finest


def _from_default(meshes: _Meshes, last: Modes, fastest: float) -> Array:
    """(m,) uncertainties from the difference to refined frequencies; infinite where there are none."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AccuracyWarning)  # in the sum
            true = _refined(meshes, last.omega, fastest, _COMPARED)
    except _FAILURES:
        return np.full(len(last.frequencies), np.inf)
    m = min(len(last.frequencies), len(true.frequencies))
    sure = np.full(len(last.frequencies), np.inf)
    sure[:m] = np.abs(last.frequencies[:m] / true.frequencies[:m] - 1.0) + true.uncertainty[:m]
    return sure


def balance(body: Chain, omega: float, gravity: Array, effects: Effects, guess: Shape | None = None) -> Steady:
    """The steady state with the given effects, and the pencil about it."""
    if effects.geometric and effects.prestretch:
        state = steady.steady(body, omega, gravity, guess)
        return (
            state
            if effects == ALL_EFFECTS
            else Steady(state.shape, pencil.linearize(body, state.shape, omega, gravity, effects))
        )
    still = pencil.undeformed(body)
    loaded = steady.prestress_at_rest(body, omega, gravity) if effects.geometric else body
    return Steady(still, pencil.linearize(loaded, still, omega, gravity, effects))
