"""Steady loads on a blade besides rotation, applied before linearisation: gravity at one azimuth, and a given load."""

from pathlib import Path

import numpy as np

from ...core.blade import Blade
from ..input.blades import read_table
from ..input.errors import CaseError
from ..judge.pairing import Array

STANDARD_GRAVITY = 9.80665
"""m/s²."""


def gravity(azimuth: float, tilt: float = 0.0) -> Array:
    """Gravity (3,) in the hub's axes, m/s², for ``core.solve.modes``.

    The load on a real blade varies once per revolution; this is the steady load at ``azimuth``.

    Args:
        azimuth: rad, from the blade pointing up, in the direction of rotation.
        tilt: rad, of the rotor's axis, positive with its upwind end raised, as the tilt of an upwind rotor: +z (downwind)
            points below the horizontal. OpenFAST's ShftTilt has the opposite sign.
    """
    vertical = np.array([np.cos(azimuth) * np.cos(tilt), -np.sin(azimuth) * np.cos(tilt), -np.sin(tilt)])
    return -STANDARD_GRAVITY * vertical


LOAD = ("fraction [-]", "fx [N/m]", "fy [N/m]", "fz [N/m]")
"""Columns of a load table: position along the blade, and force per length in the rotating hub axes."""


def load(path: Path, blade: Blade) -> Array:
    """A steady load (n, 3) at the blade's stations, N/m, linear between the rows of a CSV file with the columns ``LOAD``.

    The solver takes it as linear between the stations.

    Raises:
        CaseError: if the file is missing or malformed, its rows do not cover the blade in ascending order, or the load is not
            linear between the stations.
    """
    table = read_table(path, LOAD)
    at = table[LOAD[0]]
    if at[0] != 0.0 or at[-1] != 1.0 or (np.diff(at) <= 0).any():
        raise CaseError(f"{path}: {LOAD[0]}: from {at[0]:g} to {at[-1]:g}: rows must ascend from 0 (root) to 1 (tip)")
    stations = blade.stations / blade.length
    forces = np.stack([table[name] for name in LOAD[1:]], axis=-1)
    per_length = _linear(stations, at, forces)
    deviation = np.abs(_linear(at, stations, per_length) - forces).max(1)
    if deviation.max() > 1e-6 * np.abs(forces).max():
        raise CaseError(
            f"{path}: {LOAD[0]} {at[deviation.argmax()]:g}: the load is not linear between the blade's {len(stations)} "
            "stations: add a station to the blade there, or give the load at its stations only"
        )
    return per_length


def _linear(where: Array, at: Array, values: Array) -> Array:
    """Linear interpolation (k, 3) at ``where`` (k,) between the ``values`` (n, 3) at ``at`` (n,)."""
    return np.stack([np.interp(where, at, column) for column in values.T], axis=-1)
