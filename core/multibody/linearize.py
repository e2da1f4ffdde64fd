"""Analytic linearisation about the steady state: M̂ δv̇_I + Ĉ δv_I + K̂ δq_I = 0 (Park et al. 2010, eq. 23–25, varied).

With δq = R δq_I at all times, δv = R δv_I + Ṙ δq_I and δv̇ = R δv̇_I + 2 Ṙ δv_I + R̈ δq_I; projecting by Rᵀ removes the
variation of the multipliers, while their steady values stay in K* as the curvature of the constraints.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import eigen
from . import dynamics
from .equilibrium import State, assemble, steady
from .kinematics import kinematics
from .mechanism import Mechanism, MechanismError, at_time
from .partition import Partition, freedom, partition
from .tree import Tree, compile_tree

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Linear:
    """M̂, Ĉ, K̂ (i, i) over the independent coordinates, and the state they hold about."""

    tree: Tree
    state: State
    partition: Partition
    M: Array
    C: Array
    K: Array

    @property
    def names(self) -> tuple[str, ...]:
        """The independent coordinates."""
        return tuple(self.tree.coordinates[j] for j in self.partition.independent)


def linearize(
    mechanism: Mechanism,
    guess: Mapping[str, float] | None = None,
    independent: tuple[str, ...] | None = None,
    time: float = 0.0,
) -> Linear:
    """Find the steady state and linearise about it.

    Where motions change with time (a law, an acceleration), this is a frozen-time linearisation: the coordinates that are
    free are balanced, and vibrate, as if positions, rates and accelerations stayed what they are at ``time``. Its modes
    mean something where the motion changes little within their periods; stability of a periodic motion needs Floquet's
    theory instead.

    Args:
        mechanism: the mechanism.
        guess: coordinates to start from, by name.
        independent: coordinates to use as q_I; chosen numerically if not given.
        time: s, the instant looked at; it matters where motions follow laws.

    Raises:
        MechanismError: for whatever cannot be assembled, balanced or partitioned; the message says what.
    """
    tree = compile_tree(at_time(mechanism, time))
    state = steady(tree, guess)
    _check_regular(tree, state)
    return about(tree, state, independent)


def _check_regular(tree: Tree, state: State) -> None:
    """Compare the freedom here with that of an assembled configuration a little way off."""
    if not tree.welds:
        return
    here = partition(tree, state.kinematics)
    nudge = here.R @ np.random.default_rng(1921).normal(size=here.R.shape[1])
    q = state.q.copy()
    q[here.free] += 1e-3 * nudge / max(float(np.abs(nudge).max(initial=0.0)), 1e-300)
    near = assemble(tree, dict(zip(tree.coordinates, q.tolist(), strict=True)))
    beside = freedom(tree, kinematics(tree, near, state.v, state.a).B)
    if beside < len(here.independent):
        raise MechanismError(
            f"joints {', '.join(tree.weld_names)}: singular configuration: {len(here.independent)} freedoms here but {beside} "
            "beside it, so no linear model holds; start the assembly from another guess"
        )


def about(tree: Tree, state: State, independent: tuple[str, ...] | None = None) -> Linear:
    """Linearise about a given state."""
    M, C, K = dynamics.tangent(tree, state.kinematics, state.cartesian)
    p = partition(tree, state.kinematics, independent)
    pick = np.ix_(p.free, p.free)
    M, C, K = M[pick], C[pick], K[pick]
    if not len(p.dependent):  # R is the unit matrix
        return Linear(tree, state, p, M, C, K)
    return Linear(
        tree,
        state,
        p,
        p.R.T @ M @ p.R,
        p.R.T @ (C @ p.R + 2.0 * M @ p.R1),
        p.R.T @ (K @ p.R + C @ p.R1 + M @ p.R2),
    )


def modes(linear: Linear, count: int | None = None) -> eigen.Eigen | eigen.Damped:
    """Modes over the independent coordinates: gyroscopic where nothing damps and K̂ is positive definite, else damped."""
    M, C, K = 0.5 * (linear.M + linear.M.T), linear.C, linear.K
    if not len(M):  # everything is prescribed
        return eigen.Eigen(np.zeros(0), np.zeros((0, 0), np.complex128))
    size = np.abs(K).max(initial=0.0), np.abs(C).max(initial=0.0)
    conservative = (np.abs(K - K.T).max(initial=0.0) <= 1e-9 * size[0]) and (
        np.abs(C + C.T).max(initial=0.0) <= 1e-9 * size[1]
    )
    if conservative:
        try:
            return eigen.gyroscopic(M, 0.5 * (C - C.T), 0.5 * (K + K.T), count)
        except eigen.UnstableError:
            pass  # a zero mode, or stable by gyroscopic forces alone: the general solver tells
    return eigen.damped(M, C, K, count)
