"""Effect of lumped mass: a test of the paper's explanation of its differences.

Park et al. (2010), below Table 1, attribute their differences of 0.1 % from Yoo and Shin to a lumped instead of a
consistent mass. Their discretisation differs from a convergent one of fourth order in two ways: the mass is lumped at
the nodes, and the beam's stiffness is linear in the frame of one end (the parent body's). Here each is switched on
alone.
"""

from itertools import product
from typing import get_args

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.element.discretize import Mass
from ...core.element.measures import Measure
from ...core.participation import families, participation
from ...core.solve import mesh_modes
from ..judge.pairing import MOTIONS, aligned, weights
from ..judge.results import Level

CASE, OMEGA = "park-cantilever", 10.0
"""Speed of the paper's first example, rad/s (Table 1)."""

MASSES, STIFFNESSES = get_args(Mass), get_args(Measure)

ELEMENTS = (10, 20, 50, 100, 200)
"""Numbers of elements; the paper uses 50."""

COUNT = 3
"""Number of edgewise modes, as in Table 1."""

POINT_MASSES = Effects(rotary_inertia=False)
"""The paper's sections have mass but no moments of inertia."""


def variant(mass: Mass, stiffness: Measure) -> str:
    """Name of the rows of one combination."""
    return f"core, {mass} mass, {stiffness} stiffness"


def lumping(blade: Blade) -> tuple[Level, ...]:
    """The blade's lowest edgewise frequencies at ``OMEGA`` for every combination of mass and stiffness, refined.

    The finest answer with consistent mass and corotational stiffness is the exact value to compare with.
    """
    weight = weights(blade)
    rows = []
    for mass, stiffness, n in product(MASSES, STIFFNESSES, ELEMENTS):
        found = aligned(
            mesh_modes(blade, OMEGA, n, 3 * COUNT, mass=mass, stiffness=stiffness, effects=POINT_MASSES), weight
        )
        named = zip(families(participation(found, blade)), found.frequencies.tolist(), strict=True)
        edgewise = [f for family, f in named if family == MOTIONS[1]][:COUNT]
        rows += [Level(CASE, OMEGA, k, variant(mass, stiffness), n, f) for k, f in enumerate(edgewise, 1)]
    return tuple(rows)
