"""Facts of a blade in a report: what distinguishes it from a straight, clamped blade in the plane of rotation."""

import numpy as np
import pytest

from southwell.cases.input import library
from southwell.cases.plan.settings import settings

EVERYWHERE = {"length", "hub radius", "mass", "stations", "speeds", "modes compared", "target"}


@pytest.mark.parametrize(
    ("case", "more"),
    [
        ("park-cantilever", {"source's discretisation"}),
        ("prebent-beam", {"twist", "precone", "pitch", "prebend"}),
        ("articulated", {"root"}),
    ],
)
def test_facts_are_those_that_the_blade_has(case: str, more: set[str]) -> None:
    assert set(settings(library.load(case))[0].facts) == EVERYWHERE | more


def test_a_dimensionless_blade_states_its_tip_mass_too() -> None:
    facts = settings(library.load("tip-mass"))[0].facts
    assert facts["tip mass"] == "1 times the blade's mass"
    assert set(facts) == {"slenderness", "hub ratio", "tip mass", "speeds", "modes compared", "target"}


def test_the_facts_of_a_coned_and_prebent_blade() -> None:
    """An arc of 25 m radius and 10 m length ends 25 (1 − cos 0.4) m upwind."""
    facts = settings(library.load("prebent-beam"))[0].facts
    assert facts["precone"] == "-4° (positive downwind)"
    assert facts["pitch"] == "5° (positive with the leading edge downwind)"
    assert facts["prebend"] == f"{-25 * (1 - np.cos(0.4)):.4g} m (positive downwind)"
