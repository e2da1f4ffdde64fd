"""Putter and Manor's rotating beam: inextensible, in assumed modes.

As an inextensible blade bends, its projected length decreases by half the square of its slope; the work of the
centrifugal force on this shortening stiffens it. With deflections v in and w out of the plane of rotation and T the
tension of the straight blade,

    2 V = ∫ E I_ij κ_i κ_j + T (v′² + w′²) − Ω² m v² ds,    2 T_kin = ∫ m (v̇² + ẇ²) ds,    T(s) = Ω² ∫ₛ m (R + s) ds

(S. Putter and H. Manor, "Natural frequencies of radial rotating beams", J. Sound Vib. 56 (1978) 175–185; for twisted
blades W. Carnegie, "Vibrations of rotating cantilever blading", J. Mech. Eng. Sci. 1 (1959) 235–240). The assumed
modes are the polynomials of ``spectral``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.modes import STATIONS, Modes
from ..cache_last import cache_last
from ..protocol.interface import Independence, Motion
from .ritz import Y, Z, integral, part, shape_of, stationary_modes, union
from .spectral import clamped_functions
from .straight_beam import ClosedForm, line, refusal, tension, terms

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bending:
    """Bending in one plane, or in two that twist couples: ``M q̈ + (elastic + Ω² centrifugal) q = 0``.

    Attributes:
        elastic, centrifugal, mass: (n, n).
        shape: (21, 4, n) of the coordinates.
        planes: the directions of motion, ``Y`` (edgewise), ``Z`` (flapwise) or both.
    """

    elastic: Array
    centrifugal: Array
    mass: Array
    shape: Array
    planes: tuple[int, ...]

    def stiffness(self, omega: float) -> Array:
        """Stiffness (n, n) at rotor speed ``omega`` (rad/s)."""
        return self.elastic + omega**2 * self.centrifugal


@cache_last
def bendings(blade: Blade, terms: int) -> tuple[Bending, ...]:
    """Edgewise and flapwise bending, separate if the blade is untwisted, with ``terms`` polynomials in each interval."""
    at = line(blade, terms)
    v, slope, curvature = clamped_functions(at.ends, terms, at.s)
    angle = at.sections.twist + blade.pitch
    cos, sin = np.cos(angle), np.sin(angle)
    flap, edge = at.sections.EI_y, at.sections.EI_z  # of the section; motion along its z is resisted by EI_y
    EI = {
        (Y, Y): edge * cos**2 + flap * sin**2,
        (Z, Z): edge * sin**2 + flap * cos**2,
        (Y, Z): (edge - flap) * sin * cos,
    }
    EI[Z, Y] = EI[Y, Z]
    mass = integral(at.mass, v)
    tense = integral(at.weight * tension(blade, at.s), slope)
    zeros = np.zeros_like(mass)
    centrifugal = {(Y, Y): tense - mass, (Z, Z): tense}
    shape = clamped_functions(at.ends, terms, STATIONS * blade.length)[0]

    def together(planes: tuple[int, ...]) -> Bending:
        pairs = [[(i, j) for j in planes] for i in planes]
        return Bending(
            elastic=np.block([[integral(at.weight * EI[p], curvature) for p in row] for row in pairs]),
            centrifugal=np.block([[centrifugal.get(p, zeros) for p in row] for row in pairs]),
            mass=np.block([[mass if i == j else zeros for i, j in row] for row in pairs]),
            shape=shape_of([(plane, shape) for plane in planes]),
            planes=planes,
        )

    return (together((Y, Z)),) if angle.any() else (together((Y,)), together((Z,)))


class AssumedModes(ClosedForm):
    """The inextensible straight beam, twisted or untwisted, uniform or varying.

    It neglects rotary inertia and stretch: the steady stretch (prestretch) and the oscillating one, through which alone
    the Coriolis force acts on edgewise motion. Bending modes only.
    """

    name = "assumed-modes"
    title = "Putter and Manor, assumed modes"
    independence = Independence("Southwell's Ritz method", "Putter and Manor 1978", "assumed-modes")
    motions: tuple[Motion, ...] = ("edgewise", "flapwise")
    effects = Effects(prestretch=False, coriolis=False, rotary_inertia=False)

    def unsupported(self, blade: Blade) -> str | None:
        """The reason why the blade is outside this theory; None if it is not."""
        return refusal(blade, twist=True, stretch=False, tip_inertia=False)

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest bending modes with ``elements`` polynomials in each interval (see ``protocol.interface``)."""
        parts = [
            part(bending.shape, *stationary_modes(bending.mass, bending.stiffness(omega), count))
            for bending in bendings(blade, terms(blade, elements))
        ]
        return union(parts, omega, elements, count)


CODE = AssumedModes()
