"""Mechanisms with closed loops in Pinocchio, reduced to the null space of the loops' equations.

Shared with core is only the description: bodies, joints with their coordinates, springs, loads. The spanning tree is
built here (``spanning``) and may cut other joints. Pinocchio computes inertia forces and their derivatives. Loops are
closed by Haug's products of directions (``closure``), not by core's weld beyond a copy of the body; the curvature of the
constraints under their reactions is analytical. Steady state, reduction and eigensolver are those of ``matrices``, as for
``exudyn-loops``.
"""

from collections.abc import Mapping

from ...core.effects import ALL_EFFECTS
from ...core.mechanism.description import Mechanism
from ..matrices import null_space
from ..matrices.rescaling import in_own_length
from ..protocol.interface import Independence, MechanismAdapter, MechanismModes, extra
from .pinocchio_tree import PinocchioTree
from .spanning import spanning


class PinocchioMechanism(MechanismAdapter):
    """See the module: rigid bodies, any joints, springs, dampers, loads and gravity, in steady rotation."""

    name = "pinocchio-loops"
    title = "Pinocchio, loops by null space"
    effects = ALL_EFFECTS
    hint = extra("codes")
    distribution = "pin"
    independence = Independence(
        engine="Pinocchio",
        theory="tree of rigid bodies, loops by products of directions",
        rotation="Pinocchio, derivatives of recursive Newton-Euler",
        sections="the adapter's spanning tree",
        eigensolver="the adapters' own, with damping",
    )

    def unsupported_mechanism(self, mechanism: Mechanism) -> str | None:
        """A reason if there are beams, accelerations, or springs or motions on a joint that must close a loop."""
        if mechanism.beams:
            return "beams or bushings: this adapter supports rigid bodies only"
        if any(m.law or m.acceleration for m in mechanism.motions):
            return "an accelerating motion: no steady state"
        if odd := next((j for j in mechanism.joints if j.kind == "elastic"), None):
            return f"joint {odd.name!r}: elastic: this adapter supports rigid bodies only"
        try:
            names = spanning(mechanism).names
        except ValueError as error:
            return str(error)
        for item in (*mechanism.motions, *mechanism.coordinate_springs):
            if item.coordinate not in names:
                return f"{item.coordinate}: every joint of its loop has a spring or a motion: leave one without"
        return None

    def mechanism_modes(self, mechanism: Mechanism, guess: Mapping[str, float]) -> MechanismModes:
        """All modes; see ``interface.MechanismAdapter`` and ``null_space.modes``, which says what is an error."""
        return in_own_length(mechanism, guess, lambda m, start: null_space.modes(PinocchioTree(m), start))


CODE = PinocchioMechanism()
