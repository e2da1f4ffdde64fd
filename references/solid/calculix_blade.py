"""CalculiX as a code among the others: a uniform blade as the solid bar that has its stiffness and its mass.

A rectangle has ``EI/EA = side²/12`` in each plane, so that the two bending stiffnesses and EA set its sides and Young's
modulus, and the mass its density; the rotary inertia then is the solid's, and another one is refused. Poisson's ratio is 0,
hence a full clamp is a beam's clamp. The shear moduli follow from the blade's shear stiffness by G. R. Cowper's coefficient
for ν = 0 (J. Appl. Mech. 33 (1966) 335); shear-rigid sections get moduli so large that shear does nothing. They set torsion
too, which therefore is not the blade's: modes that turn about the blade's axis are left out, as closed forms do.

Coriolis forces are lacking (see ``calculix``), and the material is St Venant and Kirchhoff's: a strain ε stiffens it by 3ε/2,
which moves frequencies by half of ε and more. Blades are refused at speeds that strain their roots by more than ``STRAIN``.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.blade import BEND_Y, BEND_Z, Blade, Sections, sample, uniform
from ...core.modes import Modes
from ..protocol.interface import CodeError, Independence, Motion, Shares
from . import calculix
from .mesh import Bricks, blade, clamped

Array = NDArray[np.float64]

ACROSS = (2, 2)
"""Elements across the section: with reduced integration, fewer have hourglass motions."""

LAYERS = 10
"""Elements along the blade come in multiples of this, so that a layer of nodes lies at each of ``modes.STATIONS``."""

RIGID = 40.0
"""Shear modulus over Young's of a section that is rigid in shear: E I / (κ G A L²) then is a fiftieth of what ν = 0.3 has."""

COWPER = 5.0 / 6.0

STRAIN = 2e-3
"""Largest centrifugal strain at the root at which the material is the blade's to 0.1 % of a frequency or so."""

SPARE = 2
"""Modes asked for beyond those wanted: what turns about the axis lies far above, save for stubby bars."""


class Calculix:
    """See the module; uniform, straight, clamped blades with the rotary inertia of a solid."""

    name = "calculix"
    title = "CalculiX, solid elements"
    shares: Shares = "nothing"
    independence = Independence("CalculiX", "solid elements", "CalculiX", eigensolver="CalculiX")
    motions: tuple[Motion, ...] = ("axial", "chordwise", "flapwise")
    effects = calculix.EFFECTS
    levels = (10, 20, 40)
    order = 4
    digits = 5  # seven are printed; equations of slender solids are ill-conditioned, and cost two
    hint = calculix.HINT

    def version(self) -> str | None:
        """Version of ``ccx`` on the PATH."""
        return calculix.version()

    def unsupported(self, blade: Blade) -> str | None:
        """A reason unless the blade is uniform and there is a solid rectangle like its section."""
        if not uniform(blade):
            return "sections couple or vary, or there is curvature, twist, cone, pitch, tip mass or a joint; this bar has none"
        at = sample(blade, 0.0)
        if not np.isfinite([at.EA, at.EI_y, at.EI_z]).all():
            return "rigid in bending or stretch: a solid has a finite EI and EA"
        mass = np.diagonal(blade.mass[0])
        if np.ptp(mass[:3]):
            return "mass differs with direction: a solid has one density"
        for name, inertia, EI in (("I_y", mass[BEND_Y], at.EI_y[0]), ("I_z", mass[BEND_Z], at.EI_z[0])):
            solid = at.mass[0] * EI / at.EA[0]
            if not np.isclose(inertia, solid, rtol=1e-6, atol=0):
                return f"{name} = {inertia:g} kg m: a solid of this EI and EA has {solid:g} (mass × EI / EA)"
        return None

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes of bending and stretch; see ``interface.Code``. ``elements`` are rounded up to a multiple of ten.

        Raises:
            CodeError: an unsupported blade, too large a strain, ``ccx`` missing or failing, or no stable steady state.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")
        strain = omega**2 * _stretching(blade)
        if strain > STRAIN:
            raise CodeError(
                f"omega: {omega:g} rad/s: strains the root by {strain:.1e}, beyond {STRAIN:g} its material stiffens; lower it"
            )
        bricks, material = bar(blade, LAYERS * -(-elements // LAYERS))
        wanted = count + SPARE
        while True:
            found = calculix.modes(bricks, material, omega, wanted, clamped(blade.hub_radius))
            kept = np.flatnonzero(~_turning(found, sample(blade, 0.0)))[:count]
            if len(kept) == count or len(found.frequencies) < wanted:
                return replace(
                    found, frequencies=found.frequencies[kept], shapes=found.shapes[kept], damping=np.zeros(len(kept))
                )
            wanted *= 2


def bar(of: Blade, elements: int) -> tuple[Bricks, calculix.Orthotropic]:
    """The solid that a uniform blade is, from the rotor's axis outwards, and its material."""
    at = sample(of, 0.0)
    chord, thickness = (float(np.sqrt(12.0 * EI[0] / at.EA[0])) for EI in (at.EI_z, at.EI_y))
    area = chord * thickness
    young = float(at.EA[0]) / area
    shear_y, shear_z = (float(min(GA[0] / (COWPER * area), RIGID * young)) for GA in (at.GA_y, at.GA_z))
    x = of.hub_radius + np.linspace(0.0, of.length, elements + 1)
    return blade(x, chord, thickness, across=ACROSS), calculix.Orthotropic(
        young, shear_y, shear_z, float(at.mass[0]) / area
    )


def _stretching(blade: Blade) -> float:
    """Centrifugal strain at the root over Ω²: ``m (R L + L²/2) / EA``."""
    at = sample(blade, 0.0)
    return float(at.mass[0] / at.EA[0] * blade.length * (blade.hub_radius + blade.length / 2))


def _turning(modes: Modes, at: Sections) -> NDArray[np.bool_]:
    """Which modes turn about the blade's axis more than they move, the polar radius of gyration taken for measure."""
    radius = np.sqrt((at.EI_y[0] + at.EI_z[0]) / at.EA[0])
    return radius * np.abs(modes.shapes[:, :, 3]).max(1) > np.abs(modes.shapes[:, :, :3]).max((1, 2))


CODE = Calculix()
