"""Southwell: are these natural frequencies of a rotating blade right?"""

from .core import multibody
from .core.blade import Blade, BladeError, section_mass, section_stiffness, uniform_blade
from .core.effects import Effects
from .core.modes import Modes
from .core.solve import modes

__all__ = [
    "Blade",
    "BladeError",
    "Effects",
    "Modes",
    "modes",
    "multibody",
    "section_mass",
    "section_stiffness",
    "uniform_blade",
]
