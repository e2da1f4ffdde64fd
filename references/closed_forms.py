"""Mechanisms on a turning base whose eigenvalues are known in closed form, and the same as core is given them.

Each is a function of the speed Ω: ``exact`` gives one eigenvalue λ (1/s) of each pair, ``iω`` where it oscillates and a real
growth rate where the steady state has lost its stability.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core import multibody as mb
from ..core import spatial as sp
from ..core.blade import Blade, section_mass, section_stiffness
from ..core.chain_mechanism import one
from ..core.discretize import discretize

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

G = 9.81


@dataclass(frozen=True)
class ClosedForm:
    """A mechanism, its closed form, and where both are looked at.

    Attributes:
        name: short, of its figure's file.
        title: what it is.
        formula: in LaTeX.
        source: author and year, or the textbook's derivation.
        about: what there is to see.
        branches: names of what ``exact`` gives, in its order.
        speeds: (k,) Ω, rad/s.
        critical: speeds at which the steady state changes its stability, rad/s.
        exact: Ω → (branches,) λ, 1/s; nan where a branch does not exist.
        solve: Ω → core's λ (m,), 1/s, of the steady state in question.
        target: relative difference that core must keep: of rounding, or of its discretisation.
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
    """Core's eigenvalue nearest to each branch's, none taken twice, and the relative difference (branches,); nan if none."""
    exact, found = form.exact(omega), list(form.solve(omega))
    taken, off = np.full(len(exact), np.nan, complex), np.full(len(exact), np.nan)
    for k in np.flatnonzero(np.isfinite(exact)):
        taken[k] = found.pop(int(np.argmin([abs(v - exact[k]) for v in found])))
        off[k] = abs(taken[k] - exact[k]) / abs(exact[k])
    return taken, off


def _values(mechanism: mb.Mechanism, guess: Mapping[str, float] | None = None) -> Complex:
    """Core's λ: of a pair the one with Im λ ≥ 0, of a real pair the one that grows."""
    found = mb.solve(mechanism, guess).values
    tiny = 1e-9 * np.abs(found).max(initial=0.0)
    return found[(found.imag > tiny) | (found.real > tiny)]


# ----------------------------------------------------------------------------------------------- a mass on a turntable

_MASS, _KX, _KY = 2.0, 50.0, 98.0


def turntable(omega: float) -> mb.Mechanism:
    """A mass on two springs at right angles, on a table that turns."""
    return mb.Mechanism(
        (mb.Body("table"), mb.Body("slide"), mb.Body("mass", mb.inertia(_MASS))),
        (
            mb.Joint("turn", "revolute", "ground", "table"),
            mb.Joint("x", "prismatic", "table", "slide", mb.at(axis="x"), mb.at(axis="x")),
            mb.Joint("y", "prismatic", "slide", "mass", mb.at(axis="y"), mb.at(axis="y")),
        ),
        (mb.Motion("turn.rz", rate=omega),),
        coordinate_springs=(mb.CoordinateSpring("x.z", _KX), mb.CoordinateSpring("y.z", _KY)),
    )


def turntable_values(omega: float) -> Complex:
    """The two roots of ``(kx/m − Ω² + λ²)(ky/m − Ω² + λ²) + 4 Ω² λ² = 0``, the slower first."""
    a, b = _KX / _MASS - omega**2, _KY / _MASS - omega**2
    slow, fast = np.sort(np.roots([1.0, -(a + b + 4 * omega**2), a * b]).real)
    return np.array([1j * np.sqrt(slow) if slow >= 0 else np.sqrt(-slow), 1j * np.sqrt(fast)])


# -------------------------------------------------------------------------------------------------- a conical pendulum

_LENGTH = 1.0


def pendulum(omega: float, held: bool) -> mb.Mechanism:
    """A bob on an arm that swings in a plane, which turns at a prescribed rate, or freely."""
    return mb.Mechanism(
        (mb.Body("arm"), mb.Body("bob", mb.inertia(1.0, 0.0, (0.0, 0.0, -_LENGTH)))),
        (
            mb.Joint("turn", "revolute", "ground", "arm"),
            mb.Joint("swing", "revolute", "arm", "bob", mb.at(axis="y"), mb.at(axis="y")),
        ),
        (mb.Motion("turn.rz", rate=omega, held=held),),
        gravity=(0.0, 0.0, -G),
    )


def pendulum_values(omega: float) -> Complex:
    """``√(g/l − Ω²)`` hanging; with ``cos θ = g/(l Ω²)``, ``Ω sin θ``, and ``Ω √(1 + 3 cos² θ)`` if the plane turns freely."""
    cosine = G / (_LENGTH * omega**2) if omega else np.inf
    if cosine >= 1.0:
        return np.array([1j * np.sqrt(G / _LENGTH - omega**2), np.nan])
    return 1j * omega * np.array([np.sqrt(1 - cosine**2), np.sqrt(1 + 3 * cosine**2)])


def _pendulum_solved(omega: float) -> Complex:
    if omega**2 * _LENGTH <= G:
        return _values(pendulum(omega, held=True))
    free = _values(pendulum(omega, held=False), {"swing.rz": -1.0})
    return np.append(_values(pendulum(omega, held=True), {"swing.rz": -1.0}), free[np.argmax(np.abs(free))])


# --------------------------------------------------------------------------------------------------- a heavy symmetric top

_I1, _I3, _WEIGHT, _TILT = 0.5, 0.2, 2.0, 0.6


def top(precession: float) -> mb.Mechanism:
    """A symmetric top in gimbals, precessing steadily at a tilt that its spin is made for; nothing is held."""
    arm = _WEIGHT / G
    spin = (_I1 * precession**2 * np.cos(_TILT) + _WEIGHT) / (_I3 * precession) - precession * np.cos(_TILT)
    moments = np.array([_I1 - arm**2, _I1 - arm**2, _I3])
    return mb.Mechanism(
        (mb.Body("yoke"), mb.Body("cradle"), mb.Body("rotor", mb.inertia(1.0, moments, (0.0, 0.0, arm)))),
        (
            mb.Joint("precession", "revolute", "ground", "yoke"),
            mb.Joint("nutation", "revolute", "yoke", "cradle", mb.at(axis="y"), mb.at(axis="y")),
            mb.Joint("spin", "revolute", "cradle", "rotor"),
        ),
        (
            mb.Motion("precession.rz", rate=precession, held=False),
            mb.Motion("spin.rz", rate=spin, held=False),
        ),
        gravity=(0.0, 0.0, -G),
    )


def top_values(precession: float) -> Complex:
    """``ω² = Ω² − 2 (mgl/I₁) cos θ + (mgl/(I₁ Ω))²`` (Landau and Lifshitz, Mechanics, §35)."""
    ratio = _WEIGHT / _I1
    return np.array([1j * np.sqrt(precession**2 - 2 * ratio * np.cos(_TILT) + (ratio / precession) ** 2)])


def _top_solved(precession: float) -> Complex:
    found = _values(top(precession), {"nutation.rz": _TILT})
    return found[[np.argmax(np.abs(found))]]


# ------------------------------------------------------------------------------------------------------ a spinning ring

_RADIUS, _EI, _EA, _LINE = 1.0, 2.0, 2e5, 0.5
_ARCS = 16


def ring(omega: float) -> mb.Mechanism:
    """A thin ring of curved beams, free on a frame that turns about the ring's axis: a closed loop."""
    angle, nine = np.linspace(0.0, 2 * np.pi / _ARCS, 9), np.ones(9)
    arc = Blade(
        "arc",
        _RADIUS * angle,
        section_stiffness(_EA * nine, _EI * nine, 10 * _EI * nine, _EI * nine),
        section_mass(_LINE * nine),
        np.zeros(9),
        curve=_RADIUS * np.stack([np.sin(angle), 1 - np.cos(angle), 0 * angle], axis=1),
    )
    element = one(discretize(arc, 1).beams, 0)
    place = sp.pose(sp.rotation(2, np.array(np.pi / 2)), np.array([_RADIUS, 0.0, 0.0]))
    names = [f"b{k}" for k in range(_ARCS)]
    return mb.Mechanism(
        (mb.Body("frame"), *map(mb.Body, names)),
        (
            mb.Joint("turn", "revolute", "ground", "frame"),
            mb.Joint("float", "free", "frame", "b0", place),
            *(mb.Joint(f"j{k}", "elastic", names[k - 1], names[k], element.rest[0]) for k in range(1, _ARCS)),
        ),
        (mb.Motion("turn.rz", rate=omega),),
        beams=tuple(mb.Beam(names[k], names[(k + 1) % _ARCS], element) for k in range(_ARCS)),
    )


def ring_values(omega: float) -> Complex:
    """``n [±(n² − 1) √(Ω² + (n² + 1) EI/(μ R⁴)) − 2 Ω]/(n² + 1)``, in-plane, inextensible, seen turning (Carrier 1945)."""
    out = []
    for n in (2, 3):
        root = (n**2 - 1) * np.sqrt(omega**2 + (n**2 + 1) * _EI / (_LINE * _RADIUS**4))
        out += [1j * abs(n * (sign * root - 2 * omega) / (n**2 + 1)) for sign in (1, -1)]
    return np.array(out)


FORMS: tuple[ClosedForm, ...] = (
    ClosedForm(
        "turntable",
        "A mass on two springs on a turntable",
        r"\left(\frac{k_x}{m} - \Omega^2 - \omega^2\right) \left(\frac{k_y}{m} - \Omega^2 - \omega^2\right) "
        r"= 4 \Omega^2 \omega^2",
        "the classical unsymmetrical rotor in turning axes",
        "Both branches are coupled by the Coriolis force. Between the speeds that equal the springs' own frequencies the mass "
        "runs away without oscillating; beyond the second it is stable again, held by the Coriolis force alone.",
        ("slower", "faster"),
        np.linspace(0.1, 9.9, 50),
        (np.sqrt(_KX / _MASS), np.sqrt(_KY / _MASS)),
        turntable_values,
        lambda omega: _values(turntable(omega)),
        1e-9,
    ),
    ClosedForm(
        "pendulum",
        "A pendulum in a turning plane",
        r"\omega^2 = \frac{g}{l} - \Omega^2 \;\text{hanging}, \qquad \omega = \Omega \sin\theta \;\text{or}\; "
        r"\Omega \sqrt{1 + 3 \cos^2\theta} \;\text{on the cone}\; \cos\theta = \frac{g}{l \Omega^2}",
        "textbook",
        "At the critical speed the bob leaves the axis; the steady cone is found by core, from a guess of 57°. With the "
        "plane's rate prescribed it swings at Ω sin θ; turning freely, by conservation of momentum, faster.",
        ("rate prescribed", "turning freely"),
        np.concatenate([np.linspace(0.0, 3.0, 11), np.linspace(3.25, 8.0, 20)]),
        (np.sqrt(G / _LENGTH),),
        pendulum_values,
        _pendulum_solved,
        1e-8,
    ),
    ClosedForm(
        "top",
        "Nutation of a heavy symmetric top",
        r"\omega^2 = \Omega^2 - 2 \frac{mgl}{I_1} \cos\theta + \left(\frac{mgl}{I_1 \Omega}\right)^2",
        "Landau and Lifshitz, Mechanics, §35",
        "Steady precession at Ω, tilted by 0.6 rad, with the spin that this needs. The fast top precesses slowly and "
        "nutates fast.",
        ("nutation",),
        np.linspace(0.8, 8.0, 25),
        (),
        top_values,
        _top_solved,
        1e-7,
    ),
    ClosedForm(
        "ring",
        "A spinning ring",
        r"\omega = \frac{n}{n^2 + 1} \left| \pm (n^2 - 1) \sqrt{\Omega^2 + (n^2 + 1) \frac{EI}{\mu R^4}} - 2 \Omega \right|",
        "G. F. Carrier, Quarterly of Applied Mathematics 3 (1945) 235",
        f"A loop of {_ARCS} curved beam elements. Turning splits each pair of modes into a wave that runs forward and one that "
        "runs backward. The form is of an inextensible ring of Euler and Bernoulli; what is left is discretisation.",
        ("n = 2, forward", "n = 2, backward", "n = 3, forward", "n = 3, backward"),
        np.linspace(0.0, 1.5, 4),
        (),
        ring_values,
        lambda omega: _values(ring(omega)),
        1e-3,
    ),
)
"""Those of the documentation's page; ``tests`` hold core to each."""
