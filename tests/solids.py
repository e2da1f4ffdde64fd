"""The solids the tests share, and what is known of them."""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from southwell.core import condensation, segments, ties
from southwell.core import spatial as sp
from southwell.core.blade import Blade, uniform_blade
from southwell.core.modes import Modes
from southwell.references import solid
from southwell.references.solid_mesh import Bricks, Material, blade, clamped
from southwell.tests.beams import RHO, A, E, I

Array = NDArray[np.float64]

SIDE = np.sqrt(12 * I / A)
SQUARE = Material(E * A / SIDE**2, 0.3, RHO * A / SIDE**2)
"""A square section of this side and material has the EA, EI, mass and rotary inertia of the paper's cantilever."""

LENGTH, HUB = 6.0, 0.3
STEEL = Material(2.1e11, 0.3, 7850.0)
ROOT, SPAN, SEGMENTS = 0.3, 1.0, 20
SPEED = 100.0
"""rad/s: the tapered, twisted blade's first frequency rises by a third."""


def at(x: float) -> Array:
    """Pose of a frame at x on the axis, parallel to the blade's axes."""
    return sp.pose(np.eye(3), np.array([x, 0.0, 0.0]))


def timoshenko(count: int, material: Material = SQUARE, side: float = SIDE, length: float = LENGTH) -> Array:
    """Exact frequencies (rad/s) of a clamped-free Timoshenko beam of square section, in one plane.

    T. C. Huang, J. Appl. Mech. 28 (1961) 579–584, with the shear coefficient of G. R. Cowper (J. Appl. Mech. 33 (1966) 335),
    who defines displacement and rotation as a section's averages, 10 (1 + ν)/(12 + 11 ν).
    """
    EI, mass = material.young * side**4 / 12, material.density * side**2
    r2, s2 = side**2 / 12 / length**2, EI / shear_stiffness(material, side) / length**2

    def characteristic(omega: float) -> float:
        b2 = mass * length**4 * omega**2 / EI
        b, root = np.sqrt(b2), np.sqrt((r2 - s2) ** 2 + 4 / b2)
        alpha, beta = (b * np.sqrt((sign * (r2 + s2) + root) / 2) for sign in (-1, 1))
        both = (b2 * (r2 - s2) ** 2 + 2) * np.cos(beta) + 2 / np.cosh(alpha)
        return float(both - b * (r2 + s2) / np.sqrt(1 - b2 * r2 * s2) * np.tanh(alpha) * np.sin(beta))

    unit = np.sqrt(EI / mass) / length**2
    grid = unit * np.arange(0.05, 12.0 * count**2, 0.1)
    signs = np.sign([characteristic(w) for w in grid])
    cross = np.flatnonzero(signs[1:] != signs[:-1])[:count]
    return np.array([brentq(characteristic, grid[k], grid[k + 1], xtol=1e-12) for k in cross])


def shear_stiffness(material: Material, side: float) -> float:
    """κ G A with Cowper's κ of a rectangle."""
    nu = material.poisson
    return 10 * (1 + nu) / (12 + 11 * nu) * material.lame[1] * side**2


def square_beam(material: Material = SQUARE, side: float = SIDE, length: float = LENGTH, hub: float = HUB) -> Blade:
    """The same as a Timoshenko beam for core; St Venant's torsion constant of a square is 0.140577 a⁴."""
    EI, inertia = material.young * side**4 / 12, material.density * side**4 / 12
    shear = shear_stiffness(material, side)
    stiff = {"EA": material.young * side**2, "GJ": material.lame[1] * 0.1405770 * side**4, "EI_y": EI, "EI_z": EI}
    mass = {"mass": material.density * side**2, "I_y": inertia, "I_z": inertia}
    return uniform_blade("square", length, hub, **stiff, **mass, GA_y=shear, GA_z=shear)


def square_bar(length: float, layers: int, across: int = 2, start: float = 0.0) -> Bricks:
    """A piece of the paper's cantilever as a solid."""
    return blade(np.linspace(start, start + length, layers + 1), SIDE, SIDE, across=(across, across))


@cache
def twisted(layers: int = 40, across: tuple[int, int] = (6, 2)) -> Bricks:
    """A blade of 1 m, its chord 160 → 80 mm, thickness 24 → 8 mm at mid-chord and 0.4 of it at the edges, twist 30° → 0."""
    x = np.linspace(ROOT, ROOT + SPAN, layers + 1)
    t = (x - ROOT) / SPAN
    return blade(x, 0.16 - 0.08 * t, 0.024 - 0.016 * t, np.radians(30.0) * (1 - t), across=across, edge=0.4)


@cache
def twisted_modes(omega: float, coriolis: bool = True) -> Modes:
    """The lowest modes of the whole blade, by scikit-fem."""
    return solid.modes(twisted(), STEEL, omega, 6, clamped(ROOT), coriolis=coriolis)


@cache
def twisted_model() -> ties.FiniteElements:
    """The whole blade to condense."""
    return solid.finite_elements(twisted(), STEEL, "twisted blade")


def cuts() -> NDArray[np.intp]:
    """Layers of corners between the twisted blade's segments."""
    return np.arange(SEGMENTS + 1) * twisted().counts[0] // SEGMENTS


@cache
def segments_in_place() -> list[segments.Segment]:
    """The twisted blade's 20 segments, condensed in place."""
    frames = [at(x) for x in twisted().corners[cuts(), 0, 0, 0]]
    root = ties.section(twisted_model(), frames[0], "root", "rigid")
    tied = [root, *(ties.section(twisted_model(), f, f"{f[0, 3]:g} m") for f in frames[1:])]
    return condensation.segments_in_place(twisted_model(), tied, solid.lumped_by_part(twisted(), STEEL, cuts()))


def segments_apart(kind: ties.Kind) -> list[segments.Segment]:
    """The same segments, each condensed alone with both ends tied."""
    out = []
    for k, (a, b) in enumerate(zip(cuts()[:-1], cuts()[1:], strict=True)):
        part = twisted().part(a, b)
        model = solid.finite_elements(part, STEEL, f"segment {k}")
        ends = (ties.section(model, at(x), f"{x:g} m", kind) for x in part.corners[[0, -1], 0, 0, 0])
        out.append(condensation.segment(model, *ends))
    return out


def mac(a: Modes, b: Modes) -> Array:
    """Modal assurance of displacements at the common stations (m, k); all sections count alike, the root not."""
    x, y = (np.asarray(m.shapes[:, :, :3]).reshape(len(m.shapes), -1) for m in (a, b))
    return np.abs(x.conj() @ y.T) ** 2 / np.outer((np.abs(x) ** 2).sum(1), (np.abs(y) ** 2).sum(1))
