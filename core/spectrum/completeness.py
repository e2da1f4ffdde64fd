"""Proof that no mode is missing: a count of the frequencies below a given one, by Sylvester's law of inertia.

For K positive definite, M positive semi-definite and C skew, the Hermitian matrix H(ω) = K + iωC − ω²M has as many negative
eigenvalues as there are natural frequencies between 0 and ω: its eigenvalues are positive at ω = 0, and each one that
crosses zero does so downwards, since x*H′x = −(x*Kx + ω²x*Mx)/ω < 0 wherever H x = 0. The pivots of an elimination have their
signs, whatever the coordinates. (Sylvester 1852; Parlett, *The Symmetric Eigenvalue Problem*, 1998, sec. 3.3; Wittrick and
Williams, Quart. J. Mech. Appl. Math. 24, 1971, 263, for the count.)
"""

import numpy as np
from numpy.typing import NDArray

from ..compiled import kernels
from ..tree.pencil import TreePencil

Array = NDArray[np.float64]

_MIN_GAP, _MIN_DISTANCE, _MAX_DISTANCE = 1e-3, 1e-6, 0.03
"""Relative distances: the smallest gap in which to count; in smaller ones, the least and the largest distance of the count
from a frequency."""


class MissedModesError(ArithmeticError):
    """The eigensolver missed a mode or found one twice."""


def check_complete(p: TreePencil, frequencies: Array, next_frequencies: Array, rounding: float = 0.0) -> None:
    """Prove that the frequencies are the lowest ones with their multiplicities.

    The count is taken in the gap above the last frequency. If that frequency belongs to a cluster of which only some modes
    were requested, the count may exceed the number found; then the count below the cluster must agree.

    Args:
        p: the pencil.
        frequencies: (m,) ascending.
        next_frequencies: (k,) estimates of the next frequencies, from above, which locate the gap.
        rounding: relative error of the pencil due to rounding; frequencies closer than ten times that (at most 3 %) are not
            distinguished.

    Raises:
        MissedModesError: the count differs.
    """
    last = frequencies[-1]
    next_ = next_frequencies.min(initial=2.0 * last)  # not above the last if that is one of an exact pair
    distance = min(max(_MIN_DISTANCE, 10.0 * rounding), _MAX_DISTANCE)
    room = min(next_ / last - 1.0, 0.1)
    wide = room > _MIN_GAP
    shift, expected = last * (1.0 + (0.3 * room if wide else distance)), len(frequencies)
    actual = below(p, shift)
    if actual > expected or (actual == expected and not wide):
        shift = last * (1.0 - distance)
        expected = int((frequencies < shift).sum())
        actual = below(p, shift)
    if actual != expected:
        raise MissedModesError(
            f"the eigensolver found {expected} natural frequencies below {shift:.9g} rad/s, but there are {actual}: change "
            "the number of modes or elements; please report this as a bug"
        )


def below(p: TreePencil, omega: float) -> int:
    """Number of natural frequencies between 0 and ``omega`` (rad/s), which must not be one of them."""
    return kernels.negative_pivots(p.K, p.C, p.M, p.links.arrays, omega)
