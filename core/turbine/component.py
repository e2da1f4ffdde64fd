"""A flexible part of a machine, reduced to its lowest motions: a blade on a hub that moves, a tower that carries a nacelle.

The matrices of a tree act element by element on (ξ_a, ρ, β) (``tree.links``), so they hold for a node 0 that moves too: each
motion, of the basis or of node 0, is carried outwards over the links, and the element matrices are projected on it. The basis
holds the lowest modes with node 0 fixed and the static responses to the forces by which node 0 or the tip drives the part
(Craig and Bampton, AIAA J. 6, 1968, 1313; Rubin, AIAA J. 13, 1975, 995), combined to vectors that are orthogonal in K and M.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..element.mesh import Mesh
from ..space import spatial as sp
from ..spectrum.lanczos import lanczos
from ..steady.blade_state import Steady
from ..tree import elimination
from ..tree.links import gathered, twists
from ..tree.pencil import TreePencil

Array = NDArray[np.float64]

_DEPENDENT = 1e-9
"""Relative size of the part of a motion outside the others, below which it is left out."""


@dataclass(frozen=True)
class Component:
    """A part's motions and their matrices.

    Attributes:
        M, C, K: (r + 6, r + 6) over r elastic motions and the twist of the frame that carries node 0.
        frequencies: (r,) of the elastic motions alone, without gyroscopic forces, rad/s; they are orthogonal in M and K.
        vectors: (r, dn) the elastic motions as (ρ, β) of the elements.
        tip: (6, r) twist of the last node, in its axes, in each elastic motion.
    """

    M: Array
    C: Array
    K: Array
    frequencies: Array
    vectors: Array
    tip: Array

    @property
    def size(self) -> int:
        """r."""
        return len(self.frequencies)


def reduced_component(mesh: Mesh, state: Steady, count: int, by_tip: bool = False) -> Component:
    """A part reduced about its steady state.

    Args:
        mesh: its nodes and elements.
        state: the steady state.
        count: number of modes of the basis.
        by_tip: whether the part is driven at its last node, instead of at node 0.
    """
    p = state.pencil
    undamped = TreePencil(p.residual, p.M, np.zeros_like(p.C), p.K, p.links)
    modes = lanczos(undamped, count).vectors.T
    phase = modes[np.arange(len(modes)), np.abs(modes).argmax(1)]
    lowest = np.real(modes * (np.abs(phase) / phase)[:, None])
    frame = sp.adjoint(sp.inverse(mesh.nodes[0]))  # from the carrying frame to node 0
    frame_motions = _carried(p, np.zeros((6, lowest.shape[1])), frame.T)
    loads = _at_tip(p) if by_tip else np.concatenate([_loads(p.M, p, frame_motions), _loads(p.C, p, frame_motions)])
    loads = loads[np.abs(loads).max(1) > 1e-12 * np.abs(loads).max()]
    elimination.solve(p.factor, loads)
    return _restricted(mesh, state, np.concatenate([lowest, loads]))


def restricted(mesh: Mesh, state: Steady, rates: Array) -> Component:
    """A part that moves in the given rates (k, dn) of (η, β) alone, about its steady state: a Galerkin method."""
    return _restricted(mesh, state, with_strains(mesh, state, rates))


def with_strains(mesh: Mesh, state: Steady, rates: Array) -> Array:
    """(k, dn) motions (ρ, β) with these rates of (η, β) at a steady state.

    The strains η of an element are the logarithm of the pose of its end b in the frame of its end a, and ρ = T(η) η̇. The same
    ρ in every state would stretch and twist a blade that is bent.
    """
    n = len(mesh.parent)
    motions = rates.reshape(len(rates), n, rates.shape[1] // n).copy()
    tangent = sp.tangent(sp.log(state.shape.relative @ mesh.corner))
    motions[..., :6] = np.einsum("nij,knj->kni", tangent, motions[..., :6])
    return motions.reshape(rates.shape)


def _restricted(mesh: Mesh, state: Steady, motions: Array) -> Component:
    """A part that moves in the given motions (k, dn) of (ρ, β) alone."""
    p = state.pencil
    frame = sp.adjoint(sp.inverse(mesh.nodes[0]))  # from the carrying frame to node 0
    frame_motions = _carried(p, np.zeros((6, motions.shape[1])), frame.T)
    vectors, frequencies = _orthogonal(p, motions) if len(motions) else (motions, np.zeros(0))
    local = np.concatenate([_carried(p, vectors, np.zeros((len(vectors), 6))), frame_motions])
    M, C, K = (np.einsum("xni,nij,ynj->xy", local, part, local, optimize=True) for part in (p.M, p.C, p.K))
    tip = twists(p.links, vectors)[:, -1, :6].T
    return Component(M, C, K, frequencies, vectors, tip)


def _carried(p: TreePencil, x: Array, root: Array) -> Array:
    """(m, n, d + 6) motions (ξ_a, ρ, β) of the elements from x (m, dn) and twists of node 0 (m, 6)."""
    parent, to_child = p.links.parent, p.links.to_child
    own = x.reshape(len(x), len(parent), x.shape[1] // len(parent))
    nodes = np.zeros((len(x), len(parent) + 1, 6))
    nodes[:, 0] = root
    for k, a in enumerate(parent):
        nodes[:, k + 1] = (own[:, k, :6] + nodes[:, a]) @ to_child[k].T
    return np.concatenate([nodes[:, parent], own], axis=2)


def _loads(matrix: Array, p: TreePencil, motions: Array) -> Array:
    """(m, dn) forces on (ρ, β) due to motions (m, n, d + 6)."""
    zeros = np.zeros((len(p.links.parent) + 1, 6))
    return np.array([gathered(p.links, f, zeros).ravel() for f in np.einsum("nij,mnj->mni", matrix, motions)])


def _at_tip(p: TreePencil) -> Array:
    """(6, dn) forces on (ρ, β) due to unit wrenches on the last node."""
    n = len(p.links.parent)
    out = []
    for unit in np.eye(6):
        g = np.zeros((n + 1, 6))
        g[-1] = unit
        out.append(gathered(p.links, np.zeros((n, p.M.shape[1])), g).ravel())
    return np.array(out)


def _orthogonal(p: TreePencil, x: Array) -> tuple[Array, Array]:
    """Combinations (r, dn) of motions x that are orthogonal in K and M, and their frequencies (r,), ascending."""
    local = _carried(p, x, np.zeros((len(x), 6)))
    K, M = (np.einsum("xni,nij,ynj->xy", local, part, local, optimize=True) for part in (p.K, p.M))
    scale = 1.0 / np.sqrt(np.diagonal(K))
    sizes, shapes = np.linalg.eigh(scale[:, None] * 0.5 * (K + K.T) * scale)
    independent = sizes > _DEPENDENT * sizes[-1]
    unit = scale[:, None] * shapes[:, independent] / np.sqrt(sizes[independent])
    squares, combination = np.linalg.eigh(unit.T @ (0.5 * (M + M.T)) @ unit)
    massive = squares > _DEPENDENT**2 * squares[-1]
    unit = (unit @ combination)[:, massive][:, ::-1] / np.sqrt(squares[massive][::-1])
    return unit.T @ x, 1.0 / np.sqrt(squares[massive][::-1])


def with_inertia(mesh: Mesh, node: int, inertia: Array) -> Mesh:
    """The mesh with the inertia (6, 6) of a rigid body added at a node, in the node's axes."""
    lumps = mesh.lumps.copy()
    lumps[node] += inertia
    return replace(mesh, lumps=lumps)
