"""Inertias (6, 6) of rigid bodies about a frame's origin: ``[[m 1, −m c×], [m c×, J]]``, c the mass centre.

The momentum of a body is its inertia times its twist (Featherstone, *Rigid Body Dynamics Algorithms*, 2008, eq. 2.63).
"""

import numpy as np
from numpy.typing import NDArray

from .spatial import adjoint, inverse, skew

Array = NDArray[np.float64]


def about_centre(inertia: Array) -> tuple[Array, Array, Array]:
    """Mass (...), kg, mass centre (..., 3), m, and moments of inertia (..., 3, 3) about it, kg m²; axes of the frame.

    Without mass the centre is the origin. The units per length are those of a section's inertia.
    """
    mass = inertia[..., 0, 0]
    moment = 0.5 * (inertia[..., 3:, :3] - inertia[..., :3, 3:])  # m c×
    first = np.stack([moment[..., 2, 1], moment[..., 0, 2], moment[..., 1, 0]], axis=-1)
    centre = np.divide(first, mass[..., None], out=np.zeros_like(first), where=mass[..., None] > 0)
    across = skew(centre)
    return mass, centre, inertia[..., 3:, 3:] + mass[..., None, None] * across @ across


def transformed(inertia: Array, x: Array) -> Array:
    """Inertias (..., 6, 6) given in frames at poses ``x`` (..., 4, 4), transformed to the frame in which ``x`` is given."""
    a = adjoint(inverse(x))
    return np.swapaxes(a, -1, -2) @ inertia @ a
