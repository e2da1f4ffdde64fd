"""Core's reference: the modes that a case compares, and their names."""

import numpy as np
import pytest

from southwell.cases.input.schema import Compare
from southwell.cases.judge.reference import Converged
from southwell.cases.solve.core_solver import answers, converged
from southwell.core.blade import Blade, section_mass, section_stiffness, uniform_blade
from southwell.core.effects import ALL_EFFECTS
from southwell.core.modes import Modes
from southwell.core.solve import mesh_modes, modes
from southwell.references.protocol.process import Failure


@pytest.mark.parametrize("motion", ["flapwise", "edgewise"])
def test_modes_keep_their_names_whatever_is_compared(motion: str) -> None:
    """A beam twisted by a quarter turn: one of its mixed modes is mostly flapwise, the other mostly edgewise."""
    stations = np.array([0.0, 2.0])
    stiffness = np.repeat(section_stiffness(1e7, 1e3, 1e4, 2e4), 2, axis=0)
    mass = np.repeat(section_mass(1.2, 1e-3, 1e-3), 2, axis=0)
    blade = Blade("twisted", stations, stiffness, mass, stations * np.pi / 4)
    (result,) = converged(blade, [10.0], Compare(modes=3, motions=(motion,)), ALL_EFFECTS)  # type: ignore[arg-type]
    assert isinstance(result, Converged)
    mixed = {"flapwise": "mixed 1", "edgewise": "mixed 2"}[motion]
    assert result.names == (f"{motion} 1", f"{motion} 2", mixed)
    assert [result.spectrum.labels[k] for k in result.indices] == list(result.names)
    assert {"mixed 1", "mixed 2"} < set(result.spectrum.labels)


@pytest.mark.parametrize("fraction", [1e-3, 3e-3, 1e-2])
def test_a_soft_root_between_two_stations_is_within_the_stated_uncertainty(fraction: float) -> None:
    """A stiffness that grows 29-fold in a short interval: equal elements never divide it, 400 stations on its line do."""

    def blade(parts: int) -> Blade:
        s = np.append(np.linspace(0.0, 10.0 * fraction, parts + 1), 10.0)
        k = np.interp(s, [0.0, 10.0 * fraction, 10.0], [1.0 / 29.0, 1.0, 1.0])
        mass = np.repeat(section_mass(10.0, 0.1, 0.2), len(s), axis=0)
        return Blade("soft root", s, section_stiffness(1e9 * k, 1e6 * k, 1e6 * k, 2e6 * k), mass, np.zeros(len(s)))

    (result,), dense = converged(blade(1), [0.0], Compare(modes=6), ALL_EFFECTS), modes(blade(400), 0.0, count=6)
    assert isinstance(result, Converged)
    assert result.indices == tuple(range(6))
    for mode, expected, uncertainty in zip(result.modes, dense.frequencies, dense.uncertainty, strict=True):
        assert mode.estimate is not None
        assert mode.estimate.uncertainty is not None
        assert abs(mode.estimate.value / expected - 1.0) <= mode.estimate.uncertainty + uncertainty


def test_the_reference_is_refined_until_it_can_judge_a_code() -> None:
    """To 5e-5, a quarter of what is asked of a code; 90 elements leave 0.3 % of this beam, which is nearly a cable."""
    beam = uniform_blade("beam", 6.0, 0.3, EA=1e7, GJ=1e3, EI_y=1.0, EI_z=2.0, mass=1.2)
    (result,) = converged(beam, [10.0], Compare(modes=2), ALL_EFFECTS)
    assert isinstance(result, Converged)
    assert max(m.estimate.uncertainty or 1.0 for m in result.modes if m.estimate) <= 5e-5


def test_a_speed_without_a_steady_state_costs_no_other_speed() -> None:
    soft = uniform_blade("soft", 6.0, 0.3, EA=1e4, GJ=1e3, EI_y=1e3, EI_z=2e3, mass=1.2)
    runs = [(omega, n, 4) for n in (10, 20) for omega in (0.0, 2.0, 1e3, 4.0)]
    result = answers(soft, runs)
    for (omega, elements, count), answer in zip(runs, result, strict=True):
        if omega == 1e3:
            assert isinstance(answer, Failure)
            assert answer.kind == "refused"
        else:
            assert isinstance(answer, Modes)
            assert (answer.omega, answer.elements) == (omega, elements)
            alone = mesh_modes(soft, omega, elements, count)
            np.testing.assert_allclose(answer.frequencies, alone.frequencies, rtol=1e-10)
