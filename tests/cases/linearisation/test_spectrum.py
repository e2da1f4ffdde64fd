"""Frequencies and damping of a machine by formula, against a direct integration in the rotating frame."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from southwell.cases.linearisation.judged import FLOQUET, JudgedSet
from southwell.cases.linearisation.judgement import judge_set
from southwell.cases.linearisation.lin_file import parsed
from southwell.cases.linearisation.modes import spectrum
from southwell.cases.linearisation.rotating_nodes import coriolis_content, rotated
from southwell.cases.linearisation.sets import AzimuthSet, azimuth_set
from southwell.tests.support.linearised_defects import MACHINE, healthy, healthy_nodes, tower_in_millimetres
from southwell.tests.support.linearised_machines import Lin, Machine

Complex = NDArray[np.complex128]


def as_set(lins: list[Lin]) -> AzimuthSet:
    return azimuth_set("case", [parsed(Path(f"case.{k + 1}.lin"), lin.text()) for k, lin in enumerate(lins)])


def judged(lins: list[Lin]) -> JudgedSet:
    return judge_set(as_set(lins))


def floquet_exponents(machine: Machine) -> Complex:
    """Exponents of ẋ = A(Ωt) x of the states of the file over one revolution, by Runge–Kutta; known up to multiples of Ωi."""
    samples, steps = 40, 3000
    coefficients = np.fft.fft([machine.A(2 * np.pi * k / samples) for k in range(samples)], axis=0) / samples
    orders = np.fft.fftfreq(samples, 1 / samples)
    psi = 2 * np.pi * np.arange(2 * steps + 1) / (2 * steps)
    A = np.real(np.tensordot(np.exp(1j * np.outer(psi, orders)), coefficients, 1))
    h = 2 * np.pi / machine.omega / steps
    Phi = np.eye(28)
    for k in range(steps):
        a, b, c = A[2 * k], A[2 * k + 1], A[2 * k + 2]
        k1 = a @ Phi
        k2 = b @ (Phi + h / 2 * k1)
        k3 = b @ (Phi + h / 2 * k2)
        Phi = Phi + h / 6 * (k1 + 2 * k2 + 2 * k3 + c @ (Phi + h * k3))
    return np.asarray(np.log(np.linalg.eigvals(Phi).astype(complex)) / (h * steps), dtype=np.complex128)


def distance(value: complex, exponents: Complex, omega: float) -> float:
    """Distance to the nearest exponent, relative."""
    turns = np.round((value.imag - exponents.imag) / omega)
    return float(np.abs(exponents + 1j * omega * turns - value).min() / abs(value))


def test_modes_equal_those_of_a_direct_integration() -> None:
    machine = Machine(gravity=0.0)
    exponents = floquet_exponents(machine)
    judgement = judged(healthy(machine, 5, decimals=9))
    assert len(judgement.modes) == 13
    for mode in judgement.modes:
        assert distance(mode.eigenvalue, exponents, machine.omega) < max(1e-6, mode.relative_uncertainty)


def test_gravity_is_treated_by_floquet_theory() -> None:
    machine = Machine(gravity=60.0)
    exponents = floquet_exponents(machine)
    azimuth_set = as_set(healthy(machine, 12, decimals=9))
    result = judge_set(azimuth_set)
    assert result.method == FLOQUET
    mean = {
        mode.name: distance(mode.eigenvalue, exponents, machine.omega)
        for mode in spectrum(azimuth_set, azimuth_set.A).modes
    }
    periodic = {mode.name: distance(mode.eigenvalue, exponents, machine.omega) for mode in result.modes}
    assert max(mean.values()) > 5e-4
    assert max(periodic.values()) < max(mean.values()) / 5
    assert all(periodic[mode.name] < max(1e-6, mode.relative_uncertainty) for mode in result.modes)


def test_modes_are_named() -> None:
    names = [mode.name for mode in judged(healthy(Machine(gravity=0.0), 5)).modes]
    assert names[:7] == [
        "tower side-side 1",
        "tower fore-aft 1",
        "flapwise 1 backward",
        "flapwise 1 collective",
        "flapwise 1 forward",
        "edgewise 1 backward",
        "edgewise 1 forward",
    ]
    assert "drivetrain" in names


@pytest.mark.parametrize("decimals", [2, 3])
def test_the_uncertainty_covers_the_error_of_printed_digits(decimals: int) -> None:
    errors = []
    for omega in (1.0, 1.1):
        exact = {m.name: m for m in judged(healthy(Machine(gravity=0.0, omega=omega), 3, decimals=10)).modes}
        for mode in judged(healthy(Machine(gravity=0.0, omega=omega), 3, decimals=decimals)).modes:
            errors.append(abs(mode.eigenvalue - exact[mode.name].eigenvalue) / mode.uncertainty)
    assert max(errors) < 1
    assert np.median(errors) > 0.03  # not a bound that covers anything


def test_units_of_the_tower_do_not_change_the_modes() -> None:
    judgement, millimetres = judged(healthy(MACHINE)), judged(tower_in_millimetres())
    for mode, counterpart in zip(judgement.modes, millimetres.modes, strict=True):
        assert mode.name == counterpart.name
        assert counterpart.frequency == pytest.approx(mode.frequency, rel=1e-3)
        assert counterpart.confidence == pytest.approx(mode.confidence, abs=0.01)


def test_frozen_nodes_give_the_modes_of_rotating_ones() -> None:
    rotating, frozen = as_set(healthy_nodes(n=1)), as_set(healthy_nodes(n=1, frozen=True))
    assert coriolis_content(rotating) == pytest.approx(1.0, abs=1e-6)
    assert coriolis_content(frozen) == pytest.approx(0.0, abs=1e-6)
    expected = spectrum(rotating, rotating.A).modes[:12]
    for mode, counterpart in zip(expected, spectrum(frozen, rotated(frozen, frozen.A)).modes, strict=False):
        assert counterpart.frequency == pytest.approx(mode.frequency, rel=2e-5)
    altered = spectrum(frozen, frozen.A).modes[:12]
    assert max(abs(w.frequency / m.frequency - 1) for w, m in zip(altered, expected, strict=True)) > 0.01
