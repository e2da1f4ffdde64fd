"""Models of a wrong program against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.diagnosis import model
from southwell.cases.diagnosis.model import Model
from southwell.core.blade import BEND_Y, uniform_blade


@pytest.mark.parametrize("following", [0.5, 2.0])
def test_a_centrifugal_force_that_follows_the_blade_lowers_its_flapping(following: float) -> None:
    """A rigid blade hinged on the axis with a spring k has ω² = k/I + (1 − c) Ω², where the part c of the force follows it."""
    root = np.full(6, np.inf)
    root[BEND_Y] = 500.0
    blade = replace(uniform_blade("flap", 6.0, 0.0, EA=1e9, GJ=1e7, EI_y=1e9, EI_z=1e9, mass=1.2), root=root)
    inertia, omega = 1.2 * 6.0**3 / 3.0, 1.5
    (modes,) = model.solve(Model(blade, following=following), [omega], 2)
    assert modes is not None
    expected = 500.0 / inertia + (1.0 - following) * omega**2
    assert modes.frequencies[0] ** 2 == pytest.approx(expected, rel=2e-3)
