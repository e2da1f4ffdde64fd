"""Cartesian equations of a tree and their projection M* v̇ = Q* (Park et al. 2010, eq. 1, 5–11).

All wrenches are on the bodies at the ground's origin, in its axes. What the bodies feel is gathered as a ``Cartesian`` pencil:
the total wrench g that inertia and forces leave unbalanced, and its variation ``M ξ̈ + C ξ̇ + K ξ`` along with the bodies,
block by block, ξ the bodies' small twists.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import spatial as sp
from .beams import Pencil, on_ends
from .beams import pencil as beam_pencil
from .elements import strain_rate
from .kinematics import Kinematics
from .mechanism import Beam, MechanismError, Spring
from .tree import Tree

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Cartesian:
    """Total wrench g (b + m, 6) and its linearisation M, C, K, each square; rows as those of B, beams' internal forces last.

    ``springs`` are the stiffnesses (6, 6) that act on ρ = ξ_b − ξ_a between two bodies, kept out of K: ``B_b − B_a`` is exact
    where the difference of their products would cancel.
    """

    g: Array
    M: Array
    C: Array
    K: Array
    springs: list[tuple[int, int, Array]]


def cartesian(tree: Tree, k: Kinematics, multipliers: Array | None = None) -> Cartesian:
    """Gather inertia, gravity, springs, beams and the reactions of cut joints.

    Args:
        tree: the mechanism.
        k: its kinematics.
        multipliers: (w, 6) wrench each weld needs on the body, reversed on the copy; none: zero.

    Raises:
        MechanismError: a beam with mass whose ends do not move together in the steady state.
    """
    b = len(k.B)
    zero = np.zeros((6 * b, 6 * b))
    out = Cartesian(np.zeros((b, 6)), zero, zero.copy(), zero.copy(), [])
    _bodies(tree, k, out)
    for spring in tree.mechanism.springs:
        _spring(tree, k, spring, out)
    behind = len(tree.bodies)
    for beam, inner in zip(tree.mechanism.beams, tree.inner, strict=True):
        ends = (tree.body(beam.body_a), tree.body(beam.body_b))
        if inner < 0:
            _beam(tree, k, beam, ends, np.zeros(0), out)
        else:
            _beam(tree, k, beam, (*ends, behind), k.q[inner : inner + 6], out)
            behind += 1
    if multipliers is not None:
        for (body, copy), w in zip(tree.welds, multipliers, strict=True):
            _weld(body, copy, w, out)
    return out


def inertias(tree: Tree, k: Kinematics) -> Array:
    """(b, 6, 6) inertias of the bodies at the ground's origin, in its axes."""
    a = sp.adjoint(sp.inverse(k.poses))
    return np.swapaxes(a, -1, -2) @ tree.inertia @ a


def _bodies(tree: Tree, k: Kinematics, out: Cartesian) -> None:
    """g = M (A − a_g) + Y ×* M Y; along with the body δg = M ξ̈ + (Y ×* M − M Y × + M Y ×̄*) ξ̇ − M a_g × ξ."""
    M = inertias(tree, k)
    fall = np.concatenate([tree.mechanism.gravity, np.zeros(3)])
    turn = sp.ad(k.Y)
    momentum = (M @ k.Y[..., None])[..., 0]
    out.g[: len(M)] = (M @ (k.A - fall)[..., None] - np.swapaxes(turn, -1, -2) @ momentum[..., None])[..., 0]
    mt = M @ turn
    C = -np.swapaxes(mt, -1, -2) - mt - sp.cross(momentum)
    for i in range(len(M)):
        at = slice(6 * i, 6 * i + 6)
        out.M[at, at], out.C[at, at], out.K[at, at] = M[i], C[i], -M[i] @ sp.ad(fall)


def _add(out: Cartesian, ends: tuple[int, ...], pencil: Pencil) -> None:
    """Add an element's wrenches (d,) and matrices (d, d) on two ends and β; the ground takes up what acts on it."""
    out.springs.append((ends[0], ends[1], pencil.spring))
    for i, end in enumerate(ends):
        if end < 0:
            continue
        row, at = slice(6 * i, 6 * i + 6), slice(6 * end, 6 * end + 6)
        out.g[end] += pencil.residual[row]
        for j, other in enumerate(ends):
            if other < 0:
                continue
            column, beside = slice(6 * j, 6 * j + 6), slice(6 * other, 6 * other + 6)
            for total, part in ((out.M, pencil.M), (out.C, pencil.C), (out.K, pencil.rest)):
                total[at, beside] += part[row, column]


def _state(k: Kinematics, body: int, at: Array) -> tuple[Array, Array, Array]:
    if body < 0:
        return at, np.zeros(6), np.zeros(6)
    return k.poses[body] @ at, k.Y[body], k.A[body]


def _between(w: Array, k: Array, c: Array) -> Pencil:
    """w on b and −w on a, both at one point in one set of axes: with ρ = ξ_b − ξ_a, δw = k ρ + c ρ̇ + ξ_a ×* w."""
    drag = on_ends(np.zeros((1, 6, 6)), sp.cross(w)[None])[0]  # taken along with b: −ρ ×* w
    damping = on_ends(c[None], c[None])[0]
    return Pencil(np.concatenate([-w, w]), np.zeros((12, 12)), damping, drag, k)


def _spring(tree: Tree, k: Kinematics, s: Spring, out: Cartesian) -> None:
    ends = tree.body(s.body_a), tree.body(s.body_b)
    (xa, ya, _), (xb, yb, _) = (
        _state(k, e, sp.pose(np.eye(3), p)) for e, p in zip(ends, (s.point_a, s.point_b), strict=True)
    )
    pa, pb = xa[:3, 3], xb[:3, 3]
    d = pb - pa
    length = float(np.linalg.norm(d))
    if length == 0.0:
        raise MechanismError(f"spring {s.body_a!r}–{s.body_b!r}: its ends coincide: it has no direction; move one")
    n = d / length
    velocity = np.hstack([np.eye(3), -sp.skew(pb)])  # of the point at p_b, from a twist at the origin
    line = np.concatenate([n, np.cross(pb, n)])  # wrench of a unit force along the spring
    # seen from a: δd = velocity ρ, its direction turns by the part across
    across = (np.eye(3) - np.outer(n, n)) / length
    seen = yb - ya
    slip = seen[:3] + np.cross(seen[3:], pb)  # velocity of b's point seen from a
    tension = s.stiffness * (length - s.rest) + s.damping * float(n @ slip)
    # δ(rate) seen from a = slip·δn + n·δslip, with δslip = velocity ρ̇ + ρ_ω × slip
    tilt = across @ velocity
    rate_k = slip @ tilt
    rate_k[3:] -= n @ sp.skew(slip)
    force_k = np.outer(n, s.stiffness * (n @ velocity) + s.damping * rate_k) + tension * tilt
    moment = np.vstack([np.eye(3), sp.skew(pb)])
    kk = moment @ force_k
    kk[3:] += tension * (-sp.skew(n)) @ velocity  # the arm p_b moves with b
    # ρ̇ is the relative twist's rate seen from a
    c = s.damping * np.outer(line, n @ velocity)
    kk = kk - c @ sp.ad(ya)
    _add(out, ends, _between(tension * line, kk, c))


def _beam(tree: Tree, k: Kinematics, beam: Beam, ends: tuple[int, ...], beta: Array, out: Cartesian) -> None:
    (xa, ya, aa), (xb, yb, _) = (_state(k, e, x) for e, x in zip(ends[:2], (beam.at_a, beam.at_b), strict=True))
    massive = len(beam.beams.points.element) > 0
    scale = max(float(np.abs(ya).max()), 1e-30)
    if massive and (np.abs(yb - ya).max() > 1e-9 * scale or np.abs(aa).max() > 1e-9 * scale**2):
        raise MechanismError(
            f"beam {beam.body_a!r}–{beam.body_b!r}: it has mass, so its ends must turn together and steadily; lump its mass, "
            "or fix the motion between its ends"
        )
    to_a = sp.adjoint(sp.inverse(xa))
    frame = to_a @ ya
    fall = to_a @ np.concatenate([tree.mechanism.gravity, np.zeros(3)])
    x = sp.inverse(xa) @ xb
    p = beam_pencil(beam.beams, x[None], beta[None], frame[None], fall[None])
    M, C, K = p.M[0], p.C[0], p.rest[0]
    if beam.damping.any():
        E = strain_rate(beam.beams.measure, beam.beams.rest, beam.beams.shortening, x[None])
        d = np.swapaxes(E, -1, -2) @ beam.damping @ E
        C = C.copy()
        C[:12, :12] += on_ends(d, d)[0]
    # from ξ seen in the rotating frame to rates in the ground: ξ̇_r = ξ̇ − V × ξ
    turn, own = np.zeros_like(K), np.eye(len(K))
    turn[:6, :6] = turn[6:12, 6:12] = sp.ad(frame)
    own[:6, :6] = own[6:12, 6:12] = to_a
    K = K - C @ turn + M @ turn @ turn
    C = C - 2.0 * M @ turn
    spring = to_a.T @ p.spring[0] @ to_a
    _add(out, ends, Pencil(own.T @ p.residual[0], own.T @ M @ own, own.T @ C @ own, own.T @ K @ own, spring))


def _weld(body: int, copy: int, w: Array, out: Cartesian) -> None:
    """Equal and opposite reactions; δ(reaction) beyond what moves with the copy is left to the multipliers."""
    zero = np.zeros((6, 6))
    _add(out, (copy, body), _between(w, -0.5 * sp.cross(w), zero))


def reduced_mass(k: Kinematics, c: Cartesian) -> Array:
    """M* = Bᵀ M B (eq. 10)."""
    B = k.B.reshape(-1, k.B.shape[-1])
    return B.T @ c.M @ B


def unbalanced(tree: Tree, k: Kinematics, c: Cartesian, q: Array, v: Array) -> Array:
    """τ = M* v̇ − Q* (n,): the generalised forces that would be needed (eq. 8, 11)."""
    out = np.einsum("bin,bi->n", k.B, c.g)
    for s in tree.mechanism.coordinate_springs:
        j = tree.coordinate(s.coordinate)
        out[j] += s.stiffness * (q[j] - s.rest) + s.damping * v[j]
    return out


def _rows(B: Array, body: int) -> Array:
    return B[body] if body >= 0 else np.zeros(B.shape[1:])


def tangent(tree: Tree, k: Kinematics, c: Cartesian) -> tuple[Array, Array, Array]:
    """Analytic M*, C*, K* (n, n) of τ with respect to accelerations, velocities and coordinates.

    M* = Bᵀ M B, C* = Bᵀ (2 M Ḃ + C B), K* = Bᵀ (M B̈ + C Ḃ + K B) + G with G_kj = −(J_j × J_k)ᵀ f_j for j beyond k, f_j the
    total wrench on all that coordinate j carries: the turning of the screws against the forces they pass on.
    """
    n = k.J.shape[1]
    B, B1, B2 = (b.reshape(-1, n) for b in (k.B, k.B1, k.B2))
    MB1 = c.M @ B1
    M = B.T @ c.M @ B
    C = B.T @ (2.0 * MB1 + c.C @ B)
    carried = tree.carries.T.astype(float) @ c.g[: len(tree.bodies)]  # f_j
    force = -(np.swapaxes(sp.ad(k.J.T), -1, -2) @ carried[..., None])[..., 0]  # J_j ×* f_j
    below = (tree.above.astype(float) - np.eye(n)).T  # below[k, j]: j hangs beyond k
    K = B.T @ (c.M @ B2 + c.C @ B1 + c.K @ B) + below * (k.J.T @ force.T)
    if c.springs:
        stretch = np.concatenate([_rows(k.B, b) - _rows(k.B, a) for a, b, _ in c.springs])
        force = np.concatenate([spring @ (_rows(k.B, b) - _rows(k.B, a)) for a, b, spring in c.springs])
        K = K + stretch.T @ force
    for s in tree.mechanism.coordinate_springs:
        j = tree.coordinate(s.coordinate)
        K[j, j] += s.stiffness
        C[j, j] += s.damping
    return M, C, K
