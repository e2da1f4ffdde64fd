"""Differences between linearisations and core's turbine, split into parts that are planted."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from southwell.cases.input.errors import CaseError
from southwell.cases.linearisation.judgement import judge_set
from southwell.cases.linearisation.machine import deck, fields, models
from southwell.cases.linearisation.machine.causes import HYPOTHESES
from southwell.cases.linearisation.machine.deck import Deck
from southwell.cases.linearisation.machine.models import Models
from southwell.cases.linearisation.machine.split import AERODYNAMICS, NODES, REST, Comparison, compare
from southwell.cases.linearisation.modes import spectrum
from southwell.cases.linearisation.sets import AzimuthSet
from southwell.tests.support.elastodyn_decks import linearised, shaped


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> Deck:
    return deck.read(shaped(tmp_path_factory.mktemp("deck")))


@pytest.fixture(scope="module")
def healthy(machine: Deck) -> AzimuthSet:
    return linearised(machine)


def compared(azimuth_set: AzimuthSet, machine: Deck) -> Comparison:
    judged_set = judge_set(azimuth_set)
    return compare(replace(judged_set, modes=spectrum(azimuth_set, azimuth_set.A).modes), machine)


def test_point_masses_become_cores_restricted_turbine(machine: Deck, healthy: AzimuthSet) -> None:
    """Two derivations, point masses and geometrically exact beams in the same shapes, have the same modes."""
    fine = replace(machine, blade_nodes=1000, tower_nodes=1000)
    deck_models = Models(fine, healthy, models.degrees(fine, healthy), fields.points(fine))
    structure = deck_models.structure()
    undamped = replace(structure, nodes=replace(structure.nodes, damping=0.0 * structure.nodes.damping))
    A = [undamped.state_matrix(part, healthy) for part in models.matrices(undamped, healthy, False, False)]
    points, beams = models.of_states(deck_models, np.array(A)), deck_models.core(True)
    partner, mac = fields.paired(points, beams)
    assert (partner >= 0).all()
    assert np.abs(points.values) == pytest.approx(np.abs(beams.values[partner]), rel=1e-3)
    assert mac.min() > 0.99


def test_a_linearisation_of_the_deck_is_explained(machine: Deck, healthy: AzimuthSet) -> None:
    comparison = compared(healthy, machine)
    assert len(comparison.modes) == 13
    assert comparison.remark.startswith("the deck explains all differences")
    for pair in comparison.modes:
        assert sum(pair.parts.values()) == pytest.approx(pair.difference, abs=1e-12)
        assert abs(pair.parts[REST]) < 1e-6
        assert abs(pair.parts[AERODYNAMICS]) < 1e-6
    assert max(abs(pair.parts[NODES]) for pair in comparison.modes) > 0.005


def with_forces(machine: Deck, azimuth_set: AzimuthSet, family: str, damping: float, stiffness: float) -> AzimuthSet:
    """The set with a damper and a spring on the motion of each blade, of a run with aerodynamics."""
    structure = Models(machine, azimuth_set, models.degrees(machine, azimuth_set), fields.points(machine)).structure()
    on = np.diag([float(azimuth_set.states[k].family == family) for k in structure.coordinates])
    A = azimuth_set.A.copy()
    for a, (M, _, _) in zip(A, models.matrices(structure, azimuth_set, True, True), strict=True):
        a[np.ix_(structure.rates, structure.rates)] -= np.linalg.solve(M, damping * on)
        a[np.ix_(structure.rates, structure.coordinates)] -= np.linalg.solve(M, stiffness * on)
    return replace(
        azimuth_set, A=A, files=tuple(replace(file, modules=("ElastoDyn", "AeroDyn")) for file in azimuth_set.files)
    )


def test_damping_is_aerodynamics_and_stiffness_is_rest(machine: Deck, healthy: AzimuthSet) -> None:
    """Damping has no place in a structure beyond the deck's; symmetric stiffness has."""
    damped = compared(with_forces(machine, healthy, "flapwise 1", 2000.0, 0.0), machine)
    assert damped.remark.startswith("aerodynamic stiffness is part of the rest")
    parts = {pair.mode.name: pair.parts for pair in damped.modes}
    assert abs(parts["flapwise 1 collective"][AERODYNAMICS]) > 1e-3
    assert abs(parts["flapwise 1 collective"][REST]) < 1e-6
    stiff = compared(with_forces(machine, healthy, "edgewise 1", 0.0, 500.0), machine)
    pair = next(pair for pair in stiff.modes if pair.mode.name == "edgewise 1 forward")
    assert pair.parts[REST] > 1e-3
    assert abs(pair.parts[AERODYNAMICS]) < 1e-6
    assert pair.origin.endswith("%: stiffness, edgewise 1 whirl on itself")


def _altered(name: str, factor: float) -> Callable[[Deck], Deck]:
    each = next(each for each in HYPOTHESES if each.name == name)
    return lambda machine: each.alter(machine, factor)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("no gravity", 1.0),
        ("many nodes", 1.0),
        ("the generator's inertia without the square of the gear ratio", 1.0),
        ("the blades' mass", 1.03),
        ("the tower's stiffness", 1.04),
    ],
)
def test_an_altered_deck_is_named(name: str, factor: float, machine: Deck) -> None:
    comparison = compared(linearised(_altered(name, factor)(machine)), machine)
    assert comparison.remark.startswith("as the deck with ")
    assert comparison.causes[0].name == name
    assert comparison.causes[0].factor == pytest.approx(factor, rel=2e-3)


@pytest.mark.slow
def test_a_random_alteration_has_no_known_cause(machine: Deck) -> None:
    """Stations whose stiffness and mass change at random are no hypothesis."""
    rng = np.random.default_rng(3)
    blade = machine.turbine.blade
    n = len(blade.stations)
    stiffness, mass = blade.stiffness.copy(), blade.mass.copy()
    for k in range(n):
        for entry in (4, 5):
            stiffness[k, entry, entry] *= np.exp(0.2 * rng.standard_normal())
        mass[k] *= np.exp(0.2 * rng.standard_normal())
    other = replace(machine, turbine=replace(machine.turbine, blade=replace(blade, stiffness=stiffness, mass=mass)))
    comparison = compared(linearised(other, azimuths=1), machine)
    assert comparison.remark.startswith("no known cause of ")


def test_a_set_without_tower_has_a_rigid_one(machine: Deck) -> None:
    words = ("tower", "yaw", "Yaw", "Drivetrain")
    comparison = compared(linearised(machine, words=words), machine)
    assert comparison.remark.startswith("the deck explains all differences")
    assert {pair.mode.name.partition(" ")[0] for pair in comparison.modes} == {"flapwise", "edgewise"}


def test_motions_that_the_machine_lacks_are_refused(machine: Deck, healthy: AzimuthSet) -> None:
    altered = replace(machine, turbine=replace(machine.turbine, blades=2))
    with pytest.raises(CaseError, match="2 in the deck"):
        compared(healthy, altered)
    lacking = replace(machine, tower_shapes={})
    with pytest.raises(CaseError, match="stands on rigid ground"):
        compared(healthy, lacking)


def test_shapes_that_vanish_at_the_end_are_refused(tmp_path: Path) -> None:
    path = shaped(tmp_path)
    file = tmp_path / "blade.dat"
    file.write_text(file.read_text().replace("0.7 BldEdgSh(2)", "-0.3 BldEdgSh(2)"))
    with pytest.raises(CaseError, match="BldEdgSh: the coefficients sum to 0"):
        deck.read(path)
