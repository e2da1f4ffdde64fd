"""A square bar as a Timoshenko beam: the reference for a solid cantilever."""

import numpy as np
from numpy.typing import NDArray

from ..theories import timoshenko
from .materials import Material

Array = NDArray[np.float64]


def shear_stiffness(material: Material, side: float) -> float:
    """κ G A (N) of a square ``side`` (m), κ = 10 (1 + ν)/(12 + 11 ν) (G. R. Cowper, J. Appl. Mech. 33 (1966) 335)."""
    nu = material.poisson
    return 10 * (1 + nu) / (12 + 11 * nu) * material.lame[1] * side**2


def cantilever(count: int, material: Material, side: float, length: float) -> Array:
    """The ``count`` lowest frequencies (rad/s) in one plane of a bar of square section; ``side`` and ``length`` in m."""
    second = side**4 / 12
    return timoshenko.cantilever(
        count,
        EI=material.young * second,
        GA=shear_stiffness(material, side),
        mass=material.density * side**2,
        rotary=material.density * second,
        length=length,
    )
