"""Beam elements with mass: elastic between their end frames, with inertia at points that follow both ends.

A point inside an element lies at ``exp ζ`` in the frame of end a, where ``ζ = ζ₀ + L (η − η₀)`` and η is the logarithm of the
relative pose of b: the static shape functions L of the undeformed element, in the coordinates in which an arc is straight.
Its twist is ``ξ_a + H ρ``, ``H = tangent(ζ) L tangent⁻¹(η)``, so that its inertia couples both ends: a consistent mass. An
element whose mass is lumped at the nodes has no such points.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from ..effects import ALL_EFFECTS, Effects
from ..space import spatial as sp
from . import measures
from .measures import Measure, StrainLaw

Array = NDArray[Any]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Points:
    """Points that follow the elements' ends, sorted by element.

    Attributes:
        element: (q,) index of the element that each point follows.
        zeta0: (q, 6) ζ₀, logarithm of the undeformed pose in the frame of end a.
        shape: (q, 6, 6) L, ζ from η.
        bubble: (q, 6, 6) ζ from the element's internal coordinates β.
        mass: (q, 6, 6) inertia in the point's frame, quadrature weight included.
        force: (q, 3) steady load on the point, N, in the axes of the rotating frame; zero by default.
    """

    element: Index
    zeta0: Array
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
        law: their strain law.
        stiffness: (n, 6, 6) for the strain of that law.
        points: the inertia inside.
        preload: (n, 6) force conjugate to the strain, at zero strain.
        internal_preload: (n, 6) force conjugate to β, at β = 0.
    """

    law: StrainLaw
    stiffness: Array
    points: Points
    preload: Array
    internal_preload: Array

    @property
    def undeformed(self) -> Array:
        """(n, 4, 4) undeformed pose of end b in the frame of end a."""
        return self.law.undeformed

    @property
    def bushings(self) -> NDArray[np.bool_]:
        """(n,) whether an element is a bushing, which has no shape between its ends."""
        return np.asarray(~self.law.shortening.any(axis=(1, 2)))

    @cached_property
    def arrays(self) -> kernels.Beams:
        """The elements for compiled loops; ``ValueError`` if the points are not sorted by element."""
        p = self.points
        if (np.diff(p.element) < 0).any():
            raise ValueError("points: not sorted by element")
        first = np.searchsorted(p.element, np.arange(len(self.stiffness) + 1))
        parts = (self.stiffness, self.preload, self.internal_preload, p.zeta0, p.shape, p.bubble, p.mass, p.force)
        return kernels.Beams(self.law.arrays, first, *(np.ascontiguousarray(a, dtype=float) for a in parts))

    @property
    def internal_count(self) -> int:
        """Number of internal coordinates of an element: six if it has mass inside, else none."""
        return 6 if len(self.points.element) else 0


class RelativePencil(NamedTuple):
    """As ``Pencil``, on (ξ_a, ρ, β) instead of (ξ_a, ξ_b, β)."""

    residual: Array
    M: Array
    C: Array
    remainder: Array
    spring: Array


@dataclass(frozen=True)
class Pencil:
    """Residual (n, d) on ends a, b and internal coordinates β, and its linearisation M, C, K, each (n, d, d); d = 12 or 18.

    Twists and wrenches are in each element's frame a, frozen at the state. Variations of wrenches follow the body they act
    on; ξ is relative to the rotating frame. K is split into ``remainder`` (n, d, d) and the ``spring`` (n, 6, 6) that acts on
    ρ = ξ_b − ξ_a: stored separately, its energy loses no digits to cancellation.
    """

    residual: Array
    M: Array
    C: Array
    remainder: Array
    spring: Array

    @property
    def K(self) -> Array:
        """The complete stiffness (n, d, d)."""
        K = self.remainder.copy()
        K[:, :12, :12] += on_ends(self.spring, self.spring)
        return K


def end_stiffness(measure: Measure, undeformed: Array, twist_stiffness: Array) -> Array:
    """Stiffness (n, 6, 6) for a strain measure from that for the twist of b relative to a, about the undeformed pose."""
    a = sp.tangent(sp.log(undeformed)) if measure == "corotational" else sp.adjoint(undeformed)
    return np.swapaxes(a, -1, -2) @ twist_stiffness @ a


def carried_points(undeformed: Array, element: Index, pose: Array, shape: Array, bubble: Array, mass: Array) -> Points:
    """Points at undeformed poses ``pose`` (q, 4, 4) whose twists are ``shape`` (q, 6, 6) times that of b plus ``bubble`` β."""
    zeta = sp.log(pose)
    slope = sp.tangent_inverse(zeta)
    L = slope @ shape @ sp.tangent(sp.log(undeformed))[element]
    return Points(element=element, zeta0=zeta, shape=L, bubble=slope @ bubble, mass=mass)


def bushing(
    undeformed: Array, stiffness: Array, preload: Array | None = None, measure: Measure = "corotational"
) -> Beams:
    """One massless element with a given 6×6 stiffness for its strain, between frames at relative pose ``undeformed`` (4, 4).

    Raises:
        ValueError: if the stiffness is not a symmetric 6×6 matrix.
    """
    k = np.asarray(stiffness, float)
    if k.shape != (6, 6) or not _symmetric(k):
        raise ValueError(f"stiffness: shape {k.shape}, or not symmetric: a bushing needs a symmetric 6×6 matrix")
    load = np.zeros(6) if preload is None else np.asarray(preload, float)
    return Beams(measures.constant_strain(measure, undeformed[None]), k[None], NO_POINTS, load[None], np.zeros((1, 6)))


def _symmetric(k: Array) -> bool:
    """Whether a stiffness (6, 6) is symmetric within rounding; scaled by its force and moment blocks."""
    size = np.sqrt(np.repeat([np.abs(k[:3, :3]).max(), np.abs(k[3:, 3:]).max()], 3))
    return bool((np.abs(k - k.T) <= 1e-9 * np.abs(k) + 1e-12 * size[:, None] * size).all())


def linear_force(beams: Beams, rho: Array) -> Array:
    """Force (n, 6) conjugate to the strain due to small twists ρ (n, 6) of b relative to a, about the undeformed pose."""
    rate = measures.response(beams.law, beams.undeformed, np.zeros((len(rho), 6))).rate[..., :6]
    return (beams.stiffness @ rate @ rho[..., None])[..., 0]


def massless(beams: Beams) -> Beams:
    """The same elements without the inertia inside."""
    return replace(beams, points=NO_POINTS)


def relative_pencil(
    beams: Beams,
    x: Array,
    beta: Array,
    frame: Array,
    gravity: Array,
    effects: Effects = ALL_EFFECTS,
    axes: Array | None = None,
) -> RelativePencil:
    """Assemble residual and matrices of all elements, on (ξ_a, ρ, β).

    Args:
        beams: the elements.
        x: (n, 4, 4) pose of b in the frame of a.
        beta: (n, 6) internal coordinates; (n, 0) for elements without mass inside.
        frame: (n, 6) twist of the rotating frame, in a's axes.
        gravity: (n, 6) free-fall acceleration as a twist, in a's axes.
        effects: the effects included (``geometric`` matters here).
        axes: (n, 3, 3) from the rotating frame's axes to a's; needed if there are loads on the points.

    Raises:
        ValueError: loads without axes.
    """
    if axes is None and beams.points.force.any():
        raise ValueError("axes: not given, but the points carry loads: give the rotations from the rotating frame to a")
    rotations = np.zeros((len(x), 3, 3)) if axes is None else axes
    x, beta, frame, gravity, rotations = (np.ascontiguousarray(a) for a in (x, beta, frame, gravity, rotations))
    return RelativePencil(*kernels.relative_pencil(beams.arrays, x, beta, frame, gravity, rotations, effects.geometric))


def pencil(relative: RelativePencil) -> Pencil:
    """The residual and matrices on (ξ_a, ξ_b, β); the arrays of ``relative`` are changed."""
    relative.residual[:, :6] -= relative.residual[:, 6:12]  # ρ = ξ_b − ξ_a
    for matrix in relative[1:4]:
        matrix[:, :6] -= matrix[:, 6:12]
        matrix[:, :, :6] -= matrix[:, :, 6:12]
    return Pencil(*relative)


def on_ends(on_a: Array, on_b: Array) -> Array:
    """(n, 12, 12) from −on_a ρ on end a and on_b ρ on end b, with ρ = ξ_b − ξ_a."""
    out = np.empty((len(on_a), 12, 12))
    out[:, :6, :6], out[:, :6, 6:] = on_a, -on_a
    out[:, 6:, :6], out[:, 6:, 6:] = -on_b, on_b
    return out
