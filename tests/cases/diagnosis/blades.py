"""Five blades on which causes are seeded, with three speeds each, rad/s."""

from dataclasses import replace
from functools import cache

import numpy as np

from southwell.cases.diagnosis.spectra import Problem
from southwell.cases.input import library
from southwell.core.blade import BEND_Y, TORSION, Blade

MODES = (1, 2, 3, 4, 5, 6)


def _blade(case: str, number: int = 0) -> Blade:
    return library.load(case).variants[number].blade


def _coupled() -> Blade:
    """Twisted, coned and pitched, with bend–twist coupling and a tip mass."""
    blade = _blade("pretwisted-beam")
    stiffness = blade.stiffness.copy()
    size = 0.3 * np.sqrt(stiffness[:, TORSION, TORSION] * stiffness[:, BEND_Y, BEND_Y])
    stiffness[:, TORSION, BEND_Y] = stiffness[:, BEND_Y, TORSION] = size
    tip = 0.1 * blade.mass[0, 0, 0] * blade.length * np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    return replace(blade, stiffness=stiffness, tip_mass=tip, precone=0.08, pitch=0.2, hub_radius=0.15 * blade.length)


@cache
def problem(name: str) -> Problem:
    """The problem of one of the five blades; kept, so that its solutions are made once."""
    return {
        "NREL 5 MW": lambda: Problem(replace(_blade("nrel-5mw"), precone=0.04), (0.0, 1.27, 2.5), MODES),
        "WindPACT": lambda: Problem(_blade("windpact-1.5"), (0.0, 2.1, 4.0), MODES),
        "coupled": lambda: Problem(_coupled(), (0.0, 4.0, 9.0), MODES),
        "prebent": lambda: Problem(_blade("prebent-beam"), (0.0, 3.0, 5.0), MODES),
        "sprung": lambda: Problem(_blade("articulated", -1), (5.0, 10.0, 20.0), MODES),
    }[name]()
