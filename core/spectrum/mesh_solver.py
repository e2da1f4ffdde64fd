"""Modes of one mesh: the blade's steady state at a speed, the pencil about it, and its lowest eigenpairs."""

import time
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..effects import ALL_EFFECTS, Effects
from ..element.measures import LARGEST_STRAIN
from ..element.mesh import Mesh
from ..modes import Modes
from ..steady import blade_state as steady
from ..steady.blade_state import Steady, SteadyStateError
from ..steady.continuation import LATEST
from ..tree import pencil
from ..tree.mode_shapes import mode_shapes
from ..tree.pencil import Shape, TreePencil
from . import accuracy, gyroscopic
from .completeness import MissedModesError
from .eigen import Eigen, UnstableError
from .lanczos import EigensolverError, Start, lanczos

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Solved:
    """Modes of one mesh at one speed, with the steady state and the eigenvectors."""

    modes: Modes
    state: Steady
    vectors: NDArray[np.complex128]


@dataclass
class MeshSolver:
    """A mesh, its ``steady.coordinates`` at the last values of Ω², and the start of a basis from the modes at the last speed.

    ``restarts`` counts the speeds at which that basis missed a mode and the modes were computed again without it.
    """

    body: Mesh
    count: int
    effects: Effects
    gravity: Array
    known: dict[float, Array] = field(default_factory=dict)
    start: Start | None = None
    restarts: int = 0

    def at(self, omega: float, near: Shape | None = None) -> Solved:
        """Solve at one speed (rad/s), starting from the shapes at previous speeds or else from the shape ``near``."""
        begun, body = time.perf_counter(), self.body
        guess = steady.extrapolate(body, self.known, omega)
        try:
            state = balance(body, omega, self.gravity, self.effects, near if guess is None else guess)
        except SteadyStateError as error:
            if pencil.has_free_motion(
                pencil.linearize(body, pencil.undeformed(body), omega, self.gravity, self.effects)
            ):
                raise _free_root(omega) from error
            raise
        try:
            found, self.start = self._lowest(state.pencil)
        except (UnstableError, EigensolverError) as error:
            if pencil.has_free_motion(state.pencil):
                raise _free_root(omega) from error
            strain = steady.largest_strain(body, state.shape)
            if isinstance(error, UnstableError) and strain > LARGEST_STRAIN:
                raise UnstableError(
                    f"omega: {omega:.6g} rad/s: the steady state is unstable, with an axial or shear strain of {strain:.0%}: "
                    "the blade is too soft for this speed; check units, or lower the speed"
                ) from error
            raise type(error)(f"omega: {omega:.6g} rad/s: {body.elements} elements: {error}") from error
        self.known.pop(omega**2, None)  # the latest is the last one
        self.known = dict([*self.known.items(), (omega**2, steady.coordinates(body, state.shape))][-LATEST:])
        shapes = mode_shapes(body, state.shape, pencil.on_nodes(state.pencil, found.vectors))
        strain = steady.largest_strain(body, state.shape)
        seconds = time.perf_counter() - begun
        modes = Modes(omega, found.frequencies, shapes, body.elements, strain=strain, seconds=seconds)
        return Solved(modes, state, found.vectors)

    def _lowest(self, p: TreePencil) -> tuple[Eigen, Start | None]:
        try:
            if self.start is not None:
                try:
                    solved = lanczos(p, self.count, self.start)
                    return solved, solved.start
                except (MissedModesError, EigensolverError):
                    self.restarts += 1
            solved = lanczos(p, self.count)
        except UnstableError:
            stabilised = gyroscopic.stabilised(p, self.count) if p.C.any() else None
            if stabilised is None:
                raise
            return stabilised, None
        return solved, solved.start

    def rounding(self, solved: Solved) -> Array:
        """(m,) relative error of the frequencies due to rounding."""
        if not (self.effects.geometric and self.effects.prestretch):  # about the undeformed shape, which is exact
            return np.full(len(solved.modes.frequencies), accuracy.FLOOR)
        state, omega = solved.state, solved.modes.omega
        change = accuracy.rounding(self.body, state, omega, self.gravity, self.effects, solved.vectors)
        return accuracy.FLOOR + change / solved.modes.frequencies


def _free_root(omega: float) -> UnstableError:
    turning = "" if omega else "; rotation stiffens a flap hinge: give speeds above 0"
    return UnstableError(
        f"omega: {omega:.6g} rad/s: a free direction of the root has no stiffness: add a spring or clamp it{turning}"
    )


def balance(body: Mesh, omega: float, gravity: Array, effects: Effects, guess: Shape | None = None) -> Steady:
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
