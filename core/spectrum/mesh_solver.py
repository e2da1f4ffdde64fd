"""Modes of one mesh: the blade's steady state at a speed, the pencil about it, and its lowest eigenpairs."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..effects import ALL_EFFECTS, Effects
from ..element.measures import LARGEST_STRAIN
from ..element.mesh import Mesh
from ..modes import Modes
from ..steady import blade_state
from ..steady.blade_state import Steady, SteadyStateError
from ..steady.continuation import MAX_PREVIOUS
from ..tree import pencil
from ..tree.mode_shapes import mode_shapes
from ..tree.pencil import Shape, TreePencil
from . import accuracy, gyroscopic, lanczos
from .completeness import MissedModesError
from .eigen import Eigen, UnstableError
from .lanczos import EigensolverError

Array = NDArray[np.float64]

ROOT_DIRECTIONS = ("x", "y", "z", "torsion", "flap", "lag")
"""Directions in which the root of a blade may be free, in the order of ``Blade.root``; names as in a blade file."""


@dataclass(frozen=True)
class Options:
    """What is solved at every speed: the number of modes, the physical effects, and gravity (3,), m/s², in the hub's axes."""

    count: int
    effects: Effects = ALL_EFFECTS
    gravity: Array = field(default_factory=lambda: np.zeros(3))


@dataclass(frozen=True)
class Start:
    """The start of a mesh's next solution, from those at previous speeds.

    Attributes:
        coordinates: ``blade_state.coordinates`` by Ω², the latest last.
        basis: start of the eigensolver's basis, from the modes at the last speed.
    """

    coordinates: Mapping[float, Array] = field(default_factory=dict)
    basis: lanczos.Start | None = None


@dataclass(frozen=True)
class Solved:
    """The lowest modes of one mesh at one speed.

    Attributes:
        omega: rotor speed, rad/s.
        frequencies: (m,) natural frequencies, rad/s, ascending.
        shapes: (m, 21 b, 4) as in ``Modes``, in the hub's axes, of the mesh's b blades one after the other.
        vectors: (n, m) eigenvectors.
        state: the steady state, with its pencil.
        strain: largest axial or shear strain in the steady state.
        elements: number of elements.
        seconds: wall time of the solution.
        start: for the next speed.
    """

    omega: float
    frequencies: Array
    shapes: NDArray[np.complex128]
    vectors: NDArray[np.complex128]
    state: Steady
    strain: float
    elements: int
    seconds: float
    start: Start

    @property
    def modes(self) -> Modes:
        """The modes of a mesh with one blade.

        Raises:
            ValueError: the mesh has several blades.
        """
        return Modes(self.omega, self.frequencies, self.shapes, self.elements, strain=self.strain, seconds=self.seconds)


def solve(
    mesh: Mesh, omega: float, options: Options, start: Start | None = None, initial_shape: Shape | None = None
) -> Solved:
    """Solve at one speed (rad/s), from the solutions at previous speeds, or from ``initial_shape`` if there are none."""
    start_time, start = time.perf_counter(), start or Start()
    gravity, effects = options.gravity, options.effects
    guess = blade_state.extrapolate(mesh, start.coordinates, omega)
    try:
        state = balance(mesh, omega, gravity, effects, initial_shape if guess is None else guess)
    except SteadyStateError as error:
        if pencil.has_free_motion(pencil.linearize(mesh, pencil.undeformed(mesh), omega, gravity, effects)):
            raise free_root(omega, mesh) from error
        raise
    strain = blade_state.largest_strain(mesh, state.shape)
    try:
        lowest, basis = _lowest(state.pencil, options.count, start.basis)
    except (UnstableError, EigensolverError) as error:
        if pencil.has_free_motion(state.pencil):
            raise free_root(omega, mesh) from error
        if isinstance(error, UnstableError) and strain > LARGEST_STRAIN:
            raise UnstableError(
                f"omega: {omega:.6g} rad/s: the steady state is unstable, with an axial or shear strain of {strain:.0%}: "
                "the blade is too soft for this speed; check units, or lower the speed"
            ) from error
        raise type(error)(f"omega: {omega:.6g} rad/s: {mesh.elements} elements: {error}") from error
    at_other_speeds = [(square, q) for square, q in start.coordinates.items() if square != omega**2]
    previous = dict([*at_other_speeds, (omega**2, blade_state.coordinates(mesh, state.shape))][-MAX_PREVIOUS:])
    shapes = mode_shapes(mesh, state.shape, pencil.on_nodes(state.pencil, lowest.vectors))
    return Solved(
        omega,
        lowest.frequencies,
        shapes,
        lowest.vectors,
        state,
        strain,
        mesh.elements,
        seconds=time.perf_counter() - start_time,
        start=Start(previous, basis),
    )


def _lowest(p: TreePencil, count: int, basis: lanczos.Start | None) -> tuple[Eigen, lanczos.Start | None]:
    """The lowest modes, and the start of a basis for the next speed; without ``basis`` if that misses a mode."""
    try:
        if basis is not None:
            try:
                lowest = lanczos.lanczos(p, count, basis)
                return lowest, lowest.start
            except (MissedModesError, EigensolverError):
                pass
        lowest = lanczos.lanczos(p, count)
    except UnstableError:
        stabilised = gyroscopic.stabilised(p, count) if p.C.any() else None
        if stabilised is None:
            raise
        return stabilised, None
    return lowest, lowest.start


def rounding(mesh: Mesh, solved: Solved, options: Options) -> Array:
    """(m,) relative error of the frequencies due to rounding."""
    if not (options.effects.geometric and options.effects.prestretch):  # about the undeformed shape, which is exact
        return np.full(len(solved.frequencies), accuracy.FLOOR)
    change = accuracy.rounding(mesh, solved.state, solved.omega, options.gravity, options.effects, solved.vectors)
    return accuracy.FLOOR + change / solved.frequencies


def free_root(omega: float, mesh: Mesh) -> UnstableError:
    """The error to raise for a blade whose root is free in a direction without stiffness at this speed (rad/s)."""
    turning = "" if omega else "; rotation stiffens a flap hinge: give speeds above 0"
    without_spring = [joint for joint in mesh.joints if joint.screw.any() and not joint.stiffness]
    names = " or ".join(ROOT_DIRECTIONS[int(np.abs(joint.screw).argmax())] for joint in without_spring)
    where = f"{names}: " if names else ""
    return UnstableError(
        f"omega: {omega:.6g} rad/s: {where}a free direction of the root has no stiffness: add a spring or clamp it{turning}"
    )


def balance(mesh: Mesh, omega: float, gravity: Array, effects: Effects, guess: Shape | None = None) -> Steady:
    """The steady state with the given effects, and the pencil about it."""
    if effects.geometric and effects.prestretch:
        state = blade_state.steady_state(mesh, omega, gravity, guess)
        return (
            state
            if effects == ALL_EFFECTS
            else Steady(state.shape, pencil.linearize(mesh, state.shape, omega, gravity, effects))
        )
    shape = pencil.undeformed(mesh)
    loaded = blade_state.prestress_at_rest(mesh, omega, gravity) if effects.geometric else mesh
    return Steady(shape, pencil.linearize(loaded, shape, omega, gravity, effects))
