"""Strain measures of elastic elements between two frames a and b, with the energy ½ εᵀKε.

Variations are twists in the axes of frame a at that instant: with ``X = X_a⁻¹ X_b`` and ``dX = ρ^ X``, ρ = ξ_b − ξ_a, the
energy gives the wrench ``w = Eᵀ s`` on b (and −w on a), where ``E = ∂ε/∂ρ`` and ``s = K ε + preload``. The derivative of w
with respect to ρ is ``Eᵀ K E + ∂(Eᵀ s)/∂ρ``: the material and the geometric stiffness, both analytic.

Two measures:

* ``corotational``: δ = log X − log X₀ is the helicoidal strain of a frame moving from a to b (Sonneville, Cardona, Brüls 2014,
  sec. 4). It is exact where the strain is constant along the element: bending into an arc does not stretch the element.
  Two terms account for a strain that varies with the static shape of δ and the internal coordinates β. Magnus' expansion of
  X′ = X ξ gives log X = ∫ξ + (1/12) ad(∫ξ) ξ′L², so the strain solves ``ε + (1/12) ad(A δ) B (ε, β) = δ``, where A and B give
  the integral and the slope of the strain. The axial strain also contains δᵀGδ, the shortening due to the deviation of the
  static shape from the helicoid; it gives the tension stiffening of the cubic beam element. Both terms are quadratic in the
  element length; with them the element is of fourth order about any steady state;
* ``body_fixed``: displacement and Cardan angles (x, y, z) of b from its undeformed pose, in axes fixed in a. Linear in the
  parent body's frame (Park et al. 2010): an element has no geometric stiffness.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from ..space import spatial as sp

Array = NDArray[np.float64]
Measure = Literal["corotational", "body_fixed"]

LARGE_STRAIN, LARGEST_STRAIN = 0.02, 0.2
"""Steady strains from which they are reported, and refused: sections are linear elastic."""

RANGE = 0.5
"""Largest change of the rate of an element's axial strain by its second-order part; short elements stay below 1e-3."""


@dataclass(frozen=True)
class StrainLaw:
    """Strain law of n elements.

    Attributes:
        measure: see the module.
        undeformed: (n, 4, 4) relative poses without strain.
        shortening: (n, 6, 6) G, see ``sections``; this and the following are for the corotational measure.
        mean: (n, 6, 6) A: A δ is the integral of the strain over the element, for the static shape of δ.
        slope: (n, 6, 12) B: B (δ, β) is the slope of the strain along the element, times the length squared.
        eta: (n, 6) logarithm of ``undeformed``.
    """

    measure: Measure
    undeformed: Array
    shortening: Array
    mean: Array
    slope: Array
    eta: Array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "eta", sp.log(self.undeformed))

    @cached_property
    def arrays(self) -> kernels.StrainLaws:
        """The law for compiled loops."""
        parts = (np.ascontiguousarray(getattr(self, name), dtype=float) for name in (*_ARRAYS, "eta"))
        return kernels.StrainLaws(self.measure == "body_fixed", *parts)


def constant_strain(measure: Measure, undeformed: Array) -> StrainLaw:
    """Law of n elements with constant strain: bushings, and elements of which only the ends are known."""
    n = len(undeformed)
    return StrainLaw(measure, undeformed, np.zeros((n, 6, 6)), np.zeros((n, 6, 6)), np.zeros((n, 6, 12)))


def joined(laws: Sequence[StrainLaw]) -> StrainLaw:
    """Concatenate laws of one measure."""
    return StrainLaw(laws[0].measure, *(np.concatenate([getattr(law, name) for law in laws]) for name in _ARRAYS))


def part(law: StrainLaw, at: slice) -> StrainLaw:
    """Law of a slice of the elements."""
    return StrainLaw(law.measure, *(getattr(law, name)[at] for name in _ARRAYS))


_ARRAYS = ("undeformed", "shortening", "mean", "slope")


@dataclass(frozen=True)
class Response:
    """Strain of n elements at given relative poses and internal coordinates β, and its derivatives.

    Attributes:
        strain: (n, 6) ε.
        rate: (n, 6, 12) E = ∂ε/∂(ρ, β).
        curvature: (n, 12, 12) geometric stiffness: derivative with respect to (ρ, β) of the generalised forces on (ρ, β) due to
            constant forces conjugate to ε and to η = log X.
    """

    strain: Array
    rate: Array
    curvature: Array


def response(law: StrainLaw, x: Array, beta: Array, s: Array | None = None, on_eta: Array | None = None) -> Response:
    """Strain of n elements at relative poses ``x`` (n, 4, 4) and internal coordinates ``beta`` (n, 6 or 0).

    ``s`` and ``on_eta`` (n, 6) are the constant forces of ``Response.curvature``, zero by default.
    """
    zeros = np.zeros((len(x), 6))
    force, conjugate = (zeros if v is None else np.ascontiguousarray(v) for v in (s, on_eta))
    return Response(*kernels.respond(law.arrays, np.ascontiguousarray(x), np.ascontiguousarray(beta), force, conjugate))


def relative_strain(law: StrainLaw, x: Array, beta: Array) -> Array:
    """(n,) strain of elements at ``x`` and ``beta``, mean over the length: axial and, if corotational, shear.

    An element without length, such as a root joint, has none. Bending strains are not included: they need the sections'
    thickness, which a beam does not state.
    """
    strain, length = response(law, x, beta).strain[:, :3], np.linalg.norm(law.eta[:, :3], axis=1)
    size = np.abs(strain[:, 0]) if law.measure == "body_fixed" else np.linalg.norm(strain, axis=1)
    return np.divide(size, length, out=np.zeros(len(x)), where=length > 0)


def out_of_range(law: StrainLaw, x: Array) -> NDArray[np.bool_]:
    """(n,) whether elements at relative poses ``x`` (n, 4, 4) are deformed beyond the range of the corotational measure.

    Its axial strain has the rate 1 + 2 (G δ)_x with the distance of the ends. Where that is 0, it has an extremum, and beyond
    lies a second configuration without strain, which is not physical. The rate must stay within ``RANGE`` of 1.
    """
    if law.measure != "corotational":
        return np.zeros(len(x), dtype=bool)
    return np.abs(2.0 * ((sp.log(x) - law.eta) * law.shortening[:, 0]).sum(1)) > RANGE
