"""Rigid-body motions: poses (SE(3)), twists, wrenches and inertias.

Poses (..., 4, 4), twists and wrenches (..., 6) and inertias (..., 6, 6) come in and go out, in batches. ``rigid.hpp`` has the
formulae for one motion. Nothing here depends on bodies or beams.
"""

from .inertia import about_centre, transformed
from .spatial import ad, adjoint, coadjoint, exp, inverse, log, pose, rotation, skew, tangent, tangent_inverse

__all__ = [
    "about_centre",
    "ad",
    "adjoint",
    "coadjoint",
    "exp",
    "inverse",
    "log",
    "pose",
    "rotation",
    "skew",
    "tangent",
    "tangent_inverse",
    "transformed",
]
