"""Towers against closed forms: a body at the top, weight, an elastic base, distributed springs, and guy wires."""

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

from southwell.core import multibody as mb
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.element.branches import springs
from southwell.core.turbine.tower import Support, Tower
from southwell.core.turbine.tower_modes import tower_modes

EI, MASS, LENGTH = 3e7, 100.0, 20.0


def beam(tip: float = 0.0) -> Blade:
    tower = uniform_blade("tower", LENGTH, 0.0, EA=1e10, GJ=1e8, EI_y=EI, EI_z=1.2 * EI, mass=MASS)
    return replace(tower, tip_mass=np.diag([tip] * 3 + [0.0] * 3))


def rigid(body: np.ndarray | None = None) -> Blade:
    """A beam with hardly any mass that does not bend, with a body at its top."""
    tower = uniform_blade("rigid", LENGTH, 0.0, EA=1e17, GJ=1e17, EI_y=1e18, EI_z=1e18, mass=1e-6)
    return replace(tower, tip_mass=mb.inertia(500.0, (900.0, 700.0, 800.0)) if body is None else body)


def base() -> np.ndarray:
    """A stiffness with all couplings of a pile: K_xx, and sway with tilt in both directions, unequal."""
    K = np.diag([4e8, 2e7, 3e7, 5e8, 9e8, 8e8])
    K[1, 5] = K[5, 1] = -6e7
    K[2, 4] = K[4, 2] = 7e7
    return K


def test_names_and_uncertainty_of_a_clamped_tower() -> None:
    """β² = 3.5160 and 22.0345 of a cantilever (Rao, *Mechanical Vibrations*)."""
    solution = tower_modes(Tower(beam()), 4)
    assert solution.names == ("1st fore-aft", "1st side-side", "2nd fore-aft", "2nd side-side")
    unit = np.sqrt(EI / (MASS * LENGTH**4))
    np.testing.assert_allclose(solution.frequencies[[0, 2]], [3.51601527 * unit, 22.0344916 * unit], rtol=2e-5)
    assert solution.uncertainty.max() < 1e-7


def test_soil_along_the_tower_adds_to_every_square() -> None:
    """ω² = ω₀² + k/m of a uniform beam on a uniform Winkler foundation, exactly."""
    k = 5e4
    free = tower_modes(Tower(beam()), 4).frequencies
    soil = Support(soil=np.array([[0.0, k], [7.0, k], [LENGTH, k]]))
    frequencies = tower_modes(Tower(beam(), soil), 4).frequencies
    np.testing.assert_allclose(frequencies, np.sqrt(free**2 + k / MASS), rtol=1e-10)


def test_soil_in_a_part_of_the_tower_is_the_limit_of_many_springs() -> None:
    n, low, high = 64, 2.0, 9.0
    soil = Support(soil=np.array([[low, 4e5], [high, 1e5]]))
    heights = low + (high - low) * (np.arange(n) + 0.5) / n
    stiffness = np.interp(heights, [low, high], [4e5, 1e5]) * (high - low) / n
    single = Support(springs=tuple((h, np.diag([0, k, k, 0, 0, 0])) for h, k in zip(heights, stiffness, strict=True)))
    both = [tower_modes(Tower(beam(), support), 4).frequencies for support in (soil, single)]
    np.testing.assert_allclose(*both, rtol=2e-5)


def test_a_spring_at_the_top() -> None:
    """A cantilever with a spring k at its end: EI β³ (1 + c ch) + k (s ch − c sh) = 0, with c = cos βL and so on."""
    k = 4e4

    def equation(b: float) -> float:
        c, s, ch, sh = np.cos(b), np.sin(b), np.cosh(b), np.sinh(b)
        return (b / LENGTH) ** 3 * EI * (1.0 + c * ch) + k * (s * ch - c * sh)

    free = brentq(equation, 0.5, 3.0)
    exact = (cast(float, free) / LENGTH) ** 2 * np.sqrt(EI / MASS)
    top = Support(springs=((LENGTH, np.diag([0, k, k, 0, 0, 0])),))
    assert tower_modes(Tower(beam(), top), 2).frequencies[0] == pytest.approx(exact, rel=2e-5)


def test_a_body_on_an_elastic_base_has_six_frequencies() -> None:
    """K x = ω² M x of one rigid body, with its inertia moved to the base."""
    tower = rigid()
    M = mb.inertia(500.0, (900.0, 700.0, 800.0), (LENGTH, 0.0, 0.0))
    exact = np.sqrt(eigh(base(), M, eigvals_only=True))
    frequencies = tower_modes(Tower(tower, Support(base=base())), 6).frequencies
    np.testing.assert_allclose(frequencies, exact, rtol=1e-5)


def test_weight_makes_a_body_on_an_elastic_base_tip_over() -> None:
    """K_g = −m g h of the two tilts: an inverted pendulum on springs."""
    K, g = np.diag([np.inf, np.inf, np.inf, np.inf, 3e5, 2e5]), 9.81
    frequencies = tower_modes(Tower(rigid(mb.inertia(500.0)), Support(base=K), g), 2).frequencies
    exact = np.sqrt((np.array([2e5, 3e5]) - 500.0 * g * LENGTH) / (500.0 * LENGTH**2))
    np.testing.assert_allclose(frequencies, exact, rtol=1e-4)


def test_weight_leaves_the_motions_of_a_coupled_base_but_tilts() -> None:
    """The base carries the weight by a vertical force: K − m g h in the two tilts, whatever K couples."""
    M, g = mb.inertia(500.0, (900.0, 700.0, 800.0), (LENGTH, 0.0, 0.0)), 9.81
    K = base() - 500.0 * g * LENGTH * np.diag([0.0, 0.0, 0.0, 0.0, 1.0, 1.0])
    floater = mb.inertia(2000.0, (3e3, 2e3, 2e3), (-1.0, 0.2, 0.1))
    frequencies = tower_modes(Tower(rigid(), Support(base=base(), mass=floater), g), 6).frequencies
    np.testing.assert_allclose(frequencies, np.sqrt(eigh(K, M + floater, eigvals_only=True)), rtol=1e-5)


def test_joints_in_series_have_the_stiffness_of_the_base() -> None:
    screws, constants = springs(base())
    np.testing.assert_allclose(np.linalg.inv((screws.T / constants) @ screws), base(), rtol=1e-10, atol=1e-4)
    for n, screw in enumerate(screws):
        assert screw[n] == 1.0


def test_a_stiff_base_is_a_clamped_one() -> None:
    stiff = Support(base=np.diag([1e14, 1e14, 1e14, 1e16, 1e16, 1e16]))
    both = [tower_modes(Tower(beam(400.0), support), 4).frequencies for support in (stiff, Support())]
    np.testing.assert_allclose(*both, rtol=1e-6)


@pytest.mark.parametrize(
    ("support", "message"),
    [
        (Support(base=np.diag([1e9, 1e9, 1e9, 1e9, 1e9, 0.0])), "moves freely"),
        (Support(base=np.diag([1e9, 1e9, 1e9, 1e9, 1e9, -1.0])), "moves freely"),
        (Support(base=np.eye(6) + np.eye(6, k=1)), "not symmetric"),
        (Support(base=np.eye(3)), "6 rows"),
        (Support(springs=((25.0, np.eye(6)),)), "20 m high"),
        (Support(soil=np.array([[3.0, 1.0], [2.0, 1.0]])), "ascend"),
        (Support(mass=np.eye(6)), "does not move"),
        (Support(base=np.eye(6), mass=-np.eye(6)), "negative in a direction"),
    ],
)
def test_a_wrong_support_is_refused(support: Support, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        tower_modes(Tower(beam(), support), 2)


BMODES_SECTIONS = np.array(
    [
        [2549.742, 9540.03, 243.058e9, 186.968e9],
        [2275.820, 7601.16, 193.660e9, 148.969e9],
        [2017.460, 5974.02, 152.204e9, 117.080e9],
        [1774.662, 4623.25, 117.790e9, 90.608e9],
        [1547.425, 3515.63, 89.570e9, 68.900e9],
        [1335.750, 2620.07, 66.753e9, 51.349e9],
        [1139.637, 1907.59, 48.601e9, 37.386e9],
        [959.085, 1351.37, 34.430e9, 26.485e9],
        [794.095, 926.69, 23.610e9, 18.162e9],
        [644.666, 610.96, 15.566e9, 11.974e9],
    ]
)
"""kg/m, kg m, N m², N m² at ten equal distances: the WindPACT 1.5 MW tower of BModes' certification tests 3 and 4."""

BMODES_ELEMENTS = np.array([0.0, 0.08, 0.16, 0.24, 0.32, 0.40, 0.48, 0.56, 0.64, 0.72, 0.80, 0.90, 1.0])

HEIGHT = 82.39


def bmodes_tower(factor: float) -> Blade:
    """The tower with the properties in the middle of each of BModes' elements, which it uses, and rigid in tension.

    BModes leaves out the coupling of tension with bending through the eccentric mass.
    """
    middle = 0.5 * (BMODES_ELEMENTS[1:] + BMODES_ELEMENTS[:-1])
    columns = [np.interp(middle, np.linspace(0, 1, 10), column) for column in factor * BMODES_SECTIONS.T]
    mass, rotary, bending, torsion = (np.repeat(column, 2) for column in columns)
    inner = BMODES_ELEMENTS[1:-1]
    ends = np.sort(np.concatenate([[0.0], inner - 1e-7, inner + 1e-7, [1.0]]))
    arm, tilt, roll, yaw, product = -3.3, 3253223.0, 2960437.0, 3264220.0, -18400.0  # moments about the tower's top
    tip = mb.inertia(78055.8, (yaw - 78055.8 * arm**2, tilt - 78055.8 * arm**2, roll), (0.0, 0.0, arm))
    tip[3, 5] = tip[5, 3] = -product
    return Blade(
        name="BModes",
        stations=HEIGHT * ends,
        stiffness=section_stiffness(np.inf, torsion, bending, bending),
        mass=section_mass(mass, rotary, rotary),
        twist=np.zeros(len(ends)),
        tip_mass=tip,
    )


@pytest.mark.parametrize(
    ("factor", "wires", "printed"),
    [
        (1.0, (), (0.41908, 0.42087, 2.1977, 2.4880, 2.5800, 5.1828, 5.3222)),
        (0.25, ((0.40, 9.0e9, 45.0), (0.72, 1.6e9, 30.0)), (0.55780, 0.58291, 1.1727, 2.6831, 2.8594)),
    ],
    ids=["3: top mass", "4: top mass and wires"],
)
def test_bmodes_certification(
    factor: float, wires: Sequence[tuple[float, float, float]], printed: tuple[float, ...]
) -> None:
    """BModes 1.03, certification tests 3 and 4: outputs Test03_tower.out and Test04_wires_supported_tower.out of 2007.

    Twelve elements of BModes are up to 0.2 % stiffer than the converged tower. Three wires of stiffness k at an angle θ from
    the ground act like 3/2 k cos²θ in every horizontal direction. No weight: BModes 1.03 has none.
    """
    springs = tuple(
        (part * HEIGHT, 1.5 * k * np.cos(np.radians(angle)) ** 2 * np.diag([0, 1, 1, 0, 0, 0]))
        for part, k, angle in wires
    )
    solution = tower_modes(Tower(bmodes_tower(factor), Support(springs=springs)), len(printed))
    difference = solution.frequencies / (2 * np.pi) / np.array(printed) - 1
    assert (difference < 2e-5).all()
    assert (difference > -2.1e-3).all()
    assert solution.names[:3] == ("1st side-side", "1st fore-aft", "1st torsion")
