"""Beam sections of a curved solid, identified from the solid itself.

A slice around a station deforms between its neighbours, as in the blade: its sections warp and contract. Twice its strain
energy is the quadratic form ``∫ Fᵀ c F ds`` of the wrench F that it transmits, with c the compliance of its sections. No
displacement has to be averaged over a section (V. Giavotto et al., Computers and Structures 16 (1983) 403). The form is
linear in c, which is taken as uniform in the slice, in section axes.
"""

import numpy as np
from numpy.typing import NDArray

from ...core.space import spatial as sp
from .curved import PER_CHORD, STUB, CurvedSolid, inside

Array = NDArray[np.float64]

GAUSS = 4


def stiffness(
    solid: CurvedSolid, s: Array, across: tuple[int, int], stub: float = STUB, per_chord: int = PER_CHORD
) -> Array:
    """(k, 6, 6) section stiffness about the reference curve in section axes, at arc lengths ``s`` (k,), m.

    The other arguments are those of ``curved.inside``.
    """
    compliance = np.stack([_compliance(solid, float(at), across, stub, per_chord) for at in s])
    return np.asarray(np.linalg.inv(0.5 * (compliance + compliance.transpose(0, 2, 1))), float)


def _compliance(solid: CurvedSolid, at: float, across: tuple[int, int], stub: float, per_chord: int) -> Array:
    """(6, 6) of the sections of the slice around ``at``."""
    stub_inside = inside(solid, at, across, stub, per_chord)
    t, weight = np.polynomial.legendre.leggauss(GAUSS)
    s = at + 0.5 * stub_inside.length * np.append(0.0, t)
    poses = sp.pose(solid.axes(s), solid.curve(s))
    to_section = sp.adjoint(sp.inverse(poses[0]))
    lever = sp.adjoint(sp.inverse(poses[0]) @ poses[1:])
    spread = 0.5 * stub_inside.length * np.einsum("q,qij,qkl->ikjl", weight, lever, lever).reshape(36, 36)
    return np.linalg.solve(spread, (to_section @ stub_inside.energy @ to_section.T).ravel()).reshape(6, 6)


def mass(solid: CurvedSolid, s: Array) -> Array:
    """(k, 6, 6) exact section mass per arc length about the reference curve, in section axes, at arc lengths ``s`` (k,), m.

    An element of volume is ``(1 + κ_y z − κ_z y) dA ds``, with κ the curvature of the undeformed curve in section axes.
    """
    step = 1e-4 * solid.length
    rate = (solid.axes(s + step) - solid.axes(s - step)) / (2 * step)
    skew = np.einsum("sji,sjk->sik", solid.axes(s), rate)
    t, weight = np.polynomial.legendre.leggauss(GAUSS)
    share, w = 0.5 * (1 + t), 0.5 * weight
    y, z = np.broadcast_arrays(*solid.section(s[:, None, None], share[:, None], share))
    corners = [solid.section(s[:, None], share, np.array(end)) for end in (0.0, 1.0)]
    thick = corners[1][1] - corners[0][1]
    chord = solid.section(s, np.array(1.0), np.array(0.0))[0] - solid.section(s, np.array(0.0), np.array(0.0))[0]
    area = chord[:, None, None] * thick[:, :, None] * w[:, None] * w
    dm = solid.material.density * area * (1.0 + skew[:, 0, 2, None, None] * z - skew[:, 1, 0, None, None] * y)
    identity = np.eye(3)
    cross = np.zeros((*y.shape, 3, 3))
    cross[..., 0, 1], cross[..., 0, 2], cross[..., 1, 0], cross[..., 2, 0] = -z, y, z, -y
    move = np.concatenate([np.broadcast_to(identity, cross.shape), -cross], axis=-1)
    return np.einsum("sab,sabji,sabjk->sik", dm, move, move)
