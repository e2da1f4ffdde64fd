"""Uncertainties cover the errors of default meshes, of given meshes, and of cable-like blades."""

import json
import warnings
from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.campbell.sweep import NamedMode
from southwell.cases.input.library import load
from southwell.cases.input.schema import Compare
from southwell.cases.solve import core_solver
from southwell.core import solve
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.effects import ALL_EFFECTS
from southwell.core.element.discretize import discretize
from southwell.core.spectrum import accuracy, grading
from southwell.core.spectrum.refinement import AccuracyWarning
from southwell.references.scikit_fem.reissner import CODE
from southwell.reports.cli.app import main
from southwell.reports.shared.certain import certain, remarks
from southwell.reports.shared.units import RAD_S
from southwell.tests.support.units import random_blade


def cable(EI: float) -> Blade:
    return uniform_blade("cable", 10.0, 0.0, EA=1e9, GJ=1e4, EI_y=EI, EI_z=2 * EI, mass=1.0)


@pytest.mark.slow
def test_a_step_of_the_bending_stiffness_by_1e8_is_solved() -> None:
    """The outer half is a cable, for which 320 elements are too few; 3000 equal elements have these frequencies."""
    s, EI = np.array([0.0, 5.0, 5.0001, 10.0]), np.array([1e4, 1e4, 1e-4, 1e-4])
    mass = np.repeat(section_mass(1.0, 0.001, 0.002), 4, 0)
    stepped = Blade("stepped", s, section_stiffness(np.full(4, 1e8), 1e4, EI, 2 * EI), mass, np.zeros(4))
    frequencies = solve.modes(stepped, 10.0, count=2, accuracy=1e-3).frequencies
    np.testing.assert_allclose(frequencies, [6.201082, 11.192977], rtol=2e-6)


def truth(blade: Blade, omega: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies on a very fine graded mesh, and their relative change when its elements are halved."""
    nodes = grading.coarse(blade, 300, omega)
    coarse, fine = (
        solve.chain_modes(discretize(blade, s), omega, count).frequencies for s in (nodes, grading.halved(nodes))
    )
    return fine, np.abs(fine / coarse - 1.0)


@pytest.mark.parametrize("seed", range(8))
def test_uncertainties_cover_the_errors_of_random_blades(seed: int) -> None:
    blade, omega = random_blade(np.random.default_rng(seed))
    exact, unsure = truth(blade, omega, 5)
    solution = solve.modes(blade, omega, count=5)
    assert solution.uncertainty.max() <= 1e-6
    assert (np.abs(solution.frequencies / exact - 1.0) <= solution.uncertainty + unsure).all()
    for elements in (12, 30, 50):
        computed = solve.modes(blade, omega, elements, 5)
        np.testing.assert_array_equal(computed.frequencies, solve.mesh_modes(blade, omega, elements, 5).frequencies)
        assert (np.abs(computed.frequencies / exact - 1.0) <= computed.uncertainty + unsure).all()


@pytest.mark.parametrize("EI", [1e4, 1e3, 1e2, 10.0, 1.0])
def test_a_cable_like_blade_is_accurate_by_default(EI: float) -> None:
    """The first lag of a cable without bending stiffness is zero; otherwise it depends on the root's boundary layer only."""
    blade = cable(EI)
    exact, unsure = truth(blade, 30.0, 3)
    solution = solve.modes(blade, 30.0, count=3)
    assert solution.uncertainty.max() <= 1e-6
    assert (np.abs(solution.frequencies / exact - 1.0) <= solution.uncertainty + unsure).all()
    computed = solve.modes(blade, 30.0, 50, 3)
    assert (np.abs(computed.frequencies / exact - 1.0) <= computed.uncertainty).all()


def test_flap_of_a_cable_tends_to_its_closed_form() -> None:
    """ω = Ω √(k(2k − 1)) of a cable's flap; a small EI adds a term proportional to its square root."""
    excess = [solve.modes(cable(EI), 30.0, count=2).frequencies[1] / 30.0 - 1.0 for EI in (1e2, 1.0)]
    assert 0 < excess[1] < excess[0] < 1e-2
    assert excess[0] / excess[1] == pytest.approx(10.0, rel=0.05)


def test_more_accuracy_takes_more_elements() -> None:
    rough, fine = (solve.modes(cable(1e3), 30.0, count=4, accuracy=a) for a in (1e-3, 1e-9))
    assert rough.elements < fine.elements
    assert fine.uncertainty.max() <= 1e-9
    assert (np.abs(rough.frequencies / fine.frequencies - 1.0) <= rough.uncertainty + 1e-9).all()


@pytest.mark.slow
def test_accuracy_out_of_reach_is_reported() -> None:
    with pytest.warns(AccuracyWarning, match=r"relative uncertainty .* exceeds the requested accuracy 1.0e-15"):
        solution = solve.modes(cable(1e3), 30.0, count=1, accuracy=1e-15)
    assert solution.uncertainty.max() > 1e-15
    with pytest.raises(ValueError, match="accuracy: 0"):
        solve.modes(cable(1e3), 30.0, count=2, accuracy=0.0)


@pytest.mark.skipif(CODE.version() is None, reason=f"not installed: {CODE.hint}")
@pytest.mark.parametrize("omega", [5.0, 30.0, 100.0])
def test_rigid_stretch_is_rigid_within_the_uncertainty(omega: float) -> None:
    """Against scikit-fem, where a rigid strain is a constraint. The compliance in core has an effect of 5e-5 at 100 rad/s."""
    stiff = uniform_blade("inextensible", 10.0, 1.0, EA=np.inf, GJ=1e4, EI_y=1e4, EI_z=2e4, mass=1.0)
    coarse, fine = (CODE.solve(stiff, omega, n, 2).frequencies for n in (30, 60))
    true = fine + (fine - coarse) / 15.0
    unsure = np.abs(fine / coarse - 1.0) / 15.0
    refined, computed = solve.modes(stiff, omega, count=2), solve.modes(stiff, omega, 64, 2)
    assert refined.uncertainty.max() < 1e-6
    for answer in (refined, computed):
        assert (np.abs(answer.frequencies / true - 1.0) <= answer.uncertainty + unsure).all()


def test_the_reference_of_a_comparison_is_rigid_too() -> None:
    """Core's converged column of ``verify``: the same frequencies as those of ``modes``."""
    stiff = uniform_blade("inextensible", 10.0, 1.0, EA=np.inf, GJ=1e4, EI_y=1e4, EI_z=2e4, mass=1.0)
    (result,) = core_solver.converged(stiff, [30.0], Compare(modes=2), ALL_EFFECTS)
    assert isinstance(result, core_solver.Converged)
    frequencies = solve.modes(stiff, 30.0, count=2).frequencies
    for answer, true in zip(result.modes, frequencies, strict=True):
        assert answer.estimate is not None
        assert answer.estimate.uncertainty is not None
        assert abs(answer.estimate.value / true - 1.0) <= answer.estimate.uncertainty + 1e-8 < 1e-4


def test_a_sweep_agrees_with_single_speeds_within_the_uncertainty() -> None:
    speeds = [0.0, 10.0, 30.0]
    for answer in solve.sweep(cable(1e3), speeds, count=3):
        alone = solve.modes(cable(1e3), answer.omega, count=3)
        assert (np.abs(answer.frequencies / alone.frequencies - 1.0) <= answer.uncertainty + alone.uncertainty).all()


def test_richardsons_extrapolation_of_a_known_sequence() -> None:
    """f = 1 + c h⁴ + d h⁶: the estimate's value is better than the finest, and both bounds hold."""
    h = 1.0 / np.array([10.0, 20.0, 40.0])
    for c, d in ((1.0, 0.0), (1.0, 3.0), (-2.0, 5.0)):
        f = (1.0 + c * h**4 + d * h**6)[:, None]
        estimate = accuracy.estimate(f, 4)
        assert abs(estimate.values[0] - 1.0) <= estimate.of_values[0] + accuracy.FLOOR < estimate.of_finest[0]
        assert abs(f[2, 0] - 1.0) <= estimate.of_finest[0] < 5 * abs(f[2, 0] - 1.0)


def test_the_theoretical_order_by_chance_does_not_make_the_extrapolation_exact() -> None:
    """Changes by 16 to 1, as of fourth order, of a sequence that then converges faster: half the correction is wrong."""
    c = 1e-8
    estimate = accuracy.estimate(1.0 + c * np.array([[0.5 + 255.0], [0.5 + 15.0], [0.5]]), 4)
    assert abs(estimate.values[0] - 1.0) == pytest.approx(0.5 * c, rel=1e-6)
    assert abs(estimate.values[0] - 1.0) <= estimate.of_values[0] < estimate.of_finest[0]


@pytest.mark.slow
def test_the_uncertainty_where_the_order_passes_the_theoretical_one() -> None:
    """The elements of this blade converge with order 3, 4, 5 and 6 as they are halved."""
    blade = load("windpact-1.5").variants[0].blade
    rough, fine = (solve.modes(blade, 2 * np.pi, count=6, accuracy=a) for a in (1e-6, 1e-10))
    assert rough.elements < fine.elements
    assert (np.abs(rough.frequencies / fine.frequencies - 1.0) <= rough.uncertainty + fine.uncertainty).all()


@pytest.mark.parametrize("f", [(1.0, 1.5, 1.25), (1.0, 1.1, 1.3)], ids=["alternating", "diverging"])
def test_the_uncertainty_without_convergence_is_three_times_the_spread(f: tuple[float, ...]) -> None:
    estimate = accuracy.estimate(np.array(f)[:, None], 4)
    assert estimate.values[0] == f[2]
    assert estimate.of_finest[0] == pytest.approx(3 * max(abs(f[1] - f[0]), abs(f[2] - f[1])) / f[2])


def test_the_mesh_has_nodes_at_stations_and_is_fine_at_the_root() -> None:
    blade, _ = random_blade(np.random.default_rng(6))
    nodes = grading.coarse(blade, 10, 0.0)
    assert {round(s, 9) for s in blade.stations} <= {round(s, 9) for s in nodes}
    assert np.diff(nodes).max() <= blade.length / 10 * (1 + 1e-9)
    layer = np.sqrt(1.0 / (30.0**2 * 50.0))
    fine = grading.coarse(cable(1.0), 10, 30.0)
    assert fine[1] <= layer < fine[3]
    assert (fine[0], fine[-1]) == (0.0, 10.0)
    np.testing.assert_allclose(grading.halved(fine)[::2], fine)


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (12.3456789, 1e-9, "12.34568"),
        (12.3456789, 1e-4, "12.35"),
        (12.3456789, 3e-3, "12.3"),
        (12.3456789, 0.2, "10"),
        (1234.56, 0.1, "1000"),
        (9.9996, 1e-4, "10.000"),
        (0.00123456789, 1e-3, "0.00123"),
        (-0.00123456789, 1e-3, "−0.00123"),
        (12.3456789, 0.0, "12.34568"),
        (0.0, 1e-3, "0"),
        (5.0, 0.9, "?"),
        (5.0, float("inf"), "?"),
        (5.0, float("nan"), "?"),
    ],
)
def test_digits_end_where_the_uncertainty_begins(value: float, uncertainty: float, text: str) -> None:
    assert certain(value, uncertainty) == text


def test_remarks() -> None:
    row = NamedMode(3.0, 1, "flapwise 1", 5.0, 1e-3, 0.05)
    strain, accuracy_ = remarks([row], 1e-6, RAD_S)
    assert strain.startswith("steady strain up to 5.0% at")
    assert accuracy_.startswith("accuracy 1e-06 not reached: flapwise 1 at")
    assert remarks([replace(row, strain=0.01)], None, RAD_S) == []


def test_the_command_states_uncertainty_and_strain(capsys: pytest.CaptureFixture[str]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(SystemExit, match=r"^0$"):
            main(["modes", "park-cantilever", "--omega", "10", "--modes", "3", "--json"])
    rows = json.loads(capsys.readouterr().out)
    assert all(0 < row["relative_uncertainty"] <= 1e-6 and 0 < row["steady_strain"] < 0.02 for row in rows)
    with pytest.raises(SystemExit, match=r"^0$"):
        main(["modes", "park-cantilever", "--omega", "10", "--modes", "3", "--elements", "2"])
    assert "± relative" in capsys.readouterr().out
