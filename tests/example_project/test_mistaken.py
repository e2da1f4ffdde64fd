"""A solver that is wrong on purpose: it omits the stiffness due to the centrifugal force. Its tests must fail."""

import pytest
from test_beamfreq import SOLVER, solve


def unstiffened(blade, omega, elements, count):
    """Call the solver with the mistake."""
    return solve(blade, omega, elements, count, stiffened=False)


@pytest.mark.southwell(solve=unstiffened, name="mistaken", cases=("park-cantilever", "wright-flapwise"), **SOLVER)
def test_mistaken(southwell_cell):
    southwell_cell.check()
