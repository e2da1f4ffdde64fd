"""Analytic linearisation about a state: M̂ δv̇_I + Ĉ δv_I + K̂ δq_I = 0 (Park et al. 2010, eq. 23–25, varied).

With δq = R δq_I at all times, δv = R δv_I + Ṙ δq_I and δv̇ = R δv̇_I + 2 Ṙ δv_I + R̈ δq_I; projecting by Rᵀ removes the
variation of the multipliers, while their steady values stay in K* as the curvature of the constraints.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .partition import Partition, partition
from .state import State
from .topology import Tree

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Linearization:
    """M̂, Ĉ, K̂ (i, i) over the independent coordinates, with the state and the partition they belong to."""

    tree: Tree
    state: State
    partition: Partition
    M: Array
    C: Array
    K: Array

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the independent coordinates."""
        return tuple(self.tree.coordinates[j] for j in self.partition.independent)


def about(
    tree: Tree, state: State, independent: tuple[str, ...] | None = None, p: Partition | None = None
) -> Linearization:
    """Linearise about a given state; ``independent``: names to use as q_I, chosen numerically if not given; or a partition."""
    M, C, K = state.tangent
    p = p or partition(tree, state.kinematics, independent)
    M, C, K = (p.among_free(a) for a in (M, C, K))
    if not len(p.dependent):  # R is the unit matrix
        return Linearization(tree, state, p, M, C, K)
    return Linearization(
        tree,
        state,
        p,
        p.R.T @ M @ p.R,
        p.R.T @ (C @ p.R + 2.0 * M @ p.R1),
        p.R.T @ (K @ p.R + C @ p.R1 + M @ p.R2),
    )
