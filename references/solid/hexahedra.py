"""Solid blades of 27-node hexahedra by scikit-fem: matrices for condensation, and modes of the whole rotating solid.

St Venant–Kirchhoff material in the total Lagrangian form: with F the deformation gradient and E = ½(FᵀF − 1),
``S = C E`` and ``P = F S`` (J. Bonet and R. D. Wood, *Nonlinear Continuum Mechanics for Finite Element
Analysis*, 2008, §6.4). In axes that rotate with the hub, the equations about the steady state are
``M q̈ + 2Ω M B q̇ + (K_T + Ω² M B²) q = 0`` with ``B = e_z ×`` at every node: centrifugal prestress and its geometric
stiffness are in K_T, spin softening and Coriolis forces follow from M alone. The stiffness has two Gauss points along the
span and three in each other direction: with three, elements longer than thick are too stiff in bending (O. C. Zienkiewicz,
R. L. Taylor and J. M. Too, Int. J. Numer. Meth. Engng 3 (1971) 275). No motion is without energy.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib import metadata
from typing import Any

import numpy as np
import scipy.sparse as ss
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from ...core.modes import Modes
from ..cache_last import cache_last
from ..matrices.quadratic import gyroscopic_modes
from ..protocol.interface import CodeError, extra
from .materials import Material, Orthotropic, rotated
from .mesh import Bricks, Clamp, fixed_by, mean_motions, means, workless

Array = NDArray[np.float64]

HINT = extra("codes")

NEWTON = 12
"""Iterations of Newton's method."""

SETTLED = 1e-6
"""Size of a step, relative to the largest coordinate, after which the stiffness is that of the step before."""

STEPS = ((1.0,), (0.1, 0.4, 1.0))
"""Shares of the centrifugal load, one after the other; the second way for blades that straighten much."""


def version() -> str | None:
    """Version of scikit-fem, without importing it; None if it is not installed."""
    try:
        return metadata.version("scikit-fem")
    except metadata.PackageNotFoundError:
        return None


@dataclass(frozen=True)
class Solid:
    """The fields of a block: one scalar basis for each of u_x, u_y, u_z, stacked in this order.

    Attributes:
        basis: scikit-fem's, of 27-node hexahedra.
        order: (n,) index in the basis of each node of the block's lattice.
        nodes: (n, 3) the lattice, m.
        density: kg/m³.
        moduli: C (e, q, 3, 3, 3, 3), Pa, in blade axes, at each point of each element.
        own: (e, 27) the nodes of each element.
        slopes: (e, q, 27, 3) gradients of their shape functions, 1/m, at the points of the stiffness.
        volume: (e, q) volume that each point represents, m³.
    """

    basis: Any
    order: NDArray[np.intp]
    nodes: Array
    density: float
    moduli: Array
    own: NDArray[np.intp]
    slopes: Array
    volume: Array


@cache_last
def solid(bricks: Bricks, material: Material | Orthotropic) -> Solid:
    """Build the fields of a block."""
    import skfem as fem

    straight = fem.MeshHex.init_tensor(*(2.0 * np.arange(n + 1) for n in bricks.counts))
    element = fem.ElementHex2()
    i, j, k = np.rint(fem.Basis(straight, element, intorder=2).doflocs).astype(int)
    lattice = bricks.lattice()
    number: Any = np.ravel_multi_index((i, j, k), lattice.shape[:3])
    order = np.empty(i.size, dtype=np.intp)
    order[number] = np.arange(i.size)
    mesh = fem.MeshHex2(np.ascontiguousarray(lattice[i, j, k].T), straight.t)
    along = int(np.abs(straight.mapping().DF(np.full((3, 1), 0.5))[0, :, 0, 0]).argmax())
    basis = fem.Basis(mesh, element, quadrature=_points(along))
    gradients: list[Any] = [shape[0].grad for shape in basis.basis]
    slopes = np.stack(gradients).transpose(2, 3, 0, 1)
    moduli = material.moduli
    if len(bricks.axes) and isinstance(material, Orthotropic):
        own = np.repeat(bricks.axes.reshape(-1, 9), i.size // len(bricks.axes), axis=0)[number]
        axes = np.stack([basis.interpolate(entry) for entry in own.T], axis=-1)
        moduli = rotated(moduli, axes.reshape(*axes.shape[:-1], 3, 3))
    moduli = np.broadcast_to(moduli, (*slopes.shape[:2], 3, 3, 3, 3))
    full, nodes = fem.Basis(mesh, element, intorder=4), lattice.reshape(-1, 3)
    return Solid(full, order, nodes, material.density, moduli, number[basis.element_dofs.T], slopes, basis.dx)


def _points(along: int) -> tuple[Array, Array]:
    """Gauss points (3, 18) of the unit cube and their weights (18,): two in the direction ``along``, three in the others."""
    rules = [np.polynomial.legendre.leggauss(2 if axis == along else 3) for axis in range(3)]
    places, weights = (np.meshgrid(*parts, indexing="ij") for parts in zip(*rules, strict=True))
    return np.stack([0.5 * (1.0 + p.ravel()) for p in places]), np.prod(weights, axis=0).ravel() / 8.0


CHUNK = 64
"""Elements whose matrices are integrated together."""


def tangent(s: Solid, u: Array | None = None, stress: Array | None = None) -> ss.csr_array:
    """Tangent stiffness (3n, 3n) at displacements ``u`` (3n,) m, or undeformed.

    The tangent moduli are ``A_iIjJ = δ_ij S_IJ + F_iK C_KIMJ F_jM``, with S of ``u``, or another ``stress`` (e, q, 3, 3), Pa.
    """
    F, S = _deformed(s, u)
    S = S if stress is None else stress
    count, points, size, _ = s.slopes.shape
    out = np.empty((3, 3, count, size, size))
    for start in range(0, count, CHUNK):
        e = slice(start, start + CHUNK)
        A = np.einsum("eqiK,eqKIMJ,eqjM->eqIijJ", F[e], s.moduli[e], F[e], optimize=True)
        A[:, :, :, range(3), range(3)] += S[e][:, :, :, None]
        A *= s.volume[e, :, None, None, None, None]
        n = len(A)
        strain_slopes = A.reshape(n, points, 27, 3) @ s.slopes[e].swapaxes(2, 3)
        weighted = s.slopes[e].transpose(0, 2, 1, 3).reshape(n, size, 3 * points)
        blocks = (weighted @ strain_slopes.reshape(n, 3 * points, 9 * size)).reshape(n, size, 3, 3, size)
        out[:, :, e] = blocks.transpose(2, 3, 0, 1, 4)
    out = 0.5 * (out + out.transpose(1, 0, 2, 4, 3))  # equal but for rounding
    entry, rows, columns, order = _pattern(s.own, len(s.nodes))
    sums = np.array([np.bincount(entry, pair) for pair in out.reshape(9, -1)])
    return ss.csr_array((sums.ravel()[order], columns, rows), shape=(3 * len(s.nodes), 3 * len(s.nodes)))


@cache_last
def _pattern(own: NDArray[np.intp], nodes: int) -> tuple[NDArray[np.intp], ...]:
    """Where the entries of matrices of all elements, for each pair of displacement components, are in the sparse matrix.

    Returns:
        entry (e 27 27,) of the matrix of one pair, row by row; then of the whole matrix: the first entry of each row
        (3n+1,), the column of each entry, and its index in the concatenated entries of the nine pairs.
    """
    rows, columns = (
        np.broadcast_to(nodes_of, (*own.shape, own.shape[1])).ravel() for nodes_of in (own[:, :, None], own[:, None])
    )
    pairs, entry = np.unique(rows * nodes + columns, return_inverse=True)
    size, places = len(pairs), (pairs // nodes, pairs % nodes)
    numbers = np.arange(9 * size).reshape(3, 3, size)
    blocks = [[ss.csr_array((pair, places), shape=(nodes, nodes)) for pair in row] for row in numbers]
    whole: Any = ss.csr_array(ss.block_array(blocks, format="csr"))
    return entry, whole.indptr, whole.indices, whole.data


def part(s: Solid, selection: NDArray[np.bool_]) -> Solid:
    """The solid with only some of its elements (e,); the nodes remain."""
    return replace(
        s, moduli=s.moduli[selection], own=s.own[selection], slopes=s.slopes[selection], volume=s.volume[selection]
    )


def internal_force(s: Solid, u: Array) -> Array:
    """Internal forces (3n,), N, at displacements ``u`` (3n,), m."""
    F, S = _deformed(s, u)
    P = F @ S * s.volume[:, :, None, None]
    force = np.einsum("eqaI,eqiI->iea", s.slopes, P, optimize=True)
    parts: list[Array] = [np.bincount(s.own.ravel(), part.ravel(), len(s.nodes)).astype(float) for part in force]
    return np.concatenate(parts)


@cache_last
def mass(s: Solid) -> ss.csr_array:
    """Mass matrix (n, n), kg, the same for each displacement component."""
    import skfem as fem

    rho = s.density
    return ss.csr_array(fem.BilinearForm(lambda p, q, w: rho * p * q).assemble(s.basis))[s.order][:, s.order]


def _deformed(s: Solid, u: Array | None) -> tuple[Array, Array]:
    """F and S (elements, points, 3, 3)."""
    F = np.broadcast_to(np.eye(3), (*s.slopes.shape[:2], 3, 3))
    if u is not None:
        F = F + _gradient(s, u)
    E = 0.5 * (F.swapaxes(2, 3) @ F - np.eye(3))
    return F, np.einsum("eqIJKL,eqKL->eqIJ", s.moduli, E)


def predicted(s: Solid, u: Array, step: Array) -> Array:
    """Stress S (e, q, 3, 3), Pa, after a further displacement ``step`` (3n,), m, if it grew in proportion to it."""
    F, S = _deformed(s, u)
    rate = np.swapaxes(F, 2, 3) @ _gradient(s, step)
    return S + np.einsum("eqIJKL,eqKL->eqIJ", s.moduli, 0.5 * (rate + np.swapaxes(rate, 2, 3)))


def _gradient(s: Solid, u: Array) -> Array:
    """(e, q, 3, 3) derivative of displacements by position."""
    return np.einsum("iea,eqaI->eqiI", u.reshape(3, -1)[:, s.own], s.slopes, optimize=True)


def freedoms(s: Solid) -> tuple[Array, NDArray[np.intp]]:
    """Points (3n, 3) and directions (3n,) of the solid's displacements."""
    return np.tile(s.nodes, (3, 1)), np.repeat(np.arange(3), len(s.nodes))


def motions(s: Solid, clamp: Clamp | Array) -> ss.csr_array:
    """Motions (3n, m) that a clamp leaves free, in columns.

    Args:
        s: the solid.
        clamp: which displacements are fixed, see ``mesh``; or ``tractions`` (3n, 6): nodal forces that do no work, so that
            six mean motions are fixed.
    """
    identity = ss.csc_array(ss.eye_array(3 * len(s.nodes)))
    if callable(clamp):
        return ss.csr_array(identity[:, ~fixed_by(clamp, s.nodes).T.ravel()])
    follow, lead, matrix = workless(clamp)
    ratio = ss.coo_array(matrix)
    couplings = ss.csc_array((ratio.data, (follow[ratio.row], lead[ratio.col])), shape=identity.shape)
    independent = np.setdiff1d(np.arange(3 * len(s.nodes)), follow)
    return ss.csr_array(ss.csc_array(identity + couplings)[:, independent])


def steady_displacements(s: Solid, omega: float, free: Any) -> tuple[Array, Any]:
    """Displacements (3n,) of the steady state, and the stiffness there including spin softening, by Newton's method.

    ``free`` are the free ``motions``.

    Raises:
        CodeError: if no steady state is found.
    """
    position = s.nodes.T.ravel()
    if not omega:
        return np.zeros_like(position), ss.csc_array(tangent(s))
    across = ss.kron(ss.diags_array([1.0, 1.0, 0.0]), omega**2 * mass(s), format="csr")
    for shares in STEPS:
        u, K = np.zeros_like(position), None
        for share in shares:
            u, K = _balanced(s, share * across, free, u)
            if K is None:
                break
        if K is not None:
            return u, K
    raise CodeError(f"omega: {omega:g} rad/s: no steady state of the solid found; lower the speed, or check the units")


def factored(matrix: Any) -> Any:
    """SuperLU's factors of a symmetric sparse matrix, without exchange of rows, which would fill them."""
    return splu(
        ss.csc_matrix(matrix), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )


def _balanced(s: Solid, across: Any, free: Any, u: Array) -> tuple[Array, Any]:
    """As ``steady_displacements``, from displacements ``u``; no stiffness if Newton's method does not converge.

    The geometric stiffness is that of the stress which the step before predicted. With the stress of ``u``, the squares of
    the rotations of that step, as spurious tension, make a slender solid straighten slowly (D. Magisano, L. Leonetti and
    G. Garcea, Comput. Methods Appl. Mech. Eng. 313 (2017) 986). Both lead to the same state, whose stiffness is returned.
    """
    position, stress, size = s.nodes.T.ravel(), None, np.inf
    factor: Any = None
    for _ in range(NEWTON):
        if size > SETTLED:
            factor = factored(free.T @ ss.csc_array(tangent(s, u, stress) - across) @ free)
        step = free @ factor.solve(free.T @ (across @ (position + u) - internal_force(s, u)))
        stress, u = predicted(s, u, step), u + step
        size = np.abs(step).max() / np.abs(position).max()
        if size <= 1e-10:
            return u, ss.csc_array(tangent(s, u) - across)
        if not np.abs(u).max() < np.abs(position).max():
            break
    return u, None


def modes(
    bricks: Bricks,
    material: Material | Orthotropic,
    omega: float,
    count: int,
    clamp: Clamp | Array,
    *,
    coriolis: bool = True,
    sections: Sequence[tuple[NDArray[np.intp], Array]] = (),
) -> Modes:
    """The lowest modes of a solid blade in steady rotation at ``omega`` (rad/s); shapes are the sections' mean motions.

    Args:
        bricks: the blade; one of its layers of nodes along the span must lie at each of ``STATIONS``.
        material: its material.
        omega: rotor speed, rad/s.
        count: number of modes.
        clamp: which displacements are fixed, see ``motions``.
        coriolis: whether to include Coriolis forces.
        sections: of a curved blade, at ``STATIONS``; see ``mesh.means``.

    Raises:
        CodeError: no stable steady state at this speed.
    """
    s = solid(bricks, material)
    free = motions(s, clamp)
    _, K = steady_displacements(s, omega, free)
    m = mass(s)
    B = ss.csr_array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    M = ss.kron(ss.eye_array(3), m, format="csc")
    C = ss.kron(B, 2.0 * omega * m if coriolis else 0.0 * m, format="csc")
    M, C, K = (free.T @ matrix @ free for matrix in (M, C, K))
    frequencies, vectors = gyroscopic_modes(M, C, K, count)
    q = (free @ vectors).reshape(3, len(s.nodes), -1)
    weights = m.sum(axis=1)
    shapes = means(s.nodes, weights, q, sections) if sections else mean_motions(s.nodes, weights, q)
    return Modes(omega, frequencies, shapes, bricks.counts[0])
