"""Beam elements with mass: elastic between their end frames, inertia at points that ride on both ends.

A point inside an element sits at ``exp ζ`` in the frame of end a, with ``ζ = ζ₀ + L (η − η₀)`` and η the logarithm of the
relative pose of b: the undeformed element's static shape functions, kept in the coordinates in which an arc is straight.
Its twist is ``ξ_a + H ρ``, ``H = tangent(ζ) L tangent⁻¹(η)``, so its inertia couples both ends: a consistent mass. With the
mass lumped at the nodes there are no such points.
"""

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import elements, inertia, rigid
from . import spatial as sp
from .compiled import apply, clear, compiled, congruence, product, turned_apply
from .elements import Law, Measure
from .model import FULL, Model

Array = NDArray[Any]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Points:
    """Points riding on the elements' ends, sorted by element; those with mass as many on each element.

    Attributes:
        element: (q,) the element each rides on.
        rest: (q, 6) ζ₀, logarithm of the rest pose in the frame of end a.
        shape: (q, 6, 6) L, ζ from η.
        bubble: (q, 6, 6) ζ from the element's internal coordinates β.
        mass: (q, 6, 6) inertia in the point's own frame, quadrature weight included.
        force: (q, 3) steady load on it, N, in the axes of the rotating frame; none by default.
    """

    element: Index
    rest: Array
    shape: Array
    bubble: Array
    mass: Array
    force: Array = field(default_factory=lambda: np.zeros((0, 3)))

    def __post_init__(self) -> None:
        if not self.force.size:
            object.__setattr__(self, "force", np.zeros((len(self.element), 3)))


_NONE = np.zeros((0, 6, 6))
NO_POINTS = Points(np.zeros(0, dtype=np.intp), np.zeros((0, 6)), _NONE, _NONE, _NONE)


@dataclass(frozen=True)
class Beams:
    """A batch of n elements.

    Attributes:
        law: how they measure strain.
        stiffness: (n, 6, 6) for that measure.
        points: the inertia inside, as many points in each element (see ``alike``).
        preload: (n, 6) force conjugate to the strain, at zero strain.
        inner_preload: (n, 6) force conjugate to β, at β = 0.
    """

    law: Law
    stiffness: Array
    points: Points
    preload: Array
    inner_preload: Array

    @property
    def rest(self) -> Array:
        """(n, 4, 4) rest pose of end b in the frame of end a."""
        return self.law.rest

    @property
    def inner(self) -> int:
        """How many internal coordinates an element has: six where it has mass inside, else none."""
        return 6 if len(self.points.element) else 0


@dataclass(frozen=True)
class Pencil:
    """Residual (n, d) on ends a, b and internal coordinates β, and its linearisation M, C, K, each (n, d, d); d = 12 or 18.

    Twists and wrenches are in a snapshot of each element's frame a; variations of wrenches are taken along with the body
    they act on, and ξ is seen in the rotating frame. K is split into ``rest`` (n, d, d) and the ``spring`` (n, 6, 6) that
    acts on ρ = ξ_b − ξ_a: kept apart, its energy loses no digits to cancellation.
    """

    residual: Array
    M: Array
    C: Array
    rest: Array
    spring: Array

    @property
    def K(self) -> Array:
        """The whole stiffness."""
        K = self.rest.copy()
        K[:, :12, :12] += on_ends(self.spring, self.spring)
        return K


def end_stiffness(measure: Measure, rest: Array, twist_stiffness: Array) -> Array:
    """Stiffness (n, 6, 6) for a strain measure from that for the twist of b seen from a, at rest."""
    a = sp.tangent(sp.log(rest)) if measure == "corotational" else sp.adjoint(rest)
    return np.swapaxes(a, -1, -2) @ twist_stiffness @ a


def riding(rest: Array, element: Index, pose: Array, shape: Array, bubble: Array, mass: Array) -> Points:
    """Points at rest poses ``pose`` (q, 4, 4) whose twists are ``shape`` (q, 6, 6) times that of b plus ``bubble`` β."""
    zeta = sp.log(pose)
    slope = sp.tangent_inverse(zeta)
    L = slope @ shape @ sp.tangent(sp.log(rest))[element]
    return Points(element=element, rest=zeta, shape=L, bubble=slope @ bubble, mass=mass)


def alike(points: Points, elements: int) -> Points:
    """The same points, with massless ones added until every element has as many: what ``Beams`` wants."""
    number = np.bincount(points.element, minlength=elements)
    most = int(number.max())
    if (number == most).all():
        return points
    rank = np.arange(most)
    first = np.cumsum(number) - number
    pick = (first[:, None] + np.minimum(rank, number[:, None] - 1)).ravel()  # the last one again
    real = (rank < number[:, None]).ravel()
    return Points(
        element=np.repeat(np.arange(elements), most),
        rest=points.rest[pick],
        shape=points.shape[pick],
        bubble=points.bubble[pick],
        mass=points.mass[pick] * real[:, None, None],
        force=points.force[pick] * real[:, None],
    )


def place(beams: Beams, points: Points, eta: Array, beta: Array) -> tuple[Array, Array]:
    """Logarithms ζ (q, 6) of the points' poses in the frames a, and ∂ζ/∂(ρ, β) (q, 6, 12), from the η and β (q, 6) there."""
    change = eta - beams.law.eta[points.element]
    zeta = points.rest + (points.shape @ change[..., None] + points.bubble @ beta[..., None])[..., 0]
    return zeta, np.concatenate([points.shape @ sp.tangent_inverse(eta), points.bubble], axis=-1)


def bushing(rest: Array, stiffness: Array, preload: Array | None = None, measure: Measure = "corotational") -> Beams:
    """One massless element with a given 6×6 stiffness for its strain, between frames at relative pose ``rest`` (4, 4).

    Raises:
        ValueError: if the stiffness is not a symmetric 6×6 matrix.
    """
    k = np.asarray(stiffness, float)
    if k.shape != (6, 6) or not np.allclose(k, k.T, rtol=1e-9, atol=1e-12 * np.abs(k).max()):
        raise ValueError(f"stiffness: shape {k.shape}, or not symmetric: a bushing needs a symmetric 6×6 matrix")
    load = np.zeros(6) if preload is None else np.asarray(preload, float)
    return Beams(elements.even(measure, rest[None]), k[None], NO_POINTS, load[None], np.zeros((1, 6)))


def linear_force(beams: Beams, rho: Array) -> Array:
    """Force (n, 6) conjugate to the strain that small twists ρ (n, 6) of b seen from a cause, at rest."""
    rate = elements.response(beams.law, beams.rest, np.zeros((len(rho), 6))).rate[..., :6]
    return (beams.stiffness @ rate @ rho[..., None])[..., 0]


def massless(beams: Beams) -> Beams:
    """The same elements without the inertia inside."""
    return replace(beams, points=NO_POINTS)


def pencil(
    beams: Beams,
    x: Array,
    beta: Array,
    frame: Array,
    gravity: Array,
    model: Model = FULL,
    axes: Array | None = None,
) -> Pencil:
    """Assemble residual and matrices of all elements.

    Args:
        beams: the elements.
        x: (n, 4, 4) pose of b in the frame of a.
        beta: (n, 6) internal coordinates; (n, 0) for elements without mass inside.
        frame: (n, 6) twist of the rotating frame, in a's axes.
        gravity: (n, 6) free-fall acceleration as a twist, in a's axes.
        model: the effects kept (``geometric`` and ``coriolis`` matter here).
        axes: (n, 3, 3) from the rotating frame's axes to a's; needed if there are loads on the points.

    Raises:
        ValueError: loads without axes.
    """
    if axes is None and beams.points.force.any():
        raise ValueError("axes: not given, but there are loads on the points in the rotating frame's axes")
    n, d = len(x), 12 + beams.inner
    out = Pencil(np.empty((n, d)), *(np.empty((n, d, d)) for _ in range(3)), np.empty((n, 6, 6)))
    push = np.zeros((n, 3, 3)) if axes is None else axes
    given = (np.ascontiguousarray(v) for v in (x, beta if d > 12 else np.zeros((n, 6)), frame, gravity, push))
    _pencil(_arrays(beams), *given, model.geometric, out.residual, out.M, out.C, out.rest, out.spring)
    return out


def on_ends(on_a: Array, on_b: Array) -> Array:
    """(n, 12, 12) from −on_a ρ on end a and on_b ρ on end b, with ρ = ξ_b − ξ_a."""
    out = np.empty((len(on_a), 12, 12))
    out[:, :6, :6], out[:, :6, 6:] = on_a, -on_a
    out[:, 6:, :6], out[:, 6:, 6:] = -on_b, on_b
    return out


class _BeamArrays(NamedTuple):
    """``Beams`` for compiled code; ``pushed``: whether there are loads on the points."""

    law: elements.LawArrays
    stiffness: Array
    preload: Array
    inner_preload: Array
    rest: Array
    shape: Array
    bubble: Array
    mass: Array
    force: Array
    pushed: bool


def _arrays(beams: Beams) -> _BeamArrays:
    p = beams.points
    parts = (beams.stiffness, beams.preload, beams.inner_preload, p.rest, p.shape, p.bubble, p.mass, p.force)
    return _BeamArrays(
        elements.arrays(beams.law), *(np.ascontiguousarray(v, dtype=float) for v in parts), bool(p.force.any())
    )


class _Sums(NamedTuple):
    """One element's force (18,) and matrices (18, 18) on (ξ_a, ρ, β), and the force (6,) conjugate to η."""

    f: Array
    M: Array
    C: Array
    K: Array
    on_eta: Array


@compiled
def _pencil(
    beams: _BeamArrays,
    x: Array,
    beta: Array,
    frame: Array,
    fall: Array,
    axes: Array,
    geometric: bool,
    residual: Array,
    M: Array,
    C: Array,
    rest: Array,
    spring: Array,
) -> None:
    eta, back = np.empty(6), np.empty((6, 6))
    sums = _Sums(np.empty(18), np.empty((18, 18)), np.empty((18, 18)), np.empty((18, 18)), np.empty(6))
    for k in range(len(x)):
        rigid.log(x[k], eta)
        rigid.tangent_inverse(eta, back)
        for i in range(18):
            sums.f[i] = 0.0
        for i in range(6):
            sums.on_eta[i] = 0.0
        for matrix in (sums.M, sums.C, sums.K, spring[k]):
            clear(matrix)
        if len(beams.mass):
            _add_inertia(beams, k, eta, back, beta[k], frame[k], fall[k], axes[k], geometric, sums, spring[k])
            for i in range(6):
                sums.f[12 + i] += beams.inner_preload[k, i] + beta[k, i]
                sums.K[12 + i, 12 + i] += 1.0
        _add_elastic(beams, k, x[k], eta, back, beta[k], geometric, sums, spring[k])
        _on_ends(sums.M, M[k])
        _on_ends(sums.C, C[k])
        _on_ends(sums.K, rest[k])
        for i in range(len(residual[k])):
            residual[k, i] = sums.f[i]
        for i in range(6):
            residual[k, i] -= sums.f[6 + i]


@compiled
def _on_ends(of_rho: Array, out: Array) -> None:
    """From (ξ_a, ρ, β) to (ξ_a, ξ_b, β) with ρ = ξ_b − ξ_a."""
    d = len(out)
    for i in range(d):
        for j in range(d):
            out[i, j] = of_rho[i, j]
    for i in range(6):
        for j in range(d):
            out[i, j] -= of_rho[6 + i, j]
    for i in range(d):
        for j in range(6):
            out[i, j] -= out[i, 6 + j]


@compiled
def _add_elastic(
    beams: _BeamArrays,
    k: int,
    x: Array,
    eta: Array,
    back: Array,
    beta: Array,
    geometric: bool,
    sums: _Sums,
    spring: Array,
) -> None:
    """The strain's force on (ρ, β), and its material and geometric stiffness; what is between the ends alone to the spring."""
    strain, s = np.empty(6), np.empty(6)
    rate, J, undo = np.empty((6, 12)), np.empty((6, 12)), np.empty((6, 6))
    elements.strains(beams.law, k, x, eta, back, beta, strain, rate, J, undo)
    apply(beams.stiffness[k], strain, s)
    for i in range(6):
        s[i] += beams.preload[k, i]
    work, K = np.empty((6, 12)), np.empty((12, 12))
    congruence(rate, beams.stiffness[k], work, K)
    if geometric:
        elements.add_curvature(beams.law, k, eta, back, J, undo, rate, strain, s, sums.on_eta, K)
    force = np.empty(12)
    turned_apply(rate, s, force)
    for i in range(12):
        sums.f[6 + i] += force[i]
    _split(K, spring, sums.K)
    if geometric:  # −ρ ×* (wrench on b), on b alone
        crossed = np.empty((6, 6))
        rigid.cross(sums.f[6:12], crossed)
        for i in range(6):
            for j in range(6):
                sums.K[i, 6 + j] += crossed[i, j]
                sums.K[6 + i, 6 + j] += crossed[i, j]


@compiled
def _add_inertia(
    beams: _BeamArrays,
    k: int,
    eta: Array,
    back: Array,
    beta: Array,
    frame: Array,
    fall: Array,
    axes: Array,
    geometric: bool,
    sums: _Sums,
    spring: Array,
) -> None:
    """Add the points' inertia: wrench g at a point whose twist is ξ_a + H (ρ, β) acts on ξ_a, and as Hᵀ g on (ρ, β).

    All of it is in a's axes, at a, where all points of an element are carried at one twist.
    """
    per = len(beams.mass) // len(beams.stiffness)
    change, zeta, g, push, turned = np.empty(6), np.empty(6), np.empty(6), np.zeros(3), np.empty(6)
    from_point, pose, to_point = np.empty((4, 4)), np.empty((4, 4)), np.empty((6, 6))
    T, D = np.empty((6, 6)), np.empty((6, 6))
    M, C, K, work = np.empty((6, 6)), np.empty((6, 6)), np.empty((6, 6)), np.empty((6, 6))
    slopes, bent = np.empty((6 * per, 12)), np.empty((6 * per, 12))  # of all points, below each other
    U, MU, CU, KU = (np.empty((6 * per, 18)), np.empty((6 * per, 18)), np.empty((6 * per, 18)), np.empty((6 * per, 18)))
    H, turn = np.empty((6, 12)), np.empty((6, 6))
    rigid.ad(frame, turn)
    for i in range(6):
        change[i] = eta[i] - beams.law.eta[k, i]
    for p in range(per):
        point, at = per * k + p, slice(6 * p, 6 * p + 6)
        shape, bubble, slope = beams.shape[point], beams.bubble[point], slopes[at]
        for i in range(6):
            zeta[i] = beams.rest[point, i]
            for j in range(6):
                zeta[i] += shape[i, j] * change[j] + bubble[i, j] * beta[j]
                slope[i, 6 + j] = bubble[i, j]
        product(shape, back, slope)
        rigid.tangent(zeta, T)
        product(T, slope, H)
        rigid.exp(zeta, from_point)
        rigid.inverse(from_point, pose)
        rigid.adjoint(pose, to_point)
        congruence(to_point, beams.mass[point], work, M)
        inertia.carry(M, frame, turn, fall, g, C, K)
        if beams.pushed or not geometric:
            for i in range(3):
                push[i] = 0.0
                for j in range(3):
                    for m in range(3):
                        push[i] += pose[i, j] * axes[j, m] * beams.force[point, m]
            _hold_components(to_point, from_point, push, geometric, g, K)
        for i in range(6):
            sums.f[i] += g[i]
            for j in range(12):
                sums.f[6 + j] += H[i, j] * g[i]
        _ride(H, U[at])
        product(M, U[at], MU[at])
        product(C, U[at], CU[at])
        product(K, U[at], KU[at])
        if geometric:
            # D_a g = D_point g − cross(g) H (ρ, β), and ∂(Hᵀg)/∂(ρ, β) is a spring between the ends and β, H = T(ζ) ∂ζ/∂(ρ, β)
            rigid.cross(g, work)
            product(work, H, bent[at])
            for i in range(6 * p, 6 * p + 6):
                for j in range(12):
                    KU[i, 6 + j] -= bent[i, j]
            turned_apply(T, g, turned)
            for i in range(6):
                for j in range(6):
                    sums.on_eta[j] += shape[i, j] * turned[i]
            rigid.tangent_transpose_derivative(zeta, g, D)
            product(D, slope, bent[at])
    np.dot(U.T, MU, sums.M)
    np.dot(U.T, CU, sums.C)
    np.dot(U.T, KU, sums.K)
    if geometric:
        _split(np.dot(slopes.T, bent), spring, sums.K)


@compiled
def _ride(H: Array, out: Array) -> None:
    """(1, H) (6, 18): a point's twist from (ξ_a, ρ, β)."""
    for i in range(6):
        for j in range(6):
            out[i, j] = 0.0
        out[i, i] = 1.0
        for j in range(12):
            out[i, 6 + j] = H[i, j]


@compiled
def _split(k: Array, spring: Array, rest: Array) -> None:
    """Add a stiffness (12, 12) on (ρ, β): what is between the ends alone to ``spring``, else to ``rest`` (18, 18)."""
    for i in range(12):
        for j in range(12):
            if i < 6 and j < 6:
                spring[i, j] += k[i, j]
            else:
                rest[6 + i, 6 + j] += k[i, j]


@compiled
def _hold_components(to_point: Array, pose: Array, push: Array, follow: bool, g: Array, K: Array) -> None:
    """``inertia.hold_components`` at the point of a pose, whose axes and origin it is for, of g and K at a."""
    from_point = np.empty((6, 6))
    rigid.adjoint(pose, from_point)
    here, more, work, at_a = np.empty(6), np.zeros((6, 6)), np.empty((6, 6)), np.empty((6, 6))
    turned_apply(from_point, g, here)
    inertia.hold_components(here, push, follow, more)
    turned_apply(to_point, here, g)
    congruence(to_point, more, work, at_a)
    for i in range(6):
        for j in range(6):
            K[i, j] += at_a[i, j]
