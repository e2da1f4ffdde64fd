"""A solver that is wrong on purpose: without what the centrifugal force does to the stiffness. Its tests must fail."""

import pytest
from test_beamfreq import SOLVER, solve


def unstiffened(blade, omega, elements, count):
    """The same, with the mistake."""
    return solve(blade, omega, elements, count, stiffened=False)


@pytest.mark.southwell(solve=unstiffened, name="mistaken", cases=("park-cantilever", "wright-flapwise"), **SOLVER)
def test_mistaken(southwell_cell):
    southwell_cell.check()
