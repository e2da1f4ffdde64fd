"""Whirl: the direction in which a mode turns, seen from the ground, and its frequency in both frames.

Two motions along perpendicular axes, X e^{iωt} and Y e^{iωt} with ω > 0, turn about the third axis: X + iY is twice the
amplitude that turns forward, X − iY twice the one that turns backward. Cosine and sine coordinates of blades are such a pair.
In the rotor's frame a forward motion has the frequency ω − Ω, a backward one ω + Ω. (Johnson, *Helicopter Theory*, 1980,
sec. 8-3.)
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

DOMINANT = 0.5
"""Smallest direction, (forward − backward)/(forward + backward), that names a whirl."""


class Whirl(NamedTuple):
    """Direction of a mode's motion in pairs of coordinates.

    Attributes:
        forward, backward: squared amplitudes of the motion with and against the rotor's rotation.
    """

    forward: float
    backward: float

    @property
    def direction(self) -> float:
        """From −1, backward, to 1, forward; 0 for a motion along one line."""
        total = self.forward + self.backward
        return (self.forward - self.backward) / total if total > 0 else 0.0

    @property
    def name(self) -> str:
        """``forward``, ``backward`` or ``neither``."""
        if abs(self.direction) < DOMINANT:
            return "neither"
        return "forward" if self.direction > 0 else "backward"


def whirl(shape: Complex, pairs: NDArray[np.intp], omega: float, weights: Array | None = None) -> Whirl:
    """The whirl of a mode in ground-fixed coordinates.

    Args:
        shape: (n,) amplitudes of e^{iωt}, ω > 0.
        pairs: (p, 2) indices of motions along (or about) two axes that follow each other by a quarter turn about the rotor's
            axis: x and y of a support, cosine and sine coordinates of blades.
        omega: Ω, rad/s; its sign is the sense of rotation about that axis.
        weights: (p,) of the squared amplitudes of the pairs; 1 by default.
    """
    x, y = shape[pairs[:, 0]], shape[pairs[:, 1]]
    weight = np.ones(len(pairs)) if weights is None else weights
    positive, negative = (float(weight @ np.abs(x + sign * 1j * y) ** 2) for sign in (1.0, -1.0))
    return Whirl(positive, negative) if omega >= 0 else Whirl(negative, positive)
