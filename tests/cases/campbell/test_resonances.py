"""Crossings of n per revolution: against dense sweeps, an eigenproblem for the speed, and modes with known crossings."""

from collections.abc import Callable
from functools import cache
from typing import cast

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

from southwell.cases.campbell.diagram import Campbell, CampbellRequest, campbell
from southwell.cases.input import library
from southwell.core.blade import Blade
from southwell.core.element.discretize import discretize
from southwell.core.modes import STATIONS, Modes
from southwell.core.solve import mesh_modes
from southwell.core.spectrum.modal import linearize
from southwell.core.tree import as_mechanism
from southwell.core.tree.linearization import Linearization
from southwell.reports.campbell.tables import notes, sheets
from southwell.reports.shared.units import RAD_S

from ...support.veering import BLADE

ELEMENTS, MODES, PER_REV = 10, 6, (1, 2, 3, 4, 5, 6)


def subject(name: str) -> tuple[Blade, float]:
    """A blade of the library, and a speed up to which its modes cross many n per revolution, rad/s."""
    variant = library.load(name).variants[0]
    lowest = float(mesh_modes(variant.blade, 0.0, ELEMENTS, 1).frequencies[0])
    return variant.blade, max(float(max(variant.speeds)), 0.6 * lowest)


def _meets(blade: Blade, n: int, mode: int, between: np.ndarray) -> float:
    def apart(omega: float) -> float:
        return float(mesh_modes(blade, omega, ELEMENTS, MODES).frequencies[mode]) - n * omega

    return float(cast(float, brentq(apart, *between, xtol=1e-13 * between[1])))


def coarse(blade: Blade, top: float) -> Campbell:
    request = CampbellRequest((0.0, 0.5 * top, top), modes=MODES, per_rev=PER_REV)
    return campbell(blade, request, lambda omega: mesh_modes(blade, omega, ELEMENTS, MODES + 4))


def test_three_speeds_give_the_crossings_of_a_dense_sweep() -> None:
    """The n-th lowest mode is a continuous function of speed: its changes of sign need no tracking."""
    blade, top = subject("nrel-5mw")
    dense = np.linspace(0.0, top, 61)
    swept = np.array([mesh_modes(blade, omega, ELEMENTS, MODES).frequencies for omega in dense])
    coarse_answer = coarse(blade, top)
    number = 0
    for n in PER_REV:
        above = swept > n * dense[:, None]
        expected = [_meets(blade, n, int(mode), dense[k : k + 2]) for k, mode in np.argwhere(above[1:] != above[:-1])]
        actual = sorted(r.omega for r in coarse_answer.resonances if r.per_rev == n)
        np.testing.assert_allclose(actual, sorted(expected), rtol=1e-9)
        number += len(expected)
    assert len(coarse_answer.resonances) == number >= 5
    assert not coarse_answer.unlisted


def test_the_crossings_of_a_straight_blade_are_the_eigenvalues_of_one_problem() -> None:
    """(n² M − K₂ − i n C₁) x = Ω⁻² K₀ x, by the mechanism solver, with K₂ and C₁ from rest and the highest speed.

    All eigenvalues are crossings, and there are no others. Exactly, with K₂ and C₁ from rest and the crossing, since the
    stretch of the blade changes them slightly.
    """
    blade, top = subject("park-cantilever")
    coarse_answer = coarse(blade, top)

    @cache
    def matrices(at: float) -> Linearization:
        return linearize(as_mechanism.mechanism(discretize(blade, ELEMENTS), at))

    def speeds(n: int, at: float) -> np.ndarray:
        rest, turning = matrices(0.0), matrices(at)
        K0, K = (0.5 * (a.K + a.K.T) for a in (rest, turning))
        C, M = 0.5 * (turning.C - turning.C.T), 0.5 * (turning.M + turning.M.T)
        inverse = eigh(n**2 * M - (K - K0) / at**2 - 1j * n * C / at, K0, eigvals_only=True)
        return 1.0 / np.sqrt(inverse[inverse > 1.0 / top**2])

    for n in PER_REV:
        actual = [r.omega for r in coarse_answer.resonances if r.per_rev == n]
        assert len(speeds(n, top)) == len(actual)
        for omega in actual:
            assert np.abs(speeds(n, omega) / omega - 1).min() < 1e-9


def meeting(square: Callable[[float], float]) -> Callable[[float], Modes]:
    """A flap mode with ω² = ``square`` (Ω²), known within 1e-7, and an edge mode far above."""

    def solve(omega: float) -> Modes:
        shapes = np.zeros((2, 21, 4), complex)
        shapes[0, :, 2] = shapes[1, :, 1] = STATIONS**2
        frequencies = np.sqrt([square(omega**2), 1e4])
        return Modes(omega, frequencies, shapes, 10, uncertainty=np.full(2, 1e-7))

    return solve


def bent(bottom: float) -> Campbell:
    """ω² = 4 Ω² + 0.2 (Ω² − 5)² + ``bottom``, solved at four speeds."""
    request = CampbellRequest((0.5, 1.5, 2.5, 3.5), modes=1, per_rev=(2,))
    return campbell(BLADE, request, meeting(lambda x: 4 * x + 0.2 * (x - 5) ** 2 + bottom))


@pytest.mark.parametrize("bottom", [-1e-3, -0.02, -0.1])
def test_two_crossings_between_two_solved_speeds_are_found(bottom: float) -> None:
    resonances = bent(bottom).resonances
    expected = np.sqrt(5 + np.array([-1, 1]) * np.sqrt(-bottom / 0.2))
    assert [r.per_rev for r in resonances] == [2, 2]
    for r, omega in zip(resonances, expected, strict=True):
        assert abs(r.omega / omega - 1) <= r.uncertainty < 1e-3
        assert not r.touches


def test_a_touch_is_found_and_a_near_miss_is_none() -> None:
    (touch,) = bent(0.0).resonances
    assert touch.touches
    assert abs(touch.omega / np.sqrt(5) - 1) <= touch.uncertainty < 0.01
    assert not bent(0.01).resonances


def test_a_near_miss_within_the_uncertainty_is_not_excluded() -> None:
    (touch,) = bent(1e-6).resonances  # ω² is known within 4e-6
    assert touch.touches


def test_a_crossing_has_the_uncertainty_of_its_frequency() -> None:
    """ω² = 4 + 1.5 Ω² meets 2 per revolution at Ω² = 1.6; dΩ/Ω = n²/(n² − φ) dω/ω = 1.6e-7."""
    request = CampbellRequest((0.0, 2.0), modes=1, per_rev=(2,))
    diagram = campbell(BLADE, request, meeting(lambda x: 4 + 1.5 * x))
    (r,) = diagram.resonances
    assert r.omega == pytest.approx(np.sqrt(1.6), rel=1e-12)
    assert r.uncertainty == pytest.approx(1.6e-7, rel=1e-2)
    (sheet,) = (s for s in sheets(diagram, RAD_S) if s.title == "Crossings of n per revolution")
    assert sheet.rows[0][1:] == ("2P", "1.264911", "2.529822", "2e-07")


def test_a_mode_that_is_lost_where_it_crosses_is_a_warning() -> None:
    def jump(omega: float) -> Modes:
        shapes = np.zeros((2, 21, 4), complex)
        shapes[0, :, 2] = STATIONS
        shapes[1, :, 1 if omega < 1.495 else 0] = STATIONS
        return Modes(omega, np.array([5.0, 8.97]), shapes, 10, uncertainty=np.zeros(2))

    diagram = campbell(BLADE, CampbellRequest((0.0, 1.0, 1.8), modes=2, per_rev=(3, 6)), jump)
    (crossing,) = diagram.unlisted
    assert (crossing.per_rev, crossing.number) == (6, 1)
    assert crossing.omega[0] < 1.495 <= crossing.omega[1]
    assert [(r.per_rev, r.omega) for r in diagram.resonances] == [(6, pytest.approx(5 / 6)), (3, pytest.approx(5 / 3))]
    assert any(note.startswith("6P: from 1.49") and "changes by +1 more" in note for note in notes(diagram, RAD_S))
