"""Half-turns: the logarithm has the angle π, and a loop that is open by one does not close."""

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.core.space import spatial as sp

pytestmark = pytest.mark.numerical


@pytest.mark.parametrize("short", [1e-3, 1e-7, 1e-9, 1e-12, 0.0])
def test_logarithm_near_half_a_turn(short: float) -> None:
    """Rodrigues' formula by hand about random axes; the exponential is its inverse."""
    rng = np.random.default_rng(3)
    for _ in range(50):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        angle = np.pi - short
        across = np.eye(3) - np.outer(axis, axis)
        turn = np.outer(axis, axis) + np.cos(angle) * across + np.sin(angle) * sp.skew(axis)
        pose = sp.pose(turn, rng.normal(size=3))
        logarithm = sp.log(pose)
        assert np.linalg.norm(logarithm[3:]) == pytest.approx(angle, abs=1e-14)
        assert abs(logarithm[3:] @ axis) == pytest.approx(angle, abs=1e-12)
        if short > 1e-9:  # the sense is lost where the skew part is rounding
            assert logarithm[3:] @ axis > 0
        np.testing.assert_allclose(sp.exp(logarithm), pose, atol=1e-11)


@pytest.mark.parametrize("axis", np.eye(3), ids="xyz")
def test_logarithm_of_half_a_turn_about_a_coordinate_axis(axis: np.ndarray) -> None:
    result = sp.log(sp.pose(2.0 * np.outer(axis, axis) - np.eye(3), np.zeros(3))[None])[0]
    np.testing.assert_allclose(np.abs(result), [0, 0, 0, *(np.pi * axis)], atol=1e-15)


def bar(name: str, length: float, mass: float) -> mb.Body:
    across = mass * length**2 / 12
    return mb.Body(name, mb.inertia(mass, (0.0, across, across), (length / 2, 0, 0)))


def parallelogram(axis: str) -> mb.Mechanism:
    """Cranks 1, coupler 2; the rocker's pin at the coupler points along ``axis``."""
    return mb.Mechanism(
        (bar("crank", 1.0, 1.0), bar("coupler", 2.0, 2.0), bar("rocker", 1.0, 1.0)),
        (
            mb.Joint("A", "revolute", "ground", "crank"),
            mb.Joint("B", "revolute", "crank", "coupler", mb.at(1.0)),
            mb.Joint("C", "revolute", "coupler", "rocker", mb.at(2.0), mb.at(1.0, axis=axis), cut=True),
            mb.Joint("D", "revolute", "ground", "rocker", mb.at(2.0)),
        ),
        coordinate_springs=(mb.CoordinateSpring("A.rz", 60.0, 0.0, 1.2),),
    )


def test_a_loop_open_by_half_a_turn_does_not_close() -> None:
    """With the pin upside down the rocker would have to be turned over; the right way round ω² = k/(2 m/3 + M)."""
    guess = {"A.rz": 1.2, "B.rz": -1.2, "D.rz": 1.2}
    assert mb.solve(parallelogram("z"), guess).frequencies[0] == pytest.approx(
        np.sqrt(60.0 / (2.0 / 3 + 2.0)), rel=1e-9
    )
    with pytest.raises(mb.MechanismError, match=r"joint 'C': its loop does not close"):
        mb.solve(parallelogram("-z"), guess)


@pytest.mark.parametrize("angle", [0.5, 3.0, np.pi])
def test_a_slide_locked_to_a_turned_guide_does_not_close(angle: float) -> None:
    turned = sp.pose(sp.rotation(2, np.array(angle)), np.zeros(3))
    m = mb.Mechanism(
        (mb.Body("a", mb.inertia(1.0, 1.0)),),
        (mb.Joint("p", "prismatic", "ground", "a"), mb.Joint("lock", "prismatic", "ground", "a", turned, cut=True)),
        coordinate_springs=(mb.CoordinateSpring("p.z", 4.0),),
    )
    with pytest.raises(mb.MechanismError, match=r"joint 'lock': its loop does not close"):
        mb.solve(m)
