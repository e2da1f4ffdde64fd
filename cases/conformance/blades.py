"""Blades for conformance checks, with closed forms or printed numbers, and the properties that a blade may have."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root_scalar

from ...core.blade import AXIAL, BEND_Y, BEND_Z, TORSION, Blade, uniform_blade
from ...references.theories import timoshenko as timoshenko_beam

Array = NDArray[np.float64]

LENGTH, MASS, EI = 2.0, 3.0, 48.0
"""With these √(EI / m L⁴) is 1 rad/s, so that frequencies in rad/s are the dimensionless ones of the literature."""

SHEAR, SHORT = 100.0, 20.0
"""Shear stiffness in EI / L² and slenderness of the short beam, typical of a solid. Shear changes its first frequency by
4 %. In a ten times softer solid, the clamp would restrain warping over most of its length."""

SHEAR_Y = 300.0
"""Another shear stiffness, along y, for the check that the planes are not exchanged."""

TURN = 0.5
"""rad, of the principal axes within the coupled section."""


EA = 160_000 * EI / LENGTH**2
"""Slenderness 400: stretch, Coriolis and rotary inertia change the frequencies with closed forms by less than 0.05 %, and
solid elements, whose condition number grows with its fourth power, still have enough digits."""


def _beam(name: str, EI_y: float, EI_z: float) -> Blade:
    """Rotary inertia as of a solid: m EI / EA."""
    I_y, I_z = MASS * EI_y / EA, MASS * EI_z / EA
    return uniform_blade(name, LENGTH, 0.0, EA=EA, GJ=20.0, EI_y=EI_y, EI_z=EI_z, mass=MASS, I_y=I_y, I_z=I_z)


BEAM = _beam("beam", EI, EI)
PLANK = _beam("plank", EI, 4 * EI)
SWAPPED = _beam("swapped plank", 4 * EI, EI)
HINGED = replace(BEAM, name="beam on a flap hinge", root=np.array([np.inf] * BEND_Y + [0.0, np.inf]))
WITH_TIP_MASS = replace(
    BEAM, name="beam with its mass at the tip", tip_mass=MASS * LENGTH * np.diag([1, 1, 1, 0, 0, 0])
)
STUBBY = uniform_blade(
    "stubby beam", LENGTH, 0.0, EA=3e4, GJ=200.0, EI_y=EI, EI_z=EI, mass=MASS, I_y=MASS * EI / 3e4, I_z=MASS * EI / 3e4
)
"""Slenderness 50, with matching section inertia: each effect of ``core.effects`` is at least 0.7 % at ``FAST``."""

FAST = 10.0
"""rad/s."""


def coupled_plank() -> Blade:
    """The plank with principal bending axes rotated in the section: coupled planes, same frequencies."""
    c, s = np.cos(TURN), np.sin(TURN)
    rotation, stiffness = np.array([[c, -s], [s, c]]), PLANK.stiffness.copy()
    bending = slice(BEND_Y, BEND_Z + 1)
    stiffness[:, bending, bending] = rotation @ np.diag([EI, 4 * EI]) @ rotation.T
    return replace(PLANK, name="coupled plank", stiffness=stiffness)


def short_beam(shear: float = np.inf, along_y: float | None = None) -> Blade:
    """A short beam, optionally soft in shear (``shear`` in EI / L², along y another one if given)."""
    EA, GA, I = (SHORT / LENGTH) ** 2 * EI, shear * EI / LENGTH**2, MASS * (LENGTH / SHORT) ** 2
    GA_y = GA if along_y is None else along_y * EI / LENGTH**2
    stiff = {"EA": EA, "GJ": 200.0, "EI_y": EI, "EI_z": EI, "GA_y": GA_y, "GA_z": GA}
    return uniform_blade("short beam", LENGTH, 0.0, mass=MASS, I_y=I, I_z=I, **stiff)


CANTILEVER = np.array(
    [
        root_scalar(lambda x: np.cos(x) + 1 / np.cosh(x), bracket=(k * np.pi - 2.6, k * np.pi - 0.6)).root ** 2
        for k in (1, 2, 3)
    ]
)
"""β² of ``cos β cosh β = −1`` (Rayleigh, *The Theory of Sound*, 1877, §174): frequencies of the cantilever at rest, rad/s."""

WRIGHT_SPEED, WRIGHT = 6.0, 7.3604
"""First flapwise frequency of the rotating beam without a hub (Wright et al., J. Appl. Mech. 49, 1982, 197–202, Table 3a).
The edgewise frequency is √(ω² − Ω²): the same tension, and spin softening (inextensible)."""

TIP_AT_REST = 1.5573
"""First frequency with a point mass as heavy as the beam at its tip: 1 + 1/(cos β cosh β) = β (tan β − tanh β)."""

TIP_SPEED, TIP_TURNING = 4.0, 4.543
"""A speed, and the first flapwise frequency there (G. S. Bir, NREL/CP-500-47953, 2010, Table 5, analytical)."""


def cantilever_shape() -> Array:
    """First shape of the cantilever (21,), 1 at the tip."""
    beta = np.sqrt(CANTILEVER[0])
    x = np.linspace(0.0, beta, 21)
    ratio = (np.cosh(beta) + np.cos(beta)) / (np.sinh(beta) + np.sin(beta))
    shape = np.cosh(x) - np.cos(x) - ratio * (np.sinh(x) - np.sin(x))
    return shape / shape[-1]


def timoshenko(shear: float = SHEAR) -> float:
    """First frequency of the short beam at rest, rad/s; units of EI, m and L."""
    (frequency,) = timoshenko_beam.cantilever(1, EI=1.0, GA=shear, mass=1.0, rotary=SHORT**-2, length=1.0)
    return float(frequency)


def cornered() -> tuple[Blade, float]:
    """The beam with a right angle in the plane of rotation at midspan, and its first in-plane frequency at rest.

    Two inextensible halves of length a: the outer one moves along its axis with the end of the inner one,
    ``EI w₁‴ = −m a ω² w₁``; rotation and moment are continuous at the corner. Inner: C (cosh − cos) + D (sinh − sin);
    outer, without transverse displacement at the corner: A sin + B sinh + E (cos − cosh), free at its end.
    """
    half_length = 0.5 * LENGTH
    curve = np.array([[0.0, 0.0, 0.0], [half_length, 0.0, 0.0], [half_length, half_length, 0.0]])
    properties = {name: np.repeat(getattr(BEAM, name)[:1], 3, axis=0) for name in ("stiffness", "mass", "twist")}
    blade = replace(
        BEAM,
        name="beam with a corner",
        stations=[0.0, half_length, LENGTH],
        curve=curve,
        kinks=(half_length,),
        **properties,
    )

    def fits(x: float) -> float:
        c, s, C, S = np.cos(x), np.sin(x), np.cosh(x), np.sinh(x)
        rows = [
            [S + s, C - c, -1.0, -1.0, 0.0],  # w₁′ = w₂′
            [C + c, S + s, 0.0, 0.0, 2.0],  # w₁″ = w₂″
            [S - s + x * (C - c), C + c + x * (S - s), 0.0, 0.0, 0.0],  # w₁‴ + β⁴ a w₁
            [0.0, 0.0, -s, S, -c - C],  # w₂″ at the end
            [0.0, 0.0, -c, C, s - S],  # w₂‴ there
        ]
        return float(np.linalg.det(rows))

    beta = root_scalar(fits, bracket=(0.5, 1.3)).root / half_length
    return blade, float(np.sqrt(EI / MASS) * beta**2)


SPEED = 3.0
"""rad/s: near the beam's first frequency at rest, so that the effects of rotation are large."""


@dataclass(frozen=True)
class Property:
    """A property of a blade, and the blade without it; large enough that dropping it shows at ``omega`` (rad/s)."""

    name: str
    blade: Blade
    without: Blade = BEAM
    omega: float = SPEED


def _along(blade: Blade, stations: int = 13) -> Blade:
    """The same straight uniform blade with more stations."""
    s = np.linspace(0.0, blade.length, stations)
    properties = {
        name: np.repeat(getattr(blade, name)[:1], stations, axis=0) for name in ("stiffness", "mass", "twist")
    }
    return replace(blade, stations=s, curve=np.outer(s, [1.0, 0.0, 0.0]), **properties)


def _arc(axis: int) -> Blade:
    """The beam with a stress-free shape of an arc of radius 2 L in the direction of ``axis``."""
    blade, radius = _along(BEAM), 2 * LENGTH
    curve = np.zeros((len(blade.stations), 3))
    curve[:, 0] = radius * np.sin(blade.stations / radius)
    curve[:, axis] = radius * (1 - np.cos(blade.stations / radius))
    return replace(blade, curve=curve)


def _tapered() -> Blade:
    blade = _along(BEAM)
    share = np.linspace(1.0, 0.4, len(blade.stations))[:, None, None]
    return replace(blade, stiffness=blade.stiffness * share, mass=blade.mass * share)


def _twisted() -> Blade:
    blade = _along(PLANK)
    return replace(blade, twist=np.linspace(0.0, 1.2, len(blade.stations)))


def _joined(row: int, column: int) -> Blade:
    """Two strains coupled by 0.6 of the value that would make the section unstable."""
    stiffness = BEAM.stiffness.copy()
    limit = 0.6 * np.sqrt(stiffness[:, row, row] * stiffness[:, column, column])
    stiffness[:, row, column] = stiffness[:, column, row] = limit
    return replace(BEAM, stiffness=stiffness)


def _body(mass: float, moment: float = 0.0, offset: float = 0.0) -> Array:
    """Inertia (6, 6) of a rigid body with its centre offset along y; ``moment`` about y and z through the centre."""
    out = np.diag([mass, mass, mass, 2 * moment, moment, moment])
    out[0, 5] = out[5, 0] = -mass * offset
    out[2, 3] = out[3, 2] = mass * offset
    out[[3, 5], [3, 5]] += mass * offset**2
    return out


LUMP = _body(0.5 * MASS * LENGTH)
LUMPED = replace(BEAM, tip_mass=LUMP)

BESIDE = _body(LUMP[0, 0], 0.0, 0.4)
"""A tip mass with its centre beside the axis, along y."""

PROPERTIES = (
    Property("hub radius", replace(BEAM, hub_radius=1.0)),
    Property("unlike planes", PLANK),
    Property("taper", _tapered()),
    Property("twist", _twisted(), PLANK),
    Property("pitch", replace(PLANK, pitch=0.8), PLANK),
    Property("precone", replace(BEAM, precone=0.4)),
    Property("tip mass", LUMPED),
    Property("tip mass's moments of inertia", replace(BEAM, tip_mass=_body(LUMP[0, 0], 0.5)), LUMPED),
    Property("tip mass's offset", replace(BEAM, tip_mass=BESIDE), LUMPED),
    Property("sweep", _arc(1)),
    Property("prebend", _arc(2)),
    Property("bend–twist coupling", _joined(TORSION, BEND_Y)),
    Property("extension–bending coupling", _joined(AXIAL, BEND_Y)),
    Property("mass off the axis", replace(BEAM, mass=np.repeat(_body(MASS, 1e-5, 0.2)[None], 2, axis=0))),
    Property("rotary inertia", replace(BEAM, mass=np.repeat(_body(MASS, 0.1)[None], 2, axis=0))),
    Property("shear flexibility", short_beam(SHEAR), short_beam(), 0.0),
    Property("springs at the root", replace(BEAM, root=np.array([np.inf] * 4 + [5 * EI / LENGTH] * 2))),
)
"""Properties that a blade may have; a code that accepts such a blade must not drop them."""


def shaft() -> tuple[Blade, float]:
    """The beam, soft in torsion, and its first torsional frequency at rest, rad/s: π/2 √(GJ / I) / L (second mode)."""
    stiffness, frequency = BEAM.stiffness.copy(), 10.0
    polar = BEAM.mass[0, TORSION, TORSION]
    stiffness[:, TORSION, TORSION] = polar * (frequency * LENGTH / (np.pi / 2)) ** 2
    return replace(BEAM, name="shaft", stiffness=stiffness), frequency
