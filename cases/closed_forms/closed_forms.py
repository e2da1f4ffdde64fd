"""Mechanisms on a rotating base with closed-form eigenvalues, core's eigenvalues of them, and the differences.

Each is a function of the speed Ω: ``exact`` gives one eigenvalue λ (1/s) of each pair, ``iω`` where it oscillates and a real
growth rate where the steady state has lost its stability.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core import multibody as mb
from . import linkages, pendulums

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class ClosedForm:
    """A mechanism, its closed form, and the speeds at which they are compared.

    Attributes:
        name: short name, also of its figure's file.
        title: what it is.
        formula: in LaTeX.
        source: author and year, or the textbook's derivation.
        about: remarks on the comparison.
        branches: names of the eigenvalues that ``exact`` returns, in its order.
        speeds: (k,) Ω, rad/s.
        critical: speeds at which the steady state changes its stability, rad/s.
        exact: Ω → (branches,) λ, 1/s; nan where a branch does not exist.
        solve: Ω → core's λ (m,), 1/s, of the steady state in question.
        target: largest relative difference allowed: rounding, or core's discretisation error.
    """

    name: str
    title: str
    formula: str
    source: str
    about: str
    branches: tuple[str, ...]
    speeds: Array
    critical: tuple[float, ...]
    exact: Callable[[float], Complex]
    solve: Callable[[float], Complex]
    target: float


def differences(form: ClosedForm, omega: float) -> tuple[Complex, Array]:
    """For each branch, core's nearest eigenvalue, used once, and the relative difference; both (branches,), nan if none."""
    exact, found = form.exact(omega), list(form.solve(omega))
    taken, off = np.full(len(exact), np.nan, complex), np.full(len(exact), np.nan)
    for k in np.flatnonzero(np.isfinite(exact)):
        taken[k] = found.pop(int(np.argmin([abs(v - exact[k]) for v in found])))
        off[k] = abs(taken[k] - exact[k]) / abs(exact[k])
    return taken, off


def oscillating(mechanism: mb.Mechanism, guess: Mapping[str, float] | None = None) -> Complex:
    """Core's λ: of a pair the one with Im λ ≥ 0, of a real pair the one that grows."""
    found = mb.solve(mechanism, guess).values
    tiny = 1e-9 * np.abs(found)  # each by its own size: massless directions have values without bound
    return found[(found.imag > tiny) | (found.real > tiny)]


def _pendulum_solved(omega: float) -> Complex:
    if omega**2 * pendulums.LENGTH <= pendulums.G:
        return oscillating(pendulums.pendulum(omega, prescribed=True))
    free = oscillating(pendulums.pendulum(omega, prescribed=False), {"swing.rz": -1.0})
    return np.append(
        oscillating(pendulums.pendulum(omega, prescribed=True), {"swing.rz": -1.0}), free[np.argmax(np.abs(free))]
    )


def _top_solved(precession: float) -> Complex:
    found = oscillating(pendulums.top(precession), {"nutation.rz": pendulums.TILT})
    return found[[np.argmax(np.abs(found))]]


def _parallelogram_solved(omega: float) -> Complex:
    theta = linkages.parallelogram_angle(omega) + 0.1  # a guess: core finds the angle
    return oscillating(linkages.parallelogram(omega), {"A.rz": theta, "B.rz": -theta, "D.rz": theta})


FORMS: tuple[ClosedForm, ...] = (
    ClosedForm(
        "turntable",
        "A mass on two springs on a turntable",
        r"\left(\frac{k_x}{m} - \Omega^2 - \omega^2\right) \left(\frac{k_y}{m} - \Omega^2 - \omega^2\right) "
        r"= 4 \Omega^2 \omega^2",
        "the classical unsymmetrical rotor in rotating axes",
        "Both branches are coupled by the Coriolis force. Between the two natural frequencies at rest the mass diverges "
        "without oscillation; above the second it is stable again, because of the Coriolis force alone.",
        ("slower", "faster"),
        np.linspace(0.1, 9.9, 50),
        (np.sqrt(pendulums.KX / pendulums.MASS), np.sqrt(pendulums.KY / pendulums.MASS)),
        pendulums.turntable_values,
        lambda omega: oscillating(pendulums.turntable(omega)),
        1e-9,
    ),
    ClosedForm(
        "pendulum",
        "A pendulum in a rotating plane",
        r"\omega^2 = \frac{g}{l} - \Omega^2 \;\text{hanging}, \qquad \omega = \Omega \sin\theta \;\text{or}\; "
        r"\Omega \sqrt{1 + 3 \cos^2\theta} \;\text{on the cone}\; \cos\theta = \frac{g}{l \Omega^2}",
        "textbook",
        "At the critical speed the bob leaves the axis. Core finds the steady cone from a guess of 57°. If the rate of the "
        "plane is prescribed, the pendulum oscillates at Ω sin θ; if the plane rotates freely, it oscillates faster.",
        ("rate prescribed", "free rotation"),
        np.concatenate([np.linspace(0.0, 3.0, 11), np.linspace(3.25, 8.0, 20)]),
        (np.sqrt(pendulums.G / pendulums.LENGTH),),
        pendulums.pendulum_values,
        _pendulum_solved,
        1e-8,
    ),
    ClosedForm(
        "top",
        "Nutation of a heavy symmetric top",
        r"\omega^2 = \Omega^2 - 2 \frac{mgl}{I_1} \cos\theta + \left(\frac{mgl}{I_1 \Omega}\right)^2",
        "Landau and Lifshitz, Mechanics, §35",
        "Steady precession at Ω with a tilt of 0.6 rad and the spin that this requires. A top that spins fast precesses slowly "
        "and nutates fast.",
        ("nutation",),
        np.linspace(0.8, 8.0, 25),
        (),
        pendulums.top_values,
        _top_solved,
        1e-7,
    ),
    ClosedForm(
        "double-pendulum",
        "A double pendulum in a rotating plane",
        r"\omega^2 = \left(2 \mp \sqrt{2}\right) \frac{g}{l} - \Omega^2",
        "textbook; the centrifugal matrix is Ω² times the mass matrix",
        "Equal masses and lengths, hanging; the rate of the plane is prescribed. The slower frequency reaches zero where the "
        "bobs leave the axis; above that speed the hanging position is unstable.",
        ("slower", "faster"),
        np.linspace(0.0, 5.6, 29),
        (
            np.sqrt((2 - np.sqrt(2)) * pendulums.G / pendulums.ROD),
            np.sqrt((2 + np.sqrt(2)) * pendulums.G / pendulums.ROD),
        ),
        pendulums.double_pendulum_values,
        lambda omega: oscillating(pendulums.double_pendulum(omega)),
        1e-9,
    ),
    ClosedForm(
        "slider-crank",
        "A slider-crank on a turntable",
        r"\omega^2 = \frac{k + \Omega^2 \left[m_s (r + l)\, r \left(1 + \frac{r}{l}\right) "
        r"+ \tfrac12 m_l\, r\, l \left(1 + \frac{r}{l}\right)^2\right]}{\tfrac13 (m_r + m_l)\, r^2}",
        "one coordinate, from the potential of the spring and of the centrifugal forces",
        "Crank, rod and slider in a radial line, a torsion spring at the crank; the rate of the table is prescribed. The "
        "closed loop leaves one degree of freedom, which the centrifugal force stiffens: Southwell's relation is exact.",
        ("crank",),
        np.linspace(0.0, 10.0, 21),
        (),
        linkages.slider_crank_values,
        lambda omega: oscillating(linkages.slider_crank(omega), {"guide.z": linkages.CRANK + linkages.CONNECTING}),
        1e-9,
    ),
    ClosedForm(
        "four-bar",
        "A parallelogram linkage on a turntable",
        r"\omega^2 = \frac{k + \tfrac12 \Omega^2 c \cos\theta}{\tfrac13 (m_A + m_D)\, a^2 + m_B\, a^2}, \qquad "
        r"k (\theta - \theta_0) + \tfrac12 \Omega^2 c \sin\theta = 0, \quad c = (m_B + m_D)\, a\, b",
        "one coordinate, from the potential of the spring and of the centrifugal forces",
        "A planar four-bar loop, with three redundant constraints in space; a torsion spring at the crank, the table driven "
        "about the same pivot. The linkage extends as it rotates faster, so the frequency first falls and then rises. Core "
        "finds the steady angle from a guess six degrees away.",
        ("crank",),
        np.linspace(0.0, 7.0, 29),
        (),
        linkages.parallelogram_values,
        _parallelogram_solved,
        1e-8,
    ),
    ClosedForm(
        "ring",
        "A spinning ring",
        r"\omega = \frac{n}{n^2 + 1} \left| \pm (n^2 - 1) \sqrt{\Omega^2 + (n^2 + 1) \frac{EI}{\mu R^4}} - 2 \Omega \right|",
        "G. F. Carrier, Quarterly of Applied Mathematics 3 (1945) 235",
        f"A loop of {linkages.ARCS} curved beam elements. Rotation splits each pair of modes into a forward and a backward "
        "wave. The closed form is for an inextensible Euler–Bernoulli ring; the difference is the discretisation error.",
        ("n = 2, forward", "n = 2, backward", "n = 3, forward", "n = 3, backward"),
        np.linspace(0.0, 1.5, 4),
        (),
        linkages.ring_values,
        lambda omega: oscillating(linkages.ring(omega)),
        1e-3,
    ),
)
"""The closed forms on the documentation's page; the tests check each."""
