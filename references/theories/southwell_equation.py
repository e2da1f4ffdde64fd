"""Southwell's equation, ω² = ω₀² + K Ω², and bounds on its error.

The stiffness of a rotating beam is the sum of the elastic stiffness A and Ω² times the centrifugal stiffness B.
Southwell and Gough ("On the free transverse vibrations of airscrew blades", Aeronautical Research Committee, Reports
and Memoranda 766, 1921) put the non-rotating mode φ_k into Rayleigh's quotient: K = φ_kᵀ B φ_k for φ_kᵀ M φ_k = 1. This
value is returned. The frequency of the inextensible beam (``assumed_modes``) is bounded:

* From above: the highest Rayleigh–Ritz frequency in the span of the k lowest non-rotating modes is at least the beam's
  k-th frequency. For k = 1 this is the value itself: Southwell's equation never underestimates the first frequency.
* From below: the eigenvalues β_j of B alone are those of a rotating cable. Southwell's theorem is
  ω₁² ≥ α₁ + Ω² β₁, with α_i the squared non-rotating frequencies. For any k, Weyl's inequality is
  ω_k² ≥ α_i + Ω² β_j, i + j = k + 1 (H. Weyl, Math. Ann. 71 (1912) 441–479), of which the largest is used.

``Modes.uncertainty`` is the distance from the value to the farther bound: a rigorous bracket for every mode (numbered
within its plane of bending, or within both together if twist couples them). α, β and φ are assumed exact; they converge
like ``assumed_modes``, to rounding at the finer levels. For k > 1 the value itself is not a bound, but lies inside the bracket.
"""

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.modes import Modes
from ..protocol.interface import Independence, Motion
from .assumed_modes import Bending, bendings
from .ritz import Y, integral, part, stationary_modes, union
from .spectral import pinned_functions
from .straight_beam import ClosedForm, line, refusal, tension, terms

Array = NDArray[np.float64]


def cable(blade: Blade, planes: tuple[int, ...], terms: int, count: int) -> Array:
    """The lowest ``count`` eigenvalues β of B: squared frequencies over Ω² of the blade without bending stiffness.

    In the plane of rotation they are lower by 1 than out of it. Uniform, δ = 0: j (2j − 1) out of the plane.
    """
    at = line(blade, terms)
    w, slope, _ = pinned_functions(at.ends, terms, at.s)
    flapwise = stationary_modes(integral(at.mass, w), integral(at.weight * tension(blade, at.s), slope), count)[0] ** 2
    return np.sort(np.concatenate([flapwise - 1.0 if plane == Y else flapwise for plane in planes]))[:count]


def squared(bending: Bending, beta: Array, omega: float, count: int) -> tuple[Array, Array, Array, Array]:
    """Southwell's ω² (m,), its lower and upper bounds (m,), and the non-rotating modes (n, m)."""
    frequencies, q = stationary_modes(bending.mass, bending.elastic, count)
    alpha, phi = frequencies**2, q * frequencies  # φᵀ M φ = 1
    ritz = np.diag(alpha) + omega**2 * (phi.T @ bending.centrifugal @ phi)
    m = len(alpha)
    upper = np.array([np.linalg.eigvalsh(ritz[:k, :k])[-1] for k in range(1, m + 1)])
    lower = np.array([(alpha[: k + 1] + omega**2 * beta[: k + 1][::-1]).max() for k in range(m)])
    return np.diag(ritz), lower, upper, phi


class SouthwellEquation(ClosedForm):
    """Southwell's equation for each bending mode, with its bracket; for the blades that ``assumed-modes`` supports."""

    name = "southwell-equation"
    title = "Southwell's equation"
    independence = Independence("Southwell's Ritz method", "Putter and Manor 1978", "assumed-modes")
    motions: tuple[Motion, ...] = ("edgewise", "flapwise")
    effects = Effects(prestretch=False, coriolis=False, rotary_inertia=False)
    bracket = True

    def unsupported(self, blade: Blade) -> str | None:
        """The reason why the blade is outside this theory; None if it is not."""
        return refusal(blade, twist=True, stretch=False, tip_inertia=False)

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest bending modes from ``elements`` polynomials in each interval; ``Modes.uncertainty`` is the bracket."""
        parts = []
        number = terms(blade, elements)
        for bending in bendings(blade, number):
            beta = cable(blade, bending.planes, number, count)
            value, lower, upper, phi = squared(bending, beta, omega, count)
            frequency, low, high = np.sqrt(value), np.sqrt(lower), np.sqrt(upper)
            reach = np.maximum(high - frequency, frequency - low) / frequency
            parts.append(part(bending.shape, frequency, phi, reach))
        return union(parts, omega, elements, count)


CODE = SouthwellEquation()
