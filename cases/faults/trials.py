"""Small cases, each with a code that detects faults in it."""

from dataclasses import replace

import numpy as np

from ...core.blade import BEND_Y, TORSION, Blade
from .seeding import Trial


def _coupled(blade: Blade) -> Blade:
    """Torsion is coupled with flapwise bending by half the value that would make the section singular."""
    stiffness = blade.stiffness.copy()
    size = 0.5 * np.sqrt(stiffness[:, TORSION, TORSION] * stiffness[:, BEND_Y, BEND_Y])
    stiffness[:, TORSION, BEND_Y] = stiffness[:, BEND_Y, TORSION] = size
    return replace(blade, stiffness=stiffness)


INERTIA = np.pad(np.full((3, 3), 25.0), (3, 0)) + np.pad(np.ones((3, 3)), (0, 3))
"""Sections with the moments of inertia of sections five times as thick."""

PARK = Trial("park-cantilever", (10.0,), ("exact-beam",))
THICK = Trial("park-cantilever", (10.0,), ("exact-beam",), lambda b: replace(b, mass=b.mass * INERTIA))
FAST = Trial("yoo-shin-chordwise/delta-0", (10.0,), ("exact-beam",))
AXIAL = Trial("yoo-shin-chordwise/delta-0", (50.0,), ("exact-beam",))
TWISTED = Trial("pretwisted-beam", (8.0,), ("assumed-modes",))
CROSSED = replace(
    TWISTED, codes=("scikit-fem",), modes=2, change=lambda b: replace(b, twist=b.twist - 0.5 * b.twist[-1])
)
TAPERED = Trial("tapered-beam", (8.0,), ("exact-beam",))
TIP = Trial("tip-mass", (12.0,), ("exact-beam",))
PITCHED = Trial("pretwisted-beam", (8.0,), ("scikit-fem",), lambda b: replace(b, pitch=0.5))
TORSIONAL = Trial("articulated/flap", (10.0,), ("scikit-fem",), modes=1, motions=("torsion",))
HINGED = Trial("articulated/sprung", (10.0,), ("scikit-fem",))

BESIDE = np.zeros((6, 6))
BESIDE[:3, :3] = 0.2 * np.eye(3)
BESIDE[0, 5] = BESIDE[5, 0] = -0.2 * 0.1
BESIDE[2, 3] = BESIDE[3, 2] = 0.2 * 0.1
BESIDE[3, 3] = BESIDE[5, 5] = 0.2 * 0.1**2

CONED = Trial("pretwisted-beam", (4.0,), ("exudyn-tree",), lambda b: replace(b, precone=0.1, tip_mass=BESIDE), modes=2)
"""With a point mass at the tip: a fifth of the beam's mass, offset from the axis by a tenth of its length. Without
precone or without offset, reversing the sign of the other gives a mirror image with the same frequencies."""


COUPLED = replace(CONED, change=lambda b: _coupled(replace(b, precone=0.1, tip_mass=BESIDE)))
"""The same blade, so that the sign of the coupling also matters."""
