"""Yoo and Shin's rotating cantilever: bending coupled with stretch by the Coriolis force, linear in hybrid variables.

The stretch s of the arc replaces the axial displacement, ``u = s − ∫ v′² / 2``: the strain energy is then quadratic,
and the centrifugal stiffening follows from the kinetic energy. For small motions, with T the tension of the straight blade,

    edgewise:   m v̈ + 2 Ω m ṡ − Ω² m v + (E I_z v″)″ − (T v′)′ = 0
    stretch:    m s̈ − 2 Ω m v̇ − Ω² m s − (E A s′)′ = 0,              T(s) = Ω² ∫ₛ m (R + s) ds
    flapwise:   m ẅ + (E I_y w″)″ − (T w′)′ = 0

(H. H. Yoo and S. H. Shin, "Vibration analysis of rotating cantilever beams", J. Sound Vib. 212 (1998) 807–828, there
for uniform beams; here properties may vary along the span.) Rayleigh–Ritz with the polynomials of ``spectral``.

The theory is linear in s and neglects the steady stretch. No steady state exists above the speed at which Ω² m exceeds
the axial stiffness (``γ = α π/2`` for a uniform beam); the code then raises an error.
"""

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.modes import STATIONS, Modes
from ..protocol.interface import Independence, Motion
from .assumed_modes import bendings
from .ritz import X, Y, apart, coupled_modes, integral, part, shape_of, skew, stationary_modes, union
from .spectral import clamped_functions, pinned_functions
from .straight_beam import ClosedForm, line, refusal, terms

Array = NDArray[np.float64]


def edgewise(blade: Blade, omega: float, terms: int) -> tuple[Array, Array, Array, Array]:
    """M, C, K (2n, 2n) of stretch and edgewise bending at ``omega`` (rad/s), and the coordinates' shapes (21, 4, 2n)."""
    at = line(blade, terms)
    s, strain, _ = pinned_functions(at.ends, terms, at.s)
    v = clamped_functions(at.ends, terms, at.s)[0]
    bending, _ = bendings(blade, terms)
    inertia = integral(at.mass, s)
    stretching = integral(at.weight * at.sections.EA, strain) - omega**2 * inertia
    where = STATIONS * blade.length
    return (
        apart(inertia, bending.mass),
        skew(2 * omega * integral(at.mass, v, s)),
        apart(stretching, bending.stiffness(omega)),
        shape_of([(X, pinned_functions(at.ends, terms, where)[0]), (Y, clamped_functions(at.ends, terms, where)[0])]),
    )


class YooShin(ClosedForm):
    """Edgewise bending with stretch, and flapwise bending; uniform or varying, untwisted.

    It neglects rotary inertia, and the effect of the steady stretch on radius and tension.
    """

    name = "yoo-shin"
    title = "Yoo and Shin (1998), Rayleigh–Ritz"
    independence = Independence("Southwell's Ritz method", "Yoo and Shin 1998", "assumed-modes")
    motions: tuple[Motion, ...] = ("axial", "edgewise", "flapwise")
    effects = Effects(prestretch=False, rotary_inertia=False)

    def unsupported(self, blade: Blade) -> str | None:
        """The reason why the blade is outside this theory; None if it is not."""
        return refusal(blade, twist=False, stretch=True, tip_inertia=False)

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes with ``elements`` polynomials per field in each interval (see ``protocol.interface``).

        Raises:
            CodeError: unsupported blade, or a speed above which no steady state exists.
        """
        number = terms(blade, elements)
        M, C, K, shape = edgewise(blade, omega, number)
        _, flap = bendings(blade, number)
        parts = (
            part(shape, *coupled_modes(M, C, K, count)),
            part(flap.shape, *stationary_modes(flap.mass, flap.stiffness(omega), count)),
        )
        return union(parts, omega, elements, count)


CODE = YooShin()
