"""Modes of a turbine of two blades, whose equations are periodic, by Floquet's and Hill's methods.

A mode moves at the frequencies ω + hΩ, those of the tower in the ground's frame and those of the blades in the rotor's. The
lowest modes are those of the lowest frequencies with the largest participation (``rotor.exponents``). Floquet's method solves
the equations restricted to the lowest motions of their mean over the azimuth, and Hill's method confirms its exponents. From
there, Newton's method on Hill's equations with all motions leads to the modes.
Half a revolution later they are the same, with the signs of the blades' difference and of the teeter angle reversed.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ..rotor import hill
from ..rotor.exponents import Exponents
from ..rotor.floquet import floquet
from ..rotor.periodic import Periodic, PeriodicError
from ..threads import one_thread
from .assembly import Assembled, periodic
from .machine import Machine

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

HELD = 1e-4
"""Frequency, as a fraction of Ω, at which a weak spring holds a rotor that turns freely: its exponent 0 would be double."""

ACCURACY = 1e-7
"""Error of the exponents by either method, as a fraction of Ω; they must agree to ten times as much."""

EQUAL = 1e-6
"""Relative difference below which two participations are equal."""

MIN_LIKENESS = 0.5
"""Part of a mode with all motions that is the mode of the lowest motions; with a smaller one, more motions are needed."""

MORE_MOTIONS = 4
"""Motions that are added at a time where all at once lead to another mode."""

MORE_HARMONICS = 12
"""Harmonics on both sides that a mode of all motions can have and that of the lowest ones has not."""


@dataclass(frozen=True)
class PeriodicModes:
    """The m lowest modes.

    Attributes:
        values: (m,) growth plus i times the frequency of the largest harmonic, 1/s; frequencies ascend.
        harmonics: (m,) arrays (2H + 1, n): the motion at each harmonic, the largest in the middle.
    """

    values: Complex
    harmonics: tuple[Complex, ...]


def periodic_modes(machine: Machine, omega: float, count: int) -> tuple[Assembled, PeriodicModes]:
    """The ``count`` lowest modes at a speed other than 0, rad/s; the rotation of a free rotor is left out.

    Raises:
        PeriodicError: Floquet's or Hill's method does not converge, or they differ.
        SteadyStateError: the blades have no steady state.
    """
    a, system = periodic(machine, omega)
    with one_thread():
        fixed = _held(a, system) if machine.turbine.drivetrain.free else system
        signs = np.ones(len(a.M))
        signs[[*a.teeter, *a.blades[1]]] = -1.0
        motions = _motions(fixed, signs)
        used = count + machine.resolution.periodic_motions
        while (solved := _lowest(fixed, signs, motions, used, count, machine.turbine.drivetrain.free)) is None:
            if used >= len(signs):
                raise PeriodicError(
                    "exponents: Newton's method on Hill's equations does not lead to as many modes; give other speeds"
                )
            used += used // 2
    return a, PeriodicModes(values=np.array([value for value, _ in solved]), harmonics=tuple(p for _, p in solved))


def _lowest(
    system: Periodic, signs: Array, motions: tuple[Array, Array], used: int, count: int, free: bool
) -> list[tuple[complex, Complex]] | None:
    """Values and harmonics of the ``count`` lowest modes, by way of those of the ``used`` lowest motions.

    None if these do not lead to as many modes, so that more motions are needed.
    """
    X, half_turn = motions
    reduced = _restricted(system, X[:, :used])
    exponents = floquet(reduced, half_turn[:used], ACCURACY)
    largest = _largest(exponents)
    frequencies = np.take_along_axis(exponents.candidates, largest[None], 0)[0]
    order = np.argsort(frequencies)[len(frequencies) // 2 :]  # of two conjugates, that with a frequency ≥ 0
    if free:
        order = np.delete(order, np.abs(exponents.values[order]).argmin())
    out: list[tuple[complex, Complex]] = []
    for j in order[:count].tolist():
        index = int(largest[j])
        parity = (-1.0) ** (index - len(exponents.shapes) // 2)
        mode = _confirmed(reduced, half_turn[:used], exponents, j, index)
        full = _led(system, parity * signs, mode[0], mode[1] @ X[:, :used].T) or _followed(
            system, parity, signs, motions, mode
        )
        if full is None:
            return None
        if any(
            abs(s - full[0]) <= 10.0 * ACCURACY * abs(system.omega) and _alike(p, full[1]) > MIN_LIKENESS
            for s, p in out
        ):
            return None
        out.append(full)
    return sorted(out, key=lambda mode: mode[0].imag)


def _led(system: Periodic, half_turn: Array, value: complex, harmonics: Complex) -> tuple[complex, Complex] | None:
    """The mode of the system that a mode of fewer motions leads to; None if it is another one."""
    guess = np.pad(harmonics, ((MORE_HARMONICS,) * 2, (0, 0)))
    try:
        exponent, p, _ = hill.refined(system, value, guess, ACCURACY, half_turn)
    except PeriodicError:
        return None
    return (exponent, p) if _alike(p, guess) > MIN_LIKENESS else None


def _followed(
    system: Periodic, parity: float, signs: Array, motions: tuple[Array, Array], mode: tuple[complex, Complex]
) -> tuple[complex, Complex] | None:
    """``_led`` by way of modes with a few motions more at a time."""
    X, half_turn = motions
    value, p = mode
    for size in range(p.shape[1] + MORE_MOTIONS, len(X), MORE_MOTIONS):
        wider = np.pad(p, ((0, 0), (0, size - p.shape[1])))
        if (led := _led(_restricted(system, X[:, :size]), parity * half_turn[:size], value, wider)) is None:
            return None
        value, p = led
    return _led(system, parity * signs, value, p @ X[:, : p.shape[1]].T)


def _restricted(system: Periodic, X: Array) -> Periodic:
    """The system restricted to the motions X (n, k)."""
    M, C, K = (X.T @ part @ X for part in (system.M, system.C, system.K))
    return Periodic(system.omega, system.names[: X.shape[1]], M, C, K)


def _alike(p: Complex, q: Complex) -> float:
    """Modal assurance criterion of motions by their harmonics (2H + 1, n)."""
    H = max(len(p), len(q)) // 2
    x, y = (np.pad(z, ((H - len(z) // 2,) * 2, (0, 0))).ravel() for z in (p, q))
    return float(abs(np.vdot(x, y)) ** 2 / (np.vdot(x, x) * np.vdot(y, y)).real)


def _confirmed(
    system: Periodic, half_turn: Array, exponents: Exponents, mode: int, largest: int
) -> tuple[complex, Complex]:
    """An exponent of Floquet's method and its harmonics about the largest, by Hill's method.

    Raises:
        PeriodicError: Hill's method does not converge, or finds another exponent.
    """
    order = largest - len(exponents.shapes) // 2
    value = complex(exponents.values[mode]) + 1j * order * exponents.omega
    top = min(largest, len(exponents.shapes) - 1 - largest)
    about = exponents.shapes[largest - top : largest + top + 1, :, mode]
    exponent, harmonics, error = hill.refined(system, value, about, ACCURACY, (-1.0) ** order * half_turn)
    apart = abs(exponent - value)
    if apart > 10.0 * max(ACCURACY * abs(exponents.omega), error, float(exponents.error[mode])):
        raise PeriodicError(
            f"exponents: Floquet's and Hill's method differ by {apart:.1e} 1/s near {abs(value):.4g} rad/s, more than their "
            "errors; give other speeds, and please report this"
        )
    return exponent, harmonics


def _held(a: Assembled, system: Periodic) -> Periodic:
    """The system with a weak spring against the rotation of the rotor with the generator."""
    z = np.zeros(len(a.M))
    z[list(a.shaft)] = 1.0
    w = system.mean[0] @ z
    K = system.K.copy()
    K[system.harmonics] += (HELD * system.omega) ** 2 / (z @ w) * np.outer(w, w)
    return replace(system, K=K)


def _motions(system: Periodic, signs: Array) -> tuple[Array, Array]:
    """(n, n) motions of the mean over the azimuth, without gyroscopic forces, the lowest first, and the sign (n,) of each."""
    M, _, K = system.mean
    squares, motions, of_motions = [], [], []
    for sign in (1.0, -1.0):
        part = np.flatnonzero(signs == sign)
        unit = 1.0 / np.sqrt(np.diagonal(M)[part])
        scaled = (unit[:, None] * 0.5 * (A + A.T)[np.ix_(part, part)] * unit for A in (K, M))
        values, vectors = scipy.linalg.eigh(*scaled)
        X = np.zeros((len(signs), len(part)))
        X[part] = unit[:, None] * vectors
        squares.append(values)
        motions.append(X)
        of_motions.append(np.full(len(part), sign))
    order = np.argsort(np.concatenate(squares))
    return np.concatenate(motions, axis=1)[:, order], np.concatenate(of_motions)[order]


def _largest(exponents: Exponents) -> NDArray[np.intp]:
    """(2n,) index of the largest harmonic of each exponent; of equal ones, that with the lowest frequency."""
    top = exponents.participation >= (1.0 - EQUAL) * exponents.participation.max(0)
    return np.where(top, np.abs(exponents.candidates), np.inf).argmin(0)
