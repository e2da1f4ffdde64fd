"""The paper's equations at the paper's size. To the four digits of its table they do not depend on the kernels of OpenBLAS."""

import numpy as np
import pytest

from southwell.cases.solve import paper
from southwell.core.blade import without_rotary_inertia
from southwell.tests.support.beams import PARK


@pytest.mark.slow
def test_the_papers_table() -> None:
    """Park et al. (2010), Table 1, column Present, to its last digit: 51 bodies, 50 elements."""
    result = paper.paper_modes(without_rotary_inertia(PARK), 10.0, 50, 6)
    tip = np.abs(result.shapes[:, -1])
    assert [f"{f:.4g}" for f in result.frequencies[tip[:, 1] > tip[:, 2]][:3]] == ["11.71", "70.37", "189.7"]
