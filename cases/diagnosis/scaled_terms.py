"""Spin softening and geometric stiffness as parts of the linearised matrices that can be scaled.

Spin softening is the change of the centrifugal force with the displacement of a point from its steady position: for a point
mass m, the matrix ``−Ω² m`` in the two directions of the plane of rotation, and zero along the rotor's axis.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.effects import Effects
from ...core.element.mesh import Mesh
from ...core.steady.blade_state import Steady
from ...core.tree import pencil
from ...core.tree.pencil import Shape, TreePencil

Array = NDArray[np.float64]

_BARE = Effects(geometric=False)


def softened(body: Mesh, state: Steady, omega: float, factor: float) -> TreePencil:
    """The pencil of a steady state, with its spin softening multiplied by ``factor``."""
    softening = spin_softening(body, state.shape, omega)
    return replace(state.pencil, K=state.pencil.K + (factor - 1.0) * softening)


def spin_softening(body: Mesh, shape: Shape, omega: float) -> Array:
    """The part of the elements' stiffness (n, d + 6, d + 6) due to the centrifugal force of the displaced mass.

    It is the stiffness at speed minus that at rest, about the same shape, of a model without geometric stiffness.
    """
    turning, standing = (pencil.linearize(body, shape, speed, np.zeros(3), _BARE).K for speed in (omega, 0.0))
    return turning - standing


def stiffened(body: Mesh, p: TreePencil, shape: Shape, omega: float, factor: float) -> TreePencil:
    """A pencil with its geometric stiffness multiplied by ``factor``."""
    geometric, bare = (pencil.linearize(body, shape, omega, np.zeros(3), e).K for e in (Effects(), _BARE))
    return replace(p, K=p.K + (factor - 1.0) * (geometric - bare))
