"""A mechanism's rotor with equal blades on a support: its modes in multi-blade coordinates."""

from collections.abc import Mapping

import numpy as np

from ..mechanism.description import Mechanism, MechanismError
from ..mechanism.motion import Motion
from ..spectrum.eigen import Damped, damped
from ..tree.linearization import Linearization, about
from ..tree.state import state_at
from .multiblade import blades_of
from .orbit import linearize
from .periodic import CONSTANT, PeriodicError, averaged_exactly, in_multiblade

EXACT = CONSTANT
"""Relative uncertainty of the frequencies: the largest variation with the azimuth that counts as none."""


def turning(mechanism: Mechanism) -> Motion | None:
    """The motion that turns the rotor of a mechanism with equal blades; None if it has none, or stands still.

    Raises:
        MechanismError: several motions at a rate.
    """
    moving = [m for m in mechanism.motions if m.rate]
    if not mechanism.equal_blades or not moving:
        return None
    if len(moving) > 1:
        raise MechanismError(
            f"motion {moving[1].coordinate!r}: a mechanism with equal blades has one rotor: give one motion"
        )
    return moving[0]


def whirling(
    mechanism: Mechanism, rotor: Motion, guess: Mapping[str, float] | None, count: int | None
) -> tuple[Linearization, Damped]:
    """The mechanism at the azimuth 0, and the modes in multi-blade coordinates with their motions at this azimuth.

    Raises:
        MechanismError: the equations vary with the azimuth in these coordinates, names of ``equal_blades`` are unknown, or the
            mechanism has no steady state.
    """
    system, orbit = linearize(mechanism, rotor.coordinate, guess)
    for name in (name for group in mechanism.equal_blades for name in group):
        if name not in system.names:
            raise MechanismError(
                f"equal_blades: {name!r}: no free coordinate of this name: there are {', '.join(system.names)}"
            )
    try:
        blades = blades_of(
            len(system.names), [[system.names.index(name) for name in group] for group in mechanism.equal_blades]
        )
        M, C, K = averaged_exactly(in_multiblade(system, blades)).mean
    except (PeriodicError, ValueError) as error:
        raise MechanismError(f"equal_blades: {error}") from error
    q = orbit.motion(0.0).q
    linear = about(orbit.tree, state_at(orbit.tree, np.asarray(q)))
    modes = damped(M, C, K, count)
    return linear, Damped(modes.values, blades.transformation(0.0) @ modes.vectors)
