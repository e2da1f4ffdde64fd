"""Solid blades of 27-node hexahedra by scikit-fem: matrices for condensation, and modes of the whole rotating solid.

St Venant–Kirchhoff material in the total Lagrangian form: with F the deformation gradient and E = ½(FᵀF − 1),
``S = λ tr(E) 1 + 2μ E`` and ``P = F S`` (J. Bonet and R. D. Wood, *Nonlinear Continuum Mechanics for Finite Element
Analysis*, 2008, §6.4). In axes that rotate with the hub, the equations about the steady state are
``M q̈ + 2Ω M B q̇ + (K_T + Ω² M B²) q = 0`` with ``B = e_z ×`` at every node: centrifugal prestress and its geometric
stiffness are in K_T, spin softening and Coriolis forces follow from M alone.
"""

import time
from dataclasses import dataclass
from importlib import metadata
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.sparse as ss
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

from ...core.condense.ties import FiniteElements
from ...core.modes import Modes
from ..protocol import install
from ..protocol.interface import CodeError
from ..protocol.quadratic import gyroscopic_modes
from .mesh import Bools, Bricks, Clamp, Material, fixed_by, mean_motions

Array = NDArray[np.float64]

HINT = install.extra("codes")

NEWTON = 12


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
        material: its material.
    """

    basis: Any
    order: NDArray[np.intp]
    nodes: Array
    material: Material


def solid(bricks: Bricks, material: Material) -> Solid:
    """Build the fields of a block."""
    import skfem as fem

    straight = fem.MeshHex.init_tensor(*(2.0 * np.arange(n + 1) for n in bricks.counts))
    element = fem.ElementHex2()
    i, j, k = np.rint(fem.Basis(straight, element, intorder=2).doflocs).astype(int)
    lattice = bricks.lattice()
    order = np.empty(i.size, dtype=np.intp)
    order[np.ravel_multi_index((i, j, k), lattice.shape[:3])] = np.arange(i.size)
    corner = np.rint(straight.p / 2.0).astype(int)
    mesh = fem.MeshHex(np.ascontiguousarray(bricks.corners[tuple(corner)].T), straight.t)
    return Solid(fem.Basis(mesh, element, intorder=4), order, lattice.reshape(-1, 3), material)


def tangent(s: Solid, u: Array | None = None) -> ss.csr_array:
    """Tangent stiffness (3n, 3n) at displacements ``u`` (3n,) m, or undeformed.

    The tangent moduli are ``A_iIjJ = δ_ij S_IJ + λ F_iI F_jJ + μ (b_ij δ_IJ + F_iJ F_jI)``, b = F Fᵀ.
    """
    import skfem as fem

    F, S = _deformed(s, u)
    lam, mu = s.material.lame
    one = np.eye(3)[..., None, None]
    form = fem.BilinearForm(lambda p, q, w: np.einsum("IJeq,Ieq,Jeq->eq", w.moduli, q.grad, p.grad))
    blocks: list[list[Any]] = [[None] * 3 for _ in range(3)]
    for i in range(3):
        for j in range(i, 3):
            A = lam * F[i][:, None] * F[j] + mu * (F[i] * F[j][:, None] + (F[i] * F[j]).sum(0) * one)
            blocks[i][j] = _ordered(s, form.assemble(s.basis, moduli=A + S if i == j else A))
            blocks[j][i] = blocks[i][j].T
    return ss.csr_array(ss.block_array(blocks))


def internal_force(s: Solid, u: Array) -> Array:
    """Internal forces (3n,), N, at displacements ``u`` (3n,), m."""
    import skfem as fem

    F, S = _deformed(s, u)
    form = fem.LinearForm(lambda q, w: np.einsum("Ieq,Ieq->eq", w.stress, q.grad))
    P = np.einsum("iKeq,KIeq->iIeq", F, S)
    return np.concatenate([form.assemble(s.basis, stress=P[i])[s.order] for i in range(3)])


def mass(s: Solid) -> ss.csr_array:
    """Mass matrix (n, n), kg, the same for each displacement component."""
    import skfem as fem

    rho = s.material.density
    return _ordered(s, fem.BilinearForm(lambda p, q, w: rho * p * q).assemble(s.basis))


def _ordered(s: Solid, matrix: Any) -> ss.csr_array:
    return ss.csr_array(matrix)[s.order][:, s.order]


def _deformed(s: Solid, u: Array | None) -> tuple[Array, Array]:
    """F and S (3, 3, elements, points)."""
    shape = s.basis.dx.shape
    F = np.broadcast_to(np.eye(3)[..., None, None], (3, 3, *shape)).copy()
    if u is not None:
        for i, part in enumerate(u.reshape(3, -1)):
            own = np.empty_like(part)
            own[s.order] = part
            F[i] += s.basis.interpolate(own).grad
    E = 0.5 * (np.einsum("iIeq,iJeq->IJeq", F, F) - np.eye(3)[..., None, None])
    lam, mu = s.material.lame
    return F, lam * np.trace(E) * np.eye(3)[..., None, None] + 2.0 * mu * E


def freedoms(s: Solid) -> tuple[Array, NDArray[np.intp]]:
    """Points (3n, 3) and directions (3n,) of the solid's displacements."""
    return np.tile(s.nodes, (3, 1)), np.repeat(np.arange(3), len(s.nodes))


def lumped(s: Solid) -> Array:
    """Lumped mass (3n,), kg: row sums, which for 27 nodes is Simpson's rule."""
    return np.tile(mass(s).sum(axis=1), 3)


def finite_elements(bricks: Bricks, material: Material, name: str = "solid") -> FiniteElements:
    """A block as a model for condensation."""
    s = solid(bricks, material)
    return FiniteElements(name, *freedoms(s), tangent(s), lumped(s))


def lumped_by_part(bricks: Bricks, material: Material, cuts: NDArray[np.intp]) -> Array:
    """(m, 3n) lumped mass of each part of a block, cut at layers of corners ``cuts`` (m+1,) along the span."""
    shape = bricks.lattice().shape[:3]
    out = np.zeros((len(cuts) - 1, 3, *shape))
    for k, (a, b) in enumerate(pairwise(cuts)):
        part = bricks.part(a, b)
        out[k, :, 2 * a : 2 * b + 1] = lumped(solid(part, material)).reshape(3, *part.lattice().shape[:3])
    return out.reshape(len(cuts) - 1, -1)


def steady(s: Solid, omega: float, fixed: Bools) -> tuple[Array, Any]:
    """Displacements (3n,) of the steady state, and the stiffness there including spin softening, by Newton's method.

    Raises:
        CodeError: if no steady state is found.
    """
    across = ss.kron(ss.diags_array([1.0, 1.0, 0.0]), omega**2 * mass(s), format="csr")
    place, free = s.nodes.T.ravel(), ~fixed.T.ravel()
    u = np.zeros_like(place)
    for _ in range(NEWTON):
        K = ss.csc_array(tangent(s, u) - across)
        out_of_balance = (across @ (place + u) - internal_force(s, u))[free]
        step = np.zeros_like(u)
        factor: Any = splu(K[free][:, free], permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        step[free] = factor.solve(out_of_balance)
        if np.abs(step).max() <= 1e-10 * np.abs(place).max():
            return u, K
        u = u + step
        if not np.abs(u).max() < np.abs(place).max():
            break
    raise CodeError(f"omega: {omega:g} rad/s: no steady state of the solid found; lower the speed, or check the units")


def modes(
    bricks: Bricks, material: Material, omega: float, count: int, clamp: Clamp, *, coriolis: bool = True
) -> Modes:
    """The lowest modes of a solid blade in steady rotation at ``omega`` (rad/s); shapes are the sections' mean motions.

    Args:
        bricks: the blade; one of its layers of nodes along the span must lie at each of ``STATIONS``.
        material: its material.
        omega: rotor speed, rad/s.
        count: number of modes.
        clamp: which displacements are fixed, see ``mesh``.
        coriolis: whether to include Coriolis forces.

    Raises:
        CodeError: no stable steady state at this speed.
    """
    begun = time.perf_counter()
    s = solid(bricks, material)
    fixed = fixed_by(clamp, s.nodes)
    free = ~fixed.T.ravel()
    _, K = steady(s, omega, fixed)
    m = mass(s)
    B = ss.csr_array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    M = ss.kron(ss.eye_array(3), m, format="csc")
    C = ss.kron(B, 2.0 * omega * m if coriolis else 0.0 * m, format="csc")
    M, C, K = (matrix[free][:, free] for matrix in (M, C, K))
    frequencies, vectors = gyroscopic_modes(M, C, K, count)
    q = np.zeros((len(free), vectors.shape[1]), complex)
    q[free] = vectors
    shapes = mean_motions(s.nodes, m.sum(axis=1), q.reshape(3, len(s.nodes), -1))
    return Modes(omega, frequencies, shapes, bricks.counts[0], seconds=time.perf_counter() - begun)
