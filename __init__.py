"""Southwell verifies the natural frequencies of rotating blades. For example::

    import southwell

    blade = southwell.read("deck.dat")
    southwell.modes(blade, rpm=12.1).to_frame()
    southwell.campbell(blade, rpm="0:12.1:1.1").plot()
    southwell.verify(blade, rpm="0,12.1").to_frame()

``import southwell`` loads no numerical library: a name is imported when it is first used. SI units and radians throughout.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .cases.diagnosis.diagnose import diagnose
    from .core import multibody
    from .core.blade import Blade, BladeError, section_mass, section_stiffness, uniform_blade
    from .core.effects import Effects
    from .core.modes import Modes
    from .reports.notebook import campbell, modes, read, root_loads, verify

    __version__: str

_WHERE = {
    "multibody": "core",
    "Blade": "core.blade",
    "BladeError": "core.blade",
    "section_mass": "core.blade",
    "section_stiffness": "core.blade",
    "uniform_blade": "core.blade",
    "Effects": "core.effects",
    "Modes": "core.modes",
    "campbell": "reports.notebook",
    "diagnose": "cases.diagnosis.diagnose",
    "modes": "reports.notebook",
    "read": "reports.notebook",
    "root_loads": "reports.notebook",
    "verify": "reports.notebook",
}

__all__ = [
    "Blade",
    "BladeError",
    "Effects",
    "Modes",
    "__version__",
    "campbell",
    "diagnose",
    "modes",
    "multibody",
    "read",
    "root_loads",
    "section_mass",
    "section_stiffness",
    "uniform_blade",
    "verify",
]


def __getattr__(name: str) -> Any:
    """A public name, imported now."""
    if name == "__version__":
        from importlib.metadata import version

        return version("southwell")
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f".{_WHERE[name]}", __name__)
    found = import_module(f".{_WHERE[name]}.{name}", __name__) if name == "multibody" else getattr(module, name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
