"""Is it the lumped mass? The paper's explanation of its differences, taken apart with core's own switches.

Park et al. (2010), below Table 1, put their differences of 0.1 % from Yoo and Shin down to a lumped against a consistent
mass. Their discretisation departs from a convergent one of fourth order in two ways, not one: the mass is lumped at the
nodes, and the beam's stiffness is linear in the frame of one end (the parent body's). Each is switched on alone here.
"""

from itertools import product
from typing import get_args

from ...core.blade import Blade
from ...core.effects import Effects
from ...core.element.discretize import Mass
from ...core.element.measures import Measure
from ...core.solve import mesh_modes
from ..judge.pairing import MOTIONS, aligned, families, weights
from ..judge.results import Level

CASE, OMEGA = "park-cantilever", 10.0
"""The paper's first example: Table 1 is at 10 rad/s."""

MASSES, STIFFNESSES = get_args(Mass), get_args(Measure)

ELEMENTS = (10, 20, 50, 100, 200)
"""The paper has 50."""

COUNT = 3
"""Chordwise modes, as many as Table 1 prints."""

POINT_MASSES = Effects(rotary_inertia=False)
"""The paper's sections have mass, but no moments of inertia."""


def variant(mass: Mass, stiffness: Measure) -> str:
    """What the rows of one combination are called."""
    return f"core, {mass} mass, {stiffness} stiffness"


def lumping(blade: Blade) -> tuple[Level, ...]:
    """The blade's lowest chordwise frequencies at ``OMEGA`` by every combination of mass and stiffness, refined.

    The combination of consistent mass and corotational stiffness, at its finest, is the exact answer to compare with.
    """
    weight = weights(blade)
    rows = []
    for mass, stiffness, n in product(MASSES, STIFFNESSES, ELEMENTS):
        found = aligned(
            mesh_modes(blade, OMEGA, n, 3 * COUNT, mass=mass, stiffness=stiffness, effects=POINT_MASSES), weight
        )
        named = zip(families(found, weight), found.frequencies.tolist(), strict=True)
        chordwise = [f for family, f in named if family == MOTIONS[1]][:COUNT]
        rows += [Level(CASE, OMEGA, k, variant(mass, stiffness), n, f) for k, f in enumerate(chordwise, 1)]
    return tuple(rows)
