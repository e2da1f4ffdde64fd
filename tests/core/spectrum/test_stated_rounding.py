"""The uncertainty of a blade's frequencies contains their rounding, with a given mesh and with a refined one."""

import numpy as np
import pytest

from southwell.core.blade import uniform_blade
from southwell.core.solve import modes
from southwell.core.spectrum import refinement
from southwell.core.spectrum.refinement import AccuracyWarning

BLADE = uniform_blade("beam", 6.0, 0.6, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=1.2)


@pytest.mark.parametrize("elements", [32, None])
@pytest.mark.filterwarnings(f"ignore::{AccuracyWarning.__module__}.{AccuracyWarning.__name__}")
def test_rounding_is_part_of_the_uncertainty(elements: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
    certain = modes(BLADE, 10.0, elements, 4)
    assert (certain.uncertainty < 1e-4).all()
    monkeypatch.setattr(refinement, "rounding", lambda *_: np.full(4, 1e-3))
    rough = modes(BLADE, 10.0, elements, 4)
    assert rough.rounding.tolist() == [1e-3] * 4
    assert (rough.uncertainty >= 1e-3).all()
