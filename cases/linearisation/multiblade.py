"""State matrices of an azimuth set in the fixed frame, by the multi-blade coordinates of ``core.rotor``."""

import numpy as np
from numpy.typing import NDArray

from ...core.rotor import multiblade
from .sets import AzimuthSet

Array = NDArray[np.float64]

BLADES = 3
"""Number of blades whose states are transformed; those of other rotors stay in the rotating frame."""


def fixed_frame(azimuth_set: AzimuthSet, A: Array, azimuths: Array | None = None, speeds: Array | None = None) -> Array:
    """State matrices in the fixed frame for all azimuths.

    Args:
        azimuth_set: the set.
        A: state matrices (azimuth, row, column).
        azimuths: rad, in place of those of the files.
        speeds: rotor speeds in rad/s, in place of those of the files.
    """
    groups = _groups(azimuth_set)
    if not groups:
        return A.copy()
    positions = multiblade.blades_of(len(azimuth_set.states), groups)
    rates = np.array(azimuth_set.pairs, dtype=np.intp).reshape(-1, 2)
    psi = azimuth_set.azimuths if azimuths is None else azimuths
    omega = np.array([file.rotor_speed for file in azimuth_set.files]) if speeds is None else speeds
    return np.array(
        [multiblade.first_order(a, float(p), float(o), positions, rates) for a, p, o in zip(A, psi, omega, strict=True)]
    )


def states_of_components(azimuth_set: AzimuthSet, psi: float, omega: float) -> tuple[Array, Array]:
    """P and P⁻¹ at the azimuth ``psi``: the file's states are x = P z with z in the fixed frame."""
    n = len(azimuth_set.states)
    P, inverse = np.eye(n), np.eye(n)
    T, inv, R = (
        multiblade.transformation(psi, BLADES),
        multiblade.inverse(psi, BLADES),
        omega * multiblade.rate(BLADES),
    )
    if azimuth_set.blades != BLADES:
        return P, inverse
    for group in azimuth_set.groups:
        members = np.array(group.members)
        P[np.ix_(members, members)], inverse[np.ix_(members, members)] = T, inv
        if group.derivative is not None:
            rates = np.array(group.derivative)
            P[np.ix_(rates, members)], inverse[np.ix_(rates, members)] = T @ R, -R @ inv
    return P, inverse


def _groups(azimuth_set: AzimuthSet) -> list[tuple[int, ...]]:
    """Members of the groups of displacements, and of states of first order, on three blades."""
    if azimuth_set.blades != BLADES:
        return []
    displacements = {k for group in azimuth_set.groups if group.derivative for k in group.derivative}
    return [group.members for group in azimuth_set.groups if group.members[0] not in displacements]
