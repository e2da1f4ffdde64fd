"""Pendulums, a top and a turntable: mechanisms without loops whose eigenvalues are known.

For each, the mechanism at speed Ω (rad/s) and its eigenvalues λ (1/s), one of each pair; see ``forms``.
"""

import numpy as np
from numpy.typing import NDArray

from southwell.core import multibody as mb

Complex = NDArray[np.complex128]

G = 9.81

# ----------------------------------------------------------------------------------------------- a mass on a turntable

MASS, KX, KY = 2.0, 50.0, 98.0


def turntable(omega: float) -> mb.Mechanism:
    """A mass on two springs at right angles, on a rotating table."""
    return mb.Mechanism(
        (mb.Body("table"), mb.Body("slide"), mb.Body("mass", mb.inertia(MASS))),
        (
            mb.Joint("turn", "revolute", "ground", "table"),
            mb.Joint("x", "prismatic", "table", "slide", mb.at(axis="x"), mb.at(axis="x")),
            mb.Joint("y", "prismatic", "slide", "mass", mb.at(axis="y"), mb.at(axis="y")),
        ),
        (mb.Motion("turn.rz", rate=omega),),
        coordinate_springs=(mb.CoordinateSpring("x.z", KX), mb.CoordinateSpring("y.z", KY)),
    )


def turntable_values(omega: float) -> Complex:
    """The two roots of ``(kx/m − Ω² + λ²)(ky/m − Ω² + λ²) + 4 Ω² λ² = 0``, the slower first."""
    a, b = KX / MASS - omega**2, KY / MASS - omega**2
    slow, fast = np.sort(np.roots([1.0, -(a + b + 4 * omega**2), a * b]).real)
    return np.array([1j * np.sqrt(slow) if slow >= 0 else np.sqrt(-slow), 1j * np.sqrt(fast)])


# -------------------------------------------------------------------------------------------------- a conical pendulum

LENGTH = 1.0


def pendulum(omega: float, prescribed: bool) -> mb.Mechanism:
    """A bob on an arm that swings in a plane, which rotates at a prescribed rate or freely."""
    return mb.Mechanism(
        (mb.Body("arm"), mb.Body("bob", mb.inertia(1.0, 0.0, (0.0, 0.0, -LENGTH)))),
        (
            mb.Joint("turn", "revolute", "ground", "arm"),
            mb.Joint("swing", "revolute", "arm", "bob", mb.at(axis="y"), mb.at(axis="y")),
        ),
        (mb.Motion("turn.rz", rate=omega, prescribed=prescribed),),
        gravity=(0.0, 0.0, -G),
    )


def pendulum_values(omega: float) -> Complex:
    """``√(g/l − Ω²)`` hanging; with ``cos θ = g/(l Ω²)``, ``Ω sin θ``, and ``Ω √(1 + 3 cos² θ)`` if it rotates freely."""
    cosine = G / (LENGTH * omega**2) if omega else np.inf
    if cosine >= 1.0:
        return np.array([1j * np.sqrt(G / LENGTH - omega**2), np.nan])
    return 1j * omega * np.array([np.sqrt(1 - cosine**2), np.sqrt(1 + 3 * cosine**2)])


# --------------------------------------------------------------------------------------------------- a heavy symmetric top

_I1, _I3, _WEIGHT, TILT = 0.5, 0.2, 2.0, 0.6


def top(precession: float) -> mb.Mechanism:
    """A symmetric top in gimbals that precesses steadily at a tilt, with the spin that this requires; nothing is prescribed."""
    arm = _WEIGHT / G
    spin = (_I1 * precession**2 * np.cos(TILT) + _WEIGHT) / (_I3 * precession) - precession * np.cos(TILT)
    moments = np.array([_I1 - arm**2, _I1 - arm**2, _I3])
    return mb.Mechanism(
        (mb.Body("yoke"), mb.Body("cradle"), mb.Body("rotor", mb.inertia(1.0, moments, (0.0, 0.0, arm)))),
        (
            mb.Joint("precession", "revolute", "ground", "yoke"),
            mb.Joint("nutation", "revolute", "yoke", "cradle", mb.at(axis="y"), mb.at(axis="y")),
            mb.Joint("spin", "revolute", "cradle", "rotor"),
        ),
        (
            mb.Motion("precession.rz", rate=precession, prescribed=False),
            mb.Motion("spin.rz", rate=spin, prescribed=False),
        ),
        gravity=(0.0, 0.0, -G),
    )


def top_values(precession: float) -> Complex:
    """``ω² = Ω² − 2 (mgl/I₁) cos θ + (mgl/(I₁ Ω))²`` (Landau and Lifshitz, Mechanics, §35)."""
    ratio = _WEIGHT / _I1
    return np.array([1j * np.sqrt(precession**2 - 2 * ratio * np.cos(TILT) + (ratio / precession) ** 2)])


# ------------------------------------------------------------------------------------------------- a double pendulum

ROD = 1.0


def double_pendulum(omega: float) -> mb.Mechanism:
    """Two equal bobs on equal massless rods, one below the other, in a plane that rotates at a prescribed rate."""
    bob, pin = mb.inertia(1.0, 0.0, (0.0, 0.0, -ROD)), mb.at(axis="y")
    return mb.Mechanism(
        (mb.Body("yoke"), mb.Body("upper", bob), mb.Body("lower", bob)),
        (
            mb.Joint("turn", "revolute", "ground", "yoke"),
            mb.Joint("a", "revolute", "yoke", "upper", pin, pin),
            mb.Joint("b", "revolute", "upper", "lower", mb.at(z=-ROD, axis="y"), pin),
        ),
        (mb.Motion("turn.rz", rate=omega),),
        gravity=(0.0, 0.0, -G),
    )


def double_pendulum_values(omega: float) -> Complex:
    """``(2 ∓ √2) g/l − Ω²``: the centrifugal forces' matrix is Ω² times that of the mass, so every ω² loses Ω²."""
    square = (2 + np.sqrt(2) * np.array([-1.0, 1.0])) * G / ROD - omega**2
    return np.where(square >= 0, 1j * np.sqrt(np.abs(square)), np.sqrt(np.abs(square)))
