"""The fast solver for a blade: a chain of elements.

A ``Chain`` and a rotor speed come in. ``steady.steady`` finds the steady state, ``pencil.linearize`` the matrices about it and
``lanczos.lanczos`` the lowest modes, whose shapes ``mode_shapes.mode_shapes`` samples. ``as_mechanism`` converts a chain for
``multibody``.
"""

from .completeness import MissedModesError
from .lanczos import EigensolverError
from .pencil import ChainPencil, Shape, linearize
from .steady import LargeStrainError, Steady, SteadyStateError, extrapolate

__all__ = [
    "ChainPencil",
    "EigensolverError",
    "LargeStrainError",
    "MissedModesError",
    "Shape",
    "Steady",
    "SteadyStateError",
    "extrapolate",
    "linearize",
]
