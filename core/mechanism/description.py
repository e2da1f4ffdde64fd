"""A mechanism: bodies, joints (tree and cut), prescribed motions, force elements and gravity.

Poses, twists and inertias follow ``core.space.spatial``. Loops are closed by cutting a joint: its child is reached twice, once
through the tree and once through a massless copy beyond the cut joint, and the two are welded. A cut joint of any kind retains
its coordinates and gives the same six constraint equations Φᶜ (Park et al. 2010, eq. 2).
"""

from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..blade_checks import body_fault
from ..element.beams import Beams
from ..space import spatial as sp
from ..space.inertia import transformed
from .joints import SCREWS, Joint
from .motion import Motion, MotionLaw, instant

Array = NDArray[np.float64]

GROUND = "ground"


class MechanismError(ValueError):
    """An invalid mechanism: the message names the element, the value, the likely cause and the remedy."""


@dataclass(frozen=True)
class Body:
    """A rigid body with its 6×6 inertia about the origin of its frame (see ``inertia``), kg, kg m, kg m²."""

    name: str
    inertia: Array = field(default_factory=lambda: np.zeros((6, 6)))


def inertia(mass: float, moments: ArrayLike = 0.0, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Array:
    """Inertia (6, 6) of a rigid body about its frame's origin.

    Args:
        mass: kg.
        moments: about the centre of mass, kg m²: one number, three principal ones, or a (3, 3) tensor.
        centre: (3,) centre of mass, m.
    """
    m = np.asarray(moments, float)
    tensor = m if m.ndim == 2 else np.eye(3) * m
    out = np.zeros((6, 6))
    out[:3, :3] = mass * np.eye(3)
    out[3:, 3:] = tensor
    return transformed(out, sp.pose(np.eye(3), np.asarray(centre, float)))


@dataclass(frozen=True)
class CoordinateSpring:
    """A spring and damper on one joint coordinate: force (N) or torque (N m) ``stiffness (q − neutral) + damping q̇``."""

    coordinate: str
    stiffness: float = 0.0
    damping: float = 0.0
    neutral: float = 0.0


@dataclass(frozen=True)
class Spring:
    """A spring and damper between points (3,), m, of two bodies, each in the axes of its body, from its frame's origin.

    The tension, N, is ``stiffness (length − free_length) + damping × rate of the length``.
    """

    body_a: str
    body_b: str
    point_a: Array
    point_b: Array
    stiffness: float = 0.0
    damping: float = 0.0
    free_length: float = 0.0


@dataclass(frozen=True)
class Load:
    """A steady force on a body at its frame's origin.

    Attributes:
        body: its name.
        force: (3,) N, in the axes of ``axes_of``.
        axes_of: ``ground``, or a body whose motion is prescribed; the force turns with it, not with the loaded body.
    """

    body: str
    force: Array
    axes_of: str = GROUND


@dataclass(frozen=True)
class Beam:
    """A batch of one beam or bushing between the frames of two bodies; see ``beams.Beams``.

    ``damping`` (6, 6) gives the force conjugate to the strain from its rate. ``at_a`` and ``at_b`` (4, 4) are the poses of
    the end frames in the bodies. Loads on the beam's points are in the axes of ``axes_of``: ``ground``, or a body whose
    motion is prescribed.
    """

    body_a: str
    body_b: str
    beams: Beams
    damping: Array = field(default_factory=lambda: np.zeros((6, 6)))
    at_a: Array = field(default_factory=lambda: np.eye(4))
    at_b: Array = field(default_factory=lambda: np.eye(4))
    axes_of: str = GROUND


@dataclass(frozen=True)
class Mechanism:
    """The parts of a mechanism; gravity (3,) in m/s², in the ground's axes. ``spanning.compile_tree`` makes arrays of it.

    ``equal_blades`` names coordinates of N ≥ 3 equal blades on a rotor, one tuple for each coordinate of a blade, in the order
    of the blades' azimuths: a rotor on a support is solved in multi-blade coordinates.
    """

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    motions: tuple[Motion, ...] = ()
    coordinate_springs: tuple[CoordinateSpring, ...] = ()
    springs: tuple[Spring, ...] = ()
    beams: tuple[Beam, ...] = ()
    loads: tuple[Load, ...] = ()
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    equal_blades: tuple[tuple[str, ...], ...] = ()


def at_time(mechanism: Mechanism, time: float) -> Mechanism:
    """The mechanism with every law of motion evaluated at ``time`` (s).

    Raises:
        MechanismError: a law without derivatives, or given together with numbers.
    """
    for m in mechanism.motions:
        if m.law is None:
            continue
        if not isinstance(m.law, MotionLaw):
            raise MechanismError(
                f"motion {m.coordinate!r}: its law {m.law!r} has no derivatives: give a numpy Polynomial, a Harmonic, or "
                "an object with deriv()"
            )
        if m.position is not None or m.rate or m.acceleration:
            raise MechanismError(f"motion {m.coordinate!r}: both a law and numbers are given: leave the numbers out")
    return replace(mechanism, motions=tuple(instant(m, time) for m in mechanism.motions))


def at_rate(mechanism: Mechanism, coordinate: str, rate: float) -> Mechanism:
    """The mechanism with the motion of one coordinate, usually the rotor's, at another rate (rad/s or m/s).

    Raises:
        MechanismError: if that coordinate has no motion, or follows a law.
    """
    same_coordinate = [m for m in mechanism.motions if m.coordinate == coordinate and m.law is None]
    if not same_coordinate:
        raise MechanismError(f"coordinate {coordinate!r}: no motion at a rate is given: add one")
    motions = tuple(replace(m, rate=rate) if m in same_coordinate else m for m in mechanism.motions)
    return replace(mechanism, motions=motions)


def check_mechanism(m: Mechanism) -> None:
    """Validate a mechanism.

    Raises:
        MechanismError: names used twice or unknown, an impossible inertia, a motion given twice.
    """
    names = [b.name for b in m.bodies]
    for label, names_of_kind in (("body", names), ("joint", [j.name for j in m.joints])):
        twice = sorted(name for name, times in Counter(names_of_kind).items() if times > 1)
        if twice:
            raise MechanismError(f"{label} {twice[0]!r}: given twice; names must be unique")
    if GROUND in names:
        raise MechanismError("body 'ground': the name of the inertial frame; choose another")
    declared = {GROUND, *names}
    references = [(f"joint {j.name!r}", n) for j in m.joints for n in (j.parent, j.child)]
    references += [("spring", n) for s in m.springs for n in (s.body_a, s.body_b)]
    references += [("beam", n) for b in m.beams for n in (b.body_a, b.body_b, b.axes_of)]
    references += [("load", n) for f in m.loads for n in (f.body, f.axes_of)]
    for label, name in references:
        if name not in declared:
            raise MechanismError(f"{label}: body {name!r} is unknown; there are {', '.join(sorted(declared))}")
    moving = [x.coordinate for x in m.motions]
    if len(set(moving)) < len(moving):
        raise MechanismError(f"motion {max(moving, key=moving.count)!r}: given twice; give one per coordinate")
    for x in m.motions:
        if x.law is not None:
            raise MechanismError(f"motion {x.coordinate!r}: it follows a law of time: use at_time(mechanism, time)")
    for f in m.loads:
        if np.shape(f.force) != (3,) or not np.isfinite(f.force).all():
            raise MechanismError(f"load on {f.body!r}: force {f.force}: give three finite components in N")
    for j in m.joints:
        if j.kind not in SCREWS:
            raise MechanismError(f"joint {j.name!r}: kind {j.kind!r} is unknown; there are {', '.join(SCREWS)}")
        if j.parent == j.child:
            raise MechanismError(f"joint {j.name!r}: parent and child are both {j.parent!r}")
    for b in m.bodies:
        if b.inertia.shape != (6, 6) or not np.isfinite(b.inertia).all():
            raise MechanismError(f"body {b.name!r}: its inertia must be a finite 6×6 matrix; build it with inertia()")
        if b.inertia.any() and (problem := body_fault(b.inertia, "kg")):
            raise MechanismError(f"body {b.name!r}: inertia: {problem}")
