"""What a blade weighs and where: totals about the rotor's axis and the root, and the centres of its sections."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core import spatial as sp
from ..core.blade import Blade, mass_at
from ..core.sections import compliance, frames, root

Array = NDArray[np.float64]

GAUSS = 4
"""Points between stations: mass is linear there and the curve a cubic, so that totals keep nearly all digits."""


@dataclass(frozen=True)
class Totals:
    """A blade at rest as one rigid body, its tip mass with it.

    Attributes:
        mass: kg, tip mass included.
        tip_mass: kg.
        centre: (3,) m, centre of mass in the hub's axes.
        first_moment: kg m, of mass about the rotor's axis: ∫ r dm with r the distance from the axis.
        second_moment: kg m², of mass about the rotor's axis.
        root_first, root_second: the same with the distance along the blade from the root: ∫ s dm, ∫ s² dm, as blade
            makers state them.
        tip_radius: m, the tip's distance from the rotor's axis.
    """

    mass: float
    tip_mass: float
    centre: Array
    first_moment: float
    second_moment: float
    root_first: float
    root_second: float
    tip_radius: float


@dataclass(frozen=True)
class Centres:
    """Sections at the stations, in section axes.

    Attributes:
        mass, tension, shear: (n, 2) m, (y, z) of the centres from the reference axis: where a force of inertia, an axial
            force, and a transverse force act without turning, bending or twisting the section.
        EA, GJ, EI_y, EI_z: (n,) stiffness in axial and torsional strain and in bending, other strains free: each about its
            own centre; ``inf`` where rigid.
        per_length: (n,) kg/m.
    """

    mass: Array
    tension: Array
    shear: Array
    EA: Array
    GJ: Array
    EI_y: Array
    EI_z: Array
    per_length: Array


def totals(blade: Blade) -> Totals:
    """Totals by Gauss quadrature between the stations."""
    x, w = np.polynomial.legendre.leggauss(GAUSS)
    ends = blade.stations
    s = (ends[:-1, None] + np.diff(ends)[:, None] * (x + 1) / 2).ravel()
    ds = (np.diff(ends)[:, None] * w / 2).ravel()
    pose = frames(blade, s)
    sections = mass_at(blade, s) * ds[:, None, None]
    tip = frames(blade, ends[-1:])[0]
    body = _moved(sections, pose).sum(0) + _moved(blade.tip_mass[None], tip[None])[0]
    m = body[0, 0]
    centre = np.array([-body[4, 2], -body[5, 0], -body[3, 1]]) / m

    lumps, where = np.append(sections[:, 0, 0], blade.tip_mass[0, 0]), np.concatenate([pose, tip[None]])
    offsets = [np.array([0.0, -k[0, 5], k[0, 4]]) / k[0, 0] for k in sections]
    tip_offset = _centre(blade.tip_mass) if blade.tip_mass[0, 0] else np.zeros(3)
    at = where[:, :3, 3] + np.einsum("nij,nj->ni", where[:, :3, :3], np.array([*offsets, tip_offset]))
    along = at @ root(blade)[:3, 0] - blade.hub_radius
    return Totals(
        mass=float(m),
        tip_mass=float(blade.tip_mass[0, 0]),
        centre=centre,
        first_moment=float(lumps @ np.hypot(at[:, 0], at[:, 1])),
        second_moment=float(body[5, 5]),
        root_first=float(lumps @ along),
        root_second=float(lumps @ along**2),
        tip_radius=float(np.hypot(tip[0, 3], tip[1, 3])),
    )


def _moved(bodies: Array, pose: Array) -> Array:
    """Rigid bodies' inertia (n, 6, 6) from their own frames to the frame their poses are given in."""
    back = sp.adjoint(sp.inverse(pose))
    return np.swapaxes(back, -1, -2) @ bodies @ back


def _centre(body: Array) -> Array:
    return np.array([-body[4, 2], -body[5, 0], -body[3, 1]]) / body[0, 0]


def centres(blade: Blade) -> Centres:
    """Centres and stiffness of the sections at the stations."""
    c = compliance(blade, blade.stations)
    m = blade.mass
    # an axial force at (y, z) bends by c[4:, 0] + c[4:, 4:] (z, −y); a transverse one twists by c[3, 1] − z c[3, 3], …
    z, minus_y = np.linalg.solve(c[:, 4:, 4:], -c[:, 4:, 0, None])[..., 0].T
    rigid = np.isinf(blade.stiffness[:, range(6), range(6)])
    bend = np.linalg.inv(c[:, 4:, 4:])
    ea = c[:, 0, 0] - np.einsum("ni,nij,nj->n", c[:, 0, 4:], bend, c[:, 4:, 0])
    return Centres(
        mass=np.stack([-m[:, 0, 5], m[:, 0, 4]], axis=1) / m[:, :1, 0],
        tension=np.stack([-minus_y, z], axis=1) * ~rigid[:, :1],
        shear=np.stack([-c[:, 3, 2], c[:, 3, 1]], axis=1) / c[:, 3, 3, None],
        EA=np.where(rigid[:, 0], np.inf, 1 / ea),
        GJ=np.where(rigid[:, 3], np.inf, 1 / c[:, 3, 3]),
        EI_y=bend[:, 0, 0],
        EI_z=bend[:, 1, 1],
        per_length=m[:, 0, 0],
    )
