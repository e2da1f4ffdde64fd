"""Beam elements with mass: elastic between their end frames, inertia at points that ride on both ends.

A point inside an element sits at ``exp ζ`` in the frame of end a, with ``ζ = ζ₀ + L (η − η₀)`` and η the logarithm of the
relative pose of b: the undeformed element's static shape functions, kept in the coordinates in which an arc is straight.
Its twist is ``ξ_a + H ρ``, ``H = tangent(ζ) L tangent⁻¹(η)``, so its inertia couples both ends: a consistent mass. With the
mass lumped at the nodes there are no such points.
"""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import elements, inertia
from . import spatial as sp
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


def place(beams: Beams, points: Points, eta: Array, back: Array, beta: Array) -> tuple[Array, Array]:
    """Logarithms ζ (q, 6) of the points' poses in the frames a, and ∂ζ/∂(ρ, β) (q, 6, 12).

    From η and β (n, 6), and ``back`` (n, 6, 6) = ``tangent_inverse(eta)``.
    """
    e = points.element
    zeta = (
        points.rest + (points.shape @ (eta - beams.law.eta)[e][..., None] + points.bubble @ beta[e][..., None])[..., 0]
    )
    return zeta, np.concatenate([points.shape @ back[e], points.bubble], axis=-1)


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
    rate = elements.strain_rate(beams.law, beams.rest, np.zeros((len(rho), 6)))
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
    eta = sp.log(x)
    back = sp.tangent_inverse(eta)
    r = elements.response(beams.law, x, eta, back, elements.inner(beams.law, beta))
    s = beams.preload + (beams.stiffness @ r.strain[..., None])[..., 0]
    turned = np.swapaxes(r.rate, -1, -2)
    w = (turned @ s[..., None])[..., 0]
    d = 12 + beams.inner
    none = np.zeros((len(x), d, d))
    out = Pencil(np.concatenate([-w[:, :6], w[:, : d - 6]], axis=-1), none, none, none, none[:, :6, :6])
    inside = np.zeros_like(eta)
    if beams.inner:
        out, inside = _with_inertia(out, beams, eta, back, beta, frame, gravity, model, axes)
    K = turned @ beams.stiffness @ r.rate
    if model.geometric:
        K = K + r.curvature(s, inside)
    rest = out.rest.copy()
    if beams.inner:  # what acts between the ends and β; between the ends alone stays a spring
        K_beta = K[:, 6:].copy()
        rest[:, 12:, 6:] += K_beta
        rest[:, 12:, :6] -= K_beta[..., :6]
        rest[:, 6:12, 12:] += K[:, :6, 6:]
        rest[:, :6, 12:] -= K[:, :6, 6:]
    if model.geometric:
        none = np.zeros((len(x), 6, 6))
        rest[:, :12, :12] += on_ends(none, sp.cross(out.residual[:, 6:12]))  # −ρ ×* (wrench on b)
    return replace(out, rest=rest, spring=out.spring + K[:, :6, :6])


def on_ends(on_a: Array, on_b: Array) -> Array:
    """(n, 12, 12) from −on_a ρ on end a and on_b ρ on end b, with ρ = ξ_b − ξ_a."""
    out = np.empty((len(on_a), 12, 12))
    out[:, :6, :6], out[:, :6, 6:] = on_a, -on_a
    out[:, 6:, :6], out[:, 6:, 6:] = -on_b, on_b
    return out


def _with_inertia(
    out: Pencil,
    beams: Beams,
    eta: Array,
    back: Array,
    beta: Array,
    frame: Array,
    gravity: Array,
    model: Model,
    axes: Array | None,
) -> tuple[Pencil, Array]:
    """Add the points' inertia: wrench g at a point whose twist is ξ_a + H (ρ, β) acts as Hᵀ g on them, and the rest on a.

    Also returns the force (n, 6) conjugate to η that it makes.
    """
    points, e, n = beams.points, beams.points.element, len(eta)
    zeta, slope = place(beams, points, eta, back, beta)
    T = sp.tangent(zeta)
    H = T @ slope
    to_point = sp.adjoint(sp.exp(-zeta))
    g, C, K = inertia.carried(
        points.mass,
        (to_point @ frame[e][..., None])[..., 0],
        (to_point @ gravity[e][..., None])[..., 0],
        follow=model.geometric,
        push=None if axes is None else (to_point[:, :3, :3] @ axes[e] @ points.force[..., None])[..., 0],
    )
    g = (np.swapaxes(to_point, -1, -2) @ g[..., None])[..., 0]  # from here on in a's axes, at a
    seen = np.concatenate([np.eye(6) - H[..., :6], H], axis=-1)  # from (ξ_a, ξ_b, β)
    ride = to_point @ seen

    def total(left: Array, right: Array) -> Array:
        """Σ leftᵀ right over the points of each element, from (q, 6, i) and (q, 6, j)."""
        a, b = (v.reshape(n, -1, v.shape[-1]) for v in (left, right))
        return np.swapaxes(a, -1, -2) @ b

    residual = out.residual + total(seen, g[..., None])[..., 0]
    residual[:, 12:] += beams.inner_preload + beta
    rest, spring = out.rest + total(ride, K @ ride), out.spring
    rest[:, 12:, 12:] += np.eye(6)
    conjugate = np.zeros_like(eta)
    if model.geometric:
        # D_a g = D_point g − cross(g) H (ρ, β), and ∂(Hᵀg)/∂(ρ, β) is a spring between the ends and β, H = T(ζ) ∂ζ/∂(ρ, β)
        conjugate = total(points.shape, np.swapaxes(T, -1, -2) @ g[..., None])[..., 0]
        bend = total(slope, sp.tangent_transpose_derivative(zeta, g) @ slope)
        swing = -total(seen, sp.cross(g) @ H)
        spring = spring + bend[:, :6, :6]  # this part is kept in the spring
        bend[:, :6, :6] = 0.0
        swing[:, 6:] += bend
        swing[:, :6] -= bend[:, :6]
        rest[:, :, 6:] += swing
        rest[:, :, :6] -= swing[:, :, :6]
    return Pencil(residual, total(ride, points.mass @ ride), total(ride, C @ ride), rest, spring), conjugate
