"""Prescribed motion Φᴹ of a coordinate: at an instant, at a constant rate, or by a law, a given function of time.

A law is called with the time (s) and returns the coordinate (m or rad); its method ``deriv(order)`` returns its analytic
derivatives. ``numpy.polynomial.Polynomial``, ``Harmonic`` and ``Sum`` are laws.
"""

from dataclasses import dataclass, replace
from math import pi, sin
from typing import Any, Protocol, runtime_checkable


@runtime_checkable
class MotionLaw(Protocol):
    """A smooth function of time with analytic derivatives."""

    def __call__(self, time: Any, /) -> Any:
        """The value at a time, s."""
        ...

    def deriv(self, m: int = 1) -> Any:
        """Its m-th derivative, a law too."""
        ...


@dataclass(frozen=True)
class Harmonic:
    """``mean + amplitude sin(frequency t + phase)``; frequency in rad/s, phase in rad."""

    amplitude: float
    frequency: float
    phase: float = 0.0
    mean: float = 0.0

    def __call__(self, time: float, /) -> float:
        """The value at a time, s."""
        return self.mean + self.amplitude * sin(self.frequency * time + self.phase)

    def deriv(self, m: int = 1) -> "Harmonic":
        """Its m-th derivative: each shifts the phase by a quarter turn."""
        if m == 0:
            return self
        return Harmonic(self.amplitude * self.frequency**m, self.frequency, self.phase + 0.5 * pi * m)


@dataclass(frozen=True)
class Sum:
    """Laws added up."""

    laws: tuple[MotionLaw, ...]

    def __call__(self, time: float, /) -> float:
        """The value at a time, s."""
        return sum(float(law(time)) for law in self.laws)

    def deriv(self, m: int = 1) -> "Sum":
        """Its m-th derivative, term by term."""
        return Sum(tuple(law.deriv(m) for law in self.laws))


@dataclass(frozen=True)
class Motion:
    """Motion of one coordinate: position, rate and acceleration at one instant, or a law of time.

    A ``prescribed`` coordinate (Φᴹ) takes no part in vibration. One that is not prescribed has this rate in the
    steady state but moves freely about it: a rotor without speed control, a spinning top.

    Attributes:
        coordinate: its name, ``joint.rz``.
        position: m or rad; None leaves it to the guess, or 0.
        rate: m/s or rad/s.
        acceleration: m/s² or rad/s².
        prescribed: whether the coordinate takes no part in vibration.
        law: a function of time instead of the three numbers.
    """

    coordinate: str
    position: float | None = None
    rate: float = 0.0
    acceleration: float = 0.0
    prescribed: bool = True
    law: MotionLaw | None = None


def instant(motion: Motion, time: float) -> Motion:
    """The motion as it is at a time (s): its law's value, first and second derivative there."""
    if motion.law is None:
        return motion
    position, rate, acceleration = (
        float(motion.law.deriv(m)(time)) if m else float(motion.law(time)) for m in range(3)
    )
    return replace(motion, position=position, rate=rate, acceleration=acceleration, law=None)
