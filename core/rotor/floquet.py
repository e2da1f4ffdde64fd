"""Floquet's method: the exponents from the monodromy matrix, the growth of all solutions over one revolution.

The equations are integrated by Gauss–Legendre collocation with six stages, which is of order 12 and stable for stiff
systems (Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, 1993, sec. II.7). Steps are halved until
the exponents remain; the last change is their error.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from ..threads import one_thread
from .exponents import Exponents, exponents, separated
from .periodic import Periodic, PeriodicError, require_rotation

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

ACCURACY = 1e-11
"""Error of the exponents, as a fraction of Ω, below which steps are not halved again."""

MAX_STEPS = 2048
"""Largest number of steps per revolution."""

_STAGES = 6
_FIRST = 16  # steps of the first integration
_EPS = float(np.finfo(float).eps)


def floquet(system: Periodic) -> Exponents:
    """The 2n exponents of a periodic system of n coordinates, with their errors.

    Raises:
        PeriodicError: the rotor stands still, a coordinate has no mass, or the integration does not converge.
    """
    require_rotation(system)
    with one_thread():
        return _converged(system)


def _converged(system: Periodic) -> Exponents:
    """``floquet`` with steps halved until the exponents remain."""
    steps, previous = _FIRST, None
    while True:
        states = _fundamental(system, steps)
        multipliers, vectors = np.linalg.eig(states[-1])
        if previous is not None:
            change = distance(previous, multipliers)
            rounding = 10.0 * _EPS * _condition(vectors) * np.linalg.norm(states[-1], 2) / np.abs(multipliers)
            error = np.maximum(change, rounding) * abs(system.omega) / (2.0 * np.pi)
            if (change <= np.maximum(2.0 * np.pi * ACCURACY, 10.0 * rounding)).all():
                break
            if steps >= MAX_STEPS:
                raise PeriodicError(
                    f"Floquet: exponents change by {error.max() / abs(system.omega):.1e} Ω between {steps // 2} and {steps} "
                    "steps per revolution: a frequency is too high for this speed; reduce the system to its lower modes"
                )
        previous, steps = multipliers, 2 * steps
    values: Complex = np.asarray(
        np.log(multipliers.astype(np.complex128)) * abs(system.omega) / (2.0 * np.pi), np.complex128
    )
    shapes = separated(multipliers, _harmonics(states, vectors, values, system), np.abs(multipliers).max())
    return exponents(system.omega, values, error, shapes, system.mean[0], steps)


def distance(a: Complex, b: Complex) -> Array:
    """(m,) relative distance of each of the multipliers b (m,) from its partner among a (m,); pairs have the least sum."""
    apart = np.abs(a[:, None] - b[None, :]) / np.sqrt(np.abs(a)[:, None] * np.abs(b)[None, :])
    rows, columns = linear_sum_assignment(apart)
    out = np.empty(len(b))
    out[columns] = apart[rows, columns]
    return out


def _condition(vectors: Complex) -> Array:
    """(m,) condition numbers of the eigenvalues, at most the inverse root of the rounding unit, as at a double one."""
    try:
        left_norms = np.linalg.norm(np.linalg.inv(vectors), axis=1)
    except np.linalg.LinAlgError:
        left_norms = np.full(len(vectors), np.inf)
    return np.minimum(left_norms * np.linalg.norm(vectors, axis=0), _EPS**-0.5)


def _fundamental(system: Periodic, steps: int) -> Array:
    """(steps + 1, 2n, 2n) solutions (x, ẋ) from all initial states, at the ends of the steps of one revolution."""
    nodes, a, b = _gauss()
    h = system.period / steps
    n = len(system.names)
    sign = np.sign(system.omega)
    psi = sign * 2.0 * np.pi * (np.arange(steps)[:, None] + nodes) / steps
    A = _state_matrix(system, psi)  # (steps, stages, 2n, 2n)
    out = np.empty((steps + 1, 2 * n, 2 * n))
    out[0] = np.eye(2 * n)
    unit = np.eye(_STAGES * 2 * n)
    for k in range(steps):
        stacked = np.einsum("ij,iab->iajb", a, A[k]).reshape(_STAGES * 2 * n, -1)
        slopes = np.linalg.solve(unit - h * stacked, (A[k] @ out[k]).reshape(_STAGES * 2 * n, -1))
        out[k + 1] = out[k] + h * np.tensordot(b, slopes.reshape(_STAGES, 2 * n, -1), axes=1)
    return out


def _state_matrix(system: Periodic, psi: Array) -> Array:
    """(…, 2n, 2n) matrix A of (x, ẋ)˙ = A (x, ẋ)."""
    M, C, K = system.at(psi)
    n = len(system.names)
    A = np.zeros((*psi.shape, 2 * n, 2 * n))
    A[..., :n, n:] = np.eye(n)
    try:
        A[..., n:, :] = -np.linalg.solve(M, np.concatenate([K, C], axis=-1))
    except np.linalg.LinAlgError:
        worst = system.names[int(np.abs(np.diagonal(system.mean[0])).argmin())]
        raise PeriodicError(f"coordinate {worst!r}: it has no mass, so that its motion cannot be integrated") from None
    return A


def _harmonics(states: Array, vectors: Complex, values: Complex, system: Periodic) -> Complex:
    """(2H + 1, n, m) harmonics of p from solutions at equal azimuths."""
    steps = len(states) - 1
    time = system.period * np.arange(steps) / steps
    p = (states[:-1, : len(system.names)] @ vectors) * np.exp(-values * time[:, None])[:, None, :]
    spectrum = np.fft.fft(p, axis=0) / steps
    top = steps // 2 - 1
    order = np.arange(-top, top + 1) * int(np.sign(system.omega))
    return spectrum[order]


def _gauss() -> tuple[Array, Array, Array]:
    """Nodes (s,), matrix a (s, s) and weights b (s,) of collocation at Gauss's points of [0, 1]."""
    points, weights = np.polynomial.legendre.leggauss(_STAGES)
    c = 0.5 * (points + 1.0)
    powers = np.arange(_STAGES)
    vander = c[:, None] ** powers
    a = (c[:, None] ** (powers + 1) / (powers + 1)) @ np.linalg.inv(vander)
    return c, a, 0.5 * weights
