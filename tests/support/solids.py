"""The solids the tests share, as the package has them, and what is known of them."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from southwell.core.blade import Blade, uniform_blade
from southwell.core.condense import segments, ties
from southwell.core.modes import Modes
from southwell.references.solid import hexahedra
from southwell.references.solid.materials import Material
from southwell.references.solid.mesh import clamped_section
from southwell.references.theories import timoshenko as timoshenko_beam
from southwell.tests.support import solid_blades
from southwell.tests.support.solid_blades import (
    HUB,
    LENGTH,
    ROOT,
    SEGMENTS,
    SIDE,
    SPAN,
    SPEED,
    SQUARE,
    STEEL,
    at,
    square_bar,
    twisted,
)

__all__ = [
    "HUB",
    "LENGTH",
    "ROOT",
    "SEGMENTS",
    "SIDE",
    "SPAN",
    "SPEED",
    "SQUARE",
    "STEEL",
    "at",
    "square_bar",
    "twisted",
]

Array = NDArray[np.float64]


def timoshenko(count: int, material: Material = SQUARE, side: float = SIDE, length: float = LENGTH) -> Array:
    """Exact frequencies (rad/s) of a clamped-free Timoshenko beam of square section, in one plane."""
    second = side**4 / 12
    return timoshenko_beam.cantilever(
        count,
        EI=material.young * second,
        GA=shear_stiffness(material, side),
        mass=material.density * side**2,
        rotary=material.density * second,
        length=length,
    )


def shear_stiffness(material: Material, side: float) -> float:
    """κ G A (N) of a square, κ = 10 (1 + ν)/(12 + 11 ν) (G. R. Cowper, J. Appl. Mech. 33 (1966) 335)."""
    nu = material.poisson
    return 10 * (1 + nu) / (12 + 11 * nu) * material.lame[1] * side**2


def square_beam(material: Material = SQUARE, side: float = SIDE, length: float = LENGTH, hub: float = HUB) -> Blade:
    """The same as a Timoshenko beam for core; St Venant's torsion constant of a square is 0.140577 a⁴."""
    EI, inertia = material.young * side**4 / 12, material.density * side**4 / 12
    shear = shear_stiffness(material, side)
    stiff = {"EA": material.young * side**2, "GJ": material.lame[1] * 0.1405770 * side**4, "EI_y": EI, "EI_z": EI}
    mass = {"mass": material.density * side**2, "I_y": inertia, "I_z": inertia}
    return uniform_blade("square", length, hub, **stiff, **mass, GA_y=shear, GA_z=shear)


@cache
def twisted_modes(omega: float, coriolis: bool = True) -> Modes:
    """The lowest modes of the whole blade, by scikit-fem."""
    return hexahedra.modes(twisted(), STEEL, omega, 6, clamped_section(ROOT), coriolis=coriolis)


@cache
def twisted_model() -> ties.FiniteElements:
    """The whole blade to condense."""
    return solid_blades.finite_elements(twisted(), STEEL, "twisted blade")


def cuts() -> NDArray[np.intp]:
    """Layers of corners between the twisted blade's segments."""
    return solid_blades.cuts(twisted())


@cache
def segments_in_place() -> list[segments.Segment]:
    """The twisted blade's 20 segments, condensed in place."""
    return solid_blades.segments_in_place(twisted_model(), twisted())


def segments_apart(kind: ties.Kind) -> list[segments.Segment]:
    """The same segments, each condensed alone with both ends tied."""
    return solid_blades.segments_apart(kind, twisted())


def mac(a: Modes, b: Modes) -> Array:
    """Modal assurance of displacements at the common stations (m, k); all sections count alike, the root not."""
    x, y = (np.asarray(m.shapes[:, :, :3]).reshape(len(m.shapes), -1) for m in (a, b))
    return np.abs(x.conj() @ y.T) ** 2 / np.outer((np.abs(x) ** 2).sum(1), (np.abs(y) ** 2).sum(1))
