"""The six offset columns of FAST 7's blade table, as FAST's preprocessor for MSC.ADAMS uses them.

FAST's blade axes are x_b downwind and y_b to the trailing edge (both pitched with the blade); ``n1``, ``n2`` are these
axes rotated by the structural twist, towards the suction side and the trailing edge. At a station z along the pitch axis

* the reference axis is at ``PrecrvRef x_b + PreswpRef y_b`` from the pitch axis,
* the elastic axis is at ``FlpEAOf n1 + EdgEAOf n2`` from the reference axis: the beam lies along it, so that tension,
  bending and torsion act there,
* the mass centre is at ``FlpcgOf n1 + EdgcgOf n2`` from the reference axis; FlpIner and EdgIner are about it.

The preprocessor rotates the offsets by AeroDyn's aerodynamic twist; the blade file has only the structural twist, which
is used for both. It uses mass and stiffness per length of the pitch axis; here they are per length of the beam's axis,
according to the table's units (a difference of second order in the slopes). Here x = z, y = −y_b, z = x_b
(``core.blade``).

Source: J. Jonkman, FAST v7.02, ``FAST2ADAMS.f90``, subroutine ``MakeADM`` (``EAVec``; MARKERs "CM_M", "EA_M"); J. Jonkman,
M. Buhl, *FAST User's Guide*, NREL/EL-500-38230, 2005.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .....core.space.spatial import rotation
from .beamdyn_axis import measured

Array = NDArray[np.float64]

COLUMNS = ("PrecrvRef", "PreswpRef", "FlpcgOf", "EdgcgOf", "FlpEAOf", "EdgEAOf")


class ReferenceLine(NamedTuple):
    """The elastic axis: arc lengths (n,) and points (n, 3) in blade axes, and the mass centre (n, 2) from it along the
    section's y and z; m."""

    s: Array
    curve: Array
    mass_centre: Array


def line(z: Array, offsets: dict[str, Array], twist: Array) -> ReferenceLine:
    """The elastic axis and the mass centre at stations.

    Args:
        z: (n,) m from the root along the pitch axis.
        offsets: (n,) m each, by the names in ``COLUMNS``; a missing column is zero.
        twist: (n,) rad, the section's twist, positive from y towards z.
    """
    curved, swept, flap_mass, edge_mass, flap_axis, edge_axis = (offsets.get(c, np.zeros_like(z)) for c in COLUMNS)
    within = np.stack([np.zeros_like(z), -edge_axis, flap_axis], axis=1)  # section axes: y = −n2, z = n1
    points = np.stack([z, -swept, curved], axis=1) + np.einsum("nij,nj->ni", rotation(0, twist), within)
    mass_centre = np.stack([edge_axis - edge_mass, flap_mass - flap_axis], axis=1)
    if not points[:, 1:].any():
        return ReferenceLine(z, points, mass_centre)
    axis = measured(CubicSpline(z, points[:, 1:], bc_type="natural"), z)
    return ReferenceLine(axis.arc, points, mass_centre)
