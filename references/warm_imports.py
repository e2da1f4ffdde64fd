"""Modules that the fork server imports once: libraries and compiled functions that most adapters need.

No code is imported here. A worker process does not load these modules again.
"""

from ..core.blade import uniform_blade
from .matrices import quadratic  # noqa: F401
from .protocol import worker  # noqa: F401
from .theories import reference_line, spectral

_BLADE = uniform_blade("", 1.0, 0.0, EA=1.0, GJ=1.0, EI_y=1.0, EI_z=1.0, mass=1.0)
reference_line.line(_BLADE, spectral.gauss(_BLADE.stations, 2)[0][:, None])
