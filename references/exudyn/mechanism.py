"""A mechanism in Exudyn: a kinematic tree in relative coordinates, each loop closed by a generic joint.

Core's spanning tree is used: which joints form it, their frames, and the bodies' places. Exudyn computes motion, inertia
forces and springs, the equations of the loops, and their derivatives. A loop is closed by the joint itself (its locked
axes as algebraic equations), not by core's weld beyond a copy of the body. The steady state is found here, since
Exudyn's static solver omits the curvature of the constraints from its Jacobian and stops at 1e-8.

Exudyn's stiffness matrix omits the curvature of the constraints, ∂(Jλ)/∂q, which Newton's method does not need. A modal
analysis needs it (a hanging pendulum on a joint would have no stiffness), so it is added here by differences of
Exudyn's constraint Jacobian. Modes are those in the null space of the constraints (García de Jalón and Bayo 1994, ch. 5).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.effects import ALL_EFFECTS
from ...core.mechanism.description import Mechanism
from ...core.rank import ranked
from ...core.tree.spanning import compile_tree
from ...core.tree.topology import Tree
from ..matrices import rotating
from ..matrices.quadratic import damped_modes
from ..matrices.rescaling import in_own_length
from ..protocol.interface import CORE, CodeError, Independence, MechanismAdapter, MechanismModes
from . import system as ex
from .closure import System, own_coordinates, system, velocity

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stages:
    """The linearised tree and its loops, in the n coordinates of the tree's joints.

    Attributes:
        coordinates: their names.
        q: (n,) values in the steady state.
        M, C: (n, n) mass, and damping and gyroscopic matrix.
        K: (n, n) stiffness, without the curvature of the constraints.
        curvature: (n, n) stiffness of the curvature of the constraints under their reactions.
        J: (n, c) constraint directions: the equations of motion have ``J @ multipliers`` on their right.
        multipliers: (c,) Lagrange multipliers.
        free: indices of the coordinates whose motion is not prescribed.
    """

    coordinates: tuple[str, ...]
    q: Array
    M: Array
    C: Array
    K: Array
    curvature: Array
    J: Array
    multipliers: Array
    free: NDArray[np.intp]

    @property
    def null(self) -> Array:
        """(f, i) orthonormal directions in which the free coordinates can move."""
        return ranked(self.J[self.free].T).null

    def reduced(self, basis: Array) -> tuple[Array, Array, Array]:
        """M, C, K (i, i) in a basis (f, i) of the free coordinates' motion."""
        pick = np.ix_(self.free, self.free)
        M, C, K = (basis.T @ a[pick] @ basis for a in (self.M, self.C, self.K + self.curvature))
        return M, C, K


class ExudynMechanism(MechanismAdapter):
    """See the module: rigid bodies, any joints, springs on the tree's coordinates and between points, steady rotation."""

    name = "exudyn-loops"
    title = "Exudyn, kinematic tree with loop joints"
    effects = ALL_EFFECTS
    hint = ex.HINT
    distribution = ex.DISTRIBUTION
    independence = Independence(
        engine="Exudyn",
        theory="tree of rigid bodies, loops by generic joints",
        rotation="Exudyn, differences of its forces",
        sections=CORE,
        eigensolver="the adapters' own, with damping",
    )

    def unsupported_mechanism(self, mechanism: Mechanism) -> str | None:
        """A reason if there are beams, accelerations, or springs or motions on a cut joint."""
        if mechanism.beams:
            return "beams or bushings: Exudyn's elastic elements use other strain measures"
        if any(m.acceleration for m in mechanism.motions):
            return "an accelerating motion: Exudyn's static solver supports rates only"
        tree = compile_tree(mechanism)
        own = own_coordinates(tree)
        for what in (*mechanism.motions, *mechanism.coordinate_springs):
            if tree.coordinate(what.coordinate) >= own:
                return f"{what.coordinate}: a spring or motion on a joint that closes a loop: cut another joint"
        return None

    def mechanism_modes(self, mechanism: Mechanism, guess: Mapping[str, float]) -> MechanismModes:
        """All modes; see ``interface.MechanismAdapter``.

        Raises:
            CodeError: a periodic mechanism, no steady state near the guess, or loops that move in it.
        """
        return in_own_length(mechanism, guess, _modes)


def _modes(mechanism: Mechanism, guess: Mapping[str, float]) -> MechanismModes:
    if mechanism.equal_blades and any(m.rate for m in mechanism.motions):
        return _whirling(compile_tree(mechanism), guess)
    stages = linearize(compile_tree(mechanism), guess)
    _check_constant(compile_tree(mechanism), stages)
    null = stages.null
    values, x = damped_modes(*stages.reduced(null))
    shapes = np.zeros((len(values), len(stages.q)), np.complex128)
    shapes[:, stages.free] = (null @ x).T
    return MechanismModes(stages.coordinates, stages.q, values, shapes)


def _whirling(tree: Tree, guess: Mapping[str, float]) -> MechanismModes:
    """The modes of a rotor with equal blades on a support, in Fourier coordinates of the blades.

    Raises:
        CodeError: loops, no steady state near the guess, or matrices that change with the azimuth.
    """
    if tree.welds:
        raise CodeError("loops in a rotor with equal blades: not supported")
    rates = velocity(tree)
    spin = int(np.abs(rates).argmax())
    steady = linearize(tree, {**guess, tree.coordinates[spin]: 0.0})

    def at(psi: float) -> tuple[Array, Array, Array]:
        turned = steady.q.copy()
        turned[spin] = psi
        here = stages(tree, system(tree), turned)
        pick = np.ix_(here.free, here.free)
        return here.M[pick], here.C[pick], here.K[pick]

    place = {tree.coordinates[j]: k for k, j in enumerate(steady.free)}
    groups = [[place[name] for name in group] for group in tree.mechanism.equal_blades]
    values, x = rotating.modes(at, float(rates[spin]), groups)
    shapes = np.zeros((len(values), len(steady.q)), np.complex128)
    shapes[:, steady.free] = x.T
    return MechanismModes(steady.coordinates, steady.q, values, shapes)


def linearize(tree: Tree, guess: Mapping[str, float]) -> Stages:
    """Find the steady state of a mechanism in Exudyn and linearise about it.

    Raises:
        CodeError: no steady state near the guess, or loops that move in it.
    """
    q = np.zeros(own_coordinates(tree))
    for name, value in guess.items():
        if (j := tree.coordinate(name)) < len(q):
            q[j] = value
    for m in tree.mechanism.motions:
        if m.position is not None:
            q[tree.coordinate(m.coordinate)] = m.position
    made = system(tree)
    return stages(tree, made, _steady_state(tree, made, q))


def _check_constant(tree: Tree, at_steady: Stages) -> None:
    """Compare Exudyn's reduced matrices with those at another azimuth.

    Raises:
        CodeError: they differ: the equations are periodic.
    """
    v = velocity(tree)
    fastest = float(np.abs(v).max(initial=0.0))
    if fastest == 0.0 or not at_steady.null.shape[1]:
        return
    later = stages(tree, system(tree), at_steady.q + v * (1.9 / fastest))
    null, powers = at_steady.null, (2, 1, 0)
    first, second = (
        [fastest**p * m for p, m in zip(powers, matrices.reduced(null), strict=True)] for matrices in (at_steady, later)
    )
    size = max(float(np.abs(a).max()) for a in first)
    if max(float(np.abs(a - b).max()) for a, b in zip(first, second, strict=True)) > 1e-6 * size:
        raise CodeError("periodic: the matrices change with the azimuth; this adapter needs constant ones")


def stages(tree: Tree, made: System, q: Array) -> Stages:
    """Linearise at given coordinates q (n,), with the reactions that balance the forces best.

    Raises:
        CodeError: loops that move in the steady state.
    """
    v = velocity(tree)
    prescribed = [tree.coordinate(m.coordinate) for m in tree.mechanism.motions if m.prescribed]
    free = np.setdiff1d(np.arange(len(q)), prescribed)
    force, _, J = made.balance(q)
    if np.abs(J.T @ v).max(initial=0.0) > 1e-9 * np.abs(v).max(initial=0.0):
        raise CodeError("the loops move in the steady state: only mechanisms that rotate as a whole are supported")
    multipliers = ranked(J[free]).solve(-force[free])
    M, C, K = made.matrices(q)
    return Stages(tree.coordinates[: len(q)], q, M, C, K, made.curvature(q, multipliers), J, multipliers, free)


def _steady_state(tree: Tree, made: System, q: Array) -> Array:
    """Newton's method on Exudyn's residual: close the loops, then balance the forces in the null space of the
    constraints.

    Exudyn's static solver omits the curvature of the constraints from its Jacobian and stops at 1e-8.

    Raises:
        CodeError: no steady state near q.
    """
    fixed = [tree.coordinate(m.coordinate) for m in tree.mechanism.motions]
    free = np.setdiff1d(np.arange(len(q)), fixed)
    last_change = np.inf
    for _ in range(60):
        force, gap, J = made.balance(q)
        force, J = force[free], J[free]
        close = -ranked(J.T).solve(gap)
        if np.abs(gap).max(initial=0.0) > 1e-3:  # close the loops first
            q = q.copy()
            q[free] += close * min(1.0, 0.5 / max(float(np.abs(close).max()), 0.5))
            continue
        multipliers = ranked(J).solve(-force)
        K = made.matrices(q)[2] + made.curvature(q, multipliers)
        null = ranked(J.T).null
        K = K[np.ix_(free, free)]
        along = _balanced(null.T @ K @ null, null.T @ (force - K @ close))
        step = close + null @ along
        change = float(np.abs(step).max(initial=0.0))
        q = q.copy()
        q[free] += step * min(1.0, 0.3 / max(change, 0.3))
        if change < 1e-12 or (change < 1e-9 and change > 0.3 * last_change):
            unbalanced = np.abs(null.T @ force).max(initial=0.0)
            if unbalanced <= 1e-7 * max(float(np.abs(force).max(initial=0.0)), float(np.abs(K).max()) * 1e-2):
                return q
            break
        last_change = change
    raise CodeError("Exudyn finds no steady state near the guess: give a better guess")


def _balanced(K: Array, force: Array) -> Array:
    """Newton step with each coordinate scaled by its stiffness (units differ); of least norm where the stiffness is
    singular."""
    size = np.sqrt(np.abs(np.diagonal(K)))
    size = np.where(size > 0, size, 1.0)
    return ranked(K / size[:, None] / size).solve(force / size) / size


CODE = ExudynMechanism()
