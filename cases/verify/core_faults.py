"""Core with one well-known fault at a time, which any verification must detect.

Each fault is introduced from outside: in the blade, the effects, the chain, or the linearised pencil; core contains no
code for them. The faults in the pencil remove or reverse spin softening; see ``diagnosis.scaled_terms``.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...core import solve
from ...core.blade import Blade, without_rotary_inertia
from ...core.effects import Effects
from ...core.element.discretize import Mass, discretize
from ...core.element.measures import Measure
from ...core.element.mesh import Mesh
from ...core.modes import Modes
from ...core.spectrum import mesh_solver as solution
from ...core.spectrum.lanczos import lanczos
from ...core.tree import pencil
from ...core.tree.mode_shapes import mode_shapes
from ...core.tree.pencil import Shape, TreePencil
from ..diagnosis import blade_errors
from ..diagnosis.scaled_terms import softened

STILL = np.zeros(3)
"""No gravity."""

Solve = Callable[[Blade, float, int, int, Effects], Modes]
"""``(blade, omega, elements, count, effects)`` → modes; ``omega`` in rad/s."""


@dataclass(frozen=True)
class CoreFault:
    """One fault.

    Attributes:
        name: short name, for a table.
        what: one sentence on what a program with this fault does.
        wrong: computes the modes with the fault.
        right: computes the modes without the fault, with the same discretisation.
        seen_in: blades of the package's cases in which it must be detected.
        at_rest: whether it changes a blade at rest.
    """

    name: str
    what: str
    wrong: Solve
    right: Solve
    seen_in: tuple[str, ...]
    at_rest: bool = False


def right(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """Core without a fault."""
    return solve.mesh_modes(blade, omega, elements, count, effects=effects)


def no_geometric_stiffness(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """The steady internal forces do not contribute to the stiffness."""
    return right(blade, omega, elements, count, replace(effects, geometric=False))


def no_coriolis(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """No gyroscopic terms."""
    return right(blade, omega, elements, count, replace(effects, coriolis=False))


def no_hub(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """The root lies on the rotor's axis."""
    return right(replace(blade, hub_radius=0.0), omega, elements, count, effects)


def shifted_axis(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """The reference axis is shifted; see ``blade_errors.shifted_axis``."""
    return right(blade_errors.shifted_axis(blade), omega, elements, count, effects)


def softening_reversed(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """Spin softening has the wrong sign and stiffens."""
    return _altered(blade, omega, elements, count, effects, softening=-1.0)


def frozen_frame(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """Linearised in absolute coordinates of a fixed frame: neither spin softening nor Coriolis terms."""
    return _altered(blade, omega, elements, count, replace(effects, coriolis=False), softening=0.0)


def _altered(blade: Blade, omega: float, elements: int, count: int, effects: Effects, softening: float) -> Modes:
    """Core with its spin softening multiplied by ``softening``."""
    body = discretize(blade if effects.rotary_inertia else without_rotary_inertia(blade), elements)
    state = solution.balance(body, omega, STILL, effects)
    return _modes(body, softened(body, state, omega, softening), state.shape, omega, count)


def _modes(body: Mesh, p: TreePencil, shape: Shape, omega: float, count: int) -> Modes:
    found = lanczos(p, count)
    return Modes(omega, found.frequencies, mode_shapes(body, shape, pencil.on_nodes(p, found.vectors)), body.elements)


LUMPED: tuple[Mass, Measure] = ("half_end", "body_fixed")
"""The paper's discretisation; the last fault has the wrong mass at its end node. Refined from its 50 elements."""


def lumped(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """Core with point masses, half of each element's mass at either end."""
    mass, stiffness = LUMPED
    return solve.mesh_modes(blade, omega, elements, count, mass=mass, stiffness=stiffness, effects=effects)


def whole_end_mass(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """Every node has the mass of one element, including the tip, which should have half of it."""
    body = discretize(blade if effects.rotary_inertia else without_rotary_inertia(blade), elements, *LUMPED)
    lumps = body.lumps.copy()
    lumps[-1] += lumps[-1] - blade.tip_mass
    return solve.chain_modes(replace(body, lumps=lumps), omega, count, effects=effects)


PLAIN = ("park-cantilever",)

CORE_FAULTS = (
    CoreFault(
        "no geometric stiffness", "the centrifugal tension does not stiffen", no_geometric_stiffness, right, PLAIN
    ),
    CoreFault("softening's sign", "spin softening is added instead of subtracted", softening_reversed, right, PLAIN),
    CoreFault(
        "frozen frame",
        "linearised in a frame that does not rotate: edgewise is read as flapwise",
        frozen_frame,
        right,
        PLAIN,
    ),
    CoreFault(
        "axis shifted",
        f"reference axis shifted by {blade_errors.OFFSET:g} radii of gyration, without the coupling terms",
        shifted_axis,
        right,
        PLAIN,
        at_rest=True,
    ),
    CoreFault("no Coriolis", "no Coriolis force", no_coriolis, right, ("yoo-shin-chordwise/delta-0",)),
    CoreFault(
        "whole end mass",
        "the lumped mass at the tip is that of a whole element instead of a half",
        whole_end_mass,
        lumped,
        PLAIN,
        True,
    ),
    CoreFault("no hub radius", "the root is on the rotor axis", no_hub, right, PLAIN),
)
"""All faults."""
