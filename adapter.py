"""What an author of a code imports: this module keeps its names between versions; others may move::

    from southwell.adapter import BladeAdapter, CodeError, Effects, Independence, Modes, STATIONS, sample

The rules that an adapter follows are those of ``BladeAdapter`` and ``MechanismAdapter``; `southwell conform NAME` checks them.
"""

from .core import multibody
from .core.blade import Blade, clamped, coupled, straight, uniform
from .core.effects import Effects
from .core.mechanism.description import Mechanism
from .core.modes import STATIONS, Modes
from .core.turbine.turbine import Turbine
from .references.protocol.fingerprint import Fingerprint
from .references.protocol.interface import (
    CORE,
    BladeAdapter,
    CodeError,
    Independence,
    MechanismAdapter,
    MechanismModes,
)
from .references.protocol.turbines import TurbineAdapter, TurbineModes
from .references.sampling import mass_at, sample, stiffness_at, twist_at

__all__ = [
    "CORE",
    "STATIONS",
    "Blade",
    "BladeAdapter",
    "CodeError",
    "Effects",
    "Fingerprint",
    "Independence",
    "Mechanism",
    "MechanismAdapter",
    "MechanismModes",
    "Modes",
    "Turbine",
    "TurbineAdapter",
    "TurbineModes",
    "clamped",
    "coupled",
    "mass_at",
    "multibody",
    "sample",
    "stiffness_at",
    "straight",
    "twist_at",
    "uniform",
]
