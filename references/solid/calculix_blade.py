"""The CalculiX adapter: a uniform blade as a solid bar (``bar``). Coriolis forces are missing (see ``calculix``)."""

from ...core.blade import Blade
from ...core.modes import Modes
from ..protocol.interface import CodeError, Independence, Motion, Shares
from . import bar, calculix
from .materials import Orthotropic
from .mesh import Bricks, clamped


class Calculix:
    """See the module; uniform, straight, clamped blades with the rotary inertia of a solid."""

    name = "calculix"
    title = "CalculiX, solid elements"
    shares: Shares = "nothing"
    independence = Independence("CalculiX", "solid elements", "CalculiX", eigensolver="CalculiX")
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
        """A reason unless the blade is uniform and equivalent to a solid of rectangular section."""
        return bar.unsupported(blade)

    def solve(self, blade: Blade, omega: float, elements: int, count: int) -> Modes:
        """The lowest modes of bending and stretch; see ``interface.Code``. ``elements`` are rounded up to a multiple of ten.

        Raises:
            CodeError: an unsupported blade, too large a strain, ``ccx`` missing or failing, or no stable steady state.
        """
        if reason := self.unsupported(blade):
            raise CodeError(f"{blade.name}: {reason}")

        def solved(bricks: Bricks, material: Orthotropic, wanted: int) -> Modes:
            return calculix.modes(bricks, material, omega, wanted, clamped(blade.hub_radius))

        return bar.modes(blade, omega, elements, count, solved)


CODE = Calculix()
