"""Finite element matrices to complex stiffness elements and rigid bodies (Park et al. 2010, figs 1 and 2).

A finite element model comes in, as matrices (``read``, ``stored``) and the nodes of its sections; segments with 6×6 stiffness
and inertia go out (``segments_in_place``), and ``mesh_from_segments`` joins them to a chain with modes.
"""

from .compressed import chain_modes, mesh_from_segments
from .condensation import Condensed, condense, segment, segments_in_place
from .exported import Exported, MatrixFileError
from .matrix_files import read, stored
from .segments import Segment, segment_from_matrix
from .ties import CondensationError, FiniteElements, Tie

__all__ = [
    "CondensationError",
    "Condensed",
    "Exported",
    "FiniteElements",
    "MatrixFileError",
    "Segment",
    "Tie",
    "chain_modes",
    "condense",
    "mesh_from_segments",
    "read",
    "segment",
    "segment_from_matrix",
    "segments_in_place",
    "stored",
]
