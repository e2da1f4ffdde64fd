"""A cantilever along the rotor's axis above its critical speed: stable by gyroscopic forces, although K is indefinite."""

from dataclasses import replace

import numpy as np
import pytest

from southwell import Blade, section_mass, section_stiffness
from southwell.core.solve import mesh_modes, modes, sweep
from southwell.core.spectrum import gyroscopic
from southwell.core.spectrum.eigen import UnstableError
from southwell.core.spectrum.gyroscopic import GyroscopicStabilityWarning

LENGTH, EI = 10.0, 1e4
CRITICAL = 1.875104068711961**2 * np.sqrt(EI) / LENGTH**2  # of an Euler–Bernoulli cantilever of 1 kg/m


def shaft(ratio: float = 1.0) -> Blade:
    """``ratio``: of the bending stiffnesses in two directions."""
    stiffness, mass = section_stiffness(1e8, 1e4, EI, ratio * EI), section_mass(1.0, 1e-6, 1e-6)
    ends = np.array([0.0, LENGTH])
    return Blade("shaft", ends, np.repeat(stiffness, 2, 0), np.repeat(mass, 2, 0), np.zeros(2), precone=np.pi / 2)


@pytest.mark.parametrize("speed", [1.1, 2.0, 4.0])
def test_a_shaft_above_its_critical_speed_has_the_frequencies_of_the_rotating_frame(speed: float) -> None:
    """In inertial axes the frequencies are those at rest, so that they are |ω₀ ∓ Ω| in rotating ones."""
    with pytest.warns(GyroscopicStabilityWarning, match="gyroscopic forces alone"):
        solution = modes(shaft(), speed * CRITICAL, count=4)
    second = (4.694091132974175 / 1.875104068711961) ** 2
    correct = np.sort(np.abs([1 - speed, 1 + speed, second - speed, second + speed]))
    np.testing.assert_allclose(solution.frequencies / CRITICAL, correct, rtol=1e-5)


def test_a_sweep_through_the_critical_speed_continues() -> None:
    with pytest.warns(GyroscopicStabilityWarning):
        results = [
            m.frequencies[:2] / CRITICAL for m in sweep(shaft(), CRITICAL * np.array([0.5, 0.9, 1.1, 1.5]), count=2)
        ]
    np.testing.assert_allclose(results, [[0.5, 1.5], [0.1, 1.9], [0.1, 2.1], [0.5, 2.5]], rtol=2e-5)


def test_a_shaft_between_two_critical_speeds_is_unstable() -> None:
    """With unequal stiffnesses it diverges between the critical speeds of its two planes (Smith 1933)."""
    with pytest.raises(UnstableError, match="not positive definite"):
        modes(shaft(2.0), 1.2 * CRITICAL, count=2)


def test_a_missing_mode_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether it is the one with negative energy or another."""
    complete = gyroscopic._nearest_zero
    for missing in (0, 1, 2):

        def one_less(p, count, missing=missing):
            modes = complete(p, count)
            assert modes is not None
            return tuple(np.delete(part, missing, axis=-1) for part in modes)

        monkeypatch.setattr(gyroscopic, "_nearest_zero", one_less)
        with pytest.raises(UnstableError):
            mesh_modes(replace(shaft(), name=str(missing)), 2.0 * CRITICAL, 20, 4)


def test_a_cable_that_the_mesh_does_not_resolve_is_refused_without_iteration(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half as many modes as its stiffness has negative eigenvalues would have to converge: that took a minute."""

    def never(*_: object) -> None:
        raise AssertionError("the modes are iterated")

    monkeypatch.setattr(gyroscopic, "_nearest_zero", never)
    stiffness, mass = section_stiffness(1e9, 10.0, 1e-4, 2e-4), section_mass(1.0, 1e-13, 2e-13)
    ends = np.array([0.0, 10.0])
    cable = Blade("cable", ends, np.repeat(stiffness, 2, 0), np.repeat(mass, 2, 0), np.zeros(2))
    with pytest.raises(UnstableError, match="not positive definite"):
        mesh_modes(cable, 31.4, 250, count=2)
