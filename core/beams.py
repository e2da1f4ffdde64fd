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
from .elements import Measure
from .model import FULL, Model

Array = NDArray[Any]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Points:
    """Points riding on the elements' ends, sorted by element.

    Attributes:
        element: (q,) the element each rides on.
        rest: (q, 6) ζ₀, logarithm of the rest pose in the frame of end a.
        shape: (q, 6, 6) L, ζ from η.
        mass: (q, 6, 6) inertia in the point's own frame, quadrature weight included.
    """

    element: Index
    rest: Array
    shape: Array
    mass: Array


NO_POINTS = Points(np.zeros(0, dtype=np.intp), np.zeros((0, 6)), np.zeros((0, 6, 6)), np.zeros((0, 6, 6)))


@dataclass(frozen=True)
class Beams:
    """A batch of n elements.

    Attributes:
        measure: of strain, see ``elements``.
        rest: (n, 4, 4) rest pose of end b in the frame of end a.
        stiffness: (n, 6, 6) for that measure.
        points: the inertia inside.
        preload: (n, 6) force conjugate to the strain, at zero strain.
        eta: (n, 6) logarithm of ``rest``.
    """

    measure: Measure
    rest: Array
    stiffness: Array
    points: Points
    preload: Array
    eta: Array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "eta", sp.log(self.rest))


@dataclass(frozen=True)
class Pencil:
    """Residual wrench (n, 12) on ends (a, b) and its linearisation M ξ̈ + C ξ̇ + K ξ, each (n, 12, 12).

    Twists and wrenches are in a snapshot of each element's frame a; variations of wrenches are taken along with the body
    they act on, and ξ is seen in the rotating frame. K is split into ``rest`` (n, 12, 12) and the ``spring`` (n, 6, 6) that
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
        return self.rest + on_ends(self.spring, self.spring)


def end_stiffness(measure: Measure, rest: Array, twist_stiffness: Array) -> Array:
    """Stiffness (n, 6, 6) for a strain measure from that for the twist of b seen from a, at rest."""
    a = sp.tangent(sp.log(rest)) if measure == "corotational" else sp.adjoint(rest)
    return np.swapaxes(a, -1, -2) @ twist_stiffness @ a


def riding(rest: Array, element: Index, pose: Array, shape: Array, mass: Array) -> Points:
    """Points at rest poses ``pose`` (q, 4, 4) whose twists are ``shape`` (q, 6, 6) times that of b."""
    zeta = sp.log(pose)
    L = sp.tangent_inverse(zeta) @ shape @ sp.tangent(sp.log(rest))[element]
    return Points(element=element, rest=zeta, shape=L, mass=mass)


def place(beams: Beams, points: Points, eta: Array) -> tuple[Array, Array]:
    """Logarithms ζ (q, 6) of the points' poses in the frames a, and ∂ζ/∂ξ_b (q, 6, 6), from η (n, 6) of the ends."""
    e = points.element
    zeta = points.rest + (points.shape @ (eta - beams.eta)[e][..., None])[..., 0]
    return zeta, points.shape @ sp.tangent_inverse(eta)[e]


def linear_force(beams: Beams, rho: Array) -> Array:
    """Force (n, 6) conjugate to the strain that small twists ρ (n, 6) of b seen from a cause, at rest."""
    rate = elements.strain_rate(beams.measure, beams.rest, beams.rest)
    return (beams.stiffness @ rate @ rho[..., None])[..., 0]


def massless(beams: Beams) -> Beams:
    """The same elements without the inertia inside."""
    return replace(beams, points=NO_POINTS)


def prestressed(beams: Beams, preload: Array) -> Beams:
    """The same elements with another preload."""
    return replace(beams, preload=preload)


def pencil(beams: Beams, x: Array, frame: Array, gravity: Array, model: Model = FULL) -> Pencil:
    """Assemble residual and matrices of all elements.

    Args:
        beams: the elements.
        x: (n, 4, 4) pose of b in the frame of a.
        frame: (n, 6) twist of the rotating frame, in a's axes.
        gravity: (n, 6) free-fall acceleration as a twist, in a's axes.
        model: the effects kept (``geometric`` and ``coriolis`` matter here).
    """
    eta = sp.log(x)
    s, E = elements.force(beams.measure, beams.rest, x, beams.stiffness, beams.preload)
    Et = np.swapaxes(E, -1, -2)
    w = (Et @ s[..., None])[..., 0]
    spring = Et @ beams.stiffness @ E
    if model.geometric:
        spring = spring + elements.wrench_derivative(beams.measure, beams.rest, x, s)
    none = np.zeros((len(x), 12, 12))
    out = Pencil(np.concatenate([-w, w], axis=-1), none, none, none, spring)
    if len(beams.points.element):
        out = _with_inertia(out, beams, eta, frame, gravity, model)
    if not model.geometric:
        return out
    taken_along = on_ends(np.zeros_like(spring), sp.cross(out.residual[:, 6:]))  # −ρ ×* (wrench on b)
    return replace(out, rest=out.rest + taken_along) if len(beams.points.element) else replace(out, rest=taken_along)


def on_ends(on_a: Array, on_b: Array) -> Array:
    """(n, 12, 12) from −on_a ρ on end a and on_b ρ on end b, with ρ = ξ_b − ξ_a."""
    out = np.empty((len(on_a), 12, 12))
    out[:, :6, :6], out[:, :6, 6:] = on_a, -on_a
    out[:, 6:, :6], out[:, 6:, 6:] = -on_b, on_b
    return out


def _with_inertia(out: Pencil, beams: Beams, eta: Array, frame: Array, gravity: Array, model: Model) -> Pencil:
    """Add the points' inertia: wrench g at a point whose twist is ξ_a + H ρ acts as (I − H)ᵀ g on a and Hᵀ g on b."""
    points, e = beams.points, beams.points.element
    zeta, slope = place(beams, points, eta)
    T = sp.tangent(zeta)
    H = T @ slope
    to_point = sp.adjoint(sp.exp(-zeta))
    g, C, K = inertia.carried(
        points.mass,
        (to_point @ frame[e][..., None])[..., 0],
        (to_point @ gravity[e][..., None])[..., 0],
        follow=model.geometric,
    )
    g = (np.swapaxes(to_point, -1, -2) @ g[..., None])[..., 0]  # from here on in a's axes, at a
    seen = np.concatenate([np.eye(6) - H, H], axis=-1)
    ride = to_point @ seen
    rode = np.swapaxes(ride, -1, -2)
    start = np.searchsorted(e, np.arange(len(eta)))

    def total(a: Array) -> Array:
        return np.add.reduceat(a, start, axis=0)

    force = total((np.swapaxes(seen, -1, -2) @ g[..., None])[..., 0])
    rest, spring = out.rest + total(rode @ K @ ride), out.spring
    if model.geometric:
        # D_a g = D_point g − cross(g) H ρ, and ∂(Hᵀg)/∂ρ acts on both ends like a spring, H = T(ζ) L T⁻¹(η)
        swing = total(np.swapaxes(seen, -1, -2) @ (sp.cross(g) @ H))
        rest = rest - np.concatenate([-swing, swing], axis=-1)
        E = sp.tangent_inverse(eta)
        conjugate = np.swapaxes(points.shape, -1, -2) @ np.swapaxes(T, -1, -2) @ g[..., None]
        bend = np.swapaxes(slope, -1, -2) @ sp.tangent_transpose_derivative(zeta, g) @ slope
        spring = spring + total(bend) + sp.tangent_inverse_transpose_derivative(eta, total(conjugate[..., 0])) @ E
    return Pencil(out.residual + force, total(rode @ points.mass @ ride), total(rode @ C @ ride), rest, spring)
