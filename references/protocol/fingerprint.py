"""What a code's own assembled model weighs and how it bends: mass, first moments, inertia, tip flexibility.

They are those of the undeformed blade as a rigid body, about the hub's centre, in axes that turn with the hub: x at the
blade's azimuth, z the rotor's axis.
"""

from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from msgspec import Meta
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Elements = Annotated[int, Meta(ge=1, le=10**7)]

SPIN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
"""The vector product e_z ×."""


@dataclass(frozen=True)
class Fingerprint:
    """Inertia of a model as a rigid body.

    Attributes:
        mass: kg.
        first_moments: along x, y, z, kg m.
        rotor_inertia: about z, kg m².
        elements: number of elements of the model.
        start: arc length at which the model's own mass begins, m; what is before it belongs to the hub.
        flexibility: (21,) of the clamped blade at rest: displacements along, and rotations about, x, y, z of the tip by unit
            forces and moments there, m/N, rad/N and rad/(N m); the upper triangle, row by row; None if the code does not
            report it.
        inertia: (3,) of a whole turbine: ``first_moments`` and it are about the tower's base, x up, y to starboard, z downwind,
            kg m²; ``rotor_inertia`` is then about the shaft, without the generator. None of a blade.
    """

    mass: Annotated[float, Meta(ge=0)]
    first_moments: tuple[float, float, float]
    rotor_inertia: float
    elements: Elements
    start: Annotated[float, Meta(ge=0)] = 0.0
    flexibility: Annotated[tuple[float, ...], Meta(min_length=21, max_length=21)] | None = None
    inertia: tuple[float, float, float] | None = None


UPPER = np.triu_indices(6)
"""Rows and columns of the entries of a symmetric matrix (6, 6) that are reported."""


def tip_flexibility(matrix: Array) -> tuple[float, ...]:
    """The upper triangle (21,) of a flexibility (6, 6) of the tip, its displacements and rotations in the hub's axes."""
    symmetric = 0.5 * (matrix + matrix.T)
    return tuple(symmetric[UPPER].tolist())


def rigid_motions(position: Array) -> Array:
    """(…, 3, 6) displacements of points ``position`` (…, 3) by unit motions along, then about, x, y, z of the hub."""
    x, y, z = np.moveaxis(position, -1, 0)
    zeros, ones = np.zeros_like(x), np.ones_like(x)
    rows = ((ones, zeros, zeros, zeros, z, -y), (zeros, ones, zeros, -z, zeros, x), (zeros, zeros, ones, y, -x, zeros))
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def of_matrix(inertia: ArrayLike, elements: int, start: float = 0.0) -> Fingerprint:
    """The fingerprint of a rigid body's inertia (6, 6) about the hub's centre, in the order of ``rigid_motions``."""
    m = np.asarray(inertia, float)
    return Fingerprint(
        float(m[0, 0]), (float(m[1, 5]), float(m[2, 3]), float(m[0, 4])), float(m[5, 5]), elements, start
    )


def of_points(mass: Array, position: Array, elements: int) -> Fingerprint:
    """The fingerprint of masses (n,) at points (n, 3)."""
    first = mass @ position
    inertia = float(mass @ (position[:, :2] ** 2).sum(axis=1))
    return Fingerprint(float(mass.sum()), (float(first[0]), float(first[1]), float(first[2])), inertia, elements)


def of_turbine(inertia: Array, rotor: float, elements: int) -> Fingerprint:
    """The fingerprint of a turbine with the inertia (6, 6) about the tower's base, and that of its rotor about the shaft."""
    up, across, along = np.diagonal(inertia)[3:].tolist()
    return replace(of_matrix(inertia, elements), rotor_inertia=rotor, inertia=(up, across, along))
