"""Steady states far from the undeformed shape: continuation in the loads, and true causes where there is none.

Right frequencies, as multiples of Ω, are by Chebyshev collocation of the intrinsic beam equations.
"""

import numpy as np
import pytest

from southwell import Blade, section_mass, section_stiffness
from southwell.core.solve import modes
from southwell.core.spectrum.eigen import UnstableError


def soft(precone: float) -> Blade:
    """A slender clamped blade of 10 m whose first frequency at rest is 0.3516 rad/s."""
    stiffness, mass = section_stiffness(1e8, 100.0, 100.0, 200.0), section_mass(1.0, 0.001, 0.002)
    return Blade(
        "soft",
        np.array([0.0, 10.0]),
        np.repeat(stiffness, 2, 0),
        np.repeat(mass, 2, 0),
        np.zeros(2),
        1.0,
        precone=precone,
    )


@pytest.mark.parametrize(
    ("precone", "multiple", "right"),
    [
        (0.3, 10.0, (0.48104, 1.09778, 2.62333)),
        (0.6, 10.0, (0.45353, 1.08837, 2.59459)),
        (0.6, 30.0, (0.38677, 1.06905, 2.42161)),
    ],
)
def test_a_soft_blade_with_precone_is_solved_at_one_speed(
    precone: float, multiple: float, right: tuple[float, ...]
) -> None:
    omega = 0.3516 * multiple
    solution = modes(soft(precone), omega, count=3, accuracy=1e-5)
    np.testing.assert_allclose(solution.frequencies / omega, right, rtol=2e-5)


@pytest.mark.parametrize(("ratio", "right"), [(5.0, (0.90843, 1.37673, 2.65916)), (3.0, (0.7763, 1.43908, 2.3497))])
def test_a_blade_with_precone_on_a_spring_along_it_is_solved_at_one_speed(
    ratio: float, right: tuple[float, ...]
) -> None:
    omega, length = 3.0, 10.0
    blade = Blade(
        "sprung",
        np.array([0.0, length]),
        np.repeat(section_stiffness(1e7, 1e4, 4e3, 8e3), 2, 0),
        np.repeat(section_mass(1.0, 0.01, 0.02), 2, 0),
        np.zeros(2),
        precone=0.15,
        root=np.array([ratio * length * omega**2, *[np.inf] * 5]),
    )
    solution = modes(blade, omega, count=3, accuracy=1e-5, allow_large_strain=True)
    np.testing.assert_allclose(solution.frequencies / omega, right, rtol=1e-5)


def test_a_rod_past_its_largest_speed_is_unstable() -> None:
    """A rod stretches without limit at Ω L √(m/EA) = π/2; the state beyond is compressed."""
    stiffness, mass = section_stiffness(1.0, 1.0, 1.0, 1.0), section_mass(1.0, 1e-3, 1e-3)
    rod = Blade("rod", np.array([0.0, 1.0]), np.repeat(stiffness, 2, 0), np.repeat(mass, 2, 0), np.zeros(2))
    with pytest.raises(UnstableError, match="unstable, with an axial or shear strain"):
        modes(rod, 2.0, count=2)


def test_the_refusal_of_a_blade_buckled_at_rest_does_not_mention_centrifugal_force() -> None:
    """A column of 10 m under its weight buckles at m g L³/EI = 7.837 (Greenhill 1881)."""
    stiffness, mass = section_stiffness(1e9, 1e4, 1e4, 1e4), section_mass(1.0, 1e-4, 1e-4)
    column = Blade("column", np.array([0.0, 10.0]), np.repeat(stiffness, 2, 0), np.repeat(mass, 2, 0), np.zeros(2))
    critical = 7.837 * 1e4 / 1e3
    assert modes(column, 0.0, count=2, gravity=np.array([-0.99 * critical, 0.0, 0.0])).frequencies[0] > 0
    with pytest.raises(UnstableError, match="not positive definite") as error:
        modes(column, 0.0, count=2, gravity=np.array([-1.01 * critical, 0.0, 0.0]))
    assert "centrifugal" not in str(error.value)
