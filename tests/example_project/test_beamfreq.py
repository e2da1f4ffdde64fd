"""Run the verification matrix on this project's solver: a function that calls it with a blade, and a mark."""

import numpy as np
import pytest
from beamfreq import Beam, frequencies

from southwell.adapter import Blade, clamped, coupled, sample, straight


def solve(blade: Blade, omega: float, elements: int, count: int, **options):
    """Southwell's x runs along the blade, y lies in the plane of rotation, z out of it."""
    at = sample(blade, np.linspace(0, blade.length, 201))
    beam = Beam(blade.length, blade.hub_radius, at.mass, at.EI_z, at.EI_y)
    result, planes, deflections = frequencies(beam, omega, elements, count, **options)
    shapes = np.zeros((len(result), 21, 3))
    for shape, plane, deflection in zip(shapes, planes, deflections, strict=True):
        shape[:, 1 + plane] = deflection
    return result, shapes


def unsupported(blade: Blade) -> str | None:
    """Return why the solver cannot represent a blade, or None."""
    if coupled(blade) or not straight(blade) or not clamped(blade):
        return "these are straight, uncoupled, clamped beams"
    if blade.twist.any() or blade.precone or blade.pitch or blade.tip_mass.any():
        return "no twist, precone, pitch or tip mass"
    return None


SOLVER = {"lacks": ("prestretch", "coriolis", "rotary_inertia"), "unsupported": unsupported}


@pytest.mark.southwell(solve=solve, name="beamfreq", **SOLVER)
def test_beamfreq(southwell_cell):
    southwell_cell.check()
