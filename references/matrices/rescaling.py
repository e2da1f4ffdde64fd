"""A mechanism's numbers in other units of mass, length and time.

Angles are in rad in all units. Written u = (L, L, L, 1, 1, 1), the unit of a twist's component is u/T, and that of entry ij of
an inertia is M L²/(u_i u_j).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.element.beams import Beams
from ...core.element.measures import StrainLaw
from ...core.mechanism.description import Beam, Body, CoordinateSpring, Load, Mechanism, Spring
from ...core.mechanism.joints import Joint
from ...core.mechanism.length import coordinate_units, length_of
from ...core.mechanism.motion import Motion, MotionLaw
from ..protocol.interface import MechanismModes

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Units:
    """Units of mass (kg), length (m) and time (s)."""

    mass: float = 1.0
    length: float = 1.0
    time: float = 1.0

    @property
    def energy(self) -> float:
        """Unit of energy, J."""
        return self.mass * self.length**2 / self.time**2

    @property
    def twist(self) -> Array:
        """(6,) units of a small displacement: length, and 1 rad."""
        return np.repeat([self.length, 1.0], 3)


@dataclass(frozen=True)
class RescaledLaw:
    """A law of motion whose value and time are in other units, m or rad and s."""

    law: MotionLaw
    value: float
    time: float

    def __call__(self, time: float, /) -> float:
        """The value at a time."""
        return float(self.law(time * self.time)) / self.value

    def deriv(self, m: int = 1) -> "RescaledLaw":
        """Its m-th derivative."""
        return RescaledLaw(self.law.deriv(m), self.value / self.time**m, self.time)


def in_own_length(
    mechanism: Mechanism,
    guess: Mapping[str, float],
    solve: Callable[[Mechanism, Mapping[str, float]], MechanismModes],
) -> MechanismModes:
    """The modes of a mechanism, solved in a unit of length of the order of its own: tolerances on lengths are relative.

    The unit is a power of two, so that the numbers are not rounded.
    """
    length = 2.0 ** round(np.log2(length_of(mechanism)))
    unit = coordinate_units(mechanism, length)
    modes = solve(
        in_units(mechanism, Units(length=length)), {name: q / unit.get(name, 1.0) for name, q in guess.items()}
    )
    units = np.array([unit[name] for name in modes.coordinates])
    return replace(modes, steady=modes.steady * units, shapes=modes.shapes * units)


def in_units(mechanism: Mechanism, units: Units) -> Mechanism:
    """The same mechanism with its numbers in other units instead of SI."""
    mass, length, time, energy = units.mass, units.length, units.time, units.energy
    pair = units.twist[:, None] * units.twist
    coordinate = coordinate_units(mechanism, length)

    def rescaled_spring(s: CoordinateSpring) -> CoordinateSpring:
        unit = coordinate[s.coordinate]
        stiffness = energy / unit**2
        return CoordinateSpring(s.coordinate, s.stiffness / stiffness, s.damping / (stiffness * time), s.neutral / unit)

    def rescaled_motion(m: Motion) -> Motion:
        unit = coordinate[m.coordinate]
        return replace(
            m,
            position=None if m.position is None else m.position / unit,
            rate=m.rate * time / unit,
            acceleration=m.acceleration * time**2 / unit,
            law=None if m.law is None else RescaledLaw(m.law, unit, time),
        )

    def rescaled_point_spring(s: Spring) -> Spring:
        values = s.stiffness * time**2 / mass, s.damping * time / mass, s.free_length / length
        return Spring(s.body_a, s.body_b, s.point_a / length, s.point_b / length, *values)

    x, y, z = (g * time**2 / length for g in mechanism.gravity)
    return Mechanism(
        bodies=tuple(Body(b.name, b.inertia * pair / (mass * length**2)) for b in mechanism.bodies),
        joints=tuple(_joint(j, length) for j in mechanism.joints),
        motions=tuple(map(rescaled_motion, mechanism.motions)),
        coordinate_springs=tuple(map(rescaled_spring, mechanism.coordinate_springs)),
        springs=tuple(map(rescaled_point_spring, mechanism.springs)),
        beams=tuple(_beam(b, units) for b in mechanism.beams),
        loads=tuple(Load(f.body, f.force * time**2 / (mass * length), f.axes_of) for f in mechanism.loads),
        gravity=(x, y, z),
        equal_blades=mechanism.equal_blades,
    )


def _joint(joint: Joint, length: float) -> Joint:
    return replace(joint, at_parent=_pose(joint.at_parent, length), at_child=_pose(joint.at_child, length))


def _pose(pose: Array, length: float) -> Array:
    out = np.array(pose, float)
    out[..., :3, 3] /= length
    return out


def _beam(beam: Beam, units: Units) -> Beam:
    u, internal, energy, beams = units.twist, np.sqrt(units.energy), units.energy, beam.beams
    pair, ratio = u[:, None] * u, u / u[:, None]
    law, points = beams.law, beams.points
    # internal coordinates have a stiffness of 1, hence the unit √energy
    slope = law.slope * np.concatenate([ratio, np.repeat(internal / u[:, None], 6, axis=1)], axis=1)
    rescaled: Any = replace(
        points,
        zeta0=points.zeta0 / u,
        shape=points.shape * ratio,
        bubble=points.bubble * internal / u[:, None],
        mass=points.mass * pair / (units.mass * units.length**2),
        force=points.force * units.length / energy,
    )
    return replace(
        beam,
        beams=Beams(
            StrainLaw(
                law.measure,
                _pose(law.undeformed, units.length),
                law.shortening * pair / units.length,
                law.mean * ratio,
                slope,
            ),
            beams.stiffness * pair / energy,
            rescaled,
            beams.preload * u / energy,
            beams.internal_preload / internal,
        ),
        damping=beam.damping * pair / (energy * units.time),
        at_a=_pose(beam.at_a, units.length),
        at_b=_pose(beam.at_b, units.length),
    )
