"""Modes of a turbine of two blades, whose equations are periodic, by Floquet's and Hill's methods.

A mode moves at the frequencies ω + hΩ, those of the tower in the ground's frame and those of the blades in the rotor's. The
lowest modes are those of the lowest frequencies with the largest participation (``rotor.exponents``). The equations are
restricted to the lowest motions of their mean over the azimuth; what is left out shows as a change when motions are added.
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


@dataclass(frozen=True)
class PeriodicModes:
    """The m lowest modes.

    Attributes:
        values: (m,) growth plus i times the frequency of the largest harmonic, 1/s; frequencies ascend.
        harmonics: (m,) arrays (2H + 1, n): the motion at each harmonic, the largest in the middle.
    """

    values: Complex
    harmonics: tuple[Complex, ...]


def periodic_modes(made: Machine, omega: float, count: int) -> tuple[Assembled, PeriodicModes]:
    """The ``count`` lowest modes at a speed other than 0, rad/s; the rotation of a free rotor is left out.

    Raises:
        PeriodicError: Floquet's or Hill's method does not converge, or they differ.
        SteadyStateError: the blades have no steady state.
    """
    a, system = periodic(made, omega)
    free = made.turbine.drivetrain.free
    with one_thread():
        held = _held(a, system) if free else system
        signs = np.ones(len(a.M))
        signs[[*a.teeter, *a.blades[1]]] = -1.0
        X, half_turn = _lowest(held, signs, count + made.resolution.periodic_motions)
        M, C, K = (X.T @ part @ X for part in (held.M, held.C, held.K))
        reduced = Periodic(omega, held.names[: X.shape[1]], M, C, K)
        exponents = floquet(reduced, half_turn, ACCURACY)
        largest = _largest(exponents)
        frequencies = np.take_along_axis(exponents.candidates, largest[None], 0)[0]
        order = np.argsort(frequencies)[len(frequencies) // 2 :]  # of two conjugates, that with a frequency ≥ 0
        if free:
            order = np.delete(order, np.abs(exponents.values[order]).argmin())
        order = order[:count]
        confirmed = [_confirmed(reduced, half_turn, exponents, int(j), int(largest[j])) for j in order]
    return a, PeriodicModes(
        values=np.array([value for value, _ in confirmed]),
        harmonics=tuple(p @ X.T for _, p in confirmed),
    )


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


def _lowest(system: Periodic, signs: Array, count: int) -> tuple[Array, Array]:
    """(n, k) the lowest motions of the mean over the azimuth, without gyroscopic forces, and the sign (k,) of each."""
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
    order = np.argsort(np.concatenate(squares))[:count]
    return np.concatenate(motions, axis=1)[:, order], np.concatenate(of_motions)[order]


def _largest(exponents: Exponents) -> NDArray[np.intp]:
    """(2n,) index of the largest harmonic of each exponent; of equal ones, that with the lowest frequency."""
    top = exponents.participation >= (1.0 - EQUAL) * exponents.participation.max(0)
    return np.where(top, np.abs(exponents.candidates), np.inf).argmin(0)
