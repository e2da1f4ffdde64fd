"""The rounding of core: what it states itself counts if it is larger than what scaling shows."""

from dataclasses import replace

import numpy as np

from southwell.cases.judge.same import rounding
from southwell.cases.judge.spectrum import of_blade
from southwell.core.blade import uniform_blade
from southwell.core.solve import mesh_modes

BLADE = uniform_blade("beam", 6.0, 0.6, EA=1e7, GJ=1e3, EI_y=1e4, EI_z=1.4e4, mass=1.2)


def test_the_larger_of_stated_and_seen_rounding_counts() -> None:
    answer = of_blade(mesh_modes(BLADE, 10.0, 8, 4))
    second = [replace(answer, values=answer.values * (1.0 + 1e-9))]
    observed = rounding(answer, second)
    assert (observed > 1e-9).all()
    stated = np.array([1e-3, 0.0, 1e-15, 1e-5])
    assert rounding(replace(answer, rounding=stated), second).tolist() == np.maximum(observed, stated).tolist()
