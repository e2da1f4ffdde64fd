"""Altered adapters of scikit-fem, imported only by a worker: one Gauss point for beams, another solid than the case's."""

from dataclasses import replace

from ...core.blade import Blade
from ...core.modes import Modes
from ...references.scikit_fem import beam
from ...references.solid.curved import CurvedSolid
from ...references.solid.known import CURVED, GLASS
from ...references.solid.scikit_fem_blade import ScikitFemSolid, modes

beam.QUADRATURE = 1

ONE_POINT = beam.CODE


class Mirrored(ScikitFemSolid):
    """The adapter with one solid for any blade."""

    def __init__(self, solid: CurvedSolid):
        self._solid = solid

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """See ``interface.BladeAdapter``; the blade is not used."""
        return modes(self._solid, omega, elements, count)


SWEEP = Mirrored(replace(CURVED, sweep=-CURVED.sweep))

FIBRES = Mirrored(replace(CURVED, material=replace(GLASS, angle=-GLASS.angle)))
