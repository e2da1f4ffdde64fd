"""Characteristic exponents of a periodic system, and the multiple of Ω at which each one moves.

A solution is ``x = p(ψ) e^{st}`` with p of period 2π, ``p = Σ_k p_k e^{ikψ}``. The exponent s is defined up to a multiple of
iΩ, which shifts the harmonics of p. Among ``Im s + kΩ``, the frequency of a mode is that with the largest participation, the
fraction ``p_k* M̄ p_k`` of the kinetic energy per frequency squared. (Peters, Lieb and Ahaus, J. Am. Helicopter Soc. 56,
2011, 032001; Skjoldan and Hansen, J. Sound Vib. 323, 2009, 224.)
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

TIE = 0.9
"""Ratio of the second largest to the largest participation above which no frequency is named."""

EQUAL = 1e-7
"""Relative distance of multipliers below which they count as equal, so that their shapes mix."""


@dataclass(frozen=True)
class Exponents:
    """Exponents of a periodic system of n coordinates, 2n of them.

    Attributes:
        omega: Ω, rad/s.
        values: (2n,) exponents, 1/s; the imaginary part is one of those that differ by multiples of Ω.
        error: (2n,) estimated error of each, 1/s.
        shapes: (2H + 1, n, 2n) harmonics −H … H of p, each mode with the sum of its participations 1.
        participation: (2H + 1, 2n) fraction of each harmonic.
        effort: steps of the integration per revolution, or harmonics of Hill's equations.
    """

    omega: float
    values: Complex
    error: Array
    shapes: Complex
    participation: Array
    effort: int

    @property
    def multipliers(self) -> Complex:
        """(2n,) e^{sT}: a solution's growth over one revolution."""
        return np.exp(2.0 * np.pi * self.values / abs(self.omega))

    @property
    def candidates(self) -> Array:
        """(2H + 1, 2n) imaginary parts Im s + kΩ, rad/s."""
        order = np.arange(len(self.participation)) - len(self.participation) // 2
        return self.values.imag + order[:, None] * self.omega

    @property
    def tied(self) -> NDArray[np.bool_]:
        """(2n,) whether two frequencies have almost equal participations, so that none is named."""
        return np.array([_ratio(c, w) for c, w in zip(self.candidates.T, self.participation.T, strict=True)]) > TIE

    @property
    def frequencies(self) -> Array:
        """(2n,) imaginary part with the largest participation, rad/s; nan where two are tied."""
        best = np.take_along_axis(self.candidates, self.participation.argmax(0)[None], 0)[0]
        return np.where(self.tied, np.nan, best)

    @property
    def growth(self) -> float:
        """Largest real part, 1/s: positive if the state is unstable."""
        return float(self.values.real.max())


def exponents(omega: float, values: Complex, error: Array, shapes: Complex, mass: Array, effort: int) -> Exponents:
    """``Exponents`` whose shapes (2H + 1, n, m) are those of single modes, with participations by the mass M̄ (n, n)."""
    parts = _participation(shapes, mass)
    total = parts.sum(0)
    shapes = shapes / np.sqrt(np.where(total > 0, total, 1.0))
    return Exponents(omega, values, error, shapes, parts / np.where(total > 0, total, 1.0), effort)


def separated(values: Complex, shapes: Complex, scale: float) -> Complex:
    """Shapes (k, n, m) whose modes with equal ``values`` (m,) have distinct harmonics.

    Vectors of equal eigenvalues are arbitrary combinations of the modes. The combinations whose harmonics have a definite mean
    order diagonalise the order within their span.
    """
    out = shapes.copy()
    close = np.abs(values[:, None] - values) <= EQUAL * scale
    order = (np.arange(len(shapes)) - len(shapes) // 2)[:, None, None]
    for k in np.flatnonzero(close.sum(1) > 1):
        cluster = np.flatnonzero(close[k])
        if cluster[0] == k:
            P = shapes[:, :, cluster]
            flat = P.reshape(-1, len(cluster))
            ordered = (order * P).reshape(-1, len(cluster))
            combination = np.linalg.eig(np.linalg.lstsq(flat, ordered, rcond=None)[0])[1]
            out[:, :, cluster] = (flat @ combination).reshape(P.shape)
    return out


def _participation(shapes: Complex, mass: Array) -> Array:
    return np.real(np.einsum("knm,nl,klm->km", shapes.conj(), mass, shapes)).clip(0.0)


def _ratio(candidates: Array, participation: Array) -> float:
    """Ratio of the second largest to the largest participation, among frequencies of different modulus."""
    best = int(participation.argmax())
    size = np.abs(candidates)
    cluster = np.abs(size - size[best]) <= 1e-6 * max(float(np.ptp(candidates)), 1e-300)
    return float(participation[~cluster].max(initial=0.0) / participation[cluster].sum())
