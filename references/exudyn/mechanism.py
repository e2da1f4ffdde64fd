"""A mechanism in Exudyn: a kinematic tree in relative coordinates, each loop closed by a generic joint.

Core's spanning tree is used: which joints form it, their frames, and the bodies' places. Exudyn computes motion, inertia
forces and springs, the equations of the loops, and their derivatives. A loop is closed by the joint itself (its locked
axes as algebraic equations), not by core's weld beyond a copy of the body. Exudyn's static solver omits the curvature of
the constraints, ∂(Jλ)/∂q, from its Jacobian and stops at 1e-8; the curvature is added by differences of Exudyn's constraint
Jacobian, and steady state, reduction and eigensolver are those of ``matrices``, as for ``pinocchio-loops``.
"""

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...core.effects import ALL_EFFECTS
from ...core.mechanism.description import Mechanism
from ...core.tree.spanning import compile_tree
from ..matrices import null_space
from ..matrices.rescaling import in_own_length
from ..protocol.interface import CORE, Independence, MechanismAdapter, MechanismModes
from . import system as ex
from .closure import System, own_coordinates, system, velocity

Array = NDArray[np.float64]


class ExudynModel:
    """A mechanism in Exudyn (see ``matrices.null_space.Model``)."""

    rounding = 1e-6
    """Exudyn's matrices are differences of its forces."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism = mechanism
        self.tree = compile_tree(mechanism)
        self.names = self.tree.coordinates[: own_coordinates(self.tree)]
        self.rates = velocity(self.tree)
        self._system = system(self.tree)

    def at(self, q: Array) -> "ExudynTangent":
        """The tree at coordinates ``q`` (n,)."""
        return ExudynTangent(self._system, q)


class ExudynTangent:
    """The tree at one configuration (see ``matrices.null_space.Tangent``); matrices are computed when they are used."""

    def __init__(self, equations: System, q: Array) -> None:
        self._system, self._q = equations, q
        unbalanced, self.gap, J = equations.balance(q)
        self.force, self.J = -unbalanced, J.T

    @cached_property
    def _matrices(self) -> tuple[Array, Array, Array]:
        return self._system.matrices(self._q)

    @property
    def M(self) -> Array:
        """(n, n) mass matrix."""
        return self._matrices[0]

    @property
    def C(self) -> Array:
        """(n, n) damping and gyroscopic matrix."""
        return self._matrices[1]

    @property
    def K(self) -> Array:
        """(n, n) stiffness, without the curvature of the constraints."""
        return self._matrices[2]

    def curvature(self, multipliers: Array) -> Array:
        """(n, n) stiffness of the curvature of the constraints under their reactions."""
        return self._system.curvature(self._q, multipliers)

    def misclosed(self) -> str:
        """Exudyn's joints do not close with opposed axes."""
        return ""


class ExudynMechanism(MechanismAdapter):
    """See the module: rigid bodies, any joints, springs on the tree's coordinates and between points, steady rotation."""

    name = "exudyn-loops"
    title = "Exudyn, kinematic tree with loop joints"
    effects = ALL_EFFECTS
    hint = ex.HINT
    distribution = ex.DISTRIBUTION
    independence = Independence(
        engine="Exudyn",
        theory="tree of rigid bodies, loops by generic joints",
        rotation="Exudyn, differences of its forces",
        sections=CORE,
        eigensolver="the adapters' own, with damping",
    )

    def unsupported_mechanism(self, mechanism: Mechanism) -> str | None:
        """A reason if there are beams, accelerations, or springs or motions on a cut joint."""
        if mechanism.beams:
            return "beams or bushings: Exudyn's elastic elements use other strain measures"
        if any(m.acceleration for m in mechanism.motions):
            return "an accelerating motion: Exudyn's static solver supports rates only"
        tree = compile_tree(mechanism)
        own = own_coordinates(tree)
        for item in (*mechanism.motions, *mechanism.coordinate_springs):
            if tree.coordinate(item.coordinate) >= own:
                return f"{item.coordinate}: a spring or motion on a joint that closes a loop: cut another joint"
        return None

    def mechanism_modes(self, mechanism: Mechanism, guess: Mapping[str, float]) -> MechanismModes:
        """All modes; see ``interface.MechanismAdapter`` and ``null_space.modes``, which says what is an error."""
        return in_own_length(mechanism, guess, lambda m, start: null_space.modes(ExudynModel(m), start))


CODE = ExudynMechanism()
