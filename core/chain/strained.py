"""Products of a chain's stiffness with vectors, computed from the element strains to avoid cancellation."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import apply, compiled
from . import blocks
from .blocks import Transposed

Array = NDArray[np.float64]


class Strained(NamedTuple):
    """K = ``remainder`` + ``spring`` on ρ = Ad ξ_b − ξ_a, with the clamped directions decoupled.

    Attributes:
        remainder: the remainder, with transposed blocks.
        spring, lever: (n, 6, 6), see ``chain.pencil.ChainPencil``.
        clamped: (6, 6) projector of node 1's twist; zero if nothing is clamped.
    """

    remainder: Transposed
    spring: Array
    lever: Array
    clamped: Array


@compiled
def times(K: Strained, x: Array, out: Array) -> None:
    """out = K x of vectors (k, dn)."""
    n, d = K.remainder.diagonal.shape[:2]
    rho, kept = np.empty(6), np.empty(6)
    free = x.copy()
    for v in range(len(x)):
        apply(K.clamped, x[v, d - 6 : d], kept)
        for i in range(6):
            free[v, d - 6 + i] -= kept[i]
    blocks.times(K.remainder, free, out)
    for v in range(len(x)):
        for k in range(n):
            here = d * k + d - 6
            for i in range(6):
                rho[i] = -free[v, here - d + i] if k > 0 else 0.0
                for j in range(6):
                    rho[i] += K.lever[k, i, j] * free[v, here + j]
            for i in range(6):
                wrench = 0.0
                for j in range(6):
                    wrench += K.spring[k, i, j] * rho[j]
                for j in range(6):
                    out[v, here + j] += K.lever[k, i, j] * wrench
                if k > 0:
                    out[v, here - d + i] -= wrench
        apply(K.clamped, out[v, d - 6 : d], rho)
        apply(K.clamped, x[v, d - 6 : d], kept)
        for i in range(6):
            out[v, d - 6 + i] += kept[i] - rho[i]
