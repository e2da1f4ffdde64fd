"""The paper's reduction, in its order and symbols: from M Ẏ + Φ_Zᵀ λ = Q to M̂ v̇_I = Q̂ (Park et al. 2010, eq. 1–25).

Valid at any state, not only a steady one. ``equilibrium`` finds the state where Q̂ vanishes, and ``linearization`` varies
M̂ v̇_I = Q̂ about it; this module gives each term, the accelerations and the reactions.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..rank import ranked
from . import partition as pt
from .dynamics import cartesian, reduced_mass, unbalanced
from .kinematics import kinematics
from .topology import Tree

Array = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Reduced:
    """The terms of eq. 8 and 23 at one state; n coordinates, c constraints, i independent coordinates.

    Attributes:
        independent: (i,) indices of q_I; the others, which depend on loops or are prescribed, are q_D.
        v: (n,) velocities of all coordinates.
        M_star, Q_star: (n, n) and (n,) of M* v̇ + Φ_qᵀ λ = Q*.
        Phi_q: (c, n) Jacobian of Φ = [Φᶜ; Φᴹ]: cut joints, prescribed motions.
        R, gamma_bar: (n, i) and (n,) of v̇ = R v̇_I + γ̄.
        M_hat, Q_hat: (i, i) and (i,) of M̂ v̇_I = Q̂.
    """

    independent: Index
    v: Array
    M_star: Array
    Q_star: Array
    Phi_q: Array
    R: Array
    gamma_bar: Array
    M_hat: Array
    Q_hat: Array


def reduced(tree: Tree, q: Array, v_I: Array, independent: tuple[str, ...] | None = None) -> Reduced:
    """Reduce a tree's equations at coordinates q (n,) that close its loops, and independent velocities v_I (i,).

    Args:
        tree: the mechanism.
        q: m or rad.
        v_I: m/s or rad/s, in the order of the independent coordinates in the tree.
        independent: names to use as q_I; chosen numerically if not given.

    Raises:
        MechanismError: names that cannot serve as independent coordinates; beams with mass that do not move steadily.
    """
    n = len(q)
    still = np.zeros(n)
    at_rest = kinematics(tree, q, still, still)
    given = {tree.coordinate(m.coordinate): m for m in tree.mechanism.motions if m.prescribed}
    prescribed = np.eye(n)[sorted(given)]  # Φᴹ_q = Φᴹ_Z B: a unit row for each prescribed coordinate (eq. 7)
    Phi_q = np.concatenate([pt.jacobian(tree, at_rest.B), prescribed])  # of Φ = [Φᶜ; Φᴹ] (eq. 9)
    I = pt.partition(tree, at_rest, independent).independent
    D = np.setdiff1d(np.arange(n), I)  # q = [q_I; q_D] (eq. 12)
    inverse = ranked(Phi_q[:, D]).solve  # Φ_qD⁻¹, which redundant constraints make singular

    R = np.zeros((n, len(I)))
    R[I] = np.eye(len(I))
    R[D] = -inverse(Phi_q[:, I])  # R = [1; −Φ_qD⁻¹ Φ_qI] (eq. 16)

    loops = 6 * len(tree.welds)
    Phi_t = np.concatenate([np.zeros(loops), [-given[j].rate for j in sorted(given)]])
    v = np.empty(n)
    v[I] = v_I
    v[D] = -inverse(Phi_q[:, I] @ v_I + Phi_t)  # from Φ_qD q̇_D + Φ_qI q̇_I + Φ_t = 0 (eq. 17) (eq. 18)

    k = kinematics(tree, q, v, still)  # v̇ = 0, so that Ẏ is Ḃ v alone
    gamma = np.concatenate([pt.jacobian(tree, k.B1) @ v, [-given[j].acceleration for j in sorted(given)]])
    gamma_bar = np.zeros(n)
    gamma_bar[D] = -inverse(gamma)  # q̈_D of Φ_qD q̈_D + Φ_qI q̈_I + γ = 0 at q̈_I = 0 (eq. 19) (eq. 20) (eq. 22)

    wrenches = cartesian(tree, k)  # M Ḃ v − Q
    M_star = reduced_mass(k, wrenches)
    Q_star = -unbalanced(tree, k, wrenches, q, v)  # Q* = Bᵀ Q − Bᵀ M Ḃ v (eq. 11)
    M_hat = R.T @ M_star @ R  # (eq. 24)
    Q_hat = R.T @ Q_star - R.T @ M_star @ gamma_bar  # (eq. 25)
    return Reduced(I, v, M_star, Q_star, Phi_q, R, gamma_bar, M_hat, Q_hat)


def accelerations(r: Reduced) -> tuple[Array, Array]:
    """Accelerations v̇ (n,) and multipliers λ (c,), those of least norm if constraints are redundant."""
    dv_I = np.linalg.solve(r.M_hat, r.Q_hat)  # M̂ v̇_I = Q̂ (eq. 23)
    dv = r.R @ dv_I + r.gamma_bar  # (eq. 21)
    return dv, ranked(r.Phi_q.T).solve(r.Q_star - r.M_star @ dv)  # M* v̇ + Φ_qᵀ λ = Q* (eq. 8)
