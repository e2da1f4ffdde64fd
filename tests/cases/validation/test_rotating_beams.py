"""The rotating beams are those of their source: their frequencies at rest are known in closed form."""

import numpy as np
import pytest

from southwell.cases.validation import rotating_beams
from southwell.cases.validation.rotating_beams import Factors, beam, solved

FIRST_ROOTS = (1.875104068711961, 4.694091132974175, 7.854757438237613)  # cos x cosh x = −1


@pytest.mark.parametrize("name", rotating_beams.BEAMS)
def test_at_rest_a_straight_strip_is_a_cantilever(name: str) -> None:
    """Euler and Bernoulli's, in inches and pounds; shear and rotary inertia take a few parts in 10⁴."""
    d = rotating_beams.data()[name]
    length = sum(d["lengths"])
    speed = d["thickness"] * np.sqrt(d["E"] / (12.0 * d["density"]))
    solution = solved(beam(name, 0.0, Factors()), 0.0)
    for k, x in enumerate(FIRST_ROOTS, 1):
        assert solution[f"flapwise {k}"][0] == pytest.approx((x / length) ** 2 * speed / (2 * np.pi), rel=1e-3)


def test_a_swept_tip_keeps_the_beams_length_and_mass() -> None:
    straight, swept = (beam("aluminium", angle, Factors()) for angle in (0.0, 45.0))
    np.testing.assert_array_equal(straight.stations, swept.stations)
    np.testing.assert_array_equal(straight.mass, swept.mass)
    tip = swept.curve[-1] - swept.curve[-2]
    np.testing.assert_allclose(tip / 0.0254, [6 / np.sqrt(2), -6 / np.sqrt(2), 0.0], rtol=1e-12)
    assert swept.kinks == (31.5 * 0.0254,)


def test_every_measured_frequency_has_its_place() -> None:
    for name in rotating_beams.BEAMS:
        d = rotating_beams.data()[name]
        assert np.array(d["frequencies"]).shape[1:] == (len(d["rpm"]), len(d["sweep"]))
        assert (np.diff(d["frequencies"], axis=0) > 0).all()


@pytest.mark.nightly
@pytest.mark.parametrize("name", rotating_beams.BEAMS)
def test_every_point_has_a_simulation_and_an_uncertainty(name: str) -> None:
    d = rotating_beams.data()[name]
    result = list(rotating_beams.points(name))
    assert len(result) == np.array(d["frequencies"]).size
    for point in result:
        v = point.validation
        assert v.numerical < 1e-3 * v.simulated
        assert v.inputs > 1e-3 * v.simulated
        assert v.data == d["measured"]
