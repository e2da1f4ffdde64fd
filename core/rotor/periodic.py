"""Periodic systems ``M(ψ) ẍ + C(ψ) ẋ + K(ψ) x = 0``, ψ = Ω t, as Fourier series of their matrices."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import multiblade
from .multiblade import Blades

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Matrices = tuple[Array, Array, Array]

CONSTANT = 1e-10
"""Largest variation with ψ, relative to the size of each coordinate's terms, that counts as none."""

NEGLIGIBLE = 1e-13
"""Relative size of harmonics of the matrices that are rounding."""

MAX_AZIMUTHS = 256
"""Largest number of azimuths at which matrices are sampled."""


class PeriodicError(ValueError):
    """A periodic system that a method does not accept; the message gives the cause and the remedy."""


@dataclass(frozen=True)
class Periodic:
    """A periodic system of n coordinates.

    Attributes:
        omega: Ω, rad/s; not zero, unless the matrices are constant.
        names: (n,) of the coordinates.
        M, C, K: (2H + 1, n, n) Fourier coefficients of the harmonics −H … H of ψ.
    """

    omega: float
    names: tuple[str, ...]
    M: Complex
    C: Complex
    K: Complex

    @property
    def harmonics(self) -> int:
        """H, the highest harmonic of the matrices."""
        return len(self.M) // 2

    @property
    def period(self) -> float:
        """2π/|Ω|, s."""
        return 2.0 * np.pi / abs(self.omega)

    def at(self, psi: ArrayLike) -> Matrices:
        """M, C, K (…, n, n) at azimuths ψ (…), rad."""
        order = np.arange(-self.harmonics, self.harmonics + 1)
        wave = np.exp(1j * np.asarray(psi, float)[..., None] * order)
        M, C, K = (np.real(np.tensordot(wave, part, axes=1)) for part in (self.M, self.C, self.K))
        return M, C, K

    @cached_property
    def mean(self) -> Matrices:
        """M, C, K (n, n) averaged over ψ."""
        M, C, K = (part[self.harmonics].real for part in (self.M, self.C, self.K))
        return M, C, K

    @cached_property
    def variation(self) -> float:
        """Bound on what varies with ψ, relative to the size of each coordinate's terms."""
        if not self.harmonics:
            return 0.0
        size = _sizes(*self.mean, self.omega)
        varying = np.arange(len(self.M)) != self.harmonics
        parts = (np.abs(part[varying]).sum(0) for part in (self.M, self.C, self.K))
        rates = (self.omega**2, abs(self.omega), 1.0)
        return max(float((r * p / np.outer(size, size)).max()) for r, p in zip(rates, parts, strict=True))

    @property
    def constant(self) -> bool:
        """Whether the matrices do not vary with ψ."""
        return self.variation < CONSTANT


def require_rotation(system: Periodic) -> None:
    """Raise ``PeriodicError`` if the rotor stands still, so that exponents have no period."""
    if not system.omega:
        raise PeriodicError("omega: 0 rad/s: the matrices are constant, and exponents have no period")


def sampled(evaluate: Callable[[float], Matrices], omega: float, names: tuple[str, ...]) -> Periodic:
    """A periodic system from its matrices at azimuths.

    The number of azimuths is doubled until the higher half of the harmonics is rounding; these are left out.

    Args:
        evaluate: M, C, K (n, n) at an azimuth, rad.
        omega: rotor speed, rad/s.
        names: of the coordinates.

    Raises:
        PeriodicError: more than ``MAX_AZIMUTHS`` azimuths are needed.
    """
    evaluated: dict[float, Matrices] = {}
    count = 8
    while count <= MAX_AZIMUTHS:
        fractions = np.arange(count) / count
        for x in fractions:
            if float(x) not in evaluated:
                evaluated[float(x)] = evaluate(2.0 * np.pi * float(x))
        rows = [evaluated[float(x)] for x in fractions]
        M, C, K = (np.array([row[k] for row in rows]) for k in range(3))
        system = from_samples(M, C, K, omega, names)
        if system.harmonics <= count // 4:
            return system
        count *= 2
    raise PeriodicError(
        f"azimuths: the matrices need more than {MAX_AZIMUTHS // 4} harmonics: they are not smooth in ψ"
    )


def from_samples(M: Array, C: Array, K: Array, omega: float, names: tuple[str, ...]) -> Periodic:
    """A periodic system from matrices (k, n, n) at k equal azimuths ψ = 0, 2π/k …; harmonics that are rounding are left out."""
    size = _sizes(M.mean(0), C.mean(0), K.mean(0), omega)
    scale = np.outer(size, size)
    coefficients = [np.fft.fft(part, axis=0) / len(part) for part in (M, C, K)]
    rates = (omega**2, abs(omega), 1.0)
    top = (len(M) - 1) // 2
    largest = [
        max(float((r * np.abs(part[[h, -h]]) / scale).max()) for r, part in zip(rates, coefficients, strict=True))
        for h in range(1, top + 1)
    ]
    H = max((h for h, x in enumerate(largest, 1) if x > NEGLIGIBLE), default=0)
    order = np.arange(-H, H + 1)
    return Periodic(omega, names, *(part[order] for part in coefficients))


def constant(M: Array, C: Array, K: Array, omega: float, names: tuple[str, ...]) -> Periodic:
    """A system with constant matrices (n, n)."""
    return Periodic(omega, names, *(part[None].astype(np.complex128) for part in (M, C, K)))


def in_multiblade(system: Periodic, blades: Blades) -> Periodic:
    """The system in multi-blade coordinates, in which it need not be constant.

    The names of a group's coordinates become ``name of blade 0: collective`` and so on.
    """
    order = system.harmonics + 2 * ((blades.number - 1) // 2)
    count = 2 * order + 1
    psi = 2.0 * np.pi * np.arange(count) / count
    M, C, K = multiblade.second_order(*system.at(psi), psi, system.omega, blades)
    names = list(system.names)
    for group in blades.groups:
        for k, name in zip(group, multiblade.names(blades.number), strict=True):
            names[k] = f"{system.names[group[0]]}: {name}"
    return from_samples(M, C, K, system.omega, tuple(names))


def averaged_exactly(system: Periodic) -> Periodic:
    """The system with its constant matrices, if nothing varies with ψ.

    Raises:
        PeriodicError: something varies: the system is never averaged.
    """
    if not system.constant:
        raise PeriodicError(
            f"azimuth: the matrices vary with it by {min(100 * system.variation, 999.0):.3g} % of their size in these "
            "coordinates, so that they have no constant modes: the blades differ, the support or gravity acts across the "
            "axis, or blades are missing from the multi-blade coordinates; use Floquet's or Hill's method"
        )
    return constant(*system.mean, system.omega, system.names)


def _sizes(M: Array, C: Array, K: Array, omega: float) -> Array:
    """(n,) root of the size of each coordinate's terms; entry (i, j) of K is compared with size_i size_j."""
    diagonal = [np.abs(np.diagonal(part)) for part in (M, C, K)]
    size = np.sqrt(diagonal[2] + abs(omega) * diagonal[1] + omega**2 * diagonal[0])
    return np.where(size > 0, size, size.max(initial=0.0) or 1.0)
