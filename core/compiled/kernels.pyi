"""Signatures of the compiled kernels. Arrays are C-contiguous float64, unless stated otherwise: TypeError, ValueError."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

def sources() -> str:
    """The digest of the sources that were compiled."""

def processor_has_avx2() -> bool: ...

# space: arrays of any layout and number of leading dimensions, see space/spatial.py

def skew(a: Array) -> Array: ...
def inverse(x: Array) -> Array: ...
def adjoint(x: Array) -> Array: ...
def ad(twist: Array) -> Array: ...
def coadjoint(wrench: Array) -> Array: ...
def exp(twist: Array) -> Array: ...
def log(x: Array) -> Array: ...
def tangent(twist: Array) -> Array: ...
def tangent_inverse(twist: Array) -> Array: ...

# element

class StrainLaws:
    """``measures.StrainLaw`` for the kernels; it keeps the arrays."""

    def __init__(
        self, body_fixed: bool, undeformed: Array, shortening: Array, mean: Array, slope: Array, eta: Array
    ) -> None: ...

class Beams:
    """``beams.Beams`` for the kernels; it keeps the arrays. The points of element k are ``first[k]`` … ``first[k + 1] − 1``."""

    def __init__(
        self,
        laws: StrainLaws,
        first: NDArray[np.int64],
        stiffness: Array,
        preload: Array,
        inner_preload: Array,
        zeta0: Array,
        shape: Array,
        bubble: Array,
        mass: Array,
        force: Array,
    ) -> None: ...

def relative_pencil(
    beams: Beams, x: Array, beta: Array, frame: Array, gravity: Array, axes: Array, geometric: bool
) -> tuple[Array, Array, Array, Array, Array]:
    """``beams.relative_pencil``."""

def respond(laws: StrainLaws, x: Array, beta: Array, s: Array, on_eta: Array) -> tuple[Array, Array, Array]:
    """``measures.response``."""

# trees

class Links:
    """``links.Links`` for the kernels; it keeps the arrays. ``clamped`` is (n, 6, 6), or (0, 6, 6) without joints."""

    def __init__(self, parent: NDArray[np.int64], to_child: Array, clamped: Array) -> None: ...

def tree_parts(
    beams: Beams,
    nodes: Array,
    relative: Array,
    corner: Array,
    beta: Array,
    lumps: Array,
    force: Array,
    parent: NDArray[np.int64],
    omega: float,
    gravity: Array,
    geometric: bool,
) -> tuple[Array, Array, Array, Array, Array, Array, Array, Array]:
    """``beams.RelativePencil`` of the elements, and g (n+1, 6), C and K (n+1, 6, 6) of the nodes."""

def gathered(links: Links, f: Array, g: Array) -> Array:
    """``links.gathered``."""

def tree_sum(links: Links, M: Array, C: Array, K: Array, spring: Array, lumps: Array, of_C: Array, of_K: Array) -> None:
    """Add the springs and the nodes to the elements' M, C and K, in place."""

def displaced(parent: NDArray[np.int64], relative: Array, step: Array) -> Array:
    """The relative poses (n, 4, 4) after the twists of the nodes 1 … n in ``step`` (n, 6 or more)."""

def placed(parent: NDArray[np.int64], first: Array, relative: Array) -> Array:
    """The poses (n+1, 4, 4) of the nodes from that of node 0 and the relative ones (n, 4, 4)."""

def product(matrix: Array, sign: float, links: Links, x: Array) -> Array:
    """``links.product``."""

def twists(links: Links, x: Array) -> None:
    """Replace ρ by ξ_b in vectors x (k, n, d), in place."""

def factor(K: Array, links: Links) -> tuple[int, Array, Array, Array]:
    """The parts of ``elimination.Factor``; before them 2 if all pivots are positive, 1 if not, 0 if K is singular."""

def solve(flexibility: Array, transfer: Array, reaction: Array, links: Links, x: Array) -> None:
    """``elimination.solve``."""

def negative_pivots(K: Array, C: Array, M: Array, links: Links, omega: float) -> int:
    """Negative pivots of K + iωC − ω²M; see ``completeness``."""

class Operator:
    """A⁻¹S with A = diag(K, M) and S = [[C, M], [−M, 0]]; it keeps the arrays.

    ``massive`` (n, 6, 6) are projectors of the nodes' twists on directions with mass and ``lever`` (n, 6, 6) Ad; both (0, 6, 6)
    for a consistent mass.
    """

    def __init__(
        self,
        M: Array,
        C: Array,
        K: Array,
        links: Links,
        flexibility: Array,
        transfer: Array,
        reaction: Array,
        massive: Array,
        lever: Array,
    ) -> None: ...
    def keep_massive(self, y: Array) -> None:
        """Remove the motion of nodes without inertia from vectors y (k, n), in place."""

    def forward(self, v: Array) -> Array:
        """A⁻¹S v for the rows of v (k, 2n)."""

    def extend(
        self, w: Array, basis: Array, projected: Array, size: int, last_step: int, look: int
    ) -> tuple[Array, int, int, bool]:
        """Take block Lanczos steps until the basis has ``look`` vectors or cannot grow.

        Args:
            w: (k, 2n) result of the last step, k at most 8; at the end its first rows are that of the new last step,
                orthogonal to the basis.
            basis: (limit, 2n), with ``size`` rows filled, those of the last step from ``last_step`` on; extended in place.
            projected: (m, m) the operator on the basis, m at least ``look`` + k or ``limit``, zero beyond the filled part;
                extended in place.
            size, last_step: see ``basis``; both 0 at the start.
            look: requested number of vectors.

        Returns:
            The Gram matrix of w, the new size and last_step, and whether the basis is exhausted.
        """
