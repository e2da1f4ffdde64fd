"""The warning about interpolation between stations, on the tapering square bar of AFNOR's guide SDLL09."""

import numpy as np
import pytest

from southwell.cases.campbell.interpolation import (
    STEP,
    interpolation_error,
    warnings,
    without_every_second,
)
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.solve import mesh_modes


def pyramid(stations: int) -> Blade:
    """A bar of 1 m that tapers from 40 to 10 mm (AFNOR/VPCS, Guide de validation, 1990, SDLL09), without rotary inertia."""
    x = np.linspace(0.0, 1.0, stations)
    d = 0.04 - 0.03 * x
    EI, EA = 2e11 * d**4 / 12, 2e11 * d**2
    return Blade("pyramid", x, section_stiffness(EA, EI, EI, EI), section_mass(7800 * d**2), np.zeros(stations))


EXACT = np.repeat([54.18, 171.94, 384.40, 697.24, 1112.28], 2)
"""Frequencies in Hz in AFNOR's guide, pp. 200-201 (Euler and Bernoulli)."""


@pytest.mark.parametrize("stations", [17, 33, 65])
def test_the_estimate_is_the_error_against_many_stations(stations: int) -> None:
    """Within its factor of safety and 15 %; with many stations the guide's values are met within 0.04 %."""
    fine, computed = (mesh_modes(pyramid(n), 0.0, 200, 10).frequencies for n in (2001, stations))
    np.testing.assert_allclose(fine / (2 * np.pi), EXACT, rtol=4e-4)
    error = interpolation_error(pyramid(stations), 10)
    assert error is not None
    assert 0.85 * 1.25 < error.size / (computed / fine - 1.0).max() < 1.15 * 1.25


def test_33_stations_of_a_pyramid_are_warned_of_and_257_are_not() -> None:
    (line,) = warnings(pyramid(33), 10)
    assert line.startswith("interpolation between the 33 stations can change ")
    assert "by 0.12 %" in line
    assert warnings(pyramid(257), 10) == []


def test_steps_are_kept_and_few_stations_are_not_judged() -> None:
    s = np.array([0.0, 0.5 - 0.1 * STEP, 0.5, 0.7, 1.0])
    EI = np.array([4.0, 4.0, 2.0, 1.0, 1.0])
    stepped = Blade("step", s, section_stiffness(np.inf, np.inf, EI, EI), section_mass(np.ones(5)), np.zeros(5))
    result = without_every_second(stepped).stiffness[:, 4, 4]
    np.testing.assert_allclose(result, [4.0, 4.0, 2.0, 2.0 - 0.2 / 0.5, 1.0])
    beam = uniform_blade("beam", 2.0, 0.0, EA=1e6, GJ=1e3, EI_y=48.0, EI_z=48.0, mass=3.0)
    assert warnings(beam, 4) == []
