"""Deliberate faults in core: each is the one it is said to be. That the harness notices them: ``test_faults``."""

from dataclasses import replace

import numpy as np
import pytest

from southwell.cases.diagnosis import blade_errors, scaled_terms
from southwell.cases.faults import table
from southwell.cases.input import library
from southwell.cases.verify import fault_effects
from southwell.core.blade import Blade
from southwell.core.element.discretize import Mass
from southwell.core.element.measures import Measure
from southwell.core.modes import Modes
from southwell.references.theories import exact_beam

from ...support.straight_blades import Y, Z, family, park

OMEGA = 10.0
AT_REST = 10.54925  # Euler–Bernoulli: 1.875104² √(EI / (ρ A L⁴))


def first(modes: Modes, column: int = Y) -> float:
    return float(family(modes, column)[0])


def made(fault: str, omega: float = OMEGA, how: tuple[Mass, Measure] = fault_effects.CONSISTENT) -> Modes:
    modes = fault_effects.solved(fault, park(), omega, 10, how)
    assert modes is not None
    return modes


def exact(blade: Blade, omega: float = OMEGA) -> Modes:
    return exact_beam.CODE.solve(blade, omega, 24, 10)


def test_without_geometric_stiffness_the_rotation_only_softens() -> None:
    """In the plane of rotation ω² = ω₀² − Ω²: 3.36 instead of 11.71; out of it ω₀ stays."""
    altered = made("no geometric stiffness")
    assert first(altered) == pytest.approx(np.sqrt(AT_REST**2 - OMEGA**2), rel=1e-3)
    assert first(altered, Z) == pytest.approx(AT_REST, rel=1e-3)


def test_softening_reversed_adds_twice_the_square_of_the_speed() -> None:
    """ω² = ω_flap² + Ω² in the plane of rotation, but for stretch and Coriolis; out of it nothing changes."""
    altered, correct = made("softening's sign"), exact(park())
    assert first(altered) == pytest.approx(np.sqrt(first(correct, Z) ** 2 + OMEGA**2), rel=3e-4)
    assert first(altered, Z) == pytest.approx(first(correct, Z), rel=5e-5)


def test_a_frozen_frame_reads_edgewise_as_flapwise() -> None:
    altered, correct = made("frozen frame"), exact(park())
    assert altered.frequencies[:2] == pytest.approx([first(correct, Z)] * 2, rel=5e-5)
    assert altered.frequencies[0] / first(correct) - 1.0 == pytest.approx(0.315, abs=1e-3)


def test_softening_is_that_of_points() -> None:
    """For lumped masses −Ω² m along x and y, nothing along z, nothing between nodes."""
    from southwell.core.element.discretize import discretize
    from southwell.core.tree import pencil

    blade = park()
    body = discretize(blade, 4, "half_end")
    own = scaled_terms.spin_softening(body, pencil.undeformed(body), OMEGA)
    mass = np.diagonal(body.lumps, axis1=1, axis2=2)[1:, 0]
    expected = -(OMEGA**2) * mass[:, None] * [1.0, 1.0, 0.0]
    beyond = own[-1, 6:, 6:]  # of the tip, which is part of the last element
    on_nodes = np.concatenate([own[1:, :6, :6], beyond[None]])
    on_nodes[-2] -= beyond
    np.testing.assert_allclose(np.diagonal(on_nodes, axis1=1, axis2=2)[:, :3], expected, rtol=1e-12, atol=1e-12)
    assert not own[:-1, 6:].any()
    assert not own[:-1, :, 6:].any()


def test_a_shifted_axis_without_couplings_is_a_stiffer_beam() -> None:
    """EI_z + EA e² with e a quarter of √(EI_z/EA): frequencies times √(1 + 1/16); flapwise as before."""
    altered, correct = made("axis shifted", 0.0), exact(park(), 0.0)
    stiff = max(altered.frequencies[:2])
    assert stiff / correct.frequencies[0] == pytest.approx(np.sqrt(1 + blade_errors.OFFSET**2), rel=1e-4)
    assert min(altered.frequencies[:2]) == pytest.approx(correct.frequencies[0], rel=1e-4)


def test_a_whole_end_mass_is_half_an_elements_mass_too_much() -> None:
    blade = park()
    extra = 0.5 * blade.mass[0, 0, 0] * blade.length / 15
    heavier = replace(blade, tip_mass=np.diag([extra] * 3 + [0.0] * 3))
    ratio = first(made("whole end mass", how=fault_effects.LUMPED)) / first(made("", how=fault_effects.LUMPED))
    assert ratio == pytest.approx(first(exact(heavier)) / first(exact(blade)), abs=2e-3)
    assert ratio < 0.95


def test_without_hub_radius_and_coriolis() -> None:
    blade = park()
    assert first(made("no hub radius")) == pytest.approx(first(exact(replace(blade, hub_radius=0.0))), rel=1e-6)
    without = made("no Coriolis")
    assert 1e-4 < first(without) / first(exact(blade)) - 1.0 < 1.3e-4  # Yoo–Shin coupled and uncoupled: 0.012 %


def test_a_coarse_mode_is_found_among_the_converged() -> None:
    """Fifteen point masses are 2 % off in the second mode; still it is the one that half a mass too much is seen in."""
    case = library.load("tip-mass")
    variant = replace(case.variants[0], speeds=np.array([12.0]))
    (altered,) = (w for w in fault_effects.solve(variant, case.text.compare) if w.fault == "whole end mass")
    assert max(altered.modes, key=lambda m: abs(m.change or 0.0)).name == "flapwise 2"


def test_a_blade_that_a_mistake_leaves_singular_has_no_modes_to_tell_of() -> None:
    """A free lag hinge on the rotor's axis is not held by anything: its frequency is nought, or not a number."""
    lagging = replace(park(), hub_radius=0.6, root=np.array([np.inf] * 5 + [0.0]))
    variant = replace(library.load("park-cantilever").variants[0], blade=lagging, speeds=np.array([OMEGA]))
    wrongs = fault_effects.solve(variant, library.load("park-cantilever").text.compare)
    assert next(w for w in wrongs if w.fault == "no Coriolis").modes
    assert len(wrongs) == len(table.FAST)
