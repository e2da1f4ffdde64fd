"""A uniform blade as a solid bar with the same stiffness and mass, for any code of solid elements.

A rectangle has ``EI/EA = side²/12`` in each plane, so the two bending stiffnesses and EA determine its sides and
Young's modulus, and the mass its density. The rotary inertia is then that of the solid; blades with another one are
declined. Poisson's ratio is 0, so a full clamp is equivalent to a beam's clamp. The shear moduli follow from the
blade's shear stiffness by G. R. Cowper's coefficient for ν = 0 (J. Appl. Mech. 33 (1966) 335); for sections rigid in
shear they are so large that shear is negligible. They also determine torsion, which therefore differs from the blade's:
torsional modes are left out, as by the closed forms.

The material is St Venant–Kirchhoff: a strain ε stiffens it by 3ε/2, which changes frequencies by ε/2 and more. Speeds with
a strain at the root above ``STRAIN`` are therefore an error.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.blade import BEND_Y, BEND_Z, Blade, uniform
from ...core.modes import Modes
from ..cache_last import cache_last
from ..protocol.interface import CodeError
from ..sampling import SampledSections, sample
from .materials import Orthotropic
from .mesh import Bricks, straight_bricks

Array = NDArray[np.float64]

ACROSS = (2, 2)
"""Elements across the section: with reduced integration, fewer have hourglass modes."""

LAYERS = 10
"""The number of elements along the blade is a multiple of this, to have a layer of nodes at each of
``modes.STATIONS``."""

RIGID = 40.0
"""Ratio of shear to Young's modulus for sections rigid in shear: E I / (κ G A L²) is then a fiftieth of that for ν = 0.3."""

COWPER = 5.0 / 6.0

STRAIN = 2e-3
"""Largest centrifugal strain at the root for which the stiffening of the material changes frequencies by about 0.1 %."""

SPARE = 2
"""Additional modes to compute: torsional modes are far above the others, except for stubby bars."""


Solve = Callable[[Bricks, Orthotropic, int], Modes]
"""The lowest modes of a bar, clamped at the root: a number of them, torsional ones included."""


def unsupported(blade: Blade) -> str | None:
    """A reason unless the blade is uniform and equivalent to a solid of rectangular section."""
    if not uniform(blade):
        return "sections couple or vary, or curvature, twist, precone, pitch, tip mass or root joint: this bar has none"
    at = sample(blade, 0.0)
    if not np.isfinite([at.EA, at.EI_y, at.EI_z]).all():
        return "rigid in bending or stretch: a solid has finite EI and EA"
    mass = np.diagonal(blade.mass[0])
    if np.ptp(mass[:3]):
        return "mass differs with direction: a solid has one density"
    for name, inertia, EI in (("I_y", mass[BEND_Y], at.EI_y[0]), ("I_z", mass[BEND_Z], at.EI_z[0])):
        solid = at.mass[0] * EI / at.EA[0]
        if not np.isclose(inertia, solid, rtol=1e-6, atol=0):
            return f"{name} = {inertia:g} kg m: a solid of this EI and EA has {solid:g} (mass × EI / EA)"
    return None


def modes(blade: Blade, omega: float, elements: int, count: int, solve: Solve) -> Modes:
    """The ``count`` lowest modes of bending and stretch; ``elements`` are rounded up to a multiple of ten.

    Raises:
        CodeError: too large a strain, or as ``solve``.
    """
    strain = omega**2 * _stretching(blade)
    if strain > STRAIN:
        raise CodeError(
            f"omega: {omega:g} rad/s: strain at the root {strain:.1e}, the material stiffens above {STRAIN:g}; lower it"
        )
    bricks, material = bar(blade, LAYERS * -(-elements // LAYERS))
    requested = count + SPARE
    while True:
        spectrum = solve(bricks, material, requested)
        selected = np.flatnonzero(~_turning(spectrum, sample(blade, 0.0)))[:count]
        if len(selected) == count or len(spectrum.frequencies) < requested:
            return replace(
                spectrum,
                frequencies=spectrum.frequencies[selected],
                shapes=spectrum.shapes[selected],
                damping=np.zeros(len(selected)),
            )
        requested *= 2


@cache_last
def bar(blade: Blade, elements: int) -> tuple[Bricks, Orthotropic]:
    """The solid equivalent to a uniform blade, from the rotor's axis outwards, and its material."""
    at = sample(blade, 0.0)
    chord, thickness = (float(np.sqrt(12.0 * EI[0] / at.EA[0])) for EI in (at.EI_z, at.EI_y))
    area = chord * thickness
    young = float(at.EA[0]) / area
    shear_y, shear_z = (float(min(GA[0] / (COWPER * area), RIGID * young)) for GA in (at.GA_y, at.GA_z))
    x = blade.hub_radius + np.linspace(0.0, blade.length, elements + 1)
    shear = (shear_y, shear_z, max(shear_y, shear_z))
    material = Orthotropic((young, young, young), (0.0, 0.0, 0.0), shear, float(at.mass[0]) / area)
    return straight_bricks(x, chord, thickness, across=ACROSS), material


def _stretching(blade: Blade) -> float:
    """Centrifugal strain at the root over Ω²: ``m (R L + L²/2) / EA``."""
    at = sample(blade, 0.0)
    return float(at.mass[0] / at.EA[0] * blade.length * (blade.hub_radius + blade.length / 2))


def _turning(modes: Modes, at: SampledSections) -> NDArray[np.bool_]:
    """(m,) whether each mode is torsional: its rotation times the polar radius of gyration exceeds its displacement."""
    radius = np.sqrt((at.EI_y[0] + at.EI_z[0]) / at.EA[0])
    return radius * np.abs(modes.shapes[:, :, 3]).max(1) > np.abs(modes.shapes[:, :, :3]).max((1, 2))
