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


def floquet(system: Periodic, half_turn: Array | None = None, accuracy: float = ACCURACY) -> Exponents:
    """The 2n exponents of a periodic system of n coordinates, with their errors.

    Args:
        system: the system.
        half_turn: (n,) signs S of the coordinates with which the equations are the same half a revolution later, as those of
            two equal blades. The solutions of half a revolution suffice, x(t + T/2) = e^{sT/2} S x(t), and exponents are
            defined up to multiples of 2iΩ.
        accuracy: as ``ACCURACY``.

    Raises:
        PeriodicError: the rotor stands still, a coordinate has no mass, or the integration does not converge.
    """
    require_rotation(system)
    with one_thread():
        return _converged(system, half_turn, accuracy)


def _converged(system: Periodic, half_turn: Array | None, accuracy: float) -> Exponents:
    """``floquet`` with steps halved until the exponents remain."""
    steps, previous = _FIRST, None
    turns = 1.0 if half_turn is None else 0.5
    time = turns * system.period
    signs = np.ones(len(system.names)) if half_turn is None else half_turn
    while True:
        states = _fundamental(system, steps, turns)
        multipliers, vectors = np.linalg.eig(np.tile(signs, 2)[:, None] * states[-1])
        if previous is not None:
            change = distance(previous, multipliers)
            rounding = 10.0 * _EPS * _condition(vectors) * np.linalg.norm(states[-1], 2) / np.abs(multipliers)
            error = np.maximum(change, rounding) / time
            if (change <= np.maximum(2.0 * np.pi * turns * accuracy, 10.0 * rounding)).all():
                break
            if steps >= MAX_STEPS:
                raise PeriodicError(
                    f"Floquet: exponents change by {error.max() / abs(system.omega):.1e} Ω between {steps // 2} and {steps} "
                    "steps per revolution: a frequency is too high for this speed; reduce the system to its lower modes, or "
                    "give higher speeds"
                )
        previous, steps = multipliers, 2 * steps
    values: Complex = np.asarray(np.log(multipliers.astype(np.complex128)) / time, np.complex128)
    motion = _over_time(states, vectors, values, time)
    if half_turn is not None:
        motion = np.concatenate([motion, half_turn[:, None] * motion])
    shapes = separated(multipliers, _harmonics(motion, system), np.abs(multipliers).max())
    return exponents(system.omega, values, error, shapes, system.mean[0], steps)


def distance(a: Complex, b: Complex) -> Array:
    """(m,) relative distance of each of the multipliers b (m,) from its partner among a (m,); pairs have the least sum."""
    distances = np.abs(a[:, None] - b[None, :]) / np.sqrt(np.abs(a)[:, None] * np.abs(b)[None, :])
    rows, columns = linear_sum_assignment(distances)
    out = np.empty(len(b))
    out[columns] = distances[rows, columns]
    return out


def _condition(vectors: Complex) -> Array:
    """(m,) condition numbers of the eigenvalues, at most the inverse root of the rounding unit, as at a double one."""
    try:
        left_norms = np.linalg.norm(np.linalg.inv(vectors), axis=1)
    except np.linalg.LinAlgError:
        left_norms = np.full(len(vectors), np.inf)
    return np.minimum(left_norms * np.linalg.norm(vectors, axis=0), _EPS**-0.5)


def _fundamental(system: Periodic, steps: int, turns: float) -> Array:
    """(steps + 1, 2n, 2n) solutions (x, ẋ) from all initial states, at the ends of the steps of so many revolutions."""
    nodes, a, b = _gauss()
    h = turns * system.period / steps
    n = len(system.names)
    psi = system.omega * h * (np.arange(steps)[:, None] + nodes)
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


def _over_time(states: Array, vectors: Complex, values: Complex, time: float) -> Complex:
    """(steps, n, m) p = x e^{−st} at the beginning of each step of a time."""
    steps, n = len(states) - 1, states.shape[1] // 2
    t = time * np.arange(steps) / steps
    return (states[:-1, :n] @ vectors) * np.exp(-values * t[:, None])[:, None, :]


def _harmonics(motion: Complex, system: Periodic) -> Complex:
    """(2H + 1, n, m) harmonics of p from its values (k, n, m) at k equal azimuths."""
    spectrum = np.fft.fft(motion, axis=0) / len(motion)
    top = len(motion) // 2 - 1
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
