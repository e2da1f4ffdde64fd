"""Core with one well-known fault at a time, which any verification must detect.

Each fault is introduced from outside: in the blade, the effects, the chain, or the linearised pencil; core contains no
code for them. The faults in the pencil remove or reverse ``softening``: the change of the centrifugal force with the
displacement of a point from its steady position (for a point mass m the matrix ``−Ω² m`` in the two directions of the
plane of rotation, zero along the rotor's axis).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...core import solve
from ...core.blade import AXIAL, BEND_Z, SHEAR_Y, TORSION, Blade, stiffness_at, without_rotary_inertia
from ...core.effects import Effects
from ...core.element.discretize import Mass, discretize
from ...core.element.measures import Measure
from ...core.element.mesh import Mesh
from ...core.modes import Modes
from ...core.spectrum import mesh_solver as solution
from ...core.spectrum.lanczos import lanczos
from ...core.steady.blade_state import Steady
from ...core.tree import pencil
from ...core.tree.mode_shapes import mode_shapes
from ...core.tree.pencil import Shape, TreePencil

OFFSET = 0.25
"""Shift of the reference axis, as a fraction of the radius of gyration √(EI_z/EA) at midspan."""

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


def shifted(blade: Blade) -> Blade:
    """Sections about an axis shifted by ``OFFSET`` along y, with the parallel-axis terms but without the couplings.

    About an axis shifted by e, EI_z grows by EA e², GJ by GA_y e² and the moments of inertia by m e²; stretch couples
    with bending by EA e, and translation with rotation by m e. Omitting only the couplings makes the section too stiff.
    Rigid shear has no such term in torsion here.
    """
    middle = stiffness_at(blade, blade.length / 2)[0]
    square = OFFSET**2 * middle[BEND_Z, BEND_Z] / middle[AXIAL, AXIAL]
    stiffness, mass = blade.stiffness.copy(), blade.mass.copy()
    stiffness[:, BEND_Z, BEND_Z] += stiffness[:, AXIAL, AXIAL] * square
    if np.isfinite(stiffness[:, SHEAR_Y, SHEAR_Y]).all():
        stiffness[:, TORSION, TORSION] += stiffness[:, SHEAR_Y, SHEAR_Y] * square
    for turning in (TORSION, BEND_Z):
        mass[:, turning, turning] += mass[:, AXIAL, AXIAL] * square
    return replace(blade, stiffness=stiffness, mass=mass)


def shifted_axis(blade: Blade, omega: float, elements: int, count: int, effects: Effects) -> Modes:
    """The reference axis is shifted; see ``shifted``."""
    return right(shifted(blade), omega, elements, count, effects)


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


def softened(body: Mesh, state: Steady, omega: float, factor: float) -> TreePencil:
    """The pencil of a steady state, with its spin softening multiplied by ``factor``."""
    softening = spin_softening(body, state.shape, omega)
    return replace(state.pencil, K=state.pencil.K + (factor - 1.0) * softening)


def spin_softening(body: Mesh, shape: Shape, omega: float) -> np.ndarray:
    """The part of the elements' stiffness (n, d + 6, d + 6) due to the centrifugal force of the displaced mass.

    It is the stiffness at speed minus that at rest, about the same shape, of a model without geometric stiffness.
    """
    bare = Effects(geometric=False)
    turning, standing = (pencil.linearize(body, shape, speed, STILL, bare).K for speed in (omega, 0.0))
    return turning - standing


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
        f"reference axis shifted by {OFFSET:g} radii of gyration, without the coupling terms",
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
