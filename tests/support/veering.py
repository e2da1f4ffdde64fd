"""Two oscillators on a turning hub whose frequencies approach: in closed form, coupled (they veer) or not (they cross).

Unit masses; flap stiffened by ``2 Ω²``, edge not, joined by κ: ``K = [[a + 2 Ω², κ], [κ, b]]``. The frequencies are nearest
where ``a + 2 Ω² = b``, their squares then ``2 κ`` apart. Shapes are a quarter sine along a uniform blade.
"""

from collections.abc import Callable

import numpy as np

from southwell.core.blade import Blade, uniform_blade
from southwell.core.modes import STATIONS, Modes

BLADE: Blade = uniform_blade("oscillators", 1.0, 0.0, EA=1e6, GJ=1e3, EI_y=1.0, EI_z=1.0, mass=1.0)
FLAP, EDGE = 64.0, 81.0
MEETING = np.sqrt((EDGE - FLAP) / 2.0)
"""rad/s, 2.915."""


def oscillators(coupling: float, calls: list[float] | None = None) -> Callable[[float], Modes]:
    """A solver; ``calls`` collects the speeds it is asked for."""

    def solve(omega: float) -> Modes:
        if calls is not None:
            calls.append(omega)
        squares, vectors = np.linalg.eigh([[FLAP + 2.0 * omega**2, coupling], [coupling, EDGE]])
        shapes = np.zeros((3, 21, 4), complex)
        sine = np.sin(0.5 * np.pi * STATIONS)
        for k in range(2):
            shapes[k, :, 2], shapes[k, :, 1] = vectors[0, k] * sine, vectors[1, k] * sine * np.exp(0.3j)
        shapes[2, :, 2] = np.sin(1.5 * np.pi * STATIONS)
        return Modes(omega, np.sqrt([*squares, 900.0 + 3.0 * omega**2]), shapes, 10, uncertainty=np.zeros(3))

    return solve
