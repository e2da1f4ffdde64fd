"""Hill's method: the exponents from the harmonics of the solutions.

With ``x = e^{st} Σ_k p_k e^{ikψ}``, each harmonic j of the equations is

    Σ_k [(s + ikΩ)² M_{j−k} + (s + ikΩ) C_{j−k} + K_{j−k}] p_k = 0,    |j|, |k| ≤ H,

an eigenproblem in s with 2n (2H + 1) solutions: each mode up to 2H + 1 times, shifted by multiples of iΩ. Of each mode the
solution is kept whose harmonics are centred. H grows until these remain. (Hill 1886; Bolotin, *The Dynamic Stability of Elastic
Systems*, 1964.)
"""

from typing import cast

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import NDArray

from ..threads import one_thread
from .exponents import Exponents, exponents, separated
from .floquet import distance
from .periodic import Periodic, PeriodicError, require_rotation

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

ACCURACY = 1e-11
"""Change of the exponents, as a fraction of Ω, below which harmonics are not added."""

MAX_SIZE = 4000
"""Largest number of unknowns of the eigenproblem."""

MAX_SPARSE = 20_000
"""Largest number of unknowns of Newton's method, whose equations are sparse."""

TAIL = 1e-5
"""Relative size of the harmonics that Newton's method leaves out at first."""

MAX_STEPS = 20
"""Largest number of Newton's steps."""

_EPS = float(np.finfo(float).eps)


def hill(system: Periodic) -> Exponents:
    """The 2n exponents of a periodic system of n coordinates; ``effort`` is the number of harmonics H.

    Raises:
        PeriodicError: the rotor stands still, a coordinate has no mass, or the exponents do not converge.
    """
    require_rotation(system)
    with one_thread():
        return _converged(system)


def _converged(system: Periodic) -> Exponents:
    """``hill`` with harmonics added until the exponents remain."""
    n, omega = len(system.names), abs(system.omega)
    H, step = 2 * system.harmonics + 2, max(system.harmonics, 2)
    previous: Complex | None = None
    change = np.inf
    while 2 * n * (2 * H + 1) <= MAX_SIZE:
        values, shapes, rounding = _centred(system, H)
        if len(values) == 2 * n:
            multipliers = np.exp(2.0 * np.pi * values / omega)
            if previous is not None:
                change = float(distance(previous, multipliers).max()) / (2.0 * np.pi)
                if change <= max(ACCURACY, rounding / omega):
                    error = np.full(len(values), max(change * omega, rounding))
                    return exponents(system.omega, values, error, shapes, system.mean[0], H)
            previous = multipliers
        else:
            previous = None
        H += step
    raise PeriodicError(
        f"Hill: exponents change by {change:.1e} Ω at {H - step} harmonics: a frequency or the variation of the matrices is "
        "too large for this speed; reduce the system to its lower modes"
    )


def refined(
    system: Periodic, value: complex, shape: Complex, accuracy: float = ACCURACY, half_turn: Array | None = None
) -> tuple[complex, Complex, float]:
    """The solution of Hill's equations near an exponent and its harmonics, by Newton's method.

    Args:
        system: the system.
        value: the exponent, 1/s.
        shape: (2H + 1, n) its harmonics −H … H.
        accuracy: as ``ACCURACY``.
        half_turn: (n,) factors of the motion half a revolution later; coordinates with 1 have even harmonics alone, those
            with −1 odd ones. None if there is no such symmetry.

    Returns:
        The exponent, its harmonics (2H + 1, n), and the change under more harmonics, 1/s.

    Raises:
        PeriodicError: no convergence.
    """
    require_rotation(system)
    top, n = len(shape) // 2, shape.shape[1]
    order = np.arange(-top, top + 1)
    allowed = np.ones(shape.shape, bool) if half_turn is None else (-1.0) ** order[:, None] == half_turn
    size = np.abs(shape * np.sqrt(np.diagonal(system.mean[0]))).max(1)
    H = max(2, *(np.abs(order[size > TAIL * size.max()])).tolist())
    previous, change = None, np.inf
    p: Complex | None = None
    while n * (2 * H + 1) <= MAX_SPARSE and top >= H:
        window = slice(top - H, top + H + 1)
        guess = shape[window] if p is None else np.pad(p, ((H - len(p) // 2,) * 2, (0, 0)))
        value, p = _newton(system, value, guess, allowed[window])
        if previous is not None:
            change = abs(value - previous)
            if change <= accuracy * abs(system.omega):
                return value, p, change
        previous, H = value, H + max(system.harmonics, 1)
    raise PeriodicError(
        f"Hill: an exponent changes by {change / abs(system.omega):.1e} Ω at {H} harmonics: give higher speeds"
    )


def _newton(system: Periodic, s: complex, shape: Complex, allowed: NDArray[np.bool_]) -> tuple[complex, Complex]:
    """A solution (s, p) of Hill's equations with the ``allowed`` harmonics; p's component along the first guess remains."""
    H, n = len(shape) // 2, shape.shape[1]
    rows, columns, (M, C, K) = _sparse(system, allowed)
    D = np.repeat(1j * np.arange(-H, H + 1) * system.omega, n)[allowed.ravel()]
    p = shape[allowed] / np.linalg.norm(shape[allowed])
    size, along = len(p), p.conj()
    indices, last = np.arange(size), np.full(size, size)
    at = np.concatenate([rows, indices, last]), np.concatenate([columns, last, indices])
    for _ in range(MAX_STEPS):
        rate = (s + D)[columns]
        equations = scipy.sparse.csr_array((M * rate**2 + C * rate + K, (rows, columns)), (size, size))
        slope = scipy.sparse.csr_array((2.0 * M * rate + C, (rows, columns)), (size, size)) @ p
        bordered = scipy.sparse.csc_array((np.concatenate([M * rate**2 + C * rate + K, slope, along]), at))
        try:
            step = scipy.sparse.linalg.splu(bordered).solve(np.append(-(equations @ p), 0.0))
        except RuntimeError:  # singular
            break
        p, s = p + step[:-1], s + complex(step[-1])
        if abs(step[-1]) <= 100.0 * _EPS * max(abs(s), abs(system.omega) * H):
            out = np.zeros(shape.shape, np.complex128)
            out[allowed] = p
            return s, out
    raise PeriodicError(f"Hill: Newton's method does not converge near {abs(s):.4g} rad/s")


def _sparse(
    system: Periodic, kept: NDArray[np.bool_]
) -> tuple[NDArray[np.intp], NDArray[np.intp], tuple[Complex, Complex, Complex]]:
    """Rows, columns and values of the blocks M_{j−k}, C_{j−k} and K_{j−k} over the ``allowed`` harmonics (2H + 1, n)."""
    n, top = kept.shape[1], system.harmonics
    number = np.where(kept, np.cumsum(kept).reshape(kept.shape) - 1, -1).ravel()
    rows, columns, values = [], [], []
    for h in range(-top, top + 1):
        blocks = np.stack([part[top + h] for part in (system.M, system.C, system.K)])
        r, c = np.nonzero(blocks.any(0))
        j = np.arange(max(0, h), min(len(kept), len(kept) + h))[:, None]
        row, column = number[n * j + r], number[n * (j - h) + c]
        used = (row >= 0) & (column >= 0)
        rows.append(row[used])
        columns.append(column[used])
        values.append(blocks[:, r, c][:, np.nonzero(used)[1]])
    M, C, K = np.concatenate(values, axis=1)
    return np.concatenate(rows), np.concatenate(columns), (M, C, K)


def _centred(system: Periodic, H: int) -> tuple[Complex, Complex, float]:
    """Values (m,) and shapes (2H + 1, n, m) of the solutions with centred harmonics, and the rounding of the values."""
    n = len(system.names)
    order = np.arange(-H, H + 1)
    M, C, K = (_toeplitz(part, H) for part in (system.M, system.C, system.K))
    D = np.repeat(1j * order * system.omega, n)
    damping, stiffness = 2.0 * M * D + C, M * D**2 + C * D + K
    size = len(D)
    try:
        lower = -scipy.linalg.solve(M, np.concatenate([stiffness, damping], axis=1))
    except np.linalg.LinAlgError:
        raise PeriodicError("a coordinate has no mass: Hill's equations have infinite solutions; condense it") from None
    A = np.zeros((2 * size, 2 * size), np.complex128)
    A[:size, size:] = np.eye(size)
    A[size:] = lower
    values, vectors = cast(tuple[Complex, Complex], scipy.linalg.eig(A))
    shapes = vectors[:size].reshape(2 * H + 1, n, -1)
    root = np.sqrt(np.maximum(np.diagonal(system.mean[0]), 0.0))[:, None]
    shapes = separated(values, shapes * root, abs(system.omega)) / np.where(root > 0, root, 1.0)
    weight = (np.abs(shapes * root) ** 2).sum(1)
    centre = (order[:, None] * weight).sum(0) / weight.sum(0)
    central = np.flatnonzero(np.abs(centre) < max(1.6, H / 2))
    selection = central[_window(centre[central])]
    largest = float(np.abs(values[selection]).max(initial=0.0))
    return values[selection], shapes[:, :, selection], 100.0 * _EPS * max(largest, abs(system.omega) * H)


def _window(centre: Array) -> NDArray[np.intp]:
    """Indices of the centres within an interval of length 1 about 0, whose ends are in the widest gap between them."""
    fraction = np.sort(np.mod(centre[np.abs(centre) < 1.6], 1.0))
    if not len(fraction):
        return np.zeros(0, dtype=np.intp)
    gaps = np.diff(np.append(fraction, fraction[0] + 1.0))
    widest = int(gaps.argmax())
    start = float(np.mod(fraction[widest] + 0.5 * gaps[widest], 1.0)) - 1.0
    return np.flatnonzero((centre > start) & (centre <= start + 1.0))


def _toeplitz(coefficients: Complex, H: int) -> Complex:
    """(n (2H + 1), n (2H + 1)) blocks X_{j−k} of the harmonics (2h + 1, n, n)."""
    h, n = len(coefficients) // 2, coefficients.shape[1]
    out = np.zeros((2 * H + 1, n, 2 * H + 1, n), np.complex128)
    for shift in range(-h, h + 1):
        for j in range(max(0, shift), min(2 * H + 1, 2 * H + 1 + shift)):
            out[j, :, j - shift] = coefficients[shift + h]
    return out.reshape(n * (2 * H + 1), -1)
