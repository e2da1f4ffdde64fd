"""Sweeps start from the previous speeds: the same frequencies with less work, and no mode is missed."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from southwell.core import solve
from southwell.core.blade import uniform_blade
from southwell.core.element.discretize import discretize
from southwell.core.element.mesh import Mesh
from southwell.core.spectrum import completeness, lanczos
from southwell.core.spectrum import mesh_solver as solution
from southwell.core.spectrum.completeness import MissedModesError
from southwell.core.spectrum.mesh_solver import Options, Solved
from southwell.core.spectrum.mesh_solver import solve as solve_mesh
from southwell.core.steady import blade_state, extrapolation
from southwell.core.steady.blade_state import Steady

FLAT = uniform_blade("flat", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=4e6, mass=10.0, I_y=0.1, I_z=0.3)
ROUND = uniform_blade("round", 10.0, 1.0, EA=1e9, GJ=1e6, EI_y=1e6, EI_z=1e6, mass=10.0)


@pytest.fixture
def linearised(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The speed (rad/s) of every linearisation of Newton's method, as they come."""
    speeds, linearize = [], blade_state.linearize

    def noted(mesh, shape, omega, gravity):
        speeds.append(omega)
        return linearize(mesh, shape, omega, gravity)

    monkeypatch.setattr(blade_state, "linearize", noted)
    return speeds


def solved_in_turn(mesh: Mesh, speeds: Iterable[float], options: Options) -> Iterator[Solved]:
    start = None
    for omega in speeds:
        solved = solve_mesh(mesh, omega, options, start)
        start = solved.start
        yield solved


@pytest.mark.numerical
@pytest.mark.parametrize("blade", [FLAT, ROUND], ids=["flat", "round"])
def test_a_sweep_agrees_with_single_speeds(blade) -> None:
    speeds = [0.0, 3.0, 6.0, 7.0, 30.0, 7.0, 7.0]  # also far apart, back, and the same again
    swept = solve.mesh_sweep(blade, speeds, 20, 6)
    for omega, result in zip(speeds, swept, strict=True):
        alone = solve.chain_modes(discretize(blade, 20), omega, 6)
        assert (np.abs(result.frequencies / alone.frequencies - 1.0) <= alone.rounding).all()


@pytest.mark.numerical
def test_the_basis_of_a_sweep_is_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes = []
    eigh = lanczos.eigh

    def recorded(matrix, triangle):
        sizes.append(len(matrix))
        return eigh(matrix, triangle)

    monkeypatch.setattr(lanczos, "eigh", recorded)
    largest = []
    for _ in solved_in_turn(discretize(FLAT, 20), (3.0, 4.0, 5.0, 6.0), Options(10)):
        largest.append(max(sizes))
        sizes.clear()
    assert max(largest[1:]) < largest[0]


@pytest.fixture
def lumped(monkeypatch: pytest.MonkeyPatch) -> Mesh:
    """A straight blade with lumped masses. Flap is decoupled exactly, not only to rounding, which depends on the processor."""
    balance = solution.balance

    def decoupled(*arguments: Any) -> Steady:
        state = balance(*arguments)
        p = state.pencil
        flap = np.isin(np.arange(12) % 6, [2, 4])  # z and the rotation about y
        apart = flap[:, None] != flap
        assert max(np.abs(m[:, apart]).max() / np.abs(m).max() for m in (p.M, p.K)) < 1e-15
        M, C, K = (np.where(apart, 0.0, m) for m in (p.M, p.C, p.K))
        to_child = np.where(apart[:6, :6], 0.0, p.links.to_child)
        return replace(state, pencil=replace(p, M=M, C=C, K=K, links=replace(p.links, to_child=to_child)))

    monkeypatch.setattr(solution, "balance", decoupled)
    return discretize(FLAT, 40, "half_end", "body_fixed")


def only_flap(mesh: Mesh) -> lanczos.Start:
    """A start without any motion out of the plane of flap, which is decoupled at rest."""
    mask = np.zeros((len(mesh.nodes) - 1, 6))
    mask[:, [2, 4]] = 1.0
    vectors = np.random.default_rng(7).normal(size=(2, 2 * mask.size))
    return lanczos.Start(vectors * np.tile(mask.ravel(), 2), 26)


@pytest.mark.numerical
def test_modes_that_the_start_does_not_contain_are_reported_and_computed(lumped: Mesh) -> None:
    correct = solve_mesh(lumped, 0.0, Options(6))
    basis = only_flap(lumped)
    with pytest.raises(MissedModesError):
        lanczos.lanczos(correct.state.pencil, 6, basis)
    second = solve_mesh(lumped, 0.0, Options(6), replace(correct.start, basis=basis))
    np.testing.assert_allclose(second.modes.frequencies, correct.modes.frequencies, rtol=1e-12)


@pytest.mark.numerical
def test_the_count_reports_missing_modes(lumped: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    correct = solve_mesh(lumped, 0.0, Options(6))
    monkeypatch.setattr(completeness, "check_complete", lambda *_: None)
    altered = solve_mesh(lumped, 0.0, Options(6), replace(correct.start, basis=only_flap(lumped)))
    assert np.abs(altered.modes.frequencies / correct.modes.frequencies - 1.0).max() > 0.1


@pytest.mark.numerical
@pytest.mark.parametrize("gravity", [0.0, -9.81])
def test_a_settled_steady_state_is_as_accurate_as_a_stalled_one(
    gravity: float, linearised: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """In both cases within the rounding error that is stated; the settled one takes fewer linearisations."""
    mesh, speeds = discretize(FLAT, 100), np.linspace(5.0, 8.0, 13)
    options = Options(6, gravity=np.array([0.0, 0.0, gravity]))
    counts, results = [], []

    def stalled(energy: float, before: float, rounding: float) -> bool:
        return energy <= 10.0 * rounding and energy > 1e-2 * before

    for settled in (blade_state._converged, stalled):
        monkeypatch.setattr(blade_state, "_converged", settled)
        linearised.clear()
        solved = list(solved_in_turn(mesh, speeds, options))
        counts.append(len(linearised))
        errors = np.array([solution.rounding(mesh, s, options) for s in solved])
        results.append((np.array([s.modes.frequencies for s in solved]), errors))
    (settled, rounding), (stalled_, _) = results
    assert (np.abs(settled / stalled_ - 1.0) <= rounding).all()
    assert counts[0] <= counts[1] - 10


@pytest.mark.numerical
def test_a_fine_sweep_takes_one_linearisation_a_speed(linearised: list[float]) -> None:
    """The strains are extrapolated to rounding, which the poses in the hub's axes have lost."""
    speeds = np.linspace(5.0, 6.0, 25)
    for _ in solve.mesh_sweep(FLAT, speeds, 100, 6):
        pass
    assert len(linearised) <= len(speeds) + 12


@pytest.mark.parametrize("true", [1, 2, 3, 5])
def test_the_degree_of_the_extrapolation_is_that_of_the_values(true: int) -> None:
    rng = np.random.default_rng(true)
    at = np.linspace(-8.0, -1.0, 8)
    exact = np.polynomial.polynomial.polyval(at, rng.normal(size=(true + 1, 20))).T
    assert extrapolation.degree(at, exact * (1.0 + 1e-14 * rng.normal(size=exact.shape))) == true


def test_a_known_speed_is_not_extrapolated() -> None:
    mesh = discretize(replace(FLAT, precone=0.2), 20)  # its shape is no polynomial in Ω²
    *_, last = solved_in_turn(mesh, (1.0, 20.0, 30.0, 5.0, 9.0), Options(6))
    second = blade_state.extrapolate(mesh, last.start.coordinates, -9.0)
    assert second is not None
    np.testing.assert_allclose(second.relative, last.state.shape.relative, rtol=0, atol=1e-14)


@pytest.mark.numerical
def test_a_coned_blade_takes_hardly_more_than_two_linearisations_a_speed(linearised: list[float]) -> None:
    """With a cubic polynomial it would take nearly three."""
    speeds = np.linspace(0.0, 6.0, 31)
    for _ in solve.mesh_sweep(replace(FLAT, precone=0.2), speeds, 20, 6):
        pass
    assert len(linearised) <= 2.2 * len(speeds)
