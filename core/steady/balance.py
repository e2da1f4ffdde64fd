"""The balance of forces at a configuration with closed loops: the unbalanced forces, their derivative and their rounding."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ..rank import TOLERANCE, Ranked, check_finite, ranked
from ..tree import dynamics, partition
from ..tree.closure import CLOSED, close_loops
from ..tree.kinematics import projected
from ..tree.scales import coordinate_units, length_at, weld_units
from ..tree.state import State, driven_by_loops, loop_jacobian, not_driven, state_at
from ..tree.strained import out_of_range
from ..tree.topology import Tree

Array = NDArray[Any]

BALANCE_TOLERANCE = 1e-11
"""Rounding of a residual, as a fraction of the forces of which it is the sum; checked for each coordinate."""

STIFFNESS_ROUNDING = 1e-13
"""Rounding of a stiffness, as a fraction of the forces and stiffnesses of which it is the sum."""

SMALL_CORRECTION = 0.05
"""Length of a correction, rad or fraction of the mechanism's length, near a solution."""

_CONTRACTION = 0.5  # largest ratio of successive corrections
_NO_STEP, _NEGLIGIBLE_STEP, _SHORT_STEP = 1e-15, 1e-13, 1e-9  # lengths: of no step; if balanced; always accepted


@dataclass(frozen=True)
class Balance:
    """The unbalanced forces at a configuration with closed loops; an iterate of ``newton``.

    Attributes:
        tree: the mechanism.
        state: the state of motion.
        part: partition of the free coordinates.
        forces: (f,) generalised forces on the free coordinates, including those that loop reactions balance.
        independent_forces: (i,) along the independent coordinates, where reactions do no work.
        dead: (f,) constant forces on the free coordinates, subtracted from ``forces``.
        trust: coordinates (n,) and the distance from them, rad or fraction of the length, at which Newton's method ends.
    """

    tree: Tree
    state: State
    part: partition.Partition
    forces: Array
    independent_forces: Array
    dead: Array | float = 0.0
    trust: tuple[Array, float] | None = None

    @cached_property
    def tangent(self) -> "Tangent":
        """The derivative of the reduced forces."""
        check_finite(self.independent_forces)
        return tangent_at(self.tree, self.state, self.part)

    @cached_property
    def step(self) -> Array:
        """Newton's step (f,) of the free coordinates."""
        return self.tangent.step(self)

    @cached_property
    def length(self) -> float:
        """Length of the step; see ``Tangent.length``."""
        return self.tangent.length(self.step)

    @property
    def balanced(self) -> bool:
        """Whether each independent coordinate is balanced, apart from rounding."""
        return bool((np.abs(self.independent_forces) <= BALANCE_TOLERANCE * self.tangent.rounding).all())

    @cached_property
    def _moved(self) -> "Balance | None":
        return self.after(self.step) if np.isfinite(self.length) else None

    @cached_property
    def contraction(self) -> float:
        """Length of the simplified correction after the step, with the same tangent, as a fraction of the step."""
        if self._moved is None:
            return np.inf
        return self.tangent.length(self.tangent.step(self._moved)) / self.length

    def converged(self, previous: Self | None) -> bool:
        """Whether the step is negligible: the forces balance, and the next correction would not be smaller."""
        if self.length < _NO_STEP:
            return True
        return self.balanced and (self.length < _NEGLIGIBLE_STEP or self.contraction > _CONTRACTION)

    def following(self) -> "Balance | None":
        """The balance after the step, if the corrections contract or are short, within the trusted distance.

        Near the solution a first correction may grow (P. Deuflhard, *Newton Methods for Nonlinear Problems*, 2004, sec. 2.1.1).
        """
        is_short = max(self.length, self.length * self.contraction) < SMALL_CORRECTION
        if self._moved is None or not (self.contraction <= _CONTRACTION or is_short or self.length < _SHORT_STEP):
            return None
        origin, radius = self.trust or (self.state.q, np.inf)
        return self._moved if self.tangent.length((self._moved.state.q - origin)[self.part.free]) <= radius else None

    def after(self, step: Array) -> "Balance | None":
        """The balance after a step (f,) of the free coordinates; None if loops do not close or beams are out of range."""
        q = self.state.q.copy()
        q[self.part.free] += step
        q, gap = close_loops(self.tree, q, self.part.free)
        if np.abs(gap).max(initial=0.0) > CLOSED:
            return None
        names = tuple(self.tree.coordinates[j] for j in self.part.independent)
        new = replace(balance_at(self.tree, q, self.dead, names), trust=self.trust)
        return None if out_of_range(self.tree, new.state.kinematics.poses) else new


@dataclass(frozen=True)
class Tangent:
    """The derivative of the residual, with coordinates scaled by their stiffness.

    Attributes:
        matrix: (i, i) derivative, scaled.
        K: the same, decomposed.
        scale: (i,) stiffness of each independent coordinate, or a fraction of its forces per unit if that is larger.
        rounding: (i,) size of the forces of which the residual is the sum.
        units: (f,) unit of each free coordinate; see ``scales``.
    """

    matrix: Array
    K: Ranked
    scale: Array
    rounding: Array
    units: Array

    def step(self, balance: Balance) -> Array:
        """Newton's step (f,) of the free coordinates; of least norm along motions without stiffness."""
        root = np.sqrt(self.scale)
        return -balance.part.spread(self.K.solve(balance.independent_forces / root) / root)

    def relaxation(self, balance: Balance, weight: float, allow_unstable: bool) -> Array:
        """Step (f,) of Newton's method with a stiffness added to each independent coordinate: ``weight`` times its own.

        With ``allow_unstable``, the added stiffness has the sign of its own: the step leads towards an unstable equilibrium.
        """
        root = np.sqrt(self.scale)
        penalty = np.diag(weight * self._sign(allow_unstable))
        return -balance.part.spread(ranked(self.matrix + penalty).solve(balance.independent_forces / root) / root)

    def is_attractor(self, allow_unstable: bool) -> bool:
        """Whether short steps of ``relaxation`` from all nearby points lead here: no eigenvalue of D⁻¹ K̂ has Re < 0."""
        rates = np.linalg.eigvals(self._sign(allow_unstable)[:, None] * self.matrix)
        return bool((rates.real >= -TOLERANCE * np.abs(rates).max(initial=0.0)).all())

    def _sign(self, allow_unstable: bool) -> Array:
        """(i,) signs of the stiffness that ``relaxation`` adds."""
        return np.copysign(1.0, np.diagonal(self.matrix)) if allow_unstable else np.ones(len(self.matrix))

    def norm(self, balance: Balance) -> float:
        """Size of a residual in these scales."""
        return float(np.linalg.norm(balance.independent_forces / np.sqrt(self.scale)))

    def length(self, step: Array) -> float:
        """Largest component of a step (f,) of the free coordinates, in their units."""
        return float(np.abs(step / self.units).max(initial=0.0))


def balance_at(tree: Tree, q: Array, dead: Array | float = 0.0, independent: tuple[str, ...] | None = None) -> Balance:
    """The balance at coordinates q (n,) with closed loops, less ``dead`` forces (f,) on the free ones."""
    state = state_at(tree, q)
    free = partition.free_coordinates(tree)
    forces = dynamics.unbalanced(tree, state.kinematics, state.cartesian, q, state.v)[free] - dead
    if tree.welds:
        reactions = -transposed_jacobian(tree, state, free).solve(forces).reshape(-1, 6)
        state = replace(
            state, multipliers=reactions, cartesian=dynamics.with_reactions(tree, state.cartesian, reactions)
        )
    part = partition.partition(tree, state.kinematics, independent)
    return Balance(tree, state, part, forces, part.onto(forces), dead)


def transposed_jacobian(tree: Tree, state: State, free: NDArray[np.intp]) -> Ranked:
    """Φ_qᵀ (f, 6w) over the free coordinates, decomposed in units of forces and reactions that do the same work."""
    length = length_at(tree, state.kinematics.poses)
    J = partition.jacobian(tree, state.kinematics.B)[:, free]
    return ranked(J.T, 1.0 / coordinate_units(tree, length)[free], 1.0 / weld_units(tree, length))


def tangent_at(tree: Tree, state: State, part: partition.Partition) -> Tangent:
    """K̂ = Rᵀ (K R + C δv/δq + M δv̇/δq): in moving loops, rates and accelerations change with q."""
    k = state.kinematics
    R, K = part.R, part.among_free(state.tangent[2])
    by_independent = K @ R if len(part.dependent) else K
    if driven_by_loops(tree, state).any():
        J1, J2 = (partition.jacobian(tree, b)[:, part.free] for b in (k.B1, k.B2))
        following = not_driven(tree)
        pinv, rows = loop_jacobian(tree, k, following), np.isin(part.free, following)
        R1, R2 = np.zeros_like(R), np.zeros_like(R)
        R1[rows] = -pinv.solve(J1 @ R)
        R2[rows] = -pinv.solve(J2 @ R + 2.0 * J1 @ R1)
        M, C = (part.among_free(a) for a in state.tangent[:2])
        by_independent = by_independent + C @ R1 + M @ R2
    units = coordinate_units(tree, length_at(tree, k.poses))
    rounding, unit = rounding_at(tree, state, part), units[part.independent]
    floor = (replace(part, R=np.abs(R)).onto(_forces_of_unit_strain(tree, state, units)[part.free]) + rounding) / unit
    stiffness = part.onto(by_independent)
    scale = np.maximum(np.abs(np.diagonal(stiffness)), STIFFNESS_ROUNDING / TOLERANCE * floor)
    check_finite(scale)
    root = np.sqrt(np.where(scale > 0, scale, 1.0))
    scaled = stiffness / root[:, None] / root
    error = np.sqrt(STIFFNESS_ROUNDING * np.maximum(floor, 0.0)) / root
    return Tangent(scaled, ranked(scaled, error=error), root**2, rounding, units[part.free])


def rounding_at(tree: Tree, state: State, part: partition.Partition) -> Array:
    """(i,) size of the forces of which the reduced ones are the sum.

    R is rounded relative to its norm, not to each entry: where loops transmit forces, Rᵀ times their reactions vanishes only to
    rounding.
    """
    length = length_at(tree, state.kinematics.poses)
    units = coordinate_units(tree, length)[part.free]
    stiffness = np.abs(part.among_free(state.tangent[2]))
    size = _forces(tree, state)[part.free] + stiffness @ np.maximum(units, np.abs(state.q[part.free]))
    rounding = replace(part, R=np.abs(part.R)).onto(size)
    if not len(part.dependent):
        return rounding
    equations = weld_units(tree, length)
    J = partition.jacobian(tree, state.kinematics.B)[:, part.free] * units / equations[:, None]
    reactions = np.linalg.norm(state.multipliers.ravel() * equations) * np.linalg.norm(J, 2)
    return rounding + reactions * np.linalg.norm(part.R / units[:, None], axis=0)


def _forces(tree: Tree, state: State) -> Array:
    """(n,) sum of the absolute values of the forces on each coordinate."""
    k = state.kinematics
    out = projected(k, state.cartesian.size, np.abs(k.J))
    for s in tree.mechanism.coordinate_springs:
        j = tree.coordinate(s.coordinate)
        out[j] += abs(s.stiffness) * (abs(state.q[j]) + abs(s.neutral)) + abs(s.damping * state.v[j])
    return out


def _forces_of_unit_strain(tree: Tree, state: State, units: Array) -> Array:
    """(n,) forces on a coordinate from a unit strain of all stiffnesses that it carries: they bound its rounding."""
    k, c = state.kinematics, state.cartesian
    twist = np.repeat([length_at(tree, k.poses), 1.0], 3)
    internal_units = units[tree.first_internal[:, None] + np.arange(6)]
    bodies = np.tile(twist, len(k.poses))
    wrench = np.append((abs(c.K) @ np.append(bodies, internal_units)).reshape(-1, 6), np.zeros((1, 6)), axis=0)
    np.add.at(wrench, c.ends, (np.abs(c.stiffness) @ twist)[:, None, :])
    return projected(k, wrench[:-1], np.abs(k.J))
