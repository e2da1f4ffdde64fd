"""A blade's sections between its stations, for the adapters of foreign codes; independent of core's sampling.

The description of a blade says that properties are linear between stations (``core.blade.Blade``). Core interpolates matrices
in ``core.sampling``; here each entry of a matrix is a column of a table, interpolated by ``numpy.interp``. Nothing is shared
but the data class, so that a mistake in either place shows as a difference between core's frequencies and those of the codes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.blade import AXIAL, BEND_Y, BEND_Z, SHEAR_Y, SHEAR_Z, TORSION, Blade, BladeError, coupled

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SampledSections:
    """Properties of uncoupled sections at k arc lengths, each (k,), in section (twisted) axes.

    Attributes:
        EA, GA_y, GA_z: stiffness in stretch and shear, N.
        GJ, EI_y, EI_z: stiffness in torsion and in bending about y and z, N m².
        mass: kg/m.
        I_x, I_y, I_z: moments of inertia per length, kg m.
        twist: rad.
    """

    EA: Array
    GA_y: Array
    GA_z: Array
    GJ: Array
    EI_y: Array
    EI_z: Array
    mass: Array
    I_x: Array
    I_y: Array
    I_z: Array
    twist: Array


def sample(blade: Blade, s: ArrayLike) -> SampledSections:
    """Engineering properties at arc lengths ``s`` (m).

    Raises:
        BladeError: the sections are coupled (see ``core.blade.coupled``), which these properties do not describe.
    """
    if coupled(blade):
        raise BladeError(
            f"{blade.name}: coupled sections (off-diagonal entries); this code accepts uncoupled sections only"
        )
    stiffness, mass = stiffness_at(blade, s), mass_at(blade, s)
    return SampledSections(
        EA=stiffness[:, AXIAL, AXIAL],
        GA_y=stiffness[:, SHEAR_Y, SHEAR_Y],
        GA_z=stiffness[:, SHEAR_Z, SHEAR_Z],
        GJ=stiffness[:, TORSION, TORSION],
        EI_y=stiffness[:, BEND_Y, BEND_Y],
        EI_z=stiffness[:, BEND_Z, BEND_Z],
        mass=mass[:, AXIAL, AXIAL],
        I_x=mass[:, TORSION, TORSION],
        I_y=mass[:, BEND_Y, BEND_Y],
        I_z=mass[:, BEND_Z, BEND_Z],
        twist=twist_at(blade, s),
    )


def stiffness_at(blade: Blade, s: ArrayLike) -> Array:
    """Section stiffness (k, 6, 6) at arc lengths ``s``, N, N m, N m²; rigid strains are ``inf``."""
    return _table(blade.stations, blade.stiffness, s)


def mass_at(blade: Blade, s: ArrayLike) -> Array:
    """Section mass per length (k, 6, 6) at arc lengths ``s``, kg/m, kg, kg m."""
    return _table(blade.stations, blade.mass, s)


def twist_at(blade: Blade, s: ArrayLike) -> Array:
    """Structural twist (k,) at arc lengths ``s``, rad."""
    return np.interp(np.atleast_1d(s), blade.stations, blade.twist)


def points(ends: ArrayLike, count: int) -> tuple[Array, Array]:
    """Gauss points and weights (i, count) in each of the intervals between ``ends`` (i+1,), in their unit."""
    ends = np.asarray(ends, float)
    x, weight = np.polynomial.legendre.leggauss(count)
    length = np.diff(ends)[:, None]
    return ends[:-1, None] + length * (0.5 + 0.5 * x), length * (0.5 * weight)


def _table(stations: Array, matrices: Array, s: ArrayLike) -> Array:
    """Matrices (n, 6, 6) entry by entry at arc lengths ``s`` (k,); an entry is infinite at every station or at none."""
    at = np.atleast_1d(np.asarray(s, float))
    out = np.zeros((len(at), 6, 6))
    for i, j in np.argwhere((matrices != 0.0).any(axis=0)):
        column = matrices[:, i, j]
        out[:, i, j] = np.inf if np.isinf(column).any() else np.interp(at, stations, column)
    return out
