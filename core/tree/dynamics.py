"""Cartesian equations of a tree and their projection M* v̇ = Q* (Park et al. 2010, eq. 1, 5–11).

All wrenches act on the bodies at the ground's origin, in its axes. ``Cartesian`` collects the total wrench g that inertia and
forces leave unbalanced, and its variation ``M ξ̈ + C ξ̇ + K ξ`` with the small twists ξ of the bodies, block by block.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..element import beams as bm
from ..element.measures import response
from ..mechanism.description import Load, MechanismError, Spring
from ..space import spatial as sp
from ..space.inertia import transformed
from .kinematics import Kinematics, carried, projected
from .scales import length_at
from .topology import Batch, Tree

Array = NDArray[np.float64]

_STEADY = 1e-9  # change of a beam's motion, as a fraction of its rate, in units of the mechanism's length


@dataclass(frozen=True)
class Cartesian:
    """Total wrench g (b + m, 6) and its linearisation M, C, K by blocks; rows as those of B, beams' internal forces last.

    ``blocks`` (p, 3, 6, 6) are parts of M, C, K on rows ``row`` and columns ``column`` (p,); those at the same place add up.

    ``size`` (b + m, 6) is the sum of the absolute values of the parts of g; its rounding is proportional to it.
    ``stiffness`` (s, 6, 6) acts on ρ = ξ_b − ξ_a between two bodies ``ends`` (s, 2), −1 the ground. It is not part of K:
    ``B_b − B_a`` is exact, while the difference of their products would cancel.
    """

    g: Array
    size: Array
    row: NDArray[np.intp]
    column: NDArray[np.intp]
    blocks: Array
    ends: NDArray[np.intp]
    stiffness: Array

    @cached_property
    def M(self) -> csr_array:
        """(6 (b + m), 6 (b + m)), sparse."""
        return self._sparse(0)

    @cached_property
    def C(self) -> csr_array:
        """(6 (b + m), 6 (b + m)), sparse."""
        return self._sparse(1)

    @cached_property
    def K(self) -> csr_array:
        """(6 (b + m), 6 (b + m)), sparse."""
        return self._sparse(2)

    def _sparse(self, matrix: int) -> csr_array:
        six = np.arange(6)
        where = (6 * self.row[:, None] + six)[:, :, None], (6 * self.column[:, None] + six)[:, None, :]
        at = tuple(a.ravel() for a in np.broadcast_arrays(*where))
        return csr_array((self.blocks[:, matrix].ravel(), at), shape=(self.g.size, self.g.size))


class _Sum:
    """Accumulates wrenches and 6×6 blocks."""

    def __init__(self, rows: int) -> None:
        self.g = np.zeros((rows, 6))
        self.size = np.zeros((rows, 6))
        self.blocks: list[tuple[NDArray[np.intp], NDArray[np.intp], tuple[Array, Array, Array]]] = []
        self.springs: list[tuple[NDArray[np.intp], Array]] = []

    def add(self, ends: NDArray[np.intp], pencil: bm.Pencil) -> None:
        """Add wrenches (e, d) and matrices (e, d, d) of e elements on d/6 rows ``ends`` each, without those on the ground."""
        self.springs.append((ends[:, :2], pencil.spring))
        for i in range(ends.shape[1]):
            acts = ends[:, i] >= 0
            row = slice(6 * i, 6 * i + 6)
            np.add.at(self.g, ends[acts, i], pencil.residual[acts, row])
            np.add.at(self.size, ends[acts, i], np.abs(pencil.residual[acts, row]))
            for j in range(ends.shape[1]):
                on_bodies_both = acts & (ends[:, j] >= 0)
                column = slice(6 * j, 6 * j + 6)
                M, C, K = (part[on_bodies_both, row, column] for part in (pencil.M, pencil.C, pencil.remainder))
                self.blocks.append((ends[on_bodies_both, i], ends[on_bodies_both, j], (M, C, K)))

    def total(self) -> Cartesian:
        """The sum as a ``Cartesian``."""
        row = np.concatenate([part[0] for part in self.blocks])
        column = np.concatenate([part[1] for part in self.blocks])
        blocks = np.stack([np.concatenate([part[2][k] for part in self.blocks]) for k in range(3)], axis=1)
        ends, stiffness = zip(*self.springs, strict=True) if self.springs else (_NO_ENDS, _NO_SPRINGS)
        return Cartesian(self.g, self.size, row, column, blocks, np.concatenate(ends), np.concatenate(stiffness))


_NO_ENDS, _NO_SPRINGS = (np.zeros((0, 2), dtype=np.intp),), (np.zeros((0, 6, 6)),)


def cartesian(tree: Tree, k: Kinematics) -> Cartesian:
    """Gather inertia, gravity, springs, beams and loads, without the reactions of cut joints.

    Raises:
        MechanismError: a beam with mass whose ends do not move together in the steady state.
    """
    out = _Sum(len(k.poses) + len(tree.first_internal))  # g = M Ẏ + Φᶜ_Zᵀ λ − Q, which Φᴶ and Φᴹ must balance (eq. 1)
    _bodies(tree, k, out)
    for spring in tree.mechanism.springs:
        _spring(tree, k, spring, out)
    for load in tree.mechanism.loads:
        _load(tree, k, load, out)
    for batch in tree.batches:
        _beams(tree, k, batch, out)
    return out.total()


def with_reactions(tree: Tree, c: Cartesian, multipliers: Array) -> Cartesian:
    """The same with the reactions of cut joints: ``multipliers`` (w, 6), wrench of each weld on the body, reversed on the copy.

    They follow the bodies; only the multipliers vary.
    """
    out = _Sum(len(c.g))
    for weld, w in zip(tree.welds, multipliers, strict=True):
        out.add(np.array([weld[::-1]]), _between(w, np.zeros((6, 6)), np.zeros((6, 6))))
    reactions = out.total()
    return Cartesian(
        c.g + reactions.g,
        c.size + reactions.size,
        *(
            np.concatenate([getattr(part, name) for part in (c, reactions)])
            for name in ("row", "column", "blocks", "ends", "stiffness")
        ),
    )


def inertias(tree: Tree, k: Kinematics) -> Array:
    """(b, 6, 6) inertias of the bodies at the ground's origin, in its axes."""
    return transformed(tree.inertia, k.poses)


def _bodies(tree: Tree, k: Kinematics, out: _Sum) -> None:
    """g = M (A − a_g) + Y ×* M Y; following the body, δg = M ξ̈ + (Y ×* M − M Y × + M Y ×̄*) ξ̇ − M a_g × ξ."""
    M = inertias(tree, k)
    fall = np.concatenate([tree.mechanism.gravity, np.zeros(3)])
    ad_Y = sp.ad(k.Y)
    momentum = (M @ k.Y[..., None])[..., 0]
    out.g[: len(M)] += (M @ (k.A - fall)[..., None] - np.swapaxes(ad_Y, -1, -2) @ momentum[..., None])[..., 0]
    lever = np.abs(sp.adjoint(sp.inverse(k.poses)))
    parts_of_M = np.swapaxes(lever, -1, -2) @ np.abs(tree.inertia) @ lever  # M and M Y may cancel
    parts = parts_of_M @ (np.abs(k.A) + np.abs(fall))[..., None]
    parts += np.abs(np.swapaxes(ad_Y, -1, -2)) @ parts_of_M @ np.abs(k.Y)[..., None]
    out.size[: len(M)] += parts[..., 0]
    mt = M @ ad_Y
    C = -np.swapaxes(mt, -1, -2) - mt - sp.coadjoint(momentum)
    bodies = np.arange(len(M))
    out.blocks.append((bodies, bodies, (M, C, -M @ sp.ad(fall))))


def _state(k: Kinematics, body: NDArray[np.intp], at: Array) -> tuple[Array, Array, Array]:
    """Poses (e, 4, 4) of frames ``at`` in bodies, and the bodies' twists and their rates (e, 6); −1 is the ground."""
    zeros = np.zeros((1, 6))
    x = np.concatenate([k.poses, np.eye(4)[None]])[body] @ at
    return x, np.concatenate([k.Y, zeros])[body], np.concatenate([k.A, zeros])[body]


def _between(w: Array, k: Array, c: Array) -> bm.Pencil:
    """w on b and −w on a, both at one point in one set of axes: with ρ = ξ_b − ξ_a, δw = k ρ + c ρ̇ + ξ_a ×* w."""
    drag = bm.on_ends(np.zeros((1, 6, 6)), sp.coadjoint(w)[None])  # follows b: −ρ ×* w
    damping = bm.on_ends(c[None], c[None])
    return bm.Pencil(np.concatenate([-w, w])[None], np.zeros((1, 12, 12)), damping, drag, k[None])


def _spring(tree: Tree, k: Kinematics, s: Spring, out: _Sum) -> None:
    ends = np.array([tree.body(s.body_a), tree.body(s.body_b)])
    x, (ya, yb), _ = _state(k, ends, sp.pose(np.eye(3), np.array([s.point_a, s.point_b])))
    pa, pb = x[:, :3, 3]
    d = pb - pa
    length = float(np.linalg.norm(d))
    if length == 0.0:
        raise MechanismError(f"spring {s.body_a!r}–{s.body_b!r}: its ends coincide, so it has no direction; move one")
    n = d / length
    velocity = np.hstack([np.eye(3), -sp.skew(pb)])  # of the point at p_b, from a twist at the origin
    line = np.concatenate([n, np.cross(pb, n)])  # wrench of a unit force along the spring
    # seen from a: δd = velocity ρ, its direction turns by the part across
    across = (np.eye(3) - np.outer(n, n)) / length
    relative = yb - ya
    slip = relative[:3] + np.cross(relative[3:], pb)  # velocity of b's point seen from a
    tension = s.stiffness * (length - s.free_length) + s.damping * float(n @ slip)
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
    out.add(ends[None], _between(tension * line, kk, c))


def _load(tree: Tree, k: Kinematics, load: Load, out: _Sum) -> None:
    """g = −w; w stays in its axes while the body turns by ξ_ω: seen from the body, δw = −ξ_ω × w, at its origin."""
    body, axes = tree.body(load.body), tree.body(load.axes_of)
    if body < 0:
        return
    x = np.concatenate([k.poses, np.eye(4)[None]])
    to_body = sp.adjoint(sp.inverse(x[body]))
    force = x[body, :3, :3].T @ x[axes, :3, :3] @ load.force
    K = np.zeros((6, 6))
    K[:3, 3:] = -sp.skew(force)
    out.g[body] -= to_body[:3].T @ force
    row, zeros = np.array([body]), np.zeros((1, 6, 6))
    out.blocks.append((row, row, (zeros, zeros, (to_body.T @ K @ to_body)[None])))


def _beams(tree: Tree, k: Kinematics, batch: Batch, out: _Sum) -> None:
    a, b = batch.ends.T
    (xa, ya, aa), (xb, yb, _) = _state(k, a, batch.at_a), _state(k, b, batch.at_b)
    massive = batch.beams.internal_count > 0
    if massive:
        _check_steady(tree, batch, length_at(tree, k.poses), ya, yb, aa)
    to_a = sp.adjoint(sp.inverse(xa))
    frame = (to_a @ ya[..., None])[..., 0]
    fall = to_a @ np.concatenate([tree.mechanism.gravity, np.zeros(3)])
    x = sp.inverse(xa) @ xb
    beta = k.q[batch.first_internal[:, None] + np.arange(6)] if massive else np.zeros((len(a), 0))
    load_axes = np.concatenate([k.poses, np.eye(4)[None]])[batch.axes, :3, :3]
    axes = np.swapaxes(xa[:, :3, :3], -1, -2) @ load_axes
    p = bm.pencil(bm.relative_pencil(batch.beams, x, beta, frame, fall, axes=axes))
    M, C, K = p.M, p.C, p.remainder
    if batch.damping.any():
        E = response(batch.beams.law, x, beta).rate[..., :6]
        d = np.swapaxes(E, -1, -2) @ batch.damping @ E
        C = C.copy()
        C[:, :12, :12] += bm.on_ends(d, d)
    # from ξ seen in the rotating frame to rates in the ground: ξ̇_r = ξ̇ − V × ξ
    ad_frame, local = np.zeros_like(K), np.broadcast_to(np.eye(K.shape[-1]), K.shape).copy()
    ad_frame[:, :6, :6] = ad_frame[:, 6:12, 6:12] = sp.ad(frame)
    local[:, :6, :6] = local[:, 6:12, 6:12] = to_a
    K = K - C @ ad_frame + M @ ad_frame @ ad_frame
    C = C - 2.0 * M @ ad_frame
    to_ground = np.swapaxes(local, -1, -2)
    ends = np.column_stack([batch.ends, batch.internal_row]) if massive else batch.ends
    spring = np.swapaxes(to_a, -1, -2) @ p.spring @ to_a
    residual = (to_ground @ p.residual[..., None])[..., 0]
    out.add(ends, bm.Pencil(residual, to_ground @ M @ local, to_ground @ C @ local, to_ground @ K @ local, spring))


def _check_steady(tree: Tree, batch: Batch, length: float, ya: Array, yb: Array, aa: Array) -> None:
    unit = np.repeat([length, 1.0], 3)
    rate, opening, acceleration = (np.abs(y / unit).max(1) for y in (ya, yb - ya, aa))
    unsteady = (opening > _STEADY * rate) | (acceleration > _STEADY * rate**2)
    if unsteady.any():
        beam = tree.mechanism.beams[batch.index[int(unsteady.argmax())]]
        raise MechanismError(
            f"beam {beam.body_a!r}–{beam.body_b!r}: it has mass, but its ends do not move together steadily; lump its mass, "
            "or fix the motion between its ends"
        )


def reduced_mass(k: Kinematics, c: Cartesian) -> Array:
    """M* = Bᵀ M B."""
    B = k.B.reshape(-1, k.B.shape[-1])
    return B.T @ c.M @ B  # (eq. 10)


def unbalanced(tree: Tree, k: Kinematics, c: Cartesian, q: Array, v: Array) -> Array:
    """τ = M* v̇ + Φᶜ_qᵀ λ − Q* (n,): the generalised forces that would balance the tree."""
    # Bᵀ (M (B v̇ + Ḃ v) + Φᶜ_Zᵀ λ − Q), from which Bᵀ Φᴶ_Zᵀ = 0 drops the reactions of the tree's joints (eq. 5)
    out = projected(k, c.g)
    for s in tree.mechanism.coordinate_springs:
        j = tree.coordinate(s.coordinate)
        out[j] += s.stiffness * (q[j] - s.neutral) + s.damping * v[j]
    return out


def tangent(tree: Tree, k: Kinematics, c: Cartesian) -> tuple[Array, Array, Array]:
    """Analytic M*, C*, K* (n, n) of τ with respect to accelerations, velocities and coordinates.

    M* = Bᵀ M B, C* = Bᵀ (2 M Ḃ + C B), K* = Bᵀ (M B̈ + C Ḃ + K B) + ``joint_stiffness``.
    """
    B, B1, B2 = (rows.reshape(-1, rows.shape[-1]) for rows in (k.B, k.B1, k.B2))
    on_bodies = (c.M @ B, 2.0 * (c.M @ B1) + c.C @ B, c.M @ B2 + c.C @ B1 + c.K @ B)
    M, C, K = (projected(k, np.reshape(w, (-1, 6, B.shape[-1]))) for w in on_bodies)  # (eq. 10)
    j = tree.joints
    K[:j, :j] += joint_stiffness(tree, k, c)
    for s in tree.mechanism.coordinate_springs:
        i = tree.coordinate(s.coordinate)
        C[i, i] += s.damping
    return M, C, K


def joint_stiffness(tree: Tree, k: Kinematics, c: Cartesian) -> Array:
    """Springs on coordinates and between bodies, and G (j, j): the part of K* that is not a projection of K.

    G_ik = −(J_i × J_k)ᵀ f_i for i beyond k, f_i the total wrench on all bodies that coordinate i carries: the rotation of the
    screws relative to the forces they transmit.
    """
    j = tree.joints
    transmitted = carried(tree, c.g[: len(tree.bodies)])[:j]  # f_i
    force = -(np.swapaxes(sp.ad(k.J.T[:j]), -1, -2) @ transmitted[..., None])[..., 0]  # J_i ×* f_i
    descends = tree.moves_link[:j, :j] & ~np.eye(j, dtype=bool)
    K = descends.T * (k.J.T[:j] @ force.T)
    rows = np.append(k.B[: len(tree.bodies), :, :j], np.zeros((1, 6, j)), axis=0)
    for (a, b), stiffness in zip(c.ends, c.stiffness, strict=True):
        strain = rows[b] - rows[a]  # exact: columns of both ends cancel
        between = np.flatnonzero(strain.any(axis=0))
        K[np.ix_(between, between)] += strain[:, between].T @ stiffness @ strain[:, between]
    for s in tree.mechanism.coordinate_springs:
        i = tree.coordinate(s.coordinate)
        K[i, i] += s.stiffness
    return K
