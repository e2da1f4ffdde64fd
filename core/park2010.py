"""The equations of Park et al. (2010), with explicit dense matrices: the oracle of the solver.

J.-H. Park, H.-Y. Park, S.-Y. Jeong, S.-I. Lee, Y.-H. Shin, J.-P. Park, *Linear vibration analysis of rotating wind-turbine
blade*, Current Applied Physics 10 (2010) S332–S334. ``(eq. n)`` marks the line that computes their equation n.

A tree of bodies comes in (``park2010_input.tree``), the terms of its equations at any state go out; ``park2010_modes`` has the
steady state and the modes. Leading axes ``...`` of an array are complex steps, by which Q̂ is differentiated there. With the
solver this page shares the description of a mechanism, the inertia of its bodies and the force law of an element.

Twists and wrenches are at the ground's origin, in its axes. The letters are the paper's: b bodies; n coordinates q with rates
v; c rows of Φ = [Φᶜ; Φᴹ], of which r are independent; i independent coordinates.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, cast

import numpy as np
import scipy.linalg

from .mechanism.description import MechanismError
from .park2010_input import Tree, by_bodies, forces, inertia, joint_springs, poses
from .space import complex_step as cs

Array = np.ndarray[Any, Any]

_RANK = 1e-9  # relative size of a pivot that counts as zero
_ROUNDED = 1e-8  # relative size of a residual that rounding explains


# constraints and velocity transformation (eq. 2–11) -------------------------------------------------------------------


def tree_joints(t: Tree, J: Array) -> Array:
    """Φᴶ_Z (…, 6 b) at a real state: the relative motions of neighbouring bodies that the joints of the tree forbid."""
    rows = []
    for inboard, outboard, own, _, _ in t.branches:
        forbidden = np.zeros((6 - len(own), len(t.inertia) + 1, 6))  # the ground last
        forbidden[:, outboard] = scipy.linalg.null_space(J.real[:, own].T).T if own else np.eye(6)
        forbidden[:, inboard] = -forbidden[:, outboard]
        rows.append(forbidden[:, :-1].reshape(len(forbidden), 6 * len(t.inertia)))
    return np.concatenate(rows)


def cut_joints(t: Tree) -> Array:
    """Φᶜ_Z (…, 6 b): a body and its copy beyond a cut joint move together."""
    rows = np.zeros((len(t.cuts), 6, len(t.inertia) + 1, 6))
    for k, (body, copy) in enumerate(t.cuts):
        rows[k, :, body], rows[k, :, copy] = np.eye(6), -np.eye(6)
    return rows[:, :, :-1].reshape(6 * len(t.cuts), 6 * len(t.inertia))


def motions(t: Tree, J: Array, coordinates: list[int]) -> Array:
    """Φᴹ_Z (..., m, 6 b): the rates of the coordinates ``coordinates`` from the velocities of the bodies that they join."""
    rows = np.zeros((*J.shape[:-2], len(coordinates), len(t.inertia) + 1, 6), complex)
    for inboard, outboard, own, _, _ in t.branches:
        for k in set(own) & set(coordinates):
            rows[..., coordinates.index(k), outboard, :] = cs.left_inverse(J[..., own])[..., own.index(k), :]
            rows[..., coordinates.index(k), inboard, :] = -rows[..., coordinates.index(k), outboard, :]
    return rows[..., :-1, :].reshape(*rows.shape[:-2], 6 * len(t.inertia))


def transformation(t: Tree, J: Array) -> Array:
    """B (..., 6 b, n) from J (..., 6, n), and Ḃ from J̇: a body has the screws of all coordinates that carry it."""
    return (t.moves_body[:, None, :] * J[..., None, :, :]).reshape(*J.shape[:-2], -1, J.shape[-1])


def screw_rates(t: Tree, J: Array, v: Array) -> Array:
    """J̇ = Y × J (..., 6, n): a screw turns with the body, or the part of a joint, that carries it."""
    Y = t.moves_screw @ cs.transposed(J * v[..., None, :])
    return np.ascontiguousarray(cs.transposed(cs.times(cs.ad(Y), cs.transposed(J))))


def constraints(t: Tree, J: Array, B: Array) -> Array:
    """Φ_q (..., c, n) of Φ = [Φᶜ; Φᴹ]."""
    Phi_C_q = cut_joints(t) @ B  # Bᵀ Φᶜ_Zᵀ = (Φᶜ_Z B)ᵀ = Φᶜ_qᵀ (eq. 6)
    Phi_M_q = motions(t, J, t.motions()[0]) @ B  # Bᵀ Φᴹ_Zᵀ = (Φᴹ_Z B)ᵀ = Φᴹ_qᵀ (eq. 7)
    return np.concatenate([Phi_C_q, Phi_M_q], axis=-2)  # Φ = [Φᶜ; Φᴹ] (eq. 9)


# partition (eq. 12–22) ------------------------------------------------------------------------------------------------


class Partition(NamedTuple):
    """Indices of q_I (i,) and q_D (r,) among the coordinates, and of independent rows of Φ (r,)."""

    I: list[int]
    D: list[int]
    rows: list[int]


def partition(t: Tree, q: Array, independent: Sequence[str] | None = None) -> Partition:
    """Choose q_D by QR with column pivoting among the coordinates that are not ``independent``.

    Raises:
        MechanismError: the dependent coordinates do not follow from the others.
    """
    _, J = poses(t, q)
    Phi_q = constraints(t, J, transformation(t, J)).real
    rows = _pivots(Phi_q.T)
    spinning = [m.coordinate for m in t.mechanism.motions if not m.prescribed]
    independent_indices = [t.coordinates.index(name) for name in (spinning if independent is None else independent)]
    able = np.setdiff1d(np.arange(len(q)), independent_indices)
    D = able[_pivots(Phi_q[rows][:, able])].tolist()  # q = [q_I; q_D] (eq. 12)
    if len(D) < len(rows) or (independent is not None and len(D) < len(able)):
        raise MechanismError(
            f"independent: {', '.join(independent or spinning)} do not determine the other coordinates"
        )
    return Partition(np.setdiff1d(np.arange(len(q)), D).tolist(), D, rows)


def _pivots(A: Array) -> list[int]:
    """Columns that span the range of a matrix."""
    if not A.size:
        return []
    r, order = cast(tuple[Array, Array], scipy.linalg.qr(A, mode="r", pivoting=True))
    size = np.abs(np.diagonal(r))
    return sorted(order[: int((size > _RANK * size[0]).sum())].tolist())


@dataclass(frozen=True)
class Equations:
    """All terms at coordinates q (..., n) that close the loops, and independent rates v_I (..., i).

    Attributes:
        v, X, J: rates (..., n), poses (..., b + 1, 4, 4), screws (..., 6, n).
        B, B_dot: (..., 6 b, n).
        blocks, Q: the diagonal blocks (..., b, 6, 6) of M, and Q (..., 6 b).
        Phi_q, R, gamma_bar: (..., c, n), (..., n, i), (..., n).
        Q_star, Q_hat: (..., n), (..., i).
    """

    v: Array
    X: Array
    J: Array
    B: Array
    B_dot: Array
    blocks: Array
    Q: Array
    Phi_q: Array
    R: Array
    gamma_bar: Array
    Q_star: Array
    Q_hat: Array

    @property
    def M(self) -> Array:
        """M (6 b, 6 b) at a single state, as are M* and M̂."""
        return np.asarray(scipy.linalg.block_diag(*self.blocks))

    @property
    def M_star(self) -> Array:
        """M* (n, n)."""
        return self.B.T @ self.M @ self.B  # M* = Bᵀ M B (eq. 10)

    @property
    def M_hat(self) -> Array:
        """M̂ (i, i)."""
        return self.R.T @ self.M_star @ self.R  # M̂ = Rᵀ M* R (eq. 24)


def equations(t: Tree, q: Array, v_I: Array, part: Partition) -> Equations:
    """The terms of the equations at coordinates q (..., n) that close the loops, and independent rates v_I (..., i)."""
    X, J = poses(t, q)
    B = transformation(t, J)
    Phi_q = constraints(t, J, B)
    (I, D, rows), (prescribed, imposed) = part, t.motions()
    lead, cuts = np.broadcast_shapes(q.shape[:-1], v_I.shape[:-1]), Phi_q.shape[-2] - len(prescribed)

    Phi_qI, Phi_qD = Phi_q[..., rows, :][..., I], Phi_q[..., rows, :][..., D]
    R = np.zeros((*q.shape, len(I)), complex)
    R[..., I, :] = np.eye(len(I))  # δΦ = Φ_qD δq_D + Φ_qI δq_I = 0 (eq. 13), so δq_D = −Φ_qD⁻¹ Φ_qI δq_I (eq. 14)
    R[..., D, :] = -np.linalg.solve(Phi_qD, Phi_qI)  # δq = R δq_I (eq. 15), R = [1; −Φ_qD⁻¹ Φ_qI] (eq. 16)
    Phi_t = np.append(np.zeros(cuts), -imposed[:, 0])[rows]
    v = np.zeros((*lead, q.shape[-1]), complex)
    v[..., I] = v_I
    moving = cs.times(Phi_qI, v_I) + Phi_t  # Φ̇ = Φ_qD q̇_D + Φ_qI q̇_I + Φ_t = 0 (eq. 17)
    v[..., D] = -cs.solved(Phi_qD, moving)  # q̇_D = −Φ_qD⁻¹ (Φ_qI q̇_I + Φ_t) (eq. 18)

    Y = cs.times(B, v)  # Y = B v (eq. 3)
    B_dot = transformation(t, screw_rates(t, J, v))
    M, B_dot_v = inertia(t, X), cs.times(B_dot, v)
    sprung, f = joint_springs(t, q, v)
    Q = forces(t, X, Y, M) + cs.times(cs.transposed(motions(t, J, sprung)), f)
    Q_star = cs.times(cs.transposed(B), Q - by_bodies(M, B_dot_v))  # Q* = Bᵀ Q − Bᵀ M Ḃ v (eq. 11)

    accelerated = np.broadcast_to(-imposed[:, 1], (*lead, len(prescribed)))
    gamma = np.append(cs.times(cut_joints(t), B_dot_v), accelerated, axis=-1)[..., rows]  # Φ̈ = Φ_q v̇ + γ = 0 (eq. 19)
    gamma_bar = np.zeros(v.shape, complex)
    gamma_bar[..., D] = -cs.solved(Phi_qD, gamma)  # q̈_D = −Φ_qD⁻¹ (Φ_qI q̈_I + γ) (eq. 20), γ̄ = [0; −Φ_qD⁻¹ γ] (eq. 22)
    M_star_gamma = cs.times(cs.transposed(B), by_bodies(M, cs.times(B, gamma_bar)))
    Q_hat = cs.times(cs.transposed(R), Q_star - M_star_gamma)  # Q̂ = Rᵀ Q* − Rᵀ M* γ̄ (eq. 25)
    return Equations(v, X, J, B, B_dot, M, Q, Phi_q, R, gamma_bar, Q_star, Q_hat)


def inertia_forces(e: Equations, dv_I: Array) -> Array:
    """M̂ v̇_I (..., i)."""
    forces = by_bodies(e.blocks, cs.times(e.B, cs.times(e.R, dv_I)))
    return cs.times(cs.transposed(e.R), cs.times(cs.transposed(e.B), forces))


def accelerations(t: Tree, e: Equations) -> tuple[Array, Array]:
    """v̇ (n,) and multipliers λ of [Φᴶ; Φᶜ; Φᴹ] at one state; λ of least norm if constraints are redundant.

    Raises:
        ArithmeticError: a residual in eq. 1, 5 or 8.
    """
    Phi_J_Z, B, M, Q = tree_joints(t, e.J), e.B.real, e.M.real, e.Q.real
    Phi_Z = np.concatenate([Phi_J_Z, cut_joints(t), motions(t, e.J, t.motions()[0]).real])  # Φ = [Φᴶ; Φᶜ; Φᴹ] (eq. 2)
    dv_I = np.linalg.solve(e.M_hat.real, e.Q_hat.real)  # M̂ v̇_I = Q̂ (eq. 23)
    dv = e.R.real @ dv_I + e.gamma_bar.real  # v̇ = R v̇_I + γ̄ (eq. 21)
    Y_dot = B @ dv + np.real(e.B_dot @ e.v)  # Ẏ = B v̇ + Ḃ v (eq. 4)
    multipliers = np.linalg.lstsq(Phi_Z.T, Q - M @ Y_dot)[0]
    relative = e.M_star.real @ dv + e.Phi_q.real.T @ multipliers[len(Phi_J_Z) :] - e.Q_star.real
    parts = np.abs(e.R) @ np.abs(dv_I) + np.abs(e.gamma_bar)  # of v̇, which may cancel
    size = np.abs(Q) + np.abs(M) @ (np.abs(B) @ parts + np.abs(e.B_dot) @ np.abs(e.v))
    for law, residual, scale in (
        ("M Ẏ + Φ_Zᵀ λ = Q", M @ Y_dot + Phi_Z.T @ multipliers - Q, size),  # (eq. 1)
        ("Bᵀ Φᴶ_Zᵀ = 0", B.T @ Phi_J_Z.T, Phi_J_Z),  # drops λᴶ from Bᵀ (M (B v̇ + Ḃ v) + Φ_Zᵀ λ) = Bᵀ Q (eq. 5)
        ("M* v̇ + Φ_qᵀ λ = Q*", relative, np.abs(B.T) @ size),  # (eq. 8)
    ):
        if np.abs(residual).max(initial=0.0) > _ROUNDED * np.abs(scale).max(initial=0.0):
            raise ArithmeticError(f"{law}: the residual is {np.abs(residual).max():.1e}")
    return dv, multipliers
