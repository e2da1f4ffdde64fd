"""The balance of forces at a configuration with closed loops: what is left unbalanced, its derivative and its rounding."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..rank import TOLERANCE, Ranked, Regular, factored, ranked
from ..tree import dynamics, partition
from ..tree.closure import size_of
from ..tree.kinematics import projected
from ..tree.state import State, given, moving, state_at
from ..tree.topology import Tree

Array = NDArray[Any]

BALANCE_TOLERANCE = 1e-11
"""Rounding of a residual, as a fraction of the forces of which it is the sum; checked for each coordinate."""

STIFFNESS_ROUNDING = 1e-13
"""Rounding of a stiffness, as a fraction of the forces and stiffnesses of which it is the sum."""


@dataclass(frozen=True)
class Residual:
    """The unbalanced forces at a configuration with closed loops.

    Attributes:
        state: the state of motion.
        part: partition of the free coordinates.
        forces: (f,) generalised forces on the free coordinates, including those that loop reactions balance.
        reduced: (i,) along the independent coordinates, where reactions do no work.
    """

    state: State
    part: partition.Partition
    forces: Array
    reduced: Array


@dataclass(frozen=True)
class Tangent:
    """The derivative of the residual, with coordinates scaled by their stiffness.

    Attributes:
        matrix: (i, i) derivative, scaled.
        K: the same, decomposed.
        scale: (i,) stiffness of each independent coordinate, or a fraction of its forces per unit if that is larger.
        rounding: (i,) size of the forces of which the residual is the sum.
        units: (f,) 1 rad, or the mechanism's length.
    """

    matrix: Array
    K: Ranked | Regular
    scale: Array
    rounding: Array
    units: Array

    def step(self, here: Residual) -> Array:
        """Newton's step (f,) of the free coordinates; of least norm along motions without stiffness."""
        root = np.sqrt(self.scale)
        return -here.part.spread(self.K.solve(here.reduced / root) / root)

    def relaxation(self, here: Residual, weight: float, towards: bool) -> Array:
        """Step (f,) of Newton's method with a stiffness added to each independent coordinate: ``weight`` times its own.

        With ``towards``, the added stiffness has the sign of its own: the step leads towards an unstable equilibrium.
        """
        root = np.sqrt(self.scale)
        added = np.diag(weight * self._sign(towards))
        return -here.part.spread(factored(self.matrix + added).solve(here.reduced / root) / root)

    def attracts(self, towards: bool) -> bool:
        """Whether short steps of ``relaxation`` from all nearby points lead here: no eigenvalue of D⁻¹ K̂ has Re < 0."""
        rates = np.linalg.eigvals(self._sign(towards)[:, None] * self.matrix)
        return bool((rates.real >= -TOLERANCE * np.abs(rates).max(initial=0.0)).all())

    def _sign(self, towards: bool) -> Array:
        """(i,) signs of the stiffness that ``relaxation`` adds."""
        return np.copysign(1.0, np.diagonal(self.matrix)) if towards else np.ones(len(self.matrix))

    def left(self, here: Residual) -> float:
        """Size of a residual in these scales."""
        return float(np.linalg.norm(here.reduced / np.sqrt(self.scale)))

    def balanced(self, here: Residual) -> bool:
        """Whether each independent coordinate is balanced, apart from rounding."""
        return bool((np.abs(here.reduced) <= BALANCE_TOLERANCE * self.rounding).all())


def residual_at(
    tree: Tree, q: Array, dead: Array | float = 0.0, independent: tuple[str, ...] | None = None
) -> Residual:
    """The balance at coordinates q (n,) with closed loops, less ``dead`` forces (f,) on the free ones."""
    state = state_at(tree, q)
    free = partition.free_coordinates(tree)
    forces = dynamics.unbalanced(tree, state.kinematics, state.cartesian, q, state.v)[free] - dead
    if tree.welds:
        J = partition.jacobian(tree, state.kinematics.B)[:, free]
        reactions = -ranked(J.T).solve(forces).reshape(-1, 6)
        state = replace(state, multipliers=reactions, cartesian=dynamics.cartesian(tree, state.kinematics, reactions))
    part = partition.partition(tree, state.kinematics, independent)
    return Residual(state, part, forces, part.onto(forces))


def tangent_at(tree: Tree, here: Residual) -> Tangent:
    """K̂ = Rᵀ (K R + C δv/δq + M δv̇/δq): in moving loops, rates and accelerations change with q."""
    state, part, k = here.state, here.part, here.state.kinematics
    R, K = part.R, part.among_free(state.tangent[2])
    by_independent = K @ R if len(part.dependent) else K
    if moving(tree, state).any():
        J, J1, J2 = (partition.jacobian(tree, b)[:, part.free] for b in (k.B, k.B1, k.B2))
        following = ~np.isin(part.free, given(tree))
        back = ranked(J[:, following])
        R1, R2 = np.zeros_like(R), np.zeros_like(R)
        R1[following] = -back.solve(J1 @ R)
        R2[following] = -back.solve(J2 @ R + 2.0 * J1 @ R1)
        M, C = (part.among_free(a) for a in state.tangent[:2])
        by_independent = by_independent + C @ R1 + M @ R2
    units, size = _scales(tree, here)
    absolute = replace(part, R=np.abs(R))
    rounding, unit = absolute.onto(size), units[np.isin(part.free, part.independent)]
    least = (absolute.onto(_carried(state)[part.free]) + rounding) / unit
    reduced = part.onto(by_independent)
    scale = np.maximum(np.abs(np.diagonal(reduced)), STIFFNESS_ROUNDING / TOLERANCE * least)
    root = np.sqrt(np.where(scale > 0, scale, 1.0))
    scaled = reduced / root[:, None] / root
    return Tangent(scaled, factored(scaled), root**2, rounding, units)


def rounding_at(tree: Tree, here: Residual) -> Array:
    """(i,) ``Tangent.rounding``, without the derivative."""
    return replace(here.part, R=np.abs(here.part.R)).onto(_scales(tree, here)[1])


def _scales(tree: Tree, here: Residual) -> tuple[Array, Array]:
    """``Tangent.units`` (f,), and the size (f,) of the forces of which the unbalanced ones are the sum."""
    state, free = here.state, here.part.free
    units = np.where(tree.screw[free, 3:].any(1), 1.0, size_of(state.kinematics.poses))
    stiffness = np.abs(here.part.among_free(state.tangent[2]))
    return units, _sizes(tree, state)[free] + stiffness @ np.maximum(units, np.abs(state.q[free]))


def _sizes(tree: Tree, state: State) -> Array:
    """(n,) sum of the absolute values of the forces on each coordinate."""
    k = state.kinematics
    out = projected(k, state.cartesian.size, np.abs(k.J))
    for s in tree.mechanism.coordinate_springs:
        j = tree.coordinate(s.coordinate)
        out[j] += s.stiffness * (abs(state.q[j]) + abs(s.neutral)) + abs(s.damping * state.v[j])
    return out


def _carried(state: State) -> Array:
    """(n,) forces on a coordinate from a unit strain of all stiffnesses that it carries: they bound its rounding."""
    k, c = state.kinematics, state.cartesian
    units = np.tile(np.repeat([size_of(k.poses), 1.0], 3), len(c.g))
    wrench = np.append((abs(c.K) @ units).reshape(-1, 6), np.zeros((1, 6)), axis=0)
    np.add.at(wrench, c.ends, (np.abs(c.stiffness) @ units[:6])[:, None, :])
    return projected(k, wrench[:-1], np.abs(k.J))


def norm(step: Array, tangent: Tangent) -> float:
    """Largest component of a step (f,) of the free coordinates, rad or fraction of the mechanism's length."""
    return float(np.abs(step / tangent.units).max(initial=0.0))
