"""Damping is found however large other entries are; rigid motions neither grow nor decay."""

import numpy as np
import pytest

from southwell import multibody as mb
from southwell.core.spectrum import eigen

pytestmark = pytest.mark.numerical


@pytest.mark.parametrize("big", [1.0, 1e3, 1e4, 1e5])
def test_a_small_damper_with_large_gyroscopic_forces(big: float) -> None:
    """A small mass on a separate spring and damper: ζ = c/(2 √(k m)), whatever else turns."""
    c, k, m = 3e-3, 1.0, 1e-3
    solution = mb.solve(
        mb.Mechanism(
            (mb.Body("t"), mb.Body("x1"), mb.Body("m", mb.inertia(big)), mb.Body("p", mb.inertia(m))),
            (
                mb.Joint("turn", "revolute", "ground", "t"),
                mb.Joint("x", "prismatic", "t", "x1", mb.at(axis="x"), mb.at(axis="x")),
                mb.Joint("y", "prismatic", "x1", "m", mb.at(axis="y"), mb.at(axis="y")),
                mb.Joint("z", "prismatic", "ground", "p"),
            ),
            (mb.Motion("turn.rz", rate=30.0),),
            coordinate_springs=(
                mb.CoordinateSpring("x.z", 1e4 * big),
                mb.CoordinateSpring("y.z", 2e4 * big),
                mb.CoordinateSpring("z.z", k, damping=c),
            ),
        )
    )
    own_answer = solution.leading.index("z.z")
    assert solution.damping[own_answer] == pytest.approx(c / (2 * np.sqrt(k * m)), rel=1e-9)
    np.testing.assert_allclose(np.delete(solution.damping, own_answer), 0.0, atol=1e-12)


@pytest.mark.parametrize(("stiffness", "damping"), [(5.0, 0.0), (7.0, 0.1), (1e-3, 0.0)])
def test_a_rigid_motion_is_one_mode_without_damping(stiffness: float, damping: float) -> None:
    """Two discs on one axis, nothing to the ground: λ = 0, and ω² = k (1/I₁ + 1/I₂) with 2 ζ ω = c (1/I₁ + 1/I₂)."""
    m = mb.Mechanism(
        (mb.Body("a", mb.inertia(1.0, 3.0)), mb.Body("b", mb.inertia(1.0, 2.0))),
        (mb.Joint("r", "revolute", "ground", "a"), mb.Joint("q", "revolute", "a", "b")),
        coordinate_springs=(mb.CoordinateSpring("q.rz", stiffness, damping),),
    )
    solution = mb.solve(m)
    ease = 1 / 3 + 1 / 2
    assert solution.values[0] == 0.0
    assert solution.frequencies[1:] == pytest.approx([np.sqrt(stiffness * ease)], rel=1e-9)
    assert solution.damping == pytest.approx([0.0, 0.5 * damping * ease / np.sqrt(stiffness * ease)], abs=1e-12)


def test_a_damped_rigid_motion_keeps_its_decay() -> None:
    """A disc on a damper alone: λ = 0 and −c/I."""
    m = mb.Mechanism(
        (mb.Body("a", mb.inertia(1.0, 3.0)),),
        (mb.Joint("r", "revolute", "ground", "a"),),
        coordinate_springs=(mb.CoordinateSpring("r.rz", damping=0.6),),
    )
    np.testing.assert_allclose(mb.solve(m).values, [0.0, -0.2], atol=1e-14)


def test_free_bodies_have_six_undamped_rigid_modes() -> None:
    m = mb.Mechanism(
        (
            mb.Body("a", mb.inertia(1.0, (1, 2, 3), (0.3, 0.1, 0))),
            mb.Body("b", mb.inertia(2.0, (1, 2, 3), (0.2, 0.5, 0.1))),
        ),
        (mb.Joint("r", "free", "ground", "a"), mb.Joint("q", "revolute", "a", "b", mb.at(x=1.0))),
        coordinate_springs=(mb.CoordinateSpring("q.rz", 5.0),),
    )
    solution = mb.solve(m)
    assert (solution.values[:6] == 0.0).all()
    assert len(solution.values) == 7
    np.testing.assert_allclose(solution.damping, 0.0, atol=1e-12)


def test_a_solver_failure_is_not_reported_as_instability() -> None:
    bad = np.array([[np.nan]])
    for call in (
        lambda: eigen.gyroscopic(np.eye(1), 0 * bad, bad),
        lambda: eigen.damped(np.eye(1), np.zeros((1, 1)), bad),
    ):
        with pytest.raises(eigen.EigenError, match="not finite"):
            call()
    assert not issubclass(eigen.EigenError, eigen.UnstableError | ArithmeticError | ValueError)
