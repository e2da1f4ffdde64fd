"""What most adapters need, for the process that forks those of the codes: libraries, and the compiled functions of a blade.

It imports no code. What is loaded here is not loaded in each of the processes.
"""

from ..core.blade import uniform_blade
from .protocol import mechanism_worker, quadratic, worker  # noqa: F401
from .theories import reference_line, spectral

_BLADE = uniform_blade("", 1.0, 0.0, EA=1.0, GJ=1.0, EI_y=1.0, EI_z=1.0, mass=1.0)
reference_line.line(_BLADE, spectral.gauss(_BLADE.stations, 2)[0][:, None])
