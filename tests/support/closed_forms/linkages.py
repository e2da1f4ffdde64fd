"""Closed loops whose eigenvalues are known: plane linkages on a turntable and a spinning ring.

For each, the mechanism at speed Ω (rad/s) and its eigenvalues λ (1/s), one of each pair; see ``forms``.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from southwell.core import multibody as mb
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.element.discretize import discretize
from southwell.core.space import spatial as sp
from southwell.core.tree.as_mechanism import single_element

Complex = NDArray[np.complex128]

# --------------------------------------------------------------------------------------------------- plane linkages

CRANK, CONNECTING, _SPRING = 0.5, 2.0, 40.0
_CRANK_MASS, _CONNECTING_MASS, _SLIDER_MASS = 3.0, 2.0, 5.0


def bar(name: str, length: float, mass: float) -> mb.Body:
    """A uniform thin bar along x from its frame's origin."""
    moments = np.array([0.0, mass * length**2 / 12, mass * length**2 / 12])
    return mb.Body(name, mb.inertia(mass, moments, (length / 2, 0.0, 0.0)))


def slider_crank(omega: float) -> mb.Mechanism:
    """Crank, rod and slider in line on a table that rotates about the crank's pivot, a torsion spring there; a closed loop."""
    return mb.Mechanism(
        (
            mb.Body("table"),
            bar("crank", CRANK, _CRANK_MASS),
            bar("rod", CONNECTING, _CONNECTING_MASS),
            mb.Body("slider", mb.inertia(_SLIDER_MASS)),
        ),
        (
            mb.Joint("turn", "revolute", "ground", "table"),
            mb.Joint("O", "revolute", "table", "crank"),
            mb.Joint("P", "revolute", "crank", "rod", mb.at(CRANK)),
            mb.Joint("Q", "revolute", "rod", "slider", mb.at(CONNECTING)),
            mb.Joint("guide", "prismatic", "table", "slider", mb.at(axis="x"), mb.at(axis="x"), cut=True),
        ),
        (mb.Motion("turn.rz", rate=omega),),
        coordinate_springs=(mb.CoordinateSpring("O.rz", _SPRING),),
    )


def slider_crank_values(omega: float) -> Complex:
    """``ω² = [k + Ω² (m_s (r + l) r (1 + r/l) + ½ m_l r l (1 + r/l)²)]/[(m_r + m_l) r²/3]``.

    From ``V = ½ k θ² − ½ Ω² Σ m |x|²`` about the line of centres, where the rod rotates by −(r/l) θ and the slider rests.
    """
    r, rod = CRANK, CONNECTING
    pulled = _SLIDER_MASS * (r + rod) * r * (1 + r / rod) + 0.5 * _CONNECTING_MASS * r * rod * (1 + r / rod) ** 2
    moved = (_CRANK_MASS + _CONNECTING_MASS) * r**2 / 3
    return np.array([1j * np.sqrt((_SPRING + omega**2 * pulled) / moved)])


_SHORT, _LONG, _TORSION, _UNSPRUNG = 1.0, 2.0, 60.0, 2.2
_ROCKER_MASS, _COUPLER_MASS = 1.5, 3.0


def parallelogram(omega: float) -> mb.Mechanism:
    """A parallelogram of four bars on a table that rotates about the crank's pivot, a torsion spring there; a closed loop."""
    return mb.Mechanism(
        (
            mb.Body("table"),
            bar("crank", _SHORT, _ROCKER_MASS),
            bar("coupler", _LONG, _COUPLER_MASS),
            bar("rocker", _SHORT, _ROCKER_MASS),
        ),
        (
            mb.Joint("turn", "revolute", "ground", "table"),
            mb.Joint("A", "revolute", "table", "crank"),
            mb.Joint("B", "revolute", "crank", "coupler", mb.at(_SHORT)),
            mb.Joint("C", "revolute", "coupler", "rocker", mb.at(_LONG), mb.at(_SHORT), cut=True),
            mb.Joint("D", "revolute", "table", "rocker", mb.at(_LONG)),
        ),
        (mb.Motion("turn.rz", rate=omega),),
        coordinate_springs=(mb.CoordinateSpring("A.rz", _TORSION, 0.0, _UNSPRUNG),),
    )


def parallelogram_angle(omega: float) -> float:
    """The crank's steady angle: ``k (θ − θ₀) + ½ Ω² c sin θ = 0``, with ``c = (m_coupler + m_rocker) a b``."""
    outward = 0.5 * omega**2 * (_COUPLER_MASS + _ROCKER_MASS) * _SHORT * _LONG
    return float(
        np.asarray(brentq(lambda t: _TORSION * (t - _UNSPRUNG) + outward * np.sin(t), 0.0, _UNSPRUNG, xtol=1e-15))
    )


def parallelogram_values(omega: float) -> Complex:
    """``ω² = (k + ½ Ω² c cos θ)/[(m_crank + m_rocker) a²/3 + m_coupler a²]``: the coupler moves without rotation."""
    outward = 0.5 * omega**2 * (_COUPLER_MASS + _ROCKER_MASS) * _SHORT * _LONG
    moved = (2 * _ROCKER_MASS / 3 + _COUPLER_MASS) * _SHORT**2
    return np.array([1j * np.sqrt((_TORSION + outward * np.cos(parallelogram_angle(omega))) / moved)])


# ------------------------------------------------------------------------------------------------------ a spinning ring

_RADIUS, _EI, _EA, _LINE = 1.0, 2.0, 2e5, 0.5
ARCS = 16


def ring(omega: float, arcs: int = ARCS) -> mb.Mechanism:
    """A thin ring of curved beams, free on a frame that rotates about the ring's axis: a closed loop."""
    angle, nine = np.linspace(0.0, 2 * np.pi / arcs, 9), np.ones(9)
    arc = Blade(
        "arc",
        _RADIUS * angle,
        section_stiffness(_EA * nine, _EI * nine, 10 * _EI * nine, _EI * nine),
        section_mass(_LINE * nine),
        np.zeros(9),
        curve=_RADIUS * np.stack([np.sin(angle), 1 - np.cos(angle), 0 * angle], axis=1),
    )
    element = single_element(discretize(arc, 1).beams, 0)
    place = sp.pose(sp.rotation(2, np.array(np.pi / 2)), np.array([_RADIUS, 0.0, 0.0]))
    names = [f"b{k}" for k in range(arcs)]
    return mb.Mechanism(
        (mb.Body("frame"), *map(mb.Body, names)),
        (
            mb.Joint("turn", "revolute", "ground", "frame"),
            mb.Joint("float", "free", "frame", "b0", place),
            *(mb.Joint(f"j{k}", "elastic", names[k - 1], names[k], element.undeformed[0]) for k in range(1, arcs)),
        ),
        (mb.Motion("turn.rz", rate=omega),),
        beams=tuple(mb.Beam(names[k], names[(k + 1) % arcs], element) for k in range(arcs)),
    )


def ring_values(omega: float) -> Complex:
    """``n [±(n² − 1) √(Ω² + (n² + 1) EI/(μ R⁴)) − 2 Ω]/(n² + 1)``, inextensible, in the rotating frame (Carrier 1945)."""
    out = []
    for n in (2, 3):
        root = (n**2 - 1) * np.sqrt(omega**2 + (n**2 + 1) * _EI / (_LINE * _RADIUS**4))
        out += [1j * abs(n * (sign * root - 2 * omega) / (n**2 + 1)) for sign in (1, -1)]
    return np.array(out)
