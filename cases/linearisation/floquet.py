"""Floquet exponents from the azimuths of a set, by Fourier interpolation of the state matrix in the fixed frame.

For equal blades the matrix in the fixed frame has the harmonics 0, 3, 6, … of the rotor speed only.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

MAX_HARMONICS = 4
"""Highest multiple of the blade-passing frequency in the interpolation."""

STEPS = 12
"""Steps per blade passage and harmonic of the integration."""

MIN_GAP = 0.02
"""Least distance from resonance in the estimate of a periodic part's effect, relative to the rotor speed."""

SAME_PHASE = np.radians(10.0)
"""Azimuths whose phases of blade passing differ by less show the same instant of it."""


@dataclass(frozen=True)
class Interpolation:
    """A(ψ) = Σ C_h cos 3hψ + S_h sin 3hψ.

    Attributes:
        cosine, sine: coefficients (harmonic, row, column); ``sine[0]`` is zero.
        harmonics: highest harmonic; 0 if the azimuths show one phase of blade passing only.
        residual: largest deviation of a matrix from the interpolation, relative to the largest periodic part.
    """

    cosine: Array
    sine: Array
    harmonics: int
    residual: float

    def at(self, psi: float) -> Array:
        """A(ψ)."""
        h = np.arange(len(self.cosine))
        return np.tensordot(np.cos(3 * h * psi), self.cosine, 1) + np.tensordot(np.sin(3 * h * psi), self.sine, 1)


def phases(azimuths: Array) -> int:
    """Number of different phases of blade passing, 3ψ."""
    phase = np.sort(np.mod(3 * azimuths, 2 * np.pi))
    gaps = np.diff(np.append(phase, phase[0] + 2 * np.pi))
    return max(1, int(np.count_nonzero(gaps > SAME_PHASE)))


def interpolate(azimuths: Array, matrices: Array, harmonics: int | None = None) -> Interpolation:
    """Fit the harmonics of blade passing that the azimuths determine, by least squares."""
    limit = min((phases(azimuths) - 1) // 2, MAX_HARMONICS)
    count = limit if harmonics is None else min(harmonics, limit)
    h = np.arange(1, count + 1)
    basis = np.column_stack(
        [np.ones(len(azimuths)), np.cos(3 * np.outer(azimuths, h)), np.sin(3 * np.outer(azimuths, h))]
    )
    flat = matrices.reshape(len(azimuths), -1)
    coefficients = np.asarray(np.linalg.lstsq(basis, flat, rcond=None)[0], dtype=np.float64)
    shape = (-1, *matrices.shape[1:])
    residual = float(np.abs(flat - basis @ coefficients).max())
    periodic = float(np.abs(flat - flat.mean(axis=0)).max(initial=0.0))
    cosine = coefficients[: count + 1].reshape(shape)
    sine = np.concatenate([np.zeros_like(cosine[:1]), coefficients[count + 1 :].reshape(shape)])
    return Interpolation(cosine, sine, count, residual / periodic if periodic > 0 else 0.0)


def second_order(
    parts: Array, omega: float, orders: Sequence[int], values: Complex, adjoints: Complex, shapes: Complex
) -> Array:
    """Estimate of the changes of eigenvalues by periodic parts, rad/s: Σ_j |l_i δA r_j| |l_j δA r_i| / |λ_i − λ_j + inΩ|.

    Args:
        parts: δA in the fixed frame (azimuth, row, column), of zero mean.
        omega: rotor speed, rad/s.
        orders: n, the harmonics of the rotor speed in the parts.
        values: eigenvalues of the mean matrix.
        adjoints: left eigenvectors by row, of unit product with the right ones.
        shapes: right eigenvectors by column.
    """
    eigenvalues = np.concatenate([values, values.conj()])
    left, right = np.vstack([adjoints, adjoints.conj()]), np.hstack([shapes, shapes.conj()])
    coupling = np.max([np.abs(left @ part @ right) for part in parts], axis=0)
    between = eigenvalues[:, None] - eigenvalues
    gap = np.min([np.abs(between + 1j * n * omega) for n in orders], axis=0)
    size = (coupling * coupling.T / np.maximum(gap, MIN_GAP * abs(omega))).sum(axis=1)
    return size[: len(values)]


def exponents(fit: Interpolation, omega: float, eigenvalues: Complex) -> Complex:
    """Floquet exponents next to the eigenvalues ``eigenvalues`` of the mean matrix, rad/s.

    The monodromy matrix of one blade passage is a product of exponentials of A at midpoints (Magnus, second order), of which
    each exponent is known up to multiples of 3Ωi. Exponents that overflow leave all eigenvalues as they are.
    """
    steps = STEPS * max(fit.harmonics, 1)
    period = 2 * np.pi / (3 * abs(omega))
    step = period / steps
    Phi = np.eye(fit.cosine.shape[1])
    with np.errstate(over="ignore", invalid="ignore"):
        for k in range(steps):
            psi = np.sign(omega) * (k + 0.5) * 2 * np.pi / 3 / steps
            Phi = expm(fit.at(float(psi)) * step) @ Phi
    if not np.isfinite(Phi).all():
        return eigenvalues
    multipliers = np.linalg.eigvals(Phi)
    base = np.log(multipliers[np.abs(multipliers) > 1e-250] + 0j) / period
    out = np.empty(len(eigenvalues), dtype=complex)
    for k, value in enumerate(eigenvalues):
        turns = np.round((value.imag - base.imag) / (3 * abs(omega)))
        shifted = base + 3j * abs(omega) * turns
        out[k] = shifted[np.argmin(np.abs(shifted - value))]
    return out
