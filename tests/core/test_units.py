"""Predicates, refusals and frequencies do not depend on the units of mass, length and time."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from southwell.core import blade as bl
from southwell.core.blade import Blade, BladeError, section_mass, section_stiffness, uniform_blade
from southwell.core.blade_checks import body_fault
from southwell.core.element.beams import bushing
from southwell.core.element.discretize import discretize
from southwell.core.solve import modes
from southwell.core.spectrum import lanczos
from southwell.core.tree.pencil import linearize, undeformed
from southwell.references.sampling import sample

from ..support.units import in_units, random_blade

PREDICATES = (bl.coupled, bl.straight, bl.clamped, bl.uniform)

unit = st.floats(-2.0, 2.0).map(lambda power: 10.0**power)


def bend_twist(EA: float, coupling: float) -> Blade:
    """A blade whose bending and torsion are coupled."""
    stiffness = np.repeat(section_stiffness(EA, 10.0, 10.0, 40.0), 2, axis=0)
    stiffness[:, 3, 4] = stiffness[:, 4, 3] = coupling
    mass = np.repeat(section_mass(1.0, 0.001, 0.002), 2, axis=0)
    return Blade("bend-twist", np.array([0.0, 1.0]), stiffness, mass, np.zeros(2))


@pytest.mark.parametrize("EA", [1e4, 1e13, 1e20])
def test_a_coupled_blade_is_coupled_however_stiff_it_is_in_tension(EA: float) -> None:
    assert bl.coupled(bend_twist(EA, 7.0))
    assert not bl.coupled(bend_twist(EA, 1e-12))
    with pytest.raises(BladeError, match="coupled sections"):
        sample(bend_twist(EA, 7.0), [0.5])


def test_an_offset_mass_is_coupled_however_small_the_section_is() -> None:
    small = bend_twist(1e13, 0.0)
    shift = np.eye(6)
    shift[0, 4], shift[1, 3] = 1e-13, -1e-13  # a hundredth of the radius of gyration
    thin = np.repeat(section_mass(1.0, 1e-22, 1e-22), 2, axis=0)
    assert bl.coupled(replace(small, mass=shift.T @ thin @ shift))


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), kg=unit, m=unit, s=unit)
def test_predicates_and_frequencies_do_not_depend_on_units(seed: int, kg: float, m: float, s: float) -> None:
    blade, omega = random_blade(np.random.default_rng(seed))
    other = in_units(blade, kg, m, s)
    assert [holds(other) for holds in PREDICATES] == [holds(blade) for holds in PREDICATES]
    solution, scaled = modes(blade, omega, 16, 5), modes(other, omega / s, 16, 5)
    np.testing.assert_allclose(
        scaled.frequencies * s / solution.frequencies,
        1.0,
        rtol=0,
        atol=10 * max(solution.rounding.max(), scaled.rounding.max()),
    )


@pytest.mark.parametrize(("seed", "units"), [(2655, (1.0, 10.0, 1.0)), (106466, (1.0, 1.0, 0.1))])
def test_a_hinge_with_a_spring_loses_no_digits_in_other_units(seed: int, units: tuple[float, float, float]) -> None:
    """Clamped directions once had a stiffness of 1 in any unit beside springs of 1e8: frequencies changed by up to 2e-8."""
    blade, omega = random_blade(np.random.default_rng(seed))
    assert not bl.clamped(blade)
    solution = modes(blade, omega, 16, 5)
    scaled = modes(in_units(blade, *units), omega / units[2], 16, 5)
    np.testing.assert_allclose(scaled.frequencies * units[2], solution.frequencies, rtol=1e-11)


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    kg=unit,
    m=unit,
    s=unit,
    row=st.integers(0, 5),
    column=st.integers(0, 5),
    kind=st.booleans(),
)
def test_refusals_do_not_depend_on_units(
    seed: int, kg: float, m: float, s: float, row: int, column: int, kind: bool
) -> None:
    """One entry of one section is altered, by an amount far from every tolerance."""
    rng = np.random.default_rng(seed)
    blade, _ = random_blade(rng)
    name = "mass" if kind else "stiffness"
    matrix = getattr(blade, name)[0].copy()
    size = float(np.sqrt(matrix[row, row]) * np.sqrt(matrix[column, column]))
    if not np.isfinite(size):
        return
    matrix[row, column] += rng.choice([1e-15, 1e-3, 0.3, 3.0]) * size
    powers = np.add.outer(np.repeat([0, 1], 3), np.repeat([0, 1], 3))
    first = {"mass": kg / m, "stiffness": kg * m / s**2}[name]
    elsewhere = in_units(blade, kg, m, s)
    refused = [_refusal(blade, name, matrix), _refusal(elsewhere, name, first * float(m) ** powers * matrix)]
    assert refused[0] == refused[1]


def _refusal(blade: Blade, name: str, matrix: np.ndarray) -> str | None:
    """The error, without numbers, of a blade with another matrix at its root."""
    values = getattr(blade, name).copy()
    values[0] = matrix
    try:
        replace(blade, **{name: values})
    except BladeError as error:
        return "".join(c for c in str(error) if c not in "0123456789.+-e")
    return None


@pytest.mark.parametrize("metre", [1.0, 1e-6, 1e6])
def test_an_inertia_without_symmetry_is_refused_in_any_unit(metre: float) -> None:
    matrix = np.diag([1.0, 1.0, 1.0, 2e-6, 1e-6, 1e-6])
    matrix[3, 4], matrix[4, 3] = 1e-7, 2e-7
    powers = np.add.outer(np.repeat([0, 1], 3), np.repeat([0, 1], 3))
    assert "symmetric" in str(body_fault(metre**powers * matrix, "kg"))


@pytest.mark.parametrize("metre", [1.0, 1e-4, 1e4])
def test_a_bushing_without_symmetry_is_refused_in_any_unit(metre: float) -> None:
    stiffness = np.diag([1e4, 1e4, 1e4, 1.0, 1.0, 1.0])
    stiffness[3, 4] = 1e-6
    powers = np.add.outer(np.repeat([0, 1], 3), np.repeat([0, 1], 3))
    with pytest.raises(ValueError, match="symmetric"):
        bushing(np.eye(4), metre**powers * stiffness)


@pytest.mark.parametrize("metre", [1e-4, 1e-2, 1.0])
def test_directions_with_mass_do_not_depend_on_the_unit_of_length(metre: float) -> None:
    """Thin blade with lumped masses: rotation about its axis has a millionth of the inertia of the others, and counts."""
    blade = uniform_blade("thin", 10.0, 1.0, EA=1e9, GJ=1e4, EI_y=1e6, EI_z=4e6, mass=10.0, I_y=1e-7, I_z=1e-7)
    mesh = discretize(in_units(blade, 1.0, metre, 1.0), 8, "half_end", "body_fixed")
    pencil = linearize(mesh, undeformed(mesh), 0.0, np.zeros(3))
    massive, _ = lanczos._massive(pencil)
    unit = np.repeat([1.0, metre], 3)
    ranks = np.round(np.trace(massive, axis1=1, axis2=2))
    np.testing.assert_array_equal(ranks, 6.0)
    np.testing.assert_allclose(massive * unit[:, None] / unit, np.tile(np.eye(6), (8, 1, 1)), atol=1e-6)
