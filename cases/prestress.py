"""What loads a blade steadily besides its rotation, before it is linearised: gravity, with the rotor held at one azimuth."""

import numpy as np

from .pairing import Array

STANDARD_GRAVITY = 9.80665
"""m/s²."""


def gravity(azimuth: float, tilt: float = 0.0) -> Array:
    """Gravity (3,) in the hub's axes, m/s², for ``core.solve.modes``.

    A real blade meets it once a revolution; this is the blade as it hangs while it passes ``azimuth``.

    Args:
        azimuth: rad, from the blade pointing up, in the direction of rotation.
        tilt: rad, of the rotor's axis: how far +z points above the horizontal.
    """
    up = np.array([np.cos(azimuth) * np.cos(tilt), -np.sin(azimuth) * np.cos(tilt), np.sin(tilt)])
    return -STANDARD_GRAVITY * up
