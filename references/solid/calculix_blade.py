"""The CalculiX adapter: a curved solid whose beam sections are known, or a uniform blade as a solid bar.

As in ``scikit_fem_blade``, a blade is solved as a three-dimensional solid if it is the beam of one of the solids in ``known``,
or equivalent to the bar of ``bar``. The curved solid's root is held by the same tractions, which scikit-fem computes; mesh,
material, rotation and modes are CalculiX's. Elements have 20 nodes and reduced integration, and an orthotropic material has one
orientation for each layer of elements: second order. Coriolis forces are missing (see ``calculix``).
"""

from ...core.blade import Blade
from ...core.modes import STATIONS, Modes
from ..protocol.interface import BladeAdapter, Independence, Motion
from . import bar, calculix, hexahedra
from .curved import with_root_forces
from .known import ACROSS, recognised
from .materials import Orthotropic
from .mesh import Bricks, clamped_section


class Calculix(BladeAdapter):
    """See the module."""

    name = "calculix"
    title = "CalculiX, solid elements"
    independence = Independence(
        "CalculiX", "solid elements", "CalculiX", sections="the solid's geometry", eigensolver="CalculiX"
    )
    motions: tuple[Motion, ...] = ("axial", "edgewise", "flapwise")
    effects = calculix.EFFECTS
    levels = (10, 20, 40)
    order = 4
    digits = 5  # seven are printed; the ill-conditioned equations of slender solids cost two
    hint = calculix.HINT

    def version(self) -> str | None:
        """Version of ``ccx`` on the PATH."""
        return calculix.version()

    def unsupported(self, blade: Blade) -> str | None:
        """A reason unless the blade is the beam of a known solid, or uniform and equivalent to a bar."""
        solid, reason = recognised(blade)
        if solid:
            return (
                None if hexahedra.version() else f"the tractions that hold the root need scikit-fem: {hexahedra.HINT}"
            )
        return f"{bar_reason}; {reason}" if (bar_reason := bar.unsupported(blade)) else None

    def modes(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes; see ``interface.BladeAdapter``. ``elements`` are rounded up to a multiple of ten.

        Raises:
            CodeError: too large a strain, ``ccx`` missing or failing, or no stable steady state.
        """
        solid, _ = recognised(blade)
        if solid:
            bricks, root = with_root_forces(solid, bar.LAYERS * -(-elements // bar.LAYERS), ACROSS)
            points = solid.position(STATIONS * solid.length)
            return calculix.modes(bricks, solid.material, omega, count, root, points)

        def solved(bricks: Bricks, material: Orthotropic, count: int) -> Modes:
            return calculix.modes(bricks, material, omega, count, clamped_section(blade.hub_radius))

        return bar.modes(blade, omega, elements, count, solved)


CODE = Calculix()
