"""Rotating mechanisms whose eigenvalues have a closed form, and core's eigenvalues of them.

``exact`` gives one eigenvalue λ (1/s) of each pair at speed Ω: ``iω`` where it oscillates, a real growth rate where the steady
state is unstable. ``docs/closed-forms.md`` has the formulas and their sources.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from southwell.core import multibody as mb

from . import linkages, pendulums

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class ClosedForm:
    """A mechanism, its closed form, and the speeds at which they are compared.

    Attributes:
        name: short name.
        title: heading of its section in ``docs/closed-forms.md``.
        speeds: (k,) Ω, rad/s.
        exact: Ω → (branches,) λ, 1/s; nan where a branch does not exist.
        solve: Ω → core's λ (m,), 1/s, of the steady state in question.
        target: largest relative difference allowed: rounding, or core's discretisation error.
    """

    name: str
    title: str
    speeds: Array
    exact: Callable[[float], Complex]
    solve: Callable[[float], Complex]
    target: float


def differences(form: ClosedForm, omega: float) -> Array:
    """The relative difference of each branch from core's nearest eigenvalue, used once; (branches,), nan without a branch."""
    exact, values = form.exact(omega), list(form.solve(omega))
    relative = np.full(len(exact), np.nan)
    for k in np.flatnonzero(np.isfinite(exact)):
        nearest = values.pop(int(np.argmin([abs(v - exact[k]) for v in values])))
        relative[k] = abs(nearest - exact[k]) / abs(exact[k])
    return relative


def oscillating(mechanism: mb.Mechanism, guess: Mapping[str, float] | None = None) -> Complex:
    """Core's λ: of a pair the one with Im λ ≥ 0, of a real pair the one that grows."""
    values = mb.solve(mechanism, guess).values
    tiny = 1e-9 * np.abs(values)  # each by its own size: massless directions have values without bound
    return values[(values.imag > tiny) | (values.real > tiny)]


def _pendulum_solved(omega: float) -> Complex:
    if omega**2 * pendulums.LENGTH <= pendulums.G:
        return oscillating(pendulums.pendulum(omega, prescribed=True))
    free = oscillating(pendulums.pendulum(omega, prescribed=False), {"swing.rz": -1.0})
    return np.append(
        oscillating(pendulums.pendulum(omega, prescribed=True), {"swing.rz": -1.0}), free[np.argmax(np.abs(free))]
    )


def _top_solved(precession: float) -> Complex:
    values = oscillating(pendulums.top(precession), {"nutation.rz": pendulums.TILT})
    return values[[np.argmax(np.abs(values))]]


def _parallelogram_solved(omega: float) -> Complex:
    theta = linkages.parallelogram_angle(omega) + 0.1  # a guess: core finds the angle
    return oscillating(linkages.parallelogram(omega), {"A.rz": theta, "B.rz": -theta, "D.rz": theta})


FORMS: tuple[ClosedForm, ...] = (
    ClosedForm(
        "turntable",
        "A mass on two springs on a turntable",
        np.linspace(0.1, 9.9, 16),
        pendulums.turntable_values,
        lambda omega: oscillating(pendulums.turntable(omega)),
        1e-9,
    ),
    ClosedForm(
        "pendulum",
        "A pendulum in a rotating plane",
        np.concatenate([np.linspace(0.0, 3.0, 4), np.linspace(3.25, 8.0, 6)]),
        pendulums.pendulum_values,
        _pendulum_solved,
        1e-8,
    ),
    ClosedForm(
        "top",
        "Nutation of a heavy symmetric top",
        np.linspace(0.8, 8.0, 7),
        pendulums.top_values,
        _top_solved,
        1e-7,
    ),
    ClosedForm(
        "double-pendulum",
        "A double pendulum in a rotating plane",
        np.linspace(0.0, 5.6, 8),
        pendulums.double_pendulum_values,
        lambda omega: oscillating(pendulums.double_pendulum(omega)),
        1e-9,
    ),
    ClosedForm(
        "slider-crank",
        "A slider-crank on a turntable",
        np.linspace(0.0, 10.0, 6),
        linkages.slider_crank_values,
        lambda omega: oscillating(linkages.slider_crank(omega), {"guide.z": linkages.CRANK + linkages.CONNECTING}),
        1e-9,
    ),
    ClosedForm(
        "four-bar",
        "A parallelogram linkage on a turntable",
        np.linspace(0.0, 7.0, 8),
        linkages.parallelogram_values,
        _parallelogram_solved,
        1e-8,
    ),
    ClosedForm(
        "ring",
        "A spinning ring",
        np.array([0.0, 1.5]),
        linkages.ring_values,
        lambda omega: oscillating(linkages.ring(omega)),
        1e-3,
    ),
)
