"""The adapter for solids of scikit-fem: a curved solid whose beam sections are known, or a uniform blade as a solid bar.

A blade is solved as a three-dimensional solid in two cases. If it is the beam of one of the solids in ``known``, the whole
solid is solved, with its own geometry and material: neither sections nor the theory of beams enter the result, so that the
difference from a beam is that of the model. The sections are compared with those of the solid, and another blade is declined.
If it is uniform, it is solved as the bar of ``bar``, as by CalculiX, but with Coriolis forces.

Elements have 27 nodes and full integration (see ``hexahedra``). Refinement is along the blade; the number of elements in a
section is that from which the sections were identified.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.blade import Blade
from ...core.effects import ALL_EFFECTS
from ...core.modes import STATIONS, Modes
from ..protocol.fingerprint import Fingerprint, of_points
from ..protocol.interface import BladeAdapter, Independence, Motion
from . import bar, hexahedra
from .curved import CurvedSolid, layer, with_root_forces
from .known import ACROSS, recognised
from .materials import Orthotropic
from .mesh import Bricks, clamped_section

Array = NDArray[np.float64]


class ScikitFemSolid(BladeAdapter):
    """See the module."""

    name = "scikit-fem-solid"
    title = "scikit-fem, solid elements"
    independence = Independence(
        "scikit-fem",
        "three-dimensional solid, stiffness made by the adapter",
        "scikit-fem-solid's adapter",
        sections="the solid's geometry",
    )
    motions: tuple[Motion, ...] = ("axial", "edgewise", "flapwise")
    effects = ALL_EFFECTS
    levels = (10, 20, 30)
    order = 4
    finest = 80  # a layer of nodes has hundreds of freedoms
    distribution = "scikit-fem"
    digits = 5  # the equations of slender solids are ill-conditioned
    hint = hexahedra.HINT

    def unsupported(self, blade: Blade) -> str | None:
        """A reason unless the blade is the beam of a known solid, or uniform and equivalent to a bar."""
        solid, reason = recognised(blade)
        if solid is None and (bar_reason := bar.unsupported(blade)):
            return f"{bar_reason}; {reason}"
        return None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``. ``elements`` are rounded up to a multiple of ten.

        Raises:
            CodeError: too large a strain of a bar, or no stable steady state.
        """
        solid, _ = recognised(blade)
        if solid:
            return modes(solid, omega, bar.LAYERS * -(-elements // bar.LAYERS), count)

        def solved(bricks: Bricks, material: Orthotropic, count: int) -> Modes:
            return hexahedra.modes(bricks, material, omega, count, clamped_section(blade.hub_radius))

        return bar.modes(blade, omega, elements, count, solved)

    def fingerprint(self, blade: Blade, elements: int) -> Fingerprint:
        """From the mass matrix of the solid, summed over its nodes; see ``interface.BladeAdapter``."""
        solid, _ = recognised(blade)
        layers = bar.LAYERS * -(-elements // bar.LAYERS)
        if solid:
            body = hexahedra.solid(with_root_forces(solid, layers, ACROSS)[0], solid.material)
        else:
            body = hexahedra.solid(*bar.bar(blade, layers))
        M = hexahedra.mass(body)
        x, y, _ = body.nodes.T
        summed = of_points(np.asarray(M.sum(axis=1)).ravel(), body.nodes, layers)
        return replace(summed, rotor_inertia=float(x @ (M @ x) + y @ (M @ y)))


def modes(solid: CurvedSolid, omega: float, layers: int, count: int) -> Modes:
    """The lowest modes of a curved solid at ``omega`` (rad/s), its root held by St Venant's tractions.

    Args:
        solid: the solid.
        omega: rotor speed, rad/s.
        layers: elements along the span, a multiple of ten.
        count: number of modes.

    Raises:
        CodeError: no stable steady state.
    """
    bricks, root = with_root_forces(solid, layers, ACROSS)
    places = solid.position(STATIONS * solid.length)
    step = 2 * layers // (len(STATIONS) - 1)
    sections = [(layer(bricks, k * step), position) for k, position in enumerate(places)]
    return hexahedra.modes(bricks, solid.material, omega, count, root, sections=sections)


CODE = ScikitFemSolid()
