"""Core's reference: the modes that a case compares, and their names."""

import numpy as np
import pytest

from southwell.cases.input.schema import Compare
from southwell.cases.verify.core_solver import Converged, converged
from southwell.core.blade import Blade, section_mass, section_stiffness
from southwell.core.effects import ALL_EFFECTS


@pytest.mark.parametrize("motion", ["flapwise", "edgewise"])
def test_modes_keep_their_names_whatever_is_compared(motion: str) -> None:
    """A beam twisted by a quarter turn: one of its mixed modes is mostly flapwise, the other mostly edgewise."""
    stations = np.array([0.0, 2.0])
    stiffness = np.repeat(section_stiffness(1e7, 1e3, 1e4, 2e4), 2, axis=0)
    mass = np.repeat(section_mass(1.2, 1e-3, 1e-3), 2, axis=0)
    blade = Blade("twisted", stations, stiffness, mass, stations * np.pi / 4)
    found = converged(blade, 10.0, Compare(modes=3, motions=(motion,)), ALL_EFFECTS)  # type: ignore[arg-type]
    assert isinstance(found, Converged)
    mixed = {"flapwise": "mixed 1", "edgewise": "mixed 2"}[motion]
    assert found.names == (f"{motion} 1", f"{motion} 2", mixed)
    assert [found.every[k] for k in found.wanted.indices] == list(found.names)
    assert {"mixed 1", "mixed 2"} < set(found.every)
