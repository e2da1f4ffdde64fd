"""The sense of precone: a blade that leans upwind by as much as it is coned downwind is radial."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.core import solve
from southwell.core.blade import uniform_blade

RADIAL = uniform_blade("radial", 10.0, 0.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=4e6, mass=10.0, I_y=0.1, I_z=0.3)
DELTA, OMEGA = 0.3, 12.0


def leaning(angle: float):
    """The blade with its axis turned by ``angle`` from x to z, which points downwind. There is no hub."""
    return replace(RADIAL, curve=np.outer(RADIAL.stations, [np.cos(angle), 0.0, np.sin(angle)]))


def frequencies(blade):
    return solve.modes(blade, OMEGA, 20, 6).frequencies


def test_lean_and_precone_cancel() -> None:
    np.testing.assert_allclose(frequencies(replace(leaning(-DELTA), precone=DELTA)), frequencies(RADIAL), rtol=1e-9)


def test_lean_and_precone_add() -> None:
    twice = frequencies(replace(leaning(DELTA), precone=DELTA))
    np.testing.assert_allclose(twice, frequencies(replace(RADIAL, precone=2.0 * DELTA)), rtol=1e-9)
    assert twice[0] != pytest.approx(frequencies(RADIAL)[0], rel=1e-2)
